"""The commands of a study of a vehicle: its analysis graph, and runs of its variants."""

from fatigue.cli.main import cli


@cli.group()
def study() -> None:
    """Study a vehicle: its stability over speed and conicity, and what its variants do to the lives of welds.

    The vehicle is a small linear trailer with worn wheels, described by a vehicle.toml. It is invented; no number of it
    is a property of a real train.
    """
