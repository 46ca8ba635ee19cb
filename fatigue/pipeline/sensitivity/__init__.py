"""Which welds change their verdict under other assumptions, one at a time, over all of their toe points.

``closed`` has what follows in closed form from what was counted, exactly or as an upper bound, ``recount`` the damage
of some stations under another law, size or record, ``sampling`` the records sampled otherwise, and ``worst`` finds the
worst point of each weld and counts no more points than its verdict needs. ``group`` puts them together for a group of
welds.
"""
