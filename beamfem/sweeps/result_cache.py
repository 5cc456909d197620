"""Results of a sweep on disk: a file of JSON lines, one per result, which stays readable if the process is killed.

A row identifies the code that computed it by a digest; another line lists, once, the modules of that code and the
global variables that it uses. Whole solutions are separate files in a folder beside it, named after their row. Equal
functions and parameters have equal keys, in any process. The content of modules is no part of a key: all modules that
are loaded from the user's files, and those that they import, have digests of their own.
"""

import ast
import hashlib
import json
import os
import site
import sys
import sysconfig
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from errno import ENOSPC
from functools import cache, partial
from importlib.machinery import PathFinder
from itertools import accumulate
from os import PathLike
from pathlib import Path, PurePath
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType, TracebackType
from typing import Any

import numpy as np

import __main__
import beamfem
from beamfem.atomic_write import path_of
from beamfem.errors import ChangedCodeWarning, FileError, InputError, MissingPackageError, NotStoredWarning, warn
from beamfem.io.results_hdf5 import load
from beamfem.results.solution import Solution
from beamfem.sweeps.workers import Outcome

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
    content, package = path.read_bytes(), getattr(module, "__package__", None)
    if package is None:
        package = name if path.stem == "__init__" else name.rpartition(".")[0]
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):  # compiled code
        digest, imports = _digest(content), frozenset[str]()
    else:
        digest, imports = _digest(ast.dump(tree).encode()), frozenset(_imports(tree, package))
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


def point_key(function: Any, point: Mapping[str, Any]) -> str:
    """Return the key of a call (64 hexadecimal digits). Raises InputError for what cannot be keyed."""
    forms = {name: canonical(value, name) for name, value in sorted(point.items())}
    return hashlib.sha256(json.dumps([canonical(function, "the function"), forms]).encode()).hexdigest()


def global_digests(function: Any) -> dict[str, str]:
    """Return a digest of each global variable that a function of the user's files uses, itself or through others.

    Its value may change without an edit of a file. Values that cannot be keyed, such as open files, do not count.
    """
    result, seen, waiting = dict[str, str](), set[FunctionType](), [function]
    while waiting:
        item = waiting.pop()
        if isinstance(item, partial):
            waiting.append(item.func)
        if not isinstance(item, FunctionType) or item in seen or own_file(item.__module__) is None:
            continue
        seen.add(item)
        waiting += [cell.cell_contents for cell in item.__closure__ or ()]
        for name in _names(item.__code__) & item.__globals__.keys():
            value = item.__globals__[name]
            if isinstance(value, FunctionType | partial):
                waiting.append(value)
            elif not isinstance(value, ModuleType | type):
                try:
                    form = json.dumps(canonical(value, name))
                except InputError:
                    continue
                result[f"{name} of {item.__module__}"] = hashlib.sha256(form.encode()).hexdigest()[:16]
    return result


