"""The text of functions, and what names in it stand for that are not variables."""

import ast
import builtins
import inspect
import linecache
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any


@cache
def _functions(file: str) -> dict[int, ast.FunctionDef]:
    """Return the functions of a file by the lines where they begin, with their decorators."""
    text = "".join(linecache.getlines(file))
    found = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef))
    return {min([node.lineno, *(each.lineno for each in node.decorator_list)]): node for node in found}


def definition(function: Callable[..., Any]) -> ast.FunctionDef:
    """Return the syntax tree of a function, with the lines of its file."""
    file = inspect.getsourcefile(function) or function.__code__.co_filename
    found = _functions(file).get(function.__code__.co_firstlineno)
    if found is None:
        raise TypeError(f"the text of {function.__qualname__} is not in {file}, and without it nothing is compiled")
    return found


def outside(function: Callable[..., Any]) -> dict[str, Any]:
    """Return what names mean to a function that are not its own: built-in, of its module, of a function around it."""
    return vars(builtins) | function.__globals__ | dict(_enclosed(function))


def _enclosed(function: Callable[..., Any]) -> Iterator[tuple[str, Any]]:
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        yield name, cell.cell_contents
