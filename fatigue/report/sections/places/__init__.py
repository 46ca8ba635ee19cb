"""Single places of the body: ``section`` shows hot spots and every point, ``deflated`` packs these."""
