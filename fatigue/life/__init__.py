"""From stress histories to damage and kilometres: the method.

=========== ========================================================================================================
curves      S-N curves, and the damage law that an assessment draws from one
rule        the master equation: from the range of one cycle to dS and its damage, and the rule that says how
records     modal coordinates of events, in memory or on disk
counting    histories to cycles, and cycles to the damage of a block of points
bounds      proven upper bounds of that damage, for points that need no counting
mission     damage of single passes to kilometres
load_factor the factor on all stresses that just meets the target
attribution which modes, instants and frequencies owe the damage
shear       what shear would add
=========== ========================================================================================================
"""
