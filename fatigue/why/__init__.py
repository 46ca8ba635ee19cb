"""What makes the damage: modes, bands, events, places; and what would help."""
