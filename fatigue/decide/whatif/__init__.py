"""A result under another mission, curve or load without counting again, and how sure each number is then."""
