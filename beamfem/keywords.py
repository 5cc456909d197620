"""Misspelt keywords of what is public: the call names the nearest and all that there are; also surplus arguments.

Functions have the decorator where they are defined, so that they are found by their name in other processes; of classes
`public` has all methods checked in place.
"""

from collections.abc import Callable, Iterable
from functools import wraps
from inspect import Parameter, Signature, isclass, signature
from types import FunctionType
from typing import Any, TypeVar, Unpack, get_args, get_origin, get_type_hints

from beamfem.errors import UnknownKeywordError
from beamfem.validation import nearest

_Function = TypeVar("_Function", bound=Callable[..., Any])


def keywords_checked(function: _Function) -> _Function:
    """Return the function, which raises UnknownKeywordError for keywords or positional arguments that it lacks."""

    @wraps(function)
    def call(*arguments: Any, **keywords: Any) -> Any:
        try:
            return function(*arguments, **keywords)
        except TypeError as error:
            # of the call itself: a frame further in has a traceback of its own
            if error.__traceback__ is not None and error.__traceback__.tb_next is None:
                _refuse_unknown(function, arguments, keywords)
            raise

    return call  # type: ignore[return-value]


def require_keywords(name: str, given: Iterable[str], known: Iterable[str]) -> None:
    """Raise UnknownKeywordError for the first keyword that is none of those known; name: of what is called."""
    known = list(known)
    for keyword in given:
        if keyword not in known:
            hint = nearest(keyword, known) if known else "it takes none"
            raise UnknownKeywordError(f"{name} has no parameter {keyword!r}; {hint}")


def check_keywords_of(kind: type) -> None:
    """Have the constructor and the public methods of a class checked, those of its bases in the package too."""
    for base in kind.__mro__:
        if base.__module__.startswith("beamfem."):
            _check_keywords_of(base)


def _check_keywords_of(kind: type) -> None:
    for name, item in list(vars(kind).items()):
        function = item.__func__ if isinstance(item, staticmethod) else item
        if (name.startswith("_") and name != "__init__") or hasattr(function, "__wrapped__"):
            continue
        if isinstance(item, FunctionType):
            setattr(kind, name, keywords_checked(item))
        elif isinstance(item, staticmethod):
            setattr(kind, name, staticmethod(keywords_checked(item.__func__)))


def check_classes(items: Iterable[Any]) -> None:
    """Have every class among these checked, but for errors and for protocols, which others implement."""
    for item in items:
        if isclass(item) and not issubclass(item, Exception) and not getattr(item, "_is_protocol", False):
            check_keywords_of(item)


def with_options_listed(own: Signature) -> Signature:
    """Return a signature with each option of `**options: Unpack[...]` by its name, where its dictionary has defaults.

    A default is what Annotated[type, default] says beside the type.
    """
    listed: list[Parameter] = []
    for parameter in own.parameters.values():
        if get_origin(parameter.annotation) is not Unpack:
            listed.append(parameter)
            continue
        (options,) = get_args(parameter.annotation)
        for name, hint in get_type_hints(options, include_extras=True).items():
            kind, default = get_args(hint)
            listed.append(Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=kind))
    return own.replace(parameters=listed)


def _refuse_unknown(function: Callable[..., Any], arguments: tuple[Any, ...], given: Iterable[str]) -> None:
    parameters = list(signature(function).parameters.values())
    named = [
        parameter.name
        for parameter in parameters
        if parameter.kind in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY)
    ]
    placed = [
        parameter.name
        for parameter in parameters
        if parameter.kind in (parameter.POSITIONAL_OR_KEYWORD, parameter.POSITIONAL_ONLY)
    ]
    name = function.__qualname__
    if "." in name and named[:1] == ["self"]:
        name = name_of(function, arguments[0]).removesuffix(".__init__")
        named, placed, arguments = named[1:], placed[1:], arguments[1:]
    if given:
        require_keywords(name, given, named)
    if len(arguments) > len(placed) and not any(parameter.kind == parameter.VAR_POSITIONAL for parameter in parameters):
        most = f"{len(placed)} at most: {', '.join(placed)}" if placed else "none"
        number = f"{len(arguments)} argument{'s' * (len(arguments) > 1)}"
        raise UnknownKeywordError(f"{name} got {number} by position, but it takes {most}")


def name_of(method: Callable[..., Any], item: object) -> str:
    """Return the name of a method of an object, by the class of the object, which may derive from the defining one."""
    owner = method.__qualname__.rpartition(".")[0]
    derives = any(base.__name__ == owner for base in type(item).__mro__)
    return f"{type(item).__name__ if derives else owner}.{method.__name__}"
