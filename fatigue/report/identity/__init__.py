"""Who answers for a result and what its report looks like: identity, logo, company template.

``identity`` reads what a case says of it and keeps what was issued in the provenance; ``logo`` and ``template`` open
the files, ``contrast`` says whether colours can be read, ``paper`` writes the head and foot of every printed page.
"""
