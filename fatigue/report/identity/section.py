"""Who answers for the report: the block under its title, its look, and the head and foot of printed pages."""

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from fatigue.report.identity.identity import Identity
from fatigue.report.identity.paper import page_boxes
from fatigue.report.identity.template import TEXTS
from fatigue.report.wording import listed


def identity_section(identity: Identity, record: Mapping[str, Any]) -> dict[str, Any]:
    """What templates ask for of the identity of a report, and of its look."""
    look, version = identity.look, record["software"]["fatigue"]
    draft = draft_words(identity)
    boxes = page_boxes(identity, draft.partition(":")[0], record["title"], version, record.get("result", ""))
    colours = " ".join(f"--{key}: {value};" for key, value in look.colours.items())
    return {
        "identity": identity.shown,
        "draft": draft,
        "logo": look.logo,
        "company": identity.entries.get("company", ""),
        "look_texts": {key: look.texts.get(key, "") for key in TEXTS},
        "look_style": Markup(f":root {{ {colours} }}\n{boxes}" if colours else boxes),
        "signed": {key: identity.entries.get(key, "") for key in ("author", "checker", "approver")},
        "look_problems": identity.problems,
    }


def draft_words(identity: Identity) -> str:
    """Words of a report that is not identified, with what it lacks; empty where it is."""
    if not identity.missing:
        return ""
    t = identity.look.language
    head = t("DRAFT, not identified")
    if not identity.entries:
        return head
    return f"{head}: {listed([t(name) for name in identity.missing])} {t('not given')}"
