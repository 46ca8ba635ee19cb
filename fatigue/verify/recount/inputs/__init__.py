"""The inputs of a result, read anew.

``dialect`` brings CSV tables of any layout to plain texts, ``tables`` reads whole tables or some rows of them,
``register`` says which welds count and under which names, and ``case`` opens all of it for one result: the input files
as they were assessed, or a refusal.
"""
