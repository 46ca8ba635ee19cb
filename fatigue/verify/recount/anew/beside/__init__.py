"""What is checked beside the normal stress at the toe once more: throats, stress points, pairs of static load cases.

``throat`` and ``point_stress`` make stresses per unit coordinate, ``mission`` counts them over all events, and
``endurance`` compares static load cases.
"""
