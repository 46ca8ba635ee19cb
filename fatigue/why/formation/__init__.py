"""How the resonance that damages forms: effective excitation of the modes, what follows it and what swings."""
