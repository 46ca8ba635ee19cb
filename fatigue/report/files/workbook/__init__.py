"""The workbook of a result: ``book`` puts it together, ``cover`` says the verdict, ``sheet`` writes a table."""
