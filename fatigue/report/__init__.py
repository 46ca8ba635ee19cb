"""The page, its figures, and the files a result is taken away as.

``page`` is the story: ``result`` reads the tables, ``inputs`` finds the input files again, ``stress``, ``domains`` and
``variants`` compute what no table holds; ``figures`` draws, ``sections`` lays out the parts of the page, ``templates``
holds its text, ``wording`` writes numbers for people. ``files`` are the picture, the print, the workbook and CSV.
"""
