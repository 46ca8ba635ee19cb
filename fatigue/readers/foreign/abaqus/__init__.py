"""Abaqus: the text that the script writes, and decks (.inp)."""
