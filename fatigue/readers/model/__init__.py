"""A finite element body to reduce: a shell mesh with its properties, or K and M with what their rows are."""
