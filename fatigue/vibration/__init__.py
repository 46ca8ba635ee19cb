"""Vibration of one record: modal excitation, hunting, comfort, and limits of equipment and running behaviour.

Records in, numbers out: nothing here knows of welds, cases or files.
"""
