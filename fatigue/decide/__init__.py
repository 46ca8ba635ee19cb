"""Decisions from finished results: bench programmes, comparison, other missions and curves, what just holds, fleets.

``of_result`` is what all of them read of a result, ``beside_results`` keeps them out of its folder, ``text_lines``
prints their tables. ``bench_files`` reads what a bench programme is asked for, ``bench_points`` finds its points in a
result, and what one unit of each load does there; ``compare``, ``whatif``, ``backsolve`` and ``fleet`` are rooms with a
``story`` each.
Nothing is counted again unless the answer cannot be had otherwise, and the answer says so.
"""
