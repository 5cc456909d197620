"""The tutorials run in a kernel as a notebook does, and show their pictures without magic."""

import re
from pathlib import Path

import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "tutorials").glob("*.ipynb"))


def test_there_are_tutorials():
    assert [path.stem for path in NOTEBOOKS] == ["bending", "falling", "snapping"]


def printed(cell):
    """Return what a cell prints without its numbers, and the numbers."""
    text = "".join(output.text for output in cell.outputs if output.get("name") == "stdout")
    number = r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?"
    return re.sub(number, "", text), [float(found) for found in re.findall(number, text)]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_tutorial_runs_and_shows_its_pictures(path, tmp_path):
    """It has its outputs in the file, which say the same as those of a run."""
    notebook = nbformat.read(path, 4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    stored = [printed(cell) for cell in cells]
    assert all(cell.outputs for cell in cells), "kept with outputs: documentation and repositories show them"
    kernel = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources=kernel).execute()
    for cell, (words, numbers) in zip(cells, stored, strict=True):
        assert printed(cell)[0] == words
        assert printed(cell)[1] == pytest.approx(numbers, rel=2e-2, abs=1e-8)
    for cell in cells:
        last = cell.source.rstrip().splitlines()[-1]
        kinds = {kind for output in cell.outputs for kind in output.get("data", {})}
        assert ("image/png" in kinds) == (".plot" in last), last
        assert cell.outputs, "a cell that shows nothing"
        said = "".join(output.text for output in cell.outputs if output.get("name") == "stderr")
        assert re.fullmatch(r"(compiling kernels, .*\n)?(.*LargeStrainWarning: the utilisation.*\n.*\n)*", said)


def test_a_first_solve_in_a_kernel_says_that_it_compiles(tmp_path, monkeypatch):
    """Below the cell, once: a cell that takes longer than it should is asked about."""
    monkeypatch.setenv("BEAMFEM_CACHE_DIR", str(tmp_path))
    lines = [
        "import beamfem as bf",
        "from beamfem.equations.compilation_notice import announce_compilation",
        "announce_compilation()",
        "announce_compilation()",
    ]
    cell = nbformat.v4.new_code_cell("\n".join(lines))
    notebook = nbformat.v4.new_notebook(cells=[cell])
    nbclient.NotebookClient(notebook, timeout=100, kernel_name="python3").execute()
    said = "".join(output.text for output in notebook.cells[0].outputs)
    assert said == "compiling kernels, once on this computer: three to five seconds ...\n"
