"""One FE run, the same for every solver and file format: its model, its forces and its mode shapes."""
