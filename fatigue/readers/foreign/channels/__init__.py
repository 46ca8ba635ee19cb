"""Recorded and exported channels: files of many channels in groups, each on a time base of its own."""
