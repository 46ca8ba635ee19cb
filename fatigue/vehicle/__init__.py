"""The reference trailer: a linear rigid-flexible vehicle with worn wheels, small enough to run in seconds.

An invented vehicle; no number is a property of a real train. ``definition`` says what it is, ``elastic`` what its car
body is, ``assembly`` makes the equations of motion, ``roots`` their stability, ``response`` the answer to a rough track
in the frequency domain, ``run`` a ride over it in time with worn contact, ``run_numbers`` what it comes to, and
``limit_cycle`` hunting without a track. Units are SI.
"""
