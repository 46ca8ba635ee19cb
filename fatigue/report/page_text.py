"""A page beside the report: its template filled, with what its figures and its script need."""

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup
from plotly.offline import get_plotlyjs

from fatigue import __version__
from fatigue.report.environment import environment
from fatigue.report.figures import CONFIG, TEMPLATE
from fatigue.report.language import ENGLISH, Language
from fatigue.report.sections.embed import Figures, embedded


def page_text(room: str, template: str, context: Mapping[str, Any], figs: Figures, language: Language = ENGLISH) -> str:
    """Text of a page, from a template of a room (``fatigue.basis``) that extends ``page.html``.

    ``context`` has a ``title`` and what the template asks for; plotly is in the page only where it has ``figs``.
    """
    frame = {
        "version": __version__,
        "config": embedded(CONFIG),
        "template": embedded(TEMPLATE),
        "plotly": Markup(get_plotlyjs()) if figs.shown else "",
    }
    return environment(room, language=language).get_template(template).render({**frame, **context})
