"""Results beside each other: welds and points matched, ratios of lives, and what exactly makes them."""
