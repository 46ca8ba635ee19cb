"""Records of modal coordinates: in memory, or on disk."""
