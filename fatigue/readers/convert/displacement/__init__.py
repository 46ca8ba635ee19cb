"""An elastic displacement of the simulation as a proof of modal coordinates: read, compared, judged."""
