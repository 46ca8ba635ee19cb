"""What is known about foreign forces before they are believed: sign, balance, frames, completeness.

``audit`` asks every check for its row; each check has a file: ``element_balance``, ``grid_totals``, ``sign_proof``,
``completeness`` and ``modes``. ``tension_patch`` is the deck of a run that shows the sign of a solver.
"""
