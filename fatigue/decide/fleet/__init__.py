"""Damage of units that ran different distances under the conditions of several results.

``story`` first. ``fleet_file`` and ``distances`` are what is given, ``conditions`` what the results say of them;
``units``, ``percentiles`` and ``variance`` are the arithmetic; ``rows``, ``summary`` and ``page`` what comes out.
"""
