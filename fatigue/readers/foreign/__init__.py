"""Files of other programs: FE results, FE models and modal coordinates, the same for every solver.

``formats`` lists what is read, ``read`` finds the reader of a file. Readers of one solver have a folder of their own,
``nastran``; what they give is in ``fe`` and ``histories``.
"""
