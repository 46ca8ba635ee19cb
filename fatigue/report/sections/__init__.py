"""The parts of the page, each as data for a template.

Of the whole body: ``body`` (its figures), ``tables`` and ``method``; of one weld: ``weld``, with what ``details``
recovers from the records and the tables of ``weld_tables``; of a diagnosis: ``why``; ``checks`` recomputes. ``embed``
numbers and packs figures, ``cells`` writes the cells of tables.
"""
