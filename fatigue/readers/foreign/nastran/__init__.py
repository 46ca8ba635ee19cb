"""NASTRAN and OptiStruct: decks and results."""
