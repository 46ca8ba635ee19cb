"""Files of other programs: FE results, FE models and modal coordinates, the same for every solver."""
