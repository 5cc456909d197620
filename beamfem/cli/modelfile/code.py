"""Python file that a model file names in its `code`, or a command: user-defined classes and functions."""

import sys
import traceback
from collections.abc import Callable
from contextlib import redirect_stdout
from dataclasses import dataclass
from importlib.machinery import PathFinder
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

from beamfem.errors import InputError
from beamfem.validation import nearest


@dataclass(frozen=True)
class Code:
    """A Python file that has been run, and what it defines."""

    file: Path
    module: ModuleType

    def named(self, name: str) -> Callable[..., Any]:
        """Return a class or function by its name. Raises InputError if there is none."""
        public = {key: value for key, value in vars(self.module).items() if callable(value) and key[0] != "_"}
        if name in public:
            return public[name]
        defined = [key for key, value in public.items() if getattr(value, "__module__", None) == self.module.__name__]
        raise InputError(f"{self.file.name} has no class or function {name!r}; {nearest(name, defined)}")


def run_code(folder: Path, name: str) -> Code:
    """Run a Python file of a folder, once, and return what it defines. Raises InputError.

    Neither files of other folders nor installed modules can be named, so that a model file alone cannot run any code.
    """
    file = folder / name
    if Path(name).name != name or not _is_module(file):
        raise InputError(f'must be the name of a Python file beside the model file, such as "parts.py", got "{name}"')
    if not file.is_file():
        raise InputError(f"there is no {name} in {folder.resolve()}; Python that a model file runs lies beside it")
    return run_file(file)


def run_file(file: Path) -> Code:
    """Run a Python file from any folder and return what it defines. Raises InputError."""
    if not _is_module(file):
        raise InputError(f'{file} cannot be run: it must be the name of a Python file, such as "parts.py"')
    if not file.is_file():
        raise InputError(f"{file} cannot be run: there is no such file")
    _require_own_name(file)
    return Code(file, _run(file))


def _is_module(file: Path) -> bool:
    return file.suffix == ".py" and file.stem.isidentifier()


def _require_own_name(file: Path) -> None:
    """Raise InputError if another module has the same name, since imports could confuse them."""
    installed = PathFinder.find_spec(file.stem)
    origin = installed.origin if installed is not None else None
    if file.stem in sys.stdlib_module_names or (origin is not None and Path(origin).resolve() != file.resolve()):
        where = f" ({origin})" if origin is not None and Path(origin).is_file() else ""
        raise InputError(f"{file.name} has the name of an installed module{where}; give one of them another name")


def _run(file: Path) -> ModuleType:
    spec = spec_from_file_location(file.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    before = sys.modules.get(file.stem)
    sys.modules[file.stem] = module  # dataclasses and pickle look classes up there
    folder = str(file.parent.resolve())
    sys.path.append(folder)  # for files beside it, which do not replace other modules
    try:
        with redirect_stdout(sys.stderr):  # stdout is for what the command itself says, such as JSON
            spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[file.stem]
        if before is not None:
            sys.modules[file.stem] = before
        raise InputError(f"{file.name} cannot be run: {_where(error, file)}") from error
    finally:
        sys.path.remove(folder)
    return module


def _where(error: Exception | SystemExit, file: Path) -> str:
    """Return an error with its line in the file."""
    text = f"{type(error).__name__}: {error}"
    steps = traceback.extract_tb(error.__traceback__)
    lines = [step.lineno for step in steps if Path(step.filename).resolve() == file.resolve()]
    if isinstance(error, SyntaxError) or not lines:
        return text
    return f"line {lines[-1]}: {text}"
