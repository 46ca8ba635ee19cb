"""The files of a case go in; the modal stress of a group of welds, all its modes at once, comes out.

In the order of the work: ``rated_curves`` (the S-N curves the case asks for) and ``body`` (its small files) are read
once; ``weld_groups`` cuts the welds into groups and opens their forces; ``model`` solves a group; ``stations`` lays out
its nodes as one table; ``modal_stress`` is what counting needs of some of them.
"""
