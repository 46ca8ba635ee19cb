"""All that is known of a point, before it is shown."""

import pytest

from fatigue.point.page.story import point


@pytest.fixture
def gathered(monkeypatch):
    """What ``gather`` finds of a point; asked as ``point`` is."""
    found = []

    def kept(one):
        found.append(one)
        raise StopIteration

    def of(folder, weld, **asked):
        with monkeypatch.context() as patch, pytest.raises(StopIteration):
            patch.setattr("fatigue.point.page.story.summary_of", kept)
            point(folder, weld, **asked)
        return found.pop()

    return of
