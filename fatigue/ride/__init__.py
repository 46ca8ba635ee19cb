"""Channels of a ride: hunting and its stretches, coincidence with equipment, alarm, comfort, vibration of equipment."""
