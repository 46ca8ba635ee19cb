"""Static subcases as loads beside the modes: their names, which of them are loads, and what is doubtful about them."""
