"""Damaged files for every reader: none may crash, hang or change what it means without a word.

    python -m tests.fuzz --count 10000 --seed 0

Every file is known by its seed and number: ``--only 1234 --keep DIR`` damages number 1234 once more and keeps it.
"""
