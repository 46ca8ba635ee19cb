"""Channels of any recording: listed, and written as a table that a case reads."""
