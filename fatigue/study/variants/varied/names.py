"""Names of variants as words and as folders."""

import hashlib
import re
from collections.abc import Sequence

from fatigue.files.naming import composed

LONGEST = 80  # letters of a folder
_RESERVED = re.compile(r"(?:con|prn|aux|nul|com\d|lpt\d)(?:\..*)?", re.IGNORECASE)  # on Windows
BASE = "base"


def shown(value: object) -> str:
    """A value as it stands in names, commands and patterns: 350.0 as 350, true and false as TOML has them.

    >>> shown(350.0), shown(9.2), shown(True), shown("worn")
    ('350', '9.2', 'true', 'worn')
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def folder_names(variants: Sequence[str]) -> list[str]:
    """Folders of variants, on every system different from each other; a name of another one has its hash behind it.

    >>> folder_names(["base", "fe=14, contact=worn", "Base"])
    ['base', 'fe-14_contact-worn', 'Base-7b4736']
    """
    taken: set[str] = set()
    folders = []
    for name in variants:
        plain = composed(name).replace(", ", "_").replace("=", "-")
        plain = re.sub(r"[^A-Za-z0-9._+-]", "_", plain).strip(".") or "variant"
        plain = f"_{plain}" if _RESERVED.fullmatch(plain) else plain
        if len(plain) > LONGEST or plain.casefold() in taken:
            plain = f"{plain[:LONGEST]}-{hashlib.sha256(name.encode('utf-8', 'surrogatepass')).hexdigest()[:6]}"
        taken.add(plain.casefold())
        folders.append(plain)
    return folders
