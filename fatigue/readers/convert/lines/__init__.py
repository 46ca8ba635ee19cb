"""Where weld lines come from: the surfaces of a model, and the edges a user marked on them."""
