"""Files that earlier versions saved: they load, with the displacements that the version that saved them printed.

They and the script that made them are in tests/data. Files from before the package was divided into rooms load as they
are, since no class that a file names has been renamed. Those of the first version that could save do not: nodes of a
clamped inclined beam had other coordinates, 24 instead of 23, and no part was told from a wrong parameter.
"""

import gzip
import json
from pathlib import Path

import h5py
import numpy as np
import pytest

import beamfem as bf
from beamfem.io.description import describe
from beamfem.io.hdf5 import read_checked, write_checked

DATA = Path(__file__).parents[1] / "data"
PRINTED = json.loads((DATA / "before_rooms.json").read_text())


def unpacked(name, folder, version="before_rooms"):
    """Write a file as it was saved into a folder and return its path."""
    file = folder / f"{name}.h5"
    file.write_bytes(gzip.decompress((DATA / f"{version}_{name}.h5.gz").read_bytes()))
    return file


def end_of(solution, name):
    """Return the point whose displacements were printed: see `save_old_results`."""
    return solution.model.beams[1 if name == "frame" else 0].end


@pytest.mark.parametrize("name", PRINTED)
def test_a_solution_of_an_earlier_version_has_the_displacements_that_it_printed(name, tmp_path):
    solution = bf.load(unpacked(name, tmp_path))
    printed = np.array(PRINTED[name])
    np.testing.assert_allclose(
        solution.displacement(end_of(solution, name)), printed, rtol=0.0, atol=1e-14 * (1.0 + np.abs(printed).max())
    )
    assert isinstance(solution, bf.Path) is (name == "path")
    assert solution.status is bf.Status.COMPLETED


@pytest.mark.parametrize("name", PRINTED)
def test_quantities_and_pictures_of_an_earlier_solution_are_there(name, tmp_path):
    solution = bf.load(unpacked(name, tmp_path))
    for beam in solution.model.beams:
        forces = solution.section_forces(beam)
        assert all(np.isfinite(table).all() for table in (forces.normal, forces.shear, forces.moment))
        assert np.abs(forces.moment[-1]).max() > 0.0
    solution.plot(tmp_path / "shape.png")
    assert (tmp_path / "shape.png").stat().st_size > 1000


@pytest.mark.parametrize("name", [name for name in PRINTED if name != "path"])
def test_the_model_of_an_earlier_solution_is_solved_to_the_same_state(name, tmp_path):
    """Measured: within 3e-15 m, of tips that move by 3 to 100 mm, so that no part means anything else today."""
    old = bf.load(unpacked(name, tmp_path))
    new = bf.solve_static(old.model) if old.static else bf.simulate(old.model, 0.05, 0.01)
    point = end_of(old, name)
    np.testing.assert_allclose(new.displacement(point)[-1], old.displacement(point)[-1], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("name", PRINTED)
def test_an_earlier_solution_is_saved_again_as_one_of_today(name, tmp_path):
    old = bf.load(unpacked(name, tmp_path))
    old.save(tmp_path / "new.h5")
    new = bf.load(tmp_path / "new.h5")
    assert describe(new.model, new.at) == describe(old.model, old.at)
    for table in ("at", "p", "v", "a"):
        np.testing.assert_array_equal(getattr(new, table), getattr(old, table))


@pytest.mark.parametrize(("name", "kind"), [("cantilever", "Cubic"), ("motion", "Lagrange")])
def test_files_of_the_first_version_are_refused_as_those_of_another_version(name, kind, tmp_path):
    """It wrote the constants of a field as if they could be chosen; their states have other coordinates."""
    message = f"cannot be loaded: another version of beamfem saved it: a {kind} has no '"
    with pytest.raises(bf.InputError, match=message):
        bf.load(unpacked(name, tmp_path, "first"))


@pytest.mark.parametrize(
    ("given", "instead", "message"),
    [
        (
            '"density"',
            '"mass_density"',
            "another version of beamfem saved it: a Material has no 'mass_density' in this",
        ),
        (
            '"poisson_ratio": 0.3, ',
            "",
            "another version of beamfem saved it: a Material had no 'poisson_ratio' in that",
        ),
        ('"class": "Clamp"', '"class": "FixedEnd"', "this version of beamfem knows no FixedEnd"),
    ],
)
def test_parts_that_differ_in_another_version_are_named(given, instead, message, tmp_path):
    """A missing member was told as a damaged file, one too many as a wrong parameter."""
    file = unpacked("cantilever", tmp_path)
    with h5py.File(file, "r+") as saved:
        description = read_checked(saved, "model")[0].decode()
        assert given in description
        del saved["model"]
        write_checked(saved, "model", np.array([description.replace(given, instead).encode()]))
    with pytest.raises(bf.InputError, match=message):
        bf.load(file)
