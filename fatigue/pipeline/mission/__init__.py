"""The records of the events go in; what each of them brings to every station comes out.

``events`` reads and checks the records, ``record_units`` tells times that cannot be s; ``event_load`` holds a record
that is ready to be counted, with its second-order statistics.
"""
