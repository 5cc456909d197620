"""Source text of functions as syntax trees, and the objects that names other than variables stand for."""

import ast
import builtins
import linecache
from collections.abc import Callable
from functools import cache
from types import CodeType
from typing import Any


@cache
def _functions(file: str, text: str) -> dict[int, ast.FunctionDef]:
    """Return the functions of a file by the number of their first line, decorators included."""
    functions = (node for node in ast.walk(ast.parse(text, file)) if isinstance(node, ast.FunctionDef))
    return {min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)]): node for node in functions}


@cache
def _codes(file: str, text: str) -> list[CodeType]:
    """Return the code objects of all functions of a file."""
    codes, pending = list[CodeType](), [compile(text, file, "exec", dont_inherit=True)]
    while pending:
        inner = [constant for constant in pending.pop().co_consts if isinstance(constant, CodeType)]
        codes += inner
        pending += inner
    return codes


def definition(function: Callable[..., Any]) -> ast.FunctionDef:
    """Return the syntax tree of a function, with the lines of its file.

    Raises TypeError if there is no source text, if it is that of another function because the file has changed since
    the import, or if arguments have defaults or are not plain positional ones.
    """
    code = function.__code__
    linecache.checkcache(code.co_filename)
    text = "".join(linecache.getlines(code.co_filename, function.__globals__))
    tree = _functions(code.co_filename, text).get(code.co_firstlineno)
    if tree is None or code not in _codes(code.co_filename, text):
        raise TypeError(
            f"the text of {function.__qualname__} is not in {code.co_filename}, or it has been changed since it was "
            "imported, and without it nothing is compiled"
        )
    arguments = tree.args
    if arguments.posonlyargs or arguments.kwonlyargs or arguments.vararg or arguments.kwarg or arguments.defaults:
        raise TypeError(f"kernel {tree.name}: only positional parameters without defaults are supported")
    return tree


def outside(function: Callable[..., Any]) -> dict[str, Any]:
    """Return by name what a function finds outside: built-ins, globals and the variables of enclosing functions."""
    code, cells = function.__code__, function.__closure__ or ()
    enclosed = {name: cell.cell_contents for name, cell in zip(code.co_freevars, cells, strict=True)}
    objects = vars(builtins) | function.__globals__ | enclosed
    for name in (*code.co_varnames, *code.co_cellvars):
        objects.pop(name, None)
    return objects
