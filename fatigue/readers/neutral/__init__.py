"""The neutral format: tables of a case, read with file, column, row and value of every mistake.

``files`` opens a table, Parquet or CSV, as ``columns``; ``tables`` gives them as arrays and collects what is wrong.
``body``, ``history``, ``forces`` and ``register`` make of tables what a case is about. ``line_file`` keeps the weld
lines on disk.
"""
