"""One signal as a caller gives it: numbers along time in double precision, or a refusal in one line."""

import difflib
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.errors import CaseError, DataError, NumericalError, Problem
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]

_FLAT = "Give its samples as a list or an array of one dimension"
_NUMBERS = "biuf"  # kinds of numpy types that hold real numbers
_IN_WORDS = {
    "c": "complex numbers",
    "U": "text",
    "T": "text",
    "S": "text",
    "M": "dates",
    "m": "time differences",
    "V": "records of several fields",
}


def samples_of(signal: ArrayLike) -> Floats:
    """Copy a signal (t,) to double precision: an array, list or series of whole or real numbers; none is no sample.

    Raises
    ------
    DataError : not one-dimensional, or no numbers: objects, complex numbers, text, dates, masked arrays
    NumericalError : a sample that is NaN or infinite, or samples so far apart that their range overflows
    """
    if isinstance(signal, np.ma.MaskedArray):
        raise _no_signal("it is a masked array", "Give the samples without a mask, for instance signal.compressed()")
    values = _array(signal)
    if values.ndim != 1:
        remedy = "Give one signal after the other" if values.size > max(values.shape, default=1) else _FLAT
        raise _no_signal(f"it has {values.ndim} dimensions, its shape is {values.shape}", remedy)
    with np.errstate(over="ignore", invalid="ignore"):
        samples = np.array(values, np.float64)
        if not np.isfinite(samples).all():
            raise not_finite(f"sample {np.flatnonzero(~np.isfinite(samples))[0]} of the signal")
        if samples.size and not np.isfinite(samples.max() - samples.min()):
            raise NumericalError(
                Problem(
                    "overflow",
                    "signal",
                    f"the range from {samples.min():.3g} to {samples.max():.3g} exceeds what double precision can hold",
                    "Look for such values in the input",
                )
            )
    return samples


def recurs(residue: Residue) -> bool:
    """Whether a signal is a block that recurs for ever.

    Raises
    ------
    CaseError : neither ``repeat`` nor ``half``
    """
    known = get_args(Residue)
    if not (isinstance(residue, str) and residue in known):
        near = difflib.get_close_matches(str(residue).lower(), known, n=1)
        remedy = f"Write {near[0]!r}" if near else f"Write one of {', '.join(map(repr, known))}"
        raise CaseError(Problem("residue", "residue", f"{residue!r} is no way to count what does not close", remedy))
    return residue == "repeat"


def middle(a: Floats, b: Floats) -> Floats:
    """Mean of two values each, also where their sum overflows."""
    with np.errstate(over="ignore"):
        total = a + b
    return np.where(np.isfinite(total), 0.5 * total, 0.5 * a + 0.5 * b)


def not_finite(where: str) -> NumericalError:
    """Refusal of a signal or a block with a sample that is NaN or infinite."""
    return NumericalError(
        Problem("not_finite", where, "the stress is NaN or infinite", "Look for such values in the input")
    )


def _array(signal: ArrayLike) -> NDArray[Any]:
    """Array of real numbers of any dimension."""
    try:
        values = np.asarray(signal)
        if values.dtype.kind == "O" and (_is_numeric(signal) or values.shape == (0,)):
            values = np.array(signal, np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        reason = str(error).strip().splitlines()[0].split(". ")[0].rstrip(".")
        raise _no_signal(f"it is no array of numbers ({reason})", "Give one number for each sample") from error
    if values.dtype.kind not in _NUMBERS:
        what = _IN_WORDS.get(values.dtype.kind) or _objects(values)
        raise _no_signal(f"it holds {what}", "Give whole or real numbers, for instance as an array of float64")
    return values


def _is_numeric(signal: ArrayLike) -> bool:
    """Whether objects are numbers all the same: whole ones of any size, or a column that knows missing values."""
    kind = getattr(getattr(signal, "dtype", None), "kind", "")
    if isinstance(signal, list | tuple):
        return bool(signal) and all(isinstance(value, int) for value in signal)
    return bool(kind) and kind in _NUMBERS


def _objects(values: NDArray[Any]) -> str:
    """Name the first object that is no number, or the kind of objects."""
    if values.ndim == 0:
        return f"one object of type {type(values.item()).__name__}"
    kinds = {type(value).__name__: None for value in values.ravel() if not isinstance(value, int | float)}
    return f"objects, some of type {' and '.join([*kinds][:2])}" if kinds else "objects of Python"


def _no_signal(what: str, remedy: str) -> DataError:
    return DataError(Problem("no_signal", "signal", what, remedy))
