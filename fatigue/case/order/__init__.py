"""The known order of events in ``case.toml``: its table, and what is wrong with one."""
