"""The weld register: what is assessed, under which name, and which lines are one weld.

``weld_register`` are its rows, ``register_file`` reads and writes them; ``registered`` applies them to the welds of the
tables, ``registered_lines`` to their lines and plate sides. ``conversion`` is what a conversion has left for that.
"""
