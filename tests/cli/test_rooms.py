"""The rooms of the package: imports go down only, inside functions too, but for methods that draw or write."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import beamfem as bf

ROOT = Path(bf.__file__).parent
# from top to bottom: a room is a folder or a file; it imports from rooms below it only
ROOMS = (
    "__main__",
    "cli",
    "testing",
    "convergence",
    "sweeps",
    "__init__",
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
    "precision/roundoff",
    "assembly/band_workspace",
    "assembly/connector_equilibrium",
    "assembly/imposed_forces",
    "assembly/equations",
    "precision/mixed_tangent",
    "assembly",
    "linalg/bordered",
    "precision",
    "linalg",
    "forms",
    "model",
    "element",
    "physics",
    "kernels",
    "section",
    "material",
    "curves",
    "reprs",
    "tables",
    "atomic_write",
    "progress",
    "installed_memory",
    "quadrature",
    "units",
    "validation",
    "value_keys",
    "cached_properties",
    "extras",
    "errors",
)
# what a method may import inside: what draws and writes the object, and two analyses of it
INSIDE_METHODS = ("view", "io")
ANALYSES = {
    "model/model.py": "beamfem.results.imperfection",
    "results/solution.py": "beamfem.solve.stability.stability",
}
FILES = sorted(path.relative_to(ROOT) for path in ROOT.rglob("*.py"))


def room(file: Path) -> str:
    """Return the room of a file, given below the package: the longest name that it begins with."""
    name = file.with_suffix("").as_posix()
    return max((own for own in ROOMS if name == own or name.startswith(f"{own}/")), key=len)


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


def imports_inside_methods(tree: ast.AST) -> set[int]:
    """Return the lines of imports that open a method, after its docstring."""
    lines = set()
    for kind in (node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)):
        for method in (node for node in kind.body if isinstance(node, ast.FunctionDef)):
            body = method.body[1:] if ast.get_docstring(method) else method.body
            if body and isinstance(body[0], ast.ImportFrom):
                lines.add(body[0].lineno)
    return lines


def upward(source: str, file: Path) -> list[str]:
    """Return the imports of a file that do not go down, each with its line."""
    found, own, tree = [], ROOMS.index(room(file)), ast.parse(source)
    package = ".".join(["beamfem", *file.parent.parts])
    inside = imports_inside_methods(tree)
    for name, line in imported(tree, package):
        target = file_of(name)
        assert target is not None, f"{file}:{line} imports {name}, which is not there"
        other = ROOMS.index(room(target))
        allowed = room(target) in INSIDE_METHODS or name == ANALYSES.get(file.as_posix())
        if other < own and not (line in inside and allowed):
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
        "def plot(solution):\n    from beamfem.view.drawing import plot_shapes",
        "class Solution:\n    def fit(self):\n        from beamfem.sweeps.sweep import sweep",
        "class Path:\n    def plot(self):\n        if self.p:\n            from beamfem.view.plots import figure",
        "if TYPE_CHECKING:\n    from beamfem.solve.modes.modes import Modes",
    ],
)
def test_imports_that_go_up_are_found(source):
    assert upward(source, Path("results/solution.py"))


def test_a_method_that_draws_or_writes_imports_what_does_it():
    source = "class Solution:\n    def plot(self):\n        from beamfem.view.drawing import plot_shapes"
    assert upward(source, Path("results/solution.py")) == []
