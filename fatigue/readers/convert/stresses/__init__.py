"""Shell stresses at stress points: where they are read, in which axes they stand, and what proves these."""
