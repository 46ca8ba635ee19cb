"""What joins the events of a block of stations: loops, counted from residues, or bounded where nothing was counted."""
