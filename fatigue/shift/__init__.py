"""Life against the frequency or damping of one mode, by filtering its coordinate: a screening without feedback."""
