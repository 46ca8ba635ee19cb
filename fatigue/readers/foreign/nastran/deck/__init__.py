"""A NASTRAN deck, from text to model: ``lines``, ``cards`` of ``fields``, ``bulk`` data by id, the model in ``bdf``."""
