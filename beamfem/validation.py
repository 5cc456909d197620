"""Checks of what a user gives; each returns the value in the type that the rest of the code expects."""

import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from contextlib import suppress
from difflib import get_close_matches
from functools import cache, lru_cache
from operator import index
from typing import Any

import numpy as np

from beamfem.errors import InputError

# norms take squares, which must be neither infinite nor without digits
SMALLEST, LARGEST = math.sqrt(np.finfo(float).tiny), math.sqrt(np.finfo(float).max)
_MOST = 2**53  # from here on, floating-point numbers cannot count
_SHOWN = 200  # characters of a value in a message
_ENTRIES = 6  # of an array in a message
_TRUTH = bool, np.bool_


def shown(value: Any) -> str:
    """Return a value as a message shows it: cut where it is long, its class where it has no text."""
    try:
        text = repr(value)
    except Exception:
        return f"an object of {type(value).__name__}"
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."


def _number(value: Any) -> float:
    """Return a float of what is one number; float() would read text and truth values as well, and cut complex ones."""
    if type(value) is float:  # as nearly all are: models of 100,000 beams are checked in a second
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, str | bytes | bool | np.bool_ | np.complexfloating | np.ndarray):
        raise TypeError
    return float(value)


def finite(name: str, value: Any) -> float:
    """Return `value` as a float, or raise InputError naming it."""
    try:
        number = _number(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be a number, got {shown(value)}") from None
    except OverflowError:
        raise InputError(f"{name} must be a number below 1.8e308, the largest in double precision") from None
    if not math.isfinite(number):
        raise InputError(f"{name} must be finite, got {number}")
    return number


def positive(name: str, value: Any) -> float:
    """Return `value` as a float greater than zero, or raise InputError naming it."""
    number = finite(name, value)
    if number <= 0.0:
        raise InputError(f"{name} must be greater than zero, got {number}")
    return number


def not_negative(name: str, value: Any) -> float:
    """Return `value` as a float of at least zero, or raise InputError naming it."""
    number = finite(name, value)
    if number < 0.0:
        raise InputError(f"{name} must not be negative, got {number}")
    return number


def count(name: str, value: Any) -> int:
    """Return `value` as an integer of at least one, or raise InputError naming it."""
    number = whole(name, value)
    if number < 1:
        raise InputError(f"{name} must be at least 1, got {shown(number)}")
    if number > _MOST:
        raise InputError(f"{name} must be at most 2^53, about 9e15")
    return number


def number_below(name: str, value: Any, size: int, lowest: int = 0) -> int:
    """Return `value` as an integer from `lowest` to size - 1, or raise InputError naming it."""
    number = whole(name, value)
    if not lowest <= number < size:
        raise InputError(f"{name} must be between {lowest} and {size - 1}, got {shown(value)}")
    return number


def whole(name: str, value: Any) -> int:
    """Return an int of what is one whole number, also in an array without dimensions, or raise InputError naming it."""
    if not isinstance(value, _TRUTH):
        try:
            return index(value)
        except TypeError:
            pass
    raise InputError(f"{name} must be a whole number, got {shown(value)}") from None


def convert(item: object, check: Callable[[str, Any], Any], *names: str) -> None:
    """Replace attributes of a frozen dataclass by what a check returns; it names them "<name> of <class>"."""
    kind = type(item).__name__
    for name in names:
        object.__setattr__(item, name, check(f"{name} of {kind}", getattr(item, name)))


def items(name: str, values: Any) -> list[Any]:
    """Return what a list, tuple or array holds, or raise InputError naming it: text, sets and mappings are none."""
    if type(values) is list or type(values) is tuple:
        return list(values)
    if hasattr(values, "columns"):  # a table, which iterates over the names of its columns
        values = np.asarray(values)
    if not isinstance(values, str | bytes | bytearray | Set | Mapping):
        with suppress(TypeError):
            return list(values)
    raise InputError(f"{name} must be a list, got {shown(values)}")


def text(name: str, value: Any) -> str:
    """Return `value` if it is text, or raise InputError naming it."""
    if not isinstance(value, str):
        raise InputError(f"{name} must be a text, got {shown(value)}")
    return value


def squared(check: Callable[[str, Any], Any]) -> Callable[[str, Any], Any]:
    """Return a check that refuses numbers and vectors, other than zero, whose square double precision does not hold."""

    def checked(name: str, value: Any) -> Any:
        result = check(name, value)
        size = max(map(abs, result)) if isinstance(result, tuple) else abs(result)
        if size != 0.0 and not SMALLEST <= size <= LARGEST:
            raise InputError(
                f"{name} is {size:g}, which double precision cannot square ({SMALLEST:.1g} to {LARGEST:.1g}); "
                "take zero, or units in which it is closer to 1"
            )
        return result

    return checked


def optional(check: Callable[[str, Any], Any]) -> Callable[[str, Any], Any]:
    """Return a check that lets None pass."""
    return lambda name, value: None if value is None else check(name, value)


def number_table(name: str, values: Any, columns: int) -> np.ndarray:
    """Return `values` as an array (n, columns) of finite numbers, or raise InputError naming it."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of different lengths
        array = np.empty(0)
    if array.dtype.kind not in "iuf" or array.ndim != 2 or array.shape[1] != columns or not np.isfinite(array).all():
        size = f" {array.shape}" if array.size else ""
        raise InputError(f"{name} must be an array (n, {columns}) of finite numbers, got{size} {shown(values)}")
    return array


def flag(name: str, value: Any) -> bool:
    """Return `value` as True or False, or raise InputError naming it: text and numbers count as neither."""
    if not isinstance(value, _TRUTH):
        raise InputError(f"{name} must be True or False, got {shown(value)}")
    return bool(value)


def one_of(name: str, value: Any, allowed: Sequence[Any]) -> None:
    """Raise InputError if `value` is none of those `allowed`; it names the nearest."""
    if isinstance(value, str | type(None)) and value in allowed:
        return
    listed = [f'"{item}"' if isinstance(item, str) else repr(item) for item in allowed]
    message = f"{name} must be {', '.join(listed[:-1])} or {listed[-1]}, got {shown(value)}"
    near = _nearest(value, [item for item in allowed if item])
    raise InputError(f'{message}; did you mean "{near}"?' if near else message)


def require_known(sentence: str, name: Any, known: Iterable[str]) -> None:
    """Raise InputError if a name is none of those known: the sentence, the nearest and all that there are."""
    known = list(known)
    if not isinstance(name, str) or name not in known:
        raise InputError(f"{sentence}; {nearest(name, known)}")


def nearest(word: Any, known: Iterable[str], short: Iterable[str] = ()) -> str:
    """Return in words what a name could have meant; short: further names, which are suggested but not listed."""
    known = list(known)
    near = _nearest(word, [*known, *short])
    listed = ", ".join(known) if known else "none"
    return f"did you mean {near}? Known are {listed}" if near else f"known are {listed}"


def _nearest(word: Any, known: Sequence[str]) -> str | None:
    if not isinstance(word, str):
        return None
    close = get_close_matches(word.lower(), [name.lower() for name in known], 1)
    return next((name for name in known if close and name.lower() == close[0]), None)


def vector(name: str, value: Sequence[float] | np.ndarray) -> tuple[float, float]:
    """Return `value` as two finite floats, zeros without a sign, or raise InputError naming it."""
    if type(value) is tuple and [type(number) for number in value] == [float, float] and all(map(math.isfinite, value)):
        return value[0] + 0.0, value[1] + 0.0
    try:
        numbers = tuple(map(_number, items(name, value)))
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} must be two numbers (x, y), got {shown(value)}") from None
    if len(numbers) != 2 or not all(map(math.isfinite, numbers)):
        raise InputError(f"{name} must be two finite numbers (x, y), got {shown(value)}")
    return numbers[0] + 0.0, numbers[1] + 0.0


def fulfils(item: object, protocol: type) -> bool:
    """Return whether `item` has all members of a protocol; `isinstance` does, in 40 us on Python 3.11."""
    kind: Any = type(item)
    return not issubclass(kind, type) and (
        _has_all(kind, protocol) or all(hasattr(item, name) for name in members(protocol))
    )


def of_package(kind: type) -> bool:
    """Return whether a class is of the package."""
    return kind.__module__.startswith("beamfem.")


@lru_cache(maxsize=256)
def _has_all(kind: type, protocol: type) -> bool:
    """Return whether a class has all members of a protocol; an object may have the others."""
    return all(hasattr(kind, name) for name in members(protocol))


@cache
def members(protocol: type) -> tuple[str, ...]:
    """Return the names that a protocol asks for."""
    return tuple(name for name in vars(protocol) if not name.startswith("_"))


def function_value(name: str, function: Callable[[float], float], at: float) -> float:
    """Return the finite value of a user's function, or raise InputError naming it and the argument."""
    value = called(name, function, at)
    if isinstance(value, float) and math.isfinite(value):
        return float(value)
    return finite(f"{name} at {at:g}", value)


def called(name: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Return what a user's function gives, or raise InputError naming it and the arguments where it raises.

    A method of the package names what is wrong itself.
    """
    try:
        return function(*arguments)
    except Exception as error:
        if isinstance(error, InputError) and of_package(type(getattr(function, "__self__", None))):
            raise
        listed = ", ".join(map(_argument, arguments))
        what = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
        raise InputError(f"{name}({listed}) cannot be computed: {what}") from error


def _argument(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    return f"array {value.shape}" if isinstance(value, np.ndarray) and value.size > _ENTRIES else shown(value)


def takes(function: Any, count: int) -> bool:
    """Return whether a function can be called with a number of arguments, False if it does not say so."""
    try:
        inspect.signature(function).bind(*count * [0.0])
    except (TypeError, ValueError):
        return False
    return True


def function_of_one(name: str, function: Any, argument: str) -> None:
    """Raise InputError if `function` cannot be called with one argument, the `argument`."""
    if not callable(function):
        raise InputError(f"{name} must be a function of {argument}, got {shown(function)}")
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # some compiled functions have none
        return
    try:
        signature.bind(0.0)
    except TypeError as error:
        raise InputError(f"{name} must be a function of {argument} alone, but {error}: it takes {signature}") from None
