"""Do the tests notice a small mistake: mutants of the package, tried one by one in a copy of the tree."""
