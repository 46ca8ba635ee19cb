"""What a result is taken away as: ``vtp`` for ParaView, ``pdf`` a print of the page, ``export`` a workbook and CSV."""
