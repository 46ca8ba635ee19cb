"""A public ledger: ours and every rival on the same signals, ``python -m benchmarks ledger``.

``signals`` are what is counted, ``ways`` who counts and how, ``reference`` is what is right. ``child`` measures one way
on one signal in a process of its own, ``story`` goes through all of them, ``written`` makes the page and the table.
"""
