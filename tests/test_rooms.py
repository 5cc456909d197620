"""The rooms of the package: imports go down only, inside functions too; what upper rooms offer is there."""

import ast
import inspect
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

import beamfem as bf
from beamfem import registry

ROOT = Path(bf.__file__).parent
# from top to bottom: a room is a folder or a file; it imports from rooms below it only
ROOMS = (
    "__main__",
    "cli",
    "__init__",
    "public",
    "testing",
    "convergence",
    "sweeps",
    "view",
    "io",
    "solve/__init__",
    "solve/paths",
    "solve/stability",
    "solve/statics",
    "solve/continuation",
    "solve/motion",
    "solve/modes",
    "solve/newton",
    "solve/start",
    "results",
    "assembly",
    "linalg",
    "forms",
    "model",
    "element",
    "physics",
    "kernels",
    "section",
    "material",
    "curves",
    "alike",
    "brief",
    "tabulate",
    "files",
    "progress",
    "memory",
    "quadrature",
    "registry",
    "keywords",
    "units",
    "validation",
    "once",
    "extras",
    "errors",
    "whole",
)
LONGEST = 350  # lines of a file
FILES = sorted(path.relative_to(ROOT) for path in ROOT.rglob("*.py"))


def room(file: Path) -> str:
    """Return the room of a file, given below the package."""
    name = file.with_suffix("").as_posix()
    (found,) = [own for own in ROOMS if name == own or name.startswith(f"{own}/")]
    return found


def file_of(module: str) -> Path | None:
    """Return the file, below the package, of a module of it; None for other names."""
    place = Path(*module.split(".")[1:])
    for file in (place.with_suffix(".py") if place.name else place, place / "__init__.py"):
        if (ROOT / file).is_file():
            return file
    return None


def imported(tree: ast.AST, package: str) -> Iterator[tuple[str, int]]:
    """Yield what of beamfem a file imports, and in which line; package: the one that it lies in."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            names = [f"{base}.{alias.name}" if file_of(f"{base}.{alias.name}") else base for alias in node.names]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            names = [part.value for part in node.args if isinstance(part, ast.Constant)]
        else:
            continue
        yield from ((name, node.lineno) for name in names if name.split(".")[0] == "beamfem")


def upward(source: str, file: Path) -> list[str]:
    """Return the imports of a file that do not go down, each with its line."""
    found, own = [], ROOMS.index(room(file))
    package = ".".join(["beamfem", *file.parent.parts])
    for name, line in imported(ast.parse(source), package):
        target = file_of(name)
        assert target is not None, f"{file}:{line} imports {name}, which is not there"
        other = ROOMS.index(room(target))
        if other < own:
            found.append(f"{file}:{line} imports {name}: {ROOMS[own]} is below {ROOMS[other]}")
    return found


def test_each_file_is_in_one_room_and_each_room_has_files():
    assert {room(file) for file in FILES} == set(ROOMS)


def test_imports_go_down():
    assert [said for file in FILES for said in upward((ROOT / file).read_text(), file)] == []


@pytest.mark.parametrize(
    "source",
    [
        "from beamfem.view.drawing import plot_shapes",
        "import beamfem.view.drawing",
        "import beamfem",
        "from beamfem import Solution",
        "from beamfem import view",
        "from ..view import drawing",
        "from .. import view",
        "importlib.import_module('beamfem.view.drawing')",
        "def plot(self):\n    from beamfem.view.drawing import plot_shapes",
        "if TYPE_CHECKING:\n    from beamfem.solve.modes.modes import Modes",
    ],
)
def test_imports_that_go_up_are_found(source):
    assert upward(source, Path("results/solution.py"))


def test_files_are_short():
    lines = {file: len((ROOT / file).read_text().splitlines()) for file in FILES}
    generated = Path("kernels/generated")
    assert {file: count for file, count in lines.items() if count > LONGEST and file.parent != generated} == {}


def calls_of(name: str) -> list[tuple[str, Path]]:
    """Return the first argument of each call of a function, as text, and the file that calls it."""
    found = []
    for file in FILES:
        for node in ast.walk(ast.parse((ROOT / file).read_text())):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name:
                found.append((ast.unparse(node.args[0]), file))
    return found


def test_what_lower_rooms_declare_is_offered_by_one_room_above():
    declared, offered = dict(calls_of("offered")), calls_of("offer")
    assert sorted(declared) == sorted(method for method, _ in offered)
    for method, file in offered:
        assert ROOMS.index(room(file)) < ROOMS.index(room(declared[method]))


@pytest.mark.parametrize("method", registry._FUNCTIONS, ids=lambda method: method.__qualname__)
def test_functions_that_are_offered_take_what_their_method_takes(method):
    module, name = registry._FUNCTIONS[method].split(":")
    assert callable(getattr(import_module(module), name))
    taken = list(inspect.signature(registry.offered(method)).parameters.values())[1:]
    listed = list(inspect.signature(method).parameters.values())[1:]
    places = [each.name for each in listed if each.kind == each.POSITIONAL_OR_KEYWORD]
    assert [each.name for each in taken[: len(places)]] == places
    assert {each.name: each.default for each in listed} == {each.name: each.default for each in taken}


def test_a_method_that_no_room_offers_says_so():
    with pytest.raises(NotImplementedError, match=r"no room above offers PointQuantities\.position"):
        registry.offered(bf.Solution.position)


@pytest.mark.parametrize("method", [bf.Solution.plot, bf.Path.save, bf.Modes.plot, bf.Buckling.plot])
def test_methods_of_upper_rooms_have_signature_and_docstring(method):
    assert list(inspect.signature(method).parameters)[:2] == ["self", "path"]
    assert " See `beamfem." in method.__doc__
