"""A NASTRAN deck: lines, cards, shells, sets."""