def canonical(value: Any, where: str) -> Any:
    """Return lists and texts that are equal for equal values only; floats by every digit, dataclasses by members."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, Enum):
        return ["enum", _class(type(value), where), value.name]
    if value is None or isinstance(value, bool | int | float | complex | str | PurePath):
        return [type(value).__name__, repr(value)]
    if isinstance(value, np.ndarray):
        if value.dtype.hasobject:
            raise InputError(f"{where} is an array of objects, which cannot be stored under a stable key; use a tuple")
        little = value.astype(value.dtype.newbyteorder("<"), order="C", copy=False)
        return ["array", little.dtype.str, list(value.shape), hashlib.sha256(little.tobytes()).hexdigest()]
    if isinstance(value, tuple | list | range):
        return ["sequence", *(canonical(item, f"{where}[{i}]") for i, item in enumerate(value))]
    if isinstance(value, Mapping) and all(isinstance(name, str) for name in value):
        return ["mapping", *([name, canonical(value[name], f"{where}[{name!r}]")] for name in sorted(value))]
    if isinstance(value, partial):
        parts = {"of": value.func, "with": value.args, "and": value.keywords}
        return ["partial", canonical(parts, where)]
    if is_dataclass(value) and not isinstance(value, type):
        names = [member.name for member in fields(value)]
        members = [[name, canonical(getattr(value, name), f"{where}.{name}")] for name in names]
        return ["object", _class(type(value), where), *members]
    if isinstance(value, type):
        return ["class", _class(value, where)]
    if isinstance(value, BuiltinFunctionType | np.ufunc):
        return ["builtin", getattr(value, "__module__", ""), value.__name__]
    if isinstance(value, FunctionType):
        return _function(value, where)
    raise InputError(
        f"{where} is a {type(value).__name__}, which cannot be stored under a key that is the same in the next run; "
        "numbers, text, tuples, arrays, dataclasses and functions made with def can"
    )


def _function(function: FunctionType, where: str, seen: tuple[FunctionType, ...] = ()) -> Any:
    name, code = _name(function), function.__code__
    closed = [cell.cell_contents for cell in function.__closure__ or ()]
    form = ["function", name, canonical(closed, f"what {name} closes over")]
    form.append(canonical([function.__defaults__, function.__kwdefaults__], f"the defaults of {name}"))
    if function.__name__ == "<lambda>" or not _has_file(function):
        form.append(_code(code))
    if not _has_file(function):  # the values that it takes from other cells of a notebook
        used = {name: function.__globals__[name] for name in sorted(_names(code) & function.__globals__.keys())}
        form += [[name, _used(value, name, (*seen, function))] for name, value in used.items()]
    return form


def _used(value: Any, where: str, seen: tuple[FunctionType, ...]) -> Any:
    if isinstance(value, ModuleType):
        return value.__name__
    if isinstance(value, FunctionType):
        return value.__qualname__ if value in seen else _function(value, where, seen)
    return canonical(value, where)


def _class(kind: type, where: str) -> str:
    if not _has_file(kind):
        raise InputError(
            f"{where} is of {_name(kind)}, which is in no file, so a change would go unnoticed; put it in one"
        )
    return _name(kind)


def _has_file(item: FunctionType | type) -> bool:
    """Return whether a function or class comes from the file of a module, and not from a notebook, say."""
    module = item.__globals__.get("__name__", "") if isinstance(item, FunctionType) else item.__module__
    file = getattr(sys.modules.get(module), "__file__", None)
    if isinstance(item, FunctionType):
        return file is not None and Path(file).name == Path(item.__code__.co_filename).name
    return file is not None or module in sys.builtin_module_names


def _code(code: CodeType) -> Any:
    """Return what a function does, the same in each process."""
    constants = [
        _code(item)
        if isinstance(item, CodeType)
        else repr(sorted(map(repr, item)) if type(item) is frozenset else item)
        for item in code.co_consts
    ]
    return [code.co_code.hex(), constants, code.co_names, code.co_varnames, code.co_freevars]


def _names(code: CodeType) -> set[str]:
    inner = [item for item in code.co_consts if isinstance(item, CodeType)]
    return set(code.co_names).union(*map(_names, inner))


def _name(item: FunctionType | type) -> str:
    """Return module and qualified name; of beamfem itself without the module, which may move."""
    module = "beamfem" if item.__module__.startswith("beamfem.") else item.__module__
    return f"{module}.{item.__qualname__}"


_NAMED = 5  # modules in a warning


class ResultCache:
    """Results of a function at points, by the present code; a context manager that keeps the file open for appending.

    path: a file, or a folder (no suffix), which receives a `results.jsonl`; folders are created. Raises InputError,
    before any file is created, for a function or parameters that the next run could not recognise.
    """

    def __init__(
        self, path: str | PathLike[str], function: Callable[..., Any], points: Sequence[Mapping[str, Any]]
    ) -> None:
        self._keys = [point_key(function, point) for point in points]
        self._modules = {**code_digests(), **global_digests(function)}
        self._code = hashlib.sha256(json.dumps(sorted(self._modules.items())).encode()).hexdigest()[:24]
        self._function = getattr(function, "__qualname__", str(function))
        given = path_of(path)
        self.path = given / "results.jsonl" if given.is_dir() or not given.suffix else given
        self._known: dict[str, dict[str, tuple[Any, float]]] = {}
        self._modules_of: dict[str, Mapping[str, str]] = {}
        self._writable = True

    def __enter__(self) -> "ResultCache":
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            # unbuffered: each line reaches the system in one write and survives this process
            self._file = self.path.open("ab+", buffering=0)
        except OSError as error:
            raise FileError(f"the store {self.path} cannot be written: {error.strerror}") from error
        self._file.seek(0)
        data = self._file.readall()
        if data and not data.endswith(b"\n"):
            self._file.write(b"\n")  # the writer was killed within its last line
        for line in data.splitlines():
            try:
                record = json.loads(line)
                if "sources" in record:
                    self._modules_of[record["code"]] = record["sources"]
                else:
                    rows = self._known.setdefault(record["key"], {})
                    found = record["value"], record["seconds"]
                    rows.pop(record["code"], None)  # the last one written stands last
                    rows[record["code"]] = found
            except (ValueError, KeyError, TypeError):
                continue
        return self

    def __exit__(self, kind: type[BaseException] | None, error: Any, trace: TracebackType | None) -> None:
        self._file.close()

    def found(self, keep_stale: bool) -> list[Outcome | None]:
        """Return the outcome of each point, None if there is none; results of other code only with keep_stale."""
        outcomes = [self._outcome(key, self._code) for key in self._keys]
        stale, changed = 0, set[str]()
        for i, key in enumerate(self._keys):
            if outcomes[i] is None and (other := self._of_other_code(key)) is not None:
                stale += 1
                changed |= other[1]
                outcomes[i] = other[0] if keep_stale else None
        if stale:
            warn(_message(stale, len(outcomes), changed, keep_stale), ChangedCodeWarning)
        return outcomes

    def _of_other_code(self, key: str) -> tuple[Outcome, set[str]] | None:
        """Return the last outcome stored under a key by other code, and the modules and variables that differ."""
        for code in reversed(self._known.get(key, {})):
            outcome, then = self._outcome(key, code), self._modules_of.get(code, {})
            if outcome is not None:
                changed = {n for n in {*then, *self._modules} if then.get(n) != self._modules.get(n)}
                return outcome, {n for n in changed if n.partition(" of ")[2] not in changed}
        return None

    def add(self, number: int, parameters: str, outcome: Outcome) -> None:
        """Store the outcome of a point; parameters: as text, for people who read the file.

        Warns where that is not possible.
        """
        if not self._writable:
            return
        try:
            self._add(number, parameters, outcome)
        except (InputError, MissingPackageError) as error:  # of the model of a solution
            warn(f"not kept in the store {self.path}: {error}", NotStoredWarning)
        except OSError as error:
            # no more lines: one that was written in part would spoil the next one
            self._writable = False
            warn(
                f"the store {self.path} cannot be written any more ({error.strerror or error}): the sweep goes on, and "
                "what it computes from here on is in its result only",
                NotStoredWarning,
            )

    def _add(self, number: int, parameters: str, outcome: Outcome) -> None:
        key, code = self._keys[number], self._code
        if code not in self._modules_of:
            self._modules_of[code] = self._modules
            self._write({"code": code, "sources": self._modules})
        about = {"function": self._function, "parameters": parameters}
        value = self._encode(outcome.value, f"{key}-{code}")
        self._write({"key": key, "code": code, **about, "value": value, "seconds": outcome.seconds})

    def _write(self, record: Mapping[str, Any]) -> None:
        line = json.dumps(record).encode() + b"\n"
        written = self._file.write(line)
        if written != len(line):
            raise OSError(ENOSPC, os.strerror(ENOSPC))

    def _outcome(self, key: str, code: str) -> Outcome | None:
        if code not in self._known.get(key, {}):
            return None
        value, seconds = self._known[key][code]
        try:
            return Outcome(self._decode(value), seconds)
        except (FileError, InputError):  # the file of a solution is gone or damaged
            return None

    def _encode(self, value: Any, row: str) -> Any:
        """Return a mapping unchanged and a single value as a list of one, so that the two cannot be confused."""
        if isinstance(value, dict):
            return {name: self._item(item, f"{row}-{number}") for number, (name, item) in enumerate(value.items())}
        return [self._item(value, row)]

    def _item(self, value: Any, name: str) -> Any:
        if isinstance(value, np.ndarray):
            return {"dtype": value.dtype.str, "shape": value.shape, "data": value.ravel().tolist()}
        if isinstance(value, Solution):
            value.save(self._solutions / f"{name}.h5")
            return {"solution": name}
        return value

    def _decode(self, value: Any) -> Any:
        if isinstance(value, dict):
            return {name: self._value(item) for name, item in value.items()}
        return self._value(value[0])

    def _value(self, item: Any) -> Any:
        if not isinstance(item, dict):
            return item
        if "solution" in item:
            return load(self._solutions / f"{item['solution']}.h5")
        return np.array(item["data"], dtype=item["dtype"]).reshape(item["shape"])

    @property
    def _solutions(self) -> Path:
        """The folder of whole solutions."""
        return self.path.with_suffix("")


def _message(stale: int, points: int, changed: set[str], keep: bool) -> str:
    script = Path(getattr(__main__, "__file__", None) or "__main__").name
    names = sorted(script if name == "__main__" else name for name in changed)
    shown = ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")
    done = "the old results are kept" if keep else "they are computed again; keep_stale=True keeps the old results"
    return f"{stale} of {points} points in the store were computed before {shown} changed: {done}"
