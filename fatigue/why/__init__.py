"""What makes the damage: modes, bands, events, places; and what would help.

``points`` chooses the points, ``attribute`` shares their damage out, ``levers`` counts again with smaller modes,
``verdicts`` judges the frequency domain; ``evidence`` holds what they found, of which ``rows`` are written and
``findings`` are said.
"""
