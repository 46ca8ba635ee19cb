"""Channels of tables: workbooks, text, Parquet, files of modal coordinates."""
