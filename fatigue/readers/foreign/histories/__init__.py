"""Modal coordinates as a simulation exports them: text of any layout, Parquet, ``.mcf``.

``text`` and ``mcf`` read a ``foreign_history``. Of a text, ``number_rows`` finds the table, ``row_values`` reads it,
``header_lines`` and ``header`` read what stands above it, ``statements`` the free text there. ``matching`` finds the
FE modes of the columns, by ``mode_frequencies`` among others; ``time_grid`` makes the steps uniform.
"""
