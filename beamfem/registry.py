"""What upper rooms offer on the objects of lower ones, such as `solution.plot()`.

A lower room declares the method, with its signature and docstring, and calls `offered`; it knows nobody above it. The
upper room says in its `__init__` with `offer` which function that is, which is imported at the first call.
"""

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from inspect import signature
from typing import Any

from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.validation import nearest

_FUNCTIONS: dict[Callable[..., Any], str] = {}


def offer(method: Callable[..., Any], function: str) -> None:
    """Say which function "module:name" does what a method of a lower room declares; its docstring names it then.

    The function takes the object and what the method takes.
    """
    _FUNCTIONS[method] = function
    if method.__doc__:
        first, *further = method.__doc__.split("\n\n", 1)
        method.__doc__ = "\n\n".join([f"{first} See `{function.replace(':', '.')}`.", *further])


def offered(method: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function that does what a method declares. Raises NotImplementedError if no room offers one.

    What is returned raises InputError for an option that the function has not, with what it may have meant.
    """
    if method not in _FUNCTIONS:
        import_module("beamfem.public")  # an object may come from another process before anything else is imported
    if method not in _FUNCTIONS:
        raise NotImplementedError(f"no room above offers {method.__qualname__}")
    module, name = _FUNCTIONS[method].split(":")
    with needed_for(method.__name__):
        function: Callable[..., Any] = getattr(import_module(module), name)
    known = list(signature(function).parameters)[1:]

    @wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        for option in options:
            if option not in known:
                raise InputError(f"{method.__name__} has no option {option!r}; {nearest(option, known)}")
        with needed_for(method.__name__):
            return function(*arguments, **options)

    return call
