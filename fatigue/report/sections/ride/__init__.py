"""The part of the page about the channels of a ride, where one was made.

``read`` reads its tables, ``hunting`` says channel by channel where it is hot and what that does to the welds,
``tables`` has the coincidence, the alarm and what standards say, ``section`` puts them together for the template.
"""
