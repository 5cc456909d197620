"""Digests of the user's code: all modules that are loaded from the user's files, and the modules that these import."""

import ast
import hashlib
import site
import sys
import sysconfig
from collections.abc import Iterator, Sequence
from functools import cache
from importlib.machinery import PathFinder
from itertools import accumulate
from pathlib import Path
from types import ModuleType

import beamfem

# (module, its spec, digest, imports) by name: a loaded module runs the code of its file as it was when it was imported,
# and a reload gives the module a new spec
_READ: dict[str, tuple[ModuleType, object, str, frozenset[str]]] = {}


def code_digests() -> dict[str, str]:
    """Return the version of beamfem, and a digest of each module of the user by its name.

    Modules of the user are those loaded from files, except Python's, installed ones and beamfem's own, and all that
    they import, also inside functions. Comments and layout do not count. A module that is edited after the first call
    counts once it is reloaded or the process is restarted, because only then its new code runs.
    """
    digests = {"beamfem": beamfem.__version__}
    waiting = [name for name in sys.modules if name != "__mp_main__"]  # the same as __main__
    while waiting:
        name = waiting.pop()
        if name not in digests and (path := own_file(name)) is not None:
            digests[name], imports = _read(name, path)
            waiting += imports
    return digests


def _read(name: str, path: Path) -> tuple[str, frozenset[str]]:
    """Return the digest of a module and the names that it imports."""
    module = sys.modules.get(name)
    spec = getattr(module, "__spec__", None)
    if name in _READ and _READ[name][0] is module and _READ[name][1] is spec:
        return _READ[name][2:]
    content = path.read_bytes()
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):  # compiled code
        digest, imports = _digest(content), frozenset[str]()
    else:
        digest, imports = _digest(ast.dump(tree).encode()), frozenset(_imports(tree, _package(name, path)))
    if module is not None:
        _READ[name] = module, spec, digest, imports
    return digest, imports


def _imports(tree: ast.AST, package: str) -> Iterator[str]:
    """Names of modules that may be imported anywhere in a file; some are names in modules instead."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parents = package.split(".")[: -(node.level - 1) or None] if node.level else []
            base = ".".join([*parents, *([node.module] if node.module else [])])
            names = [f"{base}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("import_module", "__import__")):
            names = [part.value for part in node.args if isinstance(part, ast.Constant) and isinstance(part.value, str)]
        else:
            continue
        for name in names:
            yield from accumulate(name.split("."), "{}.{}".format)


def _package(name: str, path: Path) -> str:
    package = getattr(sys.modules.get(name), "__package__", None)
    if package is not None:
        return str(package)
    return name if path.stem == "__init__" else name.rpartition(".")[0]


def own_file(name: str) -> Path | None:
    """Return the file of a module; None of what is part of Python, installed or beamfem itself, or is no module."""
    module = sys.modules.get(name)
    if isinstance(module, ModuleType):
        origin = object.__getattribute__(module, "__dict__").get("__file__")  # getattr would load lazy modules
    else:
        origin = _unloaded(name)
    return None if origin is None else _own_path(origin)


@cache
def _own_path(origin: str) -> Path | None:
    path = Path(origin).resolve()
    return path if path.is_file() and not any(map(path.is_relative_to, _installed())) else None


def _unloaded(name: str) -> str | None:
    """Return the file of a module that has not been imported yet, without importing the packages it is in."""
    folders: Sequence[str] | None = None
    origin = None
    for part in accumulate(name.split("."), "{}.{}".format):
        spec = PathFinder.find_spec(part, folders)
        if spec is None:
            return None
        folders, origin = spec.submodule_search_locations or (), spec.origin
    return origin


@cache
def _installed() -> tuple[Path, ...]:
    paths = sysconfig.get_paths()
    folders = [paths[name] for name in ("stdlib", "platstdlib", "purelib", "platlib")]
    folders += [*site.getsitepackages(), site.getusersitepackages(), str(Path(__file__).parents[1])]
    return tuple(Path(folder).resolve() for folder in folders)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:24]
