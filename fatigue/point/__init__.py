"""Any point of a finished result on demand: its history, its cycles, what the report shows of the worst ones."""
