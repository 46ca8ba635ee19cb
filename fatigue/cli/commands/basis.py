"""The command for whether the modal basis of a case is complete enough."""
