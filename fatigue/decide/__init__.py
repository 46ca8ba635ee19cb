"""Decisions from a finished result: nothing is counted again, no input file is needed.

``bench_files`` reads what a bench programme is asked for, ``bench_points`` finds its points in a result, and what one
unit of each load does there.
"""
