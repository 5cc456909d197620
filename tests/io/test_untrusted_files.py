"""Files from elsewhere: nothing outside of them is read, and nothing waits or ends in a bare error."""

import os

import h5py
import pytest

import beamfem as bf
from beamfem.cli.model_file import read_model_file

BEAM = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
MODEL = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (0.0, -1e3))])


@pytest.fixture
def saved(tmp_path):
    bf.solve_static(MODEL, steps=2).save(tmp_path / "a.h5")
    return tmp_path / "a.h5"


@pytest.mark.parametrize("name", ["p", "statistics", "model"])
@pytest.mark.parametrize("kind", ["external link", "soft link"])
def test_a_results_file_that_links_elsewhere_is_refused(saved, name, kind):
    other = saved.with_name("b.h5")
    other.write_bytes(saved.read_bytes())
    with h5py.File(saved, "a") as file:
        file.move(name, "own")
        file[name] = h5py.ExternalLink(str(other), name) if kind == "external link" else h5py.SoftLink("/own")
    with pytest.raises(bf.InputError, match=f"its {name} is a link"):
        bf.load(saved)


def test_a_results_file_whose_numbers_are_elsewhere_is_refused(saved):
    with h5py.File(saved, "a") as file:
        p = file["p"][()]
        saved.with_name("raw").write_bytes(p.tobytes())
        del file["p"]
        file.create_dataset("p", p.shape, p.dtype, external=[(str(saved.with_name("raw")), 0, p.nbytes)])
    with pytest.raises(bf.InputError, match="are in another file"):
        bf.load(saved)


def test_a_results_file_with_rows_that_were_never_written_is_refused(saved):
    with h5py.File(saved, "a") as file:
        for name in ("at", "p", "v", "a"):
            file[name].resize(10**9, axis=0)
        file.attrs["rows"] = file.attrs["all_rows"] = 10**9
    with pytest.raises(bf.InputError, match="never written"):
        bf.load(saved)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no FIFOs here")
@pytest.mark.parametrize(("name", "read"), [("a.h5", bf.load), ("a.toml", read_model_file), ("a.inp", bf.read_mesh)])
def test_a_fifo_is_refused(tmp_path, name, read):
    os.mkfifo(tmp_path / name)
    with pytest.raises((bf.InputError, bf.FileError)):
        read(tmp_path / name)


@pytest.mark.parametrize("name", ["a\0b", "a\ud800"])
def test_names_that_no_file_can_hold_are_refused(name):
    with pytest.raises(bf.InputError, match="name of a Beam must not contain"):
        bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), BEAM.section, BEAM.material, name=name)


def test_a_bad_vtu_is_refused_with_a_reason(tmp_path):
    (tmp_path / "a.vtu").write_text("<VTKFile type='ImageData' version='1.0'></VTKFile>")
    with pytest.raises(bf.InputError, match=r"cannot be read as vtu: .*[a-z]{4}"):
        bf.read_mesh(tmp_path / "a.vtu")


@pytest.mark.filterwarnings("ignore:.*left out")
def test_sets_of_sets_of_sets_are_sets(tmp_path):
    """Each level names the one before 16 times: 16^11 entries of the same two nodes."""
    lines = ["*NODE", "1, 0, 0", "2, 1, 0", "*ELEMENT, TYPE=B21, ELSET=E", "1, 1, 2", "*NSET, NSET=S0", "1, 2"]
    for level in range(11):
        lines += [f"*NSET, NSET=S{level + 1}", ", ".join([f"S{level}"] * 16)]
    (tmp_path / "a.inp").write_text("\n".join(lines) + "\n")
    assert bf.read_mesh(tmp_path / "a.inp").point_sets["S11"].tolist() == [0, 1]
