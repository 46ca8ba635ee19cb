"""Modal coordinates as a simulation exports them: text of any layout, Parquet, ``.mcf``."""
