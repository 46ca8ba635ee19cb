"""The part of the page about how resonances form, where a diagnosis says so.

``read`` reads its tables, ``words`` says what the stress of one weld is made of, ``section`` ranks what to watch and
shows what the modes that matter do event by event.
"""
