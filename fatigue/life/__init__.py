"""From stress histories to damage and kilometres."""
