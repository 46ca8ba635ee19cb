"""Life as a band at the points that have a histogram: the table ``band.parquet``.

``points`` says what is taken over from the assessment, ``scatter`` how much the load of a point scatters and why that
may not be known, ``lives`` turns it into lives at survivals, ``lines`` into the survival of weld lines, ``rows`` writes
them. The method is in ``fatigue.life.band``.
"""
