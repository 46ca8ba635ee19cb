"""Head and foot of every printed page, as style of the page boxes: who issued what, of which numbers, page x of y.

Browsers draw boxes in the margins of a page from Chromium 131 on; an older one prints the pages without them.
"""

from fatigue.report.identity.identity import Identity
from fatigue.shown import shortened, visible

LONGEST = 90  # letters of a box: three share the width of A4


def page_boxes(identity: Identity, draft: str, title: str, version: str, result: str) -> str:
    """Style of the boxes around a printed page; ``draft`` is empty where the report is identified.

    ``result`` is the hash of the result, of which the first twelve digits are shown: as many as messages have.
    """
    entries, language = identity.entries, identity.look.language
    document = " ".join(filter(None, (entries.get("document"), _named(language("rev."), entries.get("revision")))))
    versions = f"fatigue {version}" + (f", {language('result')} {result[:12]}" if result else "")
    foot = " · ".join(filter(None, (identity.look.texts.get("foot", ""), versions)))
    boxes = {
        "top-left": title,
        "top-right": " · ".join(filter(None, (draft, document, entries.get("date", "")))),
        "bottom-left": foot,
    }
    pages = f'{quoted(language("page"))} " " counter(page) " " {quoted(language("of"))} " " counter(pages)'
    style = "font: 8px Arial, sans-serif; color: #5c6773; white-space: nowrap;"
    lines = [f"@{box} {{ content: {quoted(shortened(text, LONGEST, '…'))}; {style} }}" for box, text in boxes.items()]
    return f"@page {{ {' '.join(lines)} @bottom-right {{ content: {pages}; {style} }} }}"


def quoted(text: str) -> str:
    r"""Text as a string of CSS that nothing in it can end: all but letters, digits and blanks is written by its number.

    >>> quoted('A"</style>')
    '"A\\22 \\3c \\2f style\\3e "'
    """
    plain = visible(" ".join(text.split()))
    return '"' + "".join(c if c.isalnum() or c == " " else f"\\{ord(c):x} " for c in plain) + '"'


def _named(name: str, text: str | None) -> str:
    return f"{name} {text}" if text else ""
