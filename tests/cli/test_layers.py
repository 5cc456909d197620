"""The layers of the package: imports go down only, inside functions too, and never in a circle."""

import ast
import graphlib
from collections.abc import Iterator
from itertools import takewhile
from pathlib import Path

import pytest

import beamfem as bf

ROOT = Path(bf.__file__).parent
# from top to bottom: a layer is a folder or a file; it imports from layers below it only
LAYERS = (
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
    "solve/linear",
    "solve/modes",
    "solve/accuracy",
    "solve/newton",
    "solve/start",
    "io/motion_file",
    "io/results_hdf5",
    "io/hdf5",
    "io/description",
    "results",
    "precision/roundoff",
    "equations/band_workspace",
    "equations/data_derivatives",
    "equations/equations",
    "precision/mixed_tangent",
    "equations",
    "linalg/bordered",
    "precision",
    "linalg",
    "forms",
    "mesh",
    "parts",
    "model",
    "element",
    "physics",
    "kernels",
    "section",
    "material",
    "damping",
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
    "public_names",
    "extras",
    "errors",
)
# what a method may import inside: what meshes, draws and writes the object, and some analyses of it
INSIDE_METHODS = ("mesh", "view", "io", "io/results_hdf5")
ANALYSES = {
    "model/model.py": ("beamfem.results.imperfection", "beamfem.solve.accuracy.error_estimate"),
    "results/path.py": ("beamfem.solve.paths.path_error",),
    "solve/modes/modes.py": ("beamfem.solve.motion.consistent_rows",),
    "results/solution.py": (
        "beamfem.solve.stability.stability",
        "beamfem.solve.accuracy.error_estimate",
        "beamfem.solve.accuracy.narrow_features",
    ),
}
# classes of data: their methods import what computes results from them, and for type checkers what it returns
DATA = ("model/model.py", "results/solution.py", "results/path.py", "io/line_mesh.py")
FILES = sorted(path.relative_to(ROOT) for path in ROOT.rglob("*.py"))


def layer(file: Path) -> str:
    """Return the layer of a file, given below the package: the longest name that it begins with."""
    name = file.with_suffix("").as_posix()
    return max((own for own in LAYERS if name == own or name.startswith(f"{own}/")), key=len)


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
    """Return the lines of the imports that open a method, after its docstring."""
    lines = set()
    for kind in (node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)):
        for method in (node for node in kind.body if isinstance(node, ast.FunctionDef)):
            body = method.body[1:] if ast.get_docstring(method) else method.body
            lines |= {node.lineno for node in takewhile(lambda node: isinstance(node, ast.ImportFrom), body)}
    return lines


def imports_for_types(tree: ast.Module) -> set[int]:
    """Return the lines of the imports that only type checkers see."""
    blocks = [node for node in tree.body if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"]
    return {node.lineno for block in blocks for node in block.body}


def imported_files(file: Path) -> set[Path]:
    """Return the files that a file needs, without those that compute the results that methods of its class return."""
    tree = ast.parse((ROOT / file).read_text())
    left_out = imports_inside_methods(tree) | (imports_for_types(tree) if file.as_posix() in DATA else set())
    targets = {
        file_of(name)
        for name, line in imported(tree, ".".join(["beamfem", *file.parent.parts]))
        if line not in left_out
    }
    return {target for target in targets if target is not None} - {file}


def upward(source: str, file: Path) -> list[str]:
    """Return the imports of a file that do not go down, each with its line."""
    found, own, tree = [], LAYERS.index(layer(file)), ast.parse(source)
    package = ".".join(["beamfem", *file.parent.parts])
    inside = imports_inside_methods(tree) | (imports_for_types(tree) if file.as_posix() in DATA else set())
    for name, line in imported(tree, package):
        target = file_of(name)
        assert target is not None, f"{file}:{line} imports {name}, which is not there"
        other = LAYERS.index(layer(target))
        allowed = layer(target) in INSIDE_METHODS or name in ANALYSES.get(file.as_posix(), ())
        if other < own and not (line in inside and allowed):
            found.append(f"{file}:{line} imports {name}: {LAYERS[own]} is below {LAYERS[other]}")
    return found


def test_each_file_is_in_a_layer_and_each_layer_has_files():
    assert {layer(file) for file in FILES} == set(LAYERS)


def test_imports_go_down():
    assert [line for file in FILES for line in upward((ROOT / file).read_text(), file)] == []


def test_no_file_imports_itself_through_others():
    graphlib.TopologicalSorter({file: imported_files(file) for file in FILES}).prepare()


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


def test_a_circle_is_found(tmp_path, monkeypatch):
    (tmp_path / "first.py").write_text("from beamfem.second import b")
    (tmp_path / "second.py").write_text("def b():\n    from beamfem.first import a")
    monkeypatch.setattr("test_layers.ROOT", tmp_path)
    with pytest.raises(graphlib.CycleError):
        graphlib.TopologicalSorter({Path(n): imported_files(Path(n)) for n in ("first.py", "second.py")}).prepare()


@pytest.mark.parametrize("folder", ["solvers", "physics", "parts"])
def test_tests_of_what_users_see_use_the_public_interface_only(folder):
    """Public are the names of `beamfem` and its modules for users' parts, tests and forms."""
    public = {"beamfem", *(f"beamfem.{name}" for name in ("curves", "errors", "forms", "section", "testing"))}
    for file in sorted((Path(__file__).parents[1] / folder).glob("test_*.py")):
        nodes = ast.walk(ast.parse(file.read_text()))
        names = {node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module}
        inner = {name for name in names if name.split(".")[0] == "beamfem"} - public
        assert not inner, f"{file.name} imports {inner}"
