"""The records of the events go in; what each of them brings to every station comes out.

``plan`` checks the records and says how often each is passed, ``record_units`` tells times that cannot be s; ``events``
reads the records and prepares them; ``event_load`` holds one that is ready to be counted, with its second-order
statistics.
"""
