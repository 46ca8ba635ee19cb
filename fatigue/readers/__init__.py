"""Files to arrays: the only place where units and conventions of foreign files are converted."""
