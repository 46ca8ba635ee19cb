"""The unit of strain: ``ue`` in tables and files of measurements, as text on a page."""

MICROSTRAIN = "µε"
