"""From events and stations to damage: estimated, bounded or counted, and weighted with the mission."""
