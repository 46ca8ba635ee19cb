"""The command for life against the frequency or damping of a mode."""
