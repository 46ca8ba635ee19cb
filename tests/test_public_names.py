"""The table of contents of the package."""

import pytest

import fatigue


@pytest.mark.parametrize("name", fatigue.__all__)
def test_every_public_name_is_there(name):
    """Each name leads to something with a docstring, or is the version."""
    found = getattr(fatigue, name)
    assert name == "__version__" or found.__doc__
    assert name in dir(fatigue)


def test_other_names_are_refused():
    """As any module does."""
    with pytest.raises(AttributeError, match="module 'fatigue' has no attribute 'nothing'"):
        _ = fatigue.nothing
