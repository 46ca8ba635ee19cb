"""Arguments and options that several commands share."""

from pathlib import Path

import click

CASE = click.Path(path_type=Path)
FOLDER = click.Path(path_type=Path, file_okay=False)

as_json = click.option(
    "--json", "as_json", is_flag=True, help="Print JSON for machines (null: infinite or not available)."
)
no_lock = click.option(
    "--no-lock",
    is_flag=True,
    help="For a file system without locks: trust that no other run writes to DIR.",
)
strict = click.option("--strict", is_flag=True, help="Take unknown columns in the tables for errors.")
