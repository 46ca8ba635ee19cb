"""The frequency-domain estimate and whether it may be trusted.

``moments`` makes the moment matrices of an event (``taper`` the window, ``pairs`` the fast quadratic forms) and
``methods`` the damage from four moments: Dirlik (Eq. 20), Tovo-Benasciutti, narrow band. ``trust`` judges, from
``stationarity`` (with ``scatter``, what chance allows) and ``whole_record`` (slow content, tones); ``reasons`` says it
in words, ``surrogates`` split the ratio of both domains. ``bands`` share products out to frequency bands.
"""
