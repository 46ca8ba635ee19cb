"""A job goes in; its groups of welds come out one after the other, solved and counted, whoever does the work.

``work`` opens a job, from which any group can be assessed; ``checkpoint`` keeps what is finished, so that a run goes on
where one was interrupted; ``workers`` has the groups assessed by threads or, through ``orders``, by other processes,
such as those of a ``cluster``; ``trial`` foretells how long it will take.
"""
