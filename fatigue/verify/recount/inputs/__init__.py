"""The inputs of a result, read anew."""
