"""Foreign files in, a folder of neutral files out.

``options`` is what a conversion is told, ``convert`` the story: ``inputs`` reads and audits, ``weld_lines`` finds the
welds, ``weld_forces`` and ``neutral_tables`` make the tables, ``case_text`` the case, ``record`` what is kept about it
all, and ``folder`` writes everything or nothing. ``modal_basis`` brings the modes of both sides together.
"""
