"""What a result is taken away as: ParaView's lines, a print of the page, a workbook and CSV."""
