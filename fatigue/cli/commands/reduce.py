"""The command for reducing a finite element body to a modal basis."""
