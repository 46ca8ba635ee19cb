"""Cycles across events once more: ``turns`` keep what counts of a pass, ``sequence`` counts a loop of them.

``unknown_order`` pairs what is open; ``loop`` makes a row of either, with the bounds of ``chain_rounding``.
"""
