"""Does the installed program compute what it says: known values, and a recount of finished results."""
