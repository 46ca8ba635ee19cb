"""The command for studies: the analysis graph, variants, claims."""
