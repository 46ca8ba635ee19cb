"""The line system of a weld solved anew, and columns of solid welds summed anew."""
