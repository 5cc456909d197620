"""The user's own code behind a call: the files of a function, of what it is called with and of all that they import."""

import ast
import hashlib
import inspect
import site
import sys
import sysconfig
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache, partial
from importlib.machinery import PathFinder
from itertools import accumulate
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

from beamfem.errors import InputError
from beamfem.sweeps.keys import canonical
from beamfem.sweeps.slicing import needed

SCRIPT = "__main__"


class Sources:
    """Contents of files as they are found during one sweep, each read once."""

    def __init__(self) -> None:
        self._files: dict[str, tuple[str, frozenset[str]]] = {}
        self._behind: dict[frozenset[str], dict[str, str]] = {}

    def behind(self, function: Callable[..., Any], point: Mapping[str, Any]) -> Mapping[str, str]:
        """Return a digest of the content of each module of the user that a call can reach.

        Comments and layout do not count. Of the script that is run only what its functions need counts, since it holds
        the call of the sweep as well. Data files that are read are not looked at.
        """
        parts = list(dict.fromkeys(_code((function, tuple(point.values())))))
        script = sorted({part.__qualname__.split(".")[0] for part in parts if part.__module__ == SCRIPT})
        modules = {name for part in parts for name in _modules(part)}
        key = frozenset(modules | {f"{SCRIPT}:{name}" for name in script})
        if key not in self._behind:
            self._behind[key] = self._reachable(modules, script, parts)
        return self._behind[key]

    def _reachable(self, modules: set[str], script: list[str], parts: list[Any]) -> dict[str, str]:
        digests: dict[str, str] = {}
        waiting = sorted(modules)
        while waiting:
            name = waiting.pop()
            path = _own_file(name)
            if name in digests or (path is None and name != SCRIPT):
                continue
            if path is None:  # a notebook
                typed = [_typed(part, set()) for part in parts if part.__module__ == SCRIPT]
                digests[name] = _digest(repr(typed))
                continue
            digest, imports = self._read(name, path, script)
            digests[name] = digest
            waiting += imports
        return digests

    def _read(self, name: str, path: Path, script: list[str]) -> tuple[str, frozenset[str]]:
        key = f"{name} {script}" if name == SCRIPT else name
        if key not in self._files:
            content = path.read_bytes()
            if path.suffix != ".py":
                self._files[key] = _digest(content), frozenset()
            else:
                tree = ast.parse(content)
                if name == SCRIPT:
                    tree = needed(tree, script)
                self._files[key] = _digest(ast.dump(tree)), frozenset(_imports(tree, _package(name, path)))
        return self._files[key]


def _code(value: Any) -> Iterator[Any]:
    """Functions and classes in a value."""
    if isinstance(value, FunctionType):
        yield value
        for cell in value.__closure__ or ():
            yield from _code(cell.cell_contents)
    elif isinstance(value, type):
        yield value
    elif isinstance(value, partial):
        yield from _code((value.func, value.args, value.keywords))
    elif isinstance(value, Enum):
        yield type(value)
    elif isinstance(value, tuple | list):
        for item in value:
            yield from _code(item)
    elif isinstance(value, Mapping):
        yield from _code(tuple(value.values()))
    elif is_dataclass(value):
        yield type(value)
        yield from _code(tuple(getattr(value, member.name) for member in fields(value)))


def _modules(part: Any) -> set[str]:
    """Where a function or class is from; a decorated one is from two modules."""
    return {part.__module__, part.__globals__["__name__"]} if isinstance(part, FunctionType) else {part.__module__}


def _imports(tree: ast.AST, package: str) -> Iterator[str]:
    """Names of modules that may be imported anywhere in a file; some are names in modules instead."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parents = package.split(".")[: -(node.level - 1) or None] if node.level else []
            base = ".".join([*parents, *([node.module] if node.module else [])])
            names = [f"{base}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            yield from accumulate(name.split("."), "{}.{}".format)


def _package(name: str, path: Path) -> str:
    module = sys.modules.get(name)
    if module is not None and module.__package__ is not None:
        return module.__package__
    return name if path.stem == "__init__" else name.rpartition(".")[0]


def _own_file(name: str) -> Path | None:
    """Return the file of a module; None of what is part of Python, installed or beamfem itself, or is no module."""
    module = sys.modules.get(name)
    origin = getattr(module, "__file__", None) if module is not None else _unloaded(name)
    if origin is None or not Path(origin).is_file():
        return None
    path = Path(origin).resolve()
    return None if any(path.is_relative_to(folder) for folder in _installed()) else path


def _unloaded(name: str) -> str | None:
    """Return the file of a module that has not been imported yet, without importing the packages it is in."""
    folders, spec = None, None
    for part in accumulate(name.split("."), "{}.{}".format):
        spec = PathFinder.find_spec(part, folders)
        if spec is None:
            return None
        folders = spec.submodule_search_locations
    return spec.origin if spec else None


@cache
def _installed() -> tuple[Path, ...]:
    paths = sysconfig.get_paths()
    folders = [paths[name] for name in ("stdlib", "platstdlib", "purelib", "platlib")]
    folders += [*site.getsitepackages(), site.getusersitepackages(), str(Path(__file__).parents[1])]
    return tuple(Path(folder).resolve() for folder in folders)


def _typed(part: Any, seen: set[str]) -> Any:
    """What code without a file is known by: its source and the values that it takes from the cells around it."""
    seen.add(part.__qualname__)
    try:
        source = inspect.getsource(part)
    except (OSError, TypeError):
        source = part.__qualname__
    if not isinstance(part, FunctionType):
        return [source]
    values = [(name, part.__globals__[name]) for name in sorted(_names(part.__code__)) if name in part.__globals__]
    return [source, *([name, _value(value, name, seen)] for name, value in values)]


def _names(code: CodeType) -> set[str]:
    inner = [item for item in code.co_consts if isinstance(item, CodeType)]
    return set(code.co_names).union(*map(_names, inner))


def _value(value: Any, name: str, seen: set[str]) -> Any:
    if isinstance(value, ModuleType):
        path = _own_file(value.__name__)
        return _digest(path.read_bytes()) if path else value.__name__
    if isinstance(value, FunctionType | type) and value.__module__ == SCRIPT:
        return value.__qualname__ if value.__qualname__ in seen else _typed(value, seen)
    try:
        return canonical(value, name)
    except InputError:
        return type(value).__qualname__


def _digest(content: str | bytes) -> str:
    return hashlib.sha256(content.encode() if isinstance(content, str) else content).hexdigest()[:24]
