"""The weld register: what is assessed, under which name, and which lines are one weld."""
