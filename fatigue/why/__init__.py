"""What makes the damage: modes, bands, events, places; and what would help.

``points`` chooses the points, ``attribute`` shares their damage out, ``levers`` counts again with smaller modes,
``verdicts`` judges the frequency domain; ``rows`` are written, ``findings`` are said.
"""
