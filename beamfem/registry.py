"""What upper rooms offer on the objects of lower ones, such as `solution.plot()`.

A lower room declares the method, with its signature and docstring, and calls `offered`; it knows nobody above it. The
upper room says in its `__init__` with `offer` which function that is, which is imported at the first call.
"""

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from inspect import signature, unwrap
from typing import Any

from beamfem.extras import needed_for
from beamfem.keywords import name_of, require_keywords, with_options_listed
from beamfem.whole import whole_package

_FUNCTIONS: dict[Callable[..., Any], str] = {}


def offer(method: Callable[..., Any], function: str) -> None:
    """Say which function "module:name" does what a method of a lower room declares; its docstring names it then.

    The function takes the object and what the method takes. Help and completion list the options of the method.
    """
    _FUNCTIONS[method] = function
    method.__signature__ = with_options_listed(signature(method))  # type: ignore[attr-defined]
    if method.__doc__:
        first, *further = method.__doc__.split("\n\n", 1)
        method.__doc__ = "\n\n".join([f"{first} See `{function.replace(':', '.')}`.", *further])


def offered(method: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function that does what a method declares. Raises NotImplementedError if no room offers one.

    What is returned raises InputError for an option that the function has not, with what it may have meant.
    """
    method = unwrap(method)  # its keywords are checked
    if method not in _FUNCTIONS:
        whole_package()  # an object may come from another process before anything else is imported
    if method not in _FUNCTIONS:
        raise NotImplementedError(f"no room above offers {method.__qualname__}")
    module, name = _FUNCTIONS[method].split(":")
    with needed_for(method.__name__):
        function: Callable[..., Any] = getattr(import_module(module), name)
    keywords = list(signature(function).parameters)[1:]

    @wraps(function)
    def call(*arguments: Any, **options: Any) -> Any:
        require_keywords(name_of(method, arguments[0]), options, keywords)
        with needed_for(method.__name__):
            return function(*arguments, **options)

    return call
