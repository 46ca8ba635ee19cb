"""Whether letters of a colour can be read on a ground: the contrast of WCAG 2.1."""

LEAST = 4.5  # of text of any size, WCAG 2.1, 1.4.3 (AA)


def luminance(colour: str) -> float:
    """Relative luminance [-] of a colour ``#rrggbb``, 0 of black and 1 of white (WCAG 2.1, relative luminance).

    >>> round(luminance("#ffffff"), 6)
    1.0
    """
    channels = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    """Contrast ratio [-] of two colours, 1 of equal ones to 21 of black on white (WCAG 2.1, contrast ratio).

    >>> contrast("#000000", "#ffffff")
    21.0
    """
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)
