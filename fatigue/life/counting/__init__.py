"""From stress to cycles to damage: rainflow counters."""
