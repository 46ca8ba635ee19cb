"""Whether the modal basis of a body is complete enough for its welds."""
