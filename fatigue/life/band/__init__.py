r"""Life as a band: how far another record, another specimen, another damage sum would move the one number.

One assessment counts one record on one curve and stops at one damage sum. Each of the three scatters by itself::

    load    pieces of the record, in blocks, against each other       ``load``       se_load, degrees of freedom
    S-N     specimens about the mean curve                            ``strength``   sigma_N of ln N
    Miner   the sum at which specimens broke under variable loads     given in the case

On one slope the logarithm of the life is normal, and the variances add up (``quantiles``). On a curve with knees the
damage is taken on the histogram at each strength of the curve (``knees``). Along a line of weld the weakest link of
many independent lengths gives the survival of the whole (``line``).

The headline life is that of the mean-2sigma curve; the median life is that of the *mean* curve. With the scatter of the
S-N data alone the life of 97.725 % is the headline life again.

The band says nothing about other track, other wheels, other seasons: what was never simulated has no scatter here.
"""
