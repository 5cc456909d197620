"""Full disks, killed writers, damaged files: what is written is whole, and what was there before stays."""

import os
import subprocess
import sys

import h5py
import numpy as np
import pytest

import beamfem as bf

resource = pytest.importorskip("resource")

BEAM = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
MODEL = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (0.0, -1e5))])

# what is larger than 2000 bytes fails as on a full disk
FULL = """
import resource, sys
import numpy as np
import beamfem as bf
beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1e5))])
rest = np.tile(np.zeros(model.size), (400, 1))
solution = bf.Solution(model, True, np.linspace(0, 1, 400), rest, rest, rest, bf.load(sys.argv[2]).statistics)
solution.plot(sys.argv[1] + "/warm.svg")
resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
for name, write in {
    "a.h5": solution.save, "a.vtkhdf": solution.to_vtk, "a.pvd": solution.to_vtk, "a.png": solution.plot,
    "a.html": solution.to_html, "a.gif": solution.animate,
}.items():
    try:
        write(f"{sys.argv[1]}/{name}")
    except bf.BeamfemError as error:
        print(name, type(error).__name__, error)
"""


@pytest.fixture(scope="module")
def solution():
    return bf.solve_static(MODEL, steps=4)


def test_a_full_disk_is_named_and_costs_no_earlier_file(tmp_path, solution):
    (tmp_path / "results").mkdir()
    saved = tmp_path / "good.h5"
    solution.save(saved)
    names = ("a.h5", "a.vtkhdf", "a.png", "a.html", "a.gif")
    for name in names:
        (tmp_path / "results" / name).write_bytes(b"earlier")
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(tmp_path / "results"), str(saved)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line.split()[:2] for line in lines] == [[name, "FileError"] for name in (*names[:2], "a.pvd", *names[2:])]
    assert all("cannot be written" in line for line in lines)
    for name in names:
        assert (tmp_path / "results" / name).read_bytes() == b"earlier"
    assert not list((tmp_path / "results").glob("*.part*"))


def test_a_killed_writer_leaves_the_earlier_file(tmp_path, solution):
    path = tmp_path / "cantilever.h5"
    solution.save(path)
    code = (
        "import os, sys, beamfem as bf\n"
        "from beamfem.io import results_hdf5 as results\n"
        "results._append = lambda *_: os.kill(os.getpid(), 9)\n"
        "bf.load(sys.argv[1]).save(sys.argv[1])"
    )
    done = subprocess.run([sys.executable, "-c", code, str(path)], check=False)
    assert done.returncode == -9
    assert np.array_equal(bf.load(path).p, solution.p)


@pytest.mark.slow
def test_flipped_bits_never_load_as_other_numbers(tmp_path, solution):
    path = tmp_path / "good.h5"
    solution.save(path)
    good, random = bytearray(path.read_bytes()), np.random.default_rng(5)
    damaged = tmp_path / "damaged.h5"
    refused = 0
    for place in random.integers(0, len(good), 400).tolist():
        bad = bytearray(good)
        bad[place] ^= 1 << int(random.integers(8))
        damaged.write_bytes(bad)
        try:
            found = bf.load(damaged)
        except bf.InputError:
            refused += 1
            continue
        for name in ("at", "p", "v", "a", "stability"):
            assert np.array_equal(getattr(found, name), getattr(solution, name)), place
        assert np.array_equal(found.displacement(found.model.beams[0].end), solution.displacement(BEAM.end))
        assert (found.static, found.statistics) == (solution.static, solution.statistics)
    assert refused > 50  # the rest of the file is empty room


def test_load_reads_nothing_of_variable_length(tmp_path, solution):
    """Where that lies has no checksum, and HDF5 may look for it without end in a damaged file."""
    solution.save(tmp_path / "good.h5")
    with h5py.File(tmp_path / "good.h5", "r") as file:
        kinds = {name: file.attrs.get_id(name).dtype.kind for name in file.attrs}
        kinds |= {name: item.dtype.kind for name, item in file.items() if name != "beams"}
    assert "O" not in kinds.values(), kinds


@pytest.mark.parametrize("name", ["figure.xyz", "figure"])
def test_a_picture_of_an_unknown_kind_is_refused(tmp_path, solution, name):
    with pytest.raises(bf.InputError, match=r"a picture is a \.png, \.svg or \.pdf file"):
        solution.plot(tmp_path / name)


def test_a_folder_in_the_place_of_a_file_is_named(tmp_path, solution):
    for write in (solution.save, lambda path: solution.plot(path.with_suffix(".png"))):
        (tmp_path / "taken.h5").mkdir(exist_ok=True)
        (tmp_path / "taken.png").mkdir(exist_ok=True)
        with pytest.raises(bf.FileError, match="is a folder"):
            write(tmp_path / "taken.h5")


def test_a_link_to_a_file_stays_a_link(tmp_path, solution):
    (tmp_path / "there.h5").write_bytes(b"")
    os.symlink(tmp_path / "there.h5", tmp_path / "link.h5")
    solution.save(tmp_path / "link.h5")
    assert (tmp_path / "link.h5").is_symlink()
    assert len(bf.load(tmp_path / "there.h5")) == len(solution)


@pytest.mark.parametrize(
    ("name", "before", "after"),
    [("model", b"7800.0", b"7900.0"), ("statistics", b'"iterations": 1', b'"iterations": 2')],
)
def test_another_model_or_other_statistics_than_were_written_are_refused(tmp_path, solution, name, before, after):
    """A bit that flips in a chunk of HDF5 is seen by the checksum of beamfem alone."""
    path = tmp_path / "good.h5"
    solution.save(path)
    with h5py.File(path, "r+") as file:
        (text,) = file[name][:]
        assert before in text
        file[name][:] = [text.replace(before, after)]
    with pytest.raises(bf.InputError, match=f"its {name} is damaged"):
        bf.load(path)
