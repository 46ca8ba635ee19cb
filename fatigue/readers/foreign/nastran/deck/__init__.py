"""A NASTRAN deck, from text to model: ``lines``, ``cards`` of ``fields``, ``bulk`` data by id, and the model in ``bdf``."""
