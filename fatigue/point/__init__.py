"""Any point of a finished result on demand: its history, its cycles, what the report shows of the worst ones.

``found`` says which point is meant, ``reopened`` reads the inputs of its result again. ``history`` is its stress over
time and ``cycles`` are all its cycles, both as they were counted. ``written`` is the story of a history that goes to a
file, with nothing ``in_the_way``, in one of the ``formats``, with a ``summary`` of what it spans; ``result`` opens a
result in a notebook, whose figures are ``drawn`` as in the report. ``page`` shows all of it of one point.
"""
