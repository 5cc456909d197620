"""What works without the packages of the extras, and what is said where one is missing."""

import json
import re
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

import beamfem as bf
from beamfem.extras import needed_for

BARE = """
import json, sys, warnings

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {names}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Missing())
import beamfem as bf

section, steel = bf.Rectangle(width=0.01, height=0.01), bf.Material(2e11, 0.3, 7800.0)
beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements=4, element=bf.CRBF(2), section=section, material=steel)
model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0, 1.0))])
solution, modes = bf.solve_static(model), bf.solve_modes(model, 2)
bf.simulate(model, duration=0.01, step=1e-3), bf.trace_equilibrium(model, until=2.0)
said = {{"tip": solution.displacement(beam.end)[-1, 1]}}
solution._repr_html_(), model._repr_html_(), solution.to_html("page.html")
for name, task in {{
    "plot": lambda: solution.plot(),
    "model": lambda: model.plot("model.png"),
    "history": lambda: solution.plot_history(beam.end),
    "modes": lambda: modes.plot(),
    "pvd": lambda: solution.to_vtk("a.pvd"),
    "vtkhdf": lambda: solution.to_vtk("a.vtkhdf"),
    "picture": lambda: solution.picture("a.png"),
    "gif": lambda: solution.animate("a.gif"),
    "mp4": lambda: solution.animate("a.mp4"),
    "save": lambda: solution.save("a.h5"),
    "load": lambda: bf.load("page.html"),
    "xarray": lambda: solution.to_xarray(),
    "pandas": lambda: solution.to_pandas(),
    "modes as a table": lambda: modes.to_pandas(),
    "mesh": lambda: bf.read_mesh("page.html"),
    "drawing": lambda: bf.read_dxf("page.html"),
}}.items():
    try:
        task()
        said[name] = "done"
    except bf.MissingPackageError as error:
        said[name] = str(error)
print(json.dumps(said))
"""
OPTIONAL = {
    *("PIL", "ezdxf", "h5py", "imageio_ffmpeg", "matplotlib", "meshio", "pandas", "pyvista", "typer", "vtkmodules"),
    "xarray",
}
EXTRA_OF = {
    **dict.fromkeys(("plot", "model", "history", "modes", "gif"), "plot"),
    **dict.fromkeys(("pvd", "vtkhdf", "picture"), "vtk"),
    **dict.fromkeys(("save", "load"), "store"),
    "mp4": "video",
    "xarray": "xarray",
    **dict.fromkeys(("pandas", "modes as a table"), "pandas"),
    "mesh": "mesh",
    "drawing": "cad",
}


def test_solves_need_no_extra_and_what_does_names_it(tmp_path):
    script = BARE.format(names=repr(OPTIONAL))
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    # shear adds 7e-5
    assert said.pop("tip") == pytest.approx(1.0 / (3.0 * 2e11 * 0.01**4 / 12.0), rel=1e-4)
    assert {name: re.findall(r'pip install "beamfem\[(.*)\]"', text) for name, text in said.items()} == {
        name: [extra] for name, extra in EXTRA_OF.items()
    }


def test_the_long_description_has_no_link_to_a_file_beside_it():
    """Package indexes show the README alone: its picture and its links were broken there."""
    root = Path(bf.__file__).parents[1]
    settings = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["hatch"]["metadata"]["hooks"]
    text = (root / "README.md").read_text()
    assert "](docs/" in text
    for each in settings["fancy-pypi-readme"]["substitutions"]:
        text = re.sub(each["pattern"], each["replacement"], text)
    assert re.findall(r"\]\((?!https?:)[^)]*\)", text) == []
    assert "Examples to copy" in text


def test_the_package_tells_its_version():
    assert bf.__version__ == version("beamfem")


def test_a_missing_package_that_no_extra_has_is_not_hidden():
    with pytest.raises(ModuleNotFoundError, match="no_such_package"), needed_for("a test"):
        import no_such_package  # noqa: F401


def test_every_extra_named_is_one_of_the_project():
    project = tomllib.loads((Path(bf.__file__).parents[1] / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    assert set(EXTRA_OF.values()) <= set(extras)
    ours = set(extras) - {"all", "test", "bench", "docs"}
    assert extras["all"] == [f"beamfem[{','.join(name for name in extras if name in ours)}]"]
