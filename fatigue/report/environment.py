"""How templates become pages: undefined names are errors, numbers are written for people, nothing stays unseen."""

from typing import Any

import jinja2
from markupsafe import Markup

from fatigue.report import wording
from fatigue.report.language import ENGLISH, Language
from fatigue.shown import visible

LONGEST_NAME = 120  # letters of a name in a sentence or a heading


def environment(*rooms: str, language: Language = ENGLISH) -> jinja2.Environment:
    """Environment of the templates of the report, and of those in the rooms (``fatigue.basis``) before them.

    Templates say ``t("words")`` where the words have their like in other languages.
    """
    loader = jinja2.ChoiceLoader([jinja2.PackageLoader(room) for room in dict.fromkeys((*rooms, "fatigue.report"))])
    made = jinja2.Environment(
        loader=loader,
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_shown,
    )
    made.filters |= {
        "number": wording.number,
        "result": wording.result,
        "given": wording.given,
        "km": wording.km,
        "years": wording.years,
        "life": wording.life,
        "life_km": wording.life_km,
        "life_years": wording.life_years,
        "share": wording.share,
        "whole": wording.whole,
        "short": lambda name: wording.short(str(name), LONGEST_NAME),
    }

    def source(name: str) -> Markup:
        """Style sheet or script of the page, as it is."""
        return Markup(loader.get_source(made, name)[0])

    made.globals |= {"source": source, "t": language, "language": language.tag}
    return made


def _shown(value: Any) -> Any:
    """What the page says of a value: in a text of somebody else, as a name, what cannot be seen is spelled out."""
    return (
        visible(value, keep="\n\t\u2028\u2029") if isinstance(value, str) and not isinstance(value, Markup) else value
    )
