"""Saving and loading of solutions."""

import subprocess
import sys
from contextlib import nullcontext

import h5py
import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf
from beamfem.io import description
from beamfem.io import description as own_parts
from beamfem.io import results_hdf5 as results
from beamfem.io.results_hdf5 import load, save
from beamfem.model.sampled_functions import Sampled
from beamfem.results.solution import Solution


def beam(element: bf.Element, start: tuple[float, float] = (0.0, 0.0), length: float = 1.0) -> bf.Beam:
    x, y = start
    line = bf.Line(start, (x + length, y))
    return bf.Beam(line, 2, element, bf.Rectangle(0.1, 0.1), bf.Material(2.1e7, 0.3, 7850.0))


def ramp(at: float) -> float:
    return float(np.sin(at / 0.3))


def static_solution() -> Solution:
    one, two = beam(bf.ANCF()), beam(bf.BilinearCRBF(bf.ContinuumMechanics(plane_stress=True), "reduced"), (0.0, 1.0))
    supports = [bf.Clamp(one.start), bf.Pin(two.start), bf.Roller(two.end), bf.Prescribed(one.at(1 / 3), uy=-0.01)]
    loads = [
        bf.Gravity((0.0, -9.81), scale=False),
        bf.DistributedLoad(two, (0.0, -3.0)),
        bf.PointForce(one.end, (1.0, np.float64(-5.0))),
        bf.PointMoment(two.at(0.3), 2.0),
    ]
    return bf.solve_static(bf.Model([one, two], supports, loads), steps=3)


def moving_solution(element: bf.Element) -> Solution:
    one = beam(element)
    supports = [bf.Prescribed(one.start, ux=0.0, uy=lambda t: 0.1 * t**3, rotation=ramp)]
    loads = [bf.PointForce(one.end, (0.0, 20.0), amplitude=ramp), bf.DistributedLoad(one, (1.0, 0.0), amplitude=ramp)]
    return bf.simulate(bf.Model([one], supports, loads), 0.02, 1e-3)


def assert_same(before: Solution, after: Solution) -> None:
    assert after.static == before.static
    assert repr(after.statistics) == repr(before.statistics)  # digits may be nan
    for name in ("at", "p", "v", "a"):
        np.testing.assert_array_equal(getattr(after, name), getattr(before, name), strict=True)
    for name in ("kinetic", "strain", "potential"):
        np.testing.assert_array_equal(getattr(after.energy(), name), getattr(before.energy(), name))
    for old, new in zip(before.model.supports, after.model.supports, strict=True):
        np.testing.assert_array_equal(after.reaction(new.point), before.reaction(old.point))
        np.testing.assert_array_equal(after.position(new.point), before.position(old.point))
    for old, new in zip(before.model.beams, after.model.beams, strict=True):
        assert (new.curve, new.elements, new.element) == (old.curve, old.elements, old.element)
        assert (new.section, new.material) == (old.section, old.material)
        np.testing.assert_array_equal(after.rotation(new.at(0.7)), before.rotation(old.at(0.7)))
        np.testing.assert_array_equal(after.section_forces(new).moment, before.section_forces(old).moment)


def test_static_solution_comes_back_the_same_from_a_new_folder(tmp_path):
    before = static_solution()
    path = tmp_path / "new" / "folder" / "static.h5"
    before.save(path)
    after = load(str(path))
    assert_same(before, after)
    one, two = after.model.beams
    assert after.model.supports[0].point.beam is one
    assert after.model.loads[1].beam is two


@pytest.mark.parametrize("element", [bf.ANCFCRBF(), bf.BilinearANCF()], ids=lambda element: element.name)
def test_motion_with_functions_comes_back_the_same(tmp_path, monkeypatch, element):
    monkeypatch.setattr(results, "_BLOCK_BYTES", 1000)
    before = moving_solution(element)
    save(before, tmp_path / "motion.h5")
    after = load(tmp_path / "motion.h5")
    assert_same(before, after)
    save(after, tmp_path / "motion.h5")
    assert_same(before, load(tmp_path / "motion.h5"))


def test_loaded_model_cannot_be_run_beyond_the_saved_values(tmp_path):
    save(moving_solution(bf.BilinearCRBF()), tmp_path / "motion.h5")
    model = load(tmp_path / "motion.h5").model
    amplitude = model.loads[0].amplitude
    assert isinstance(amplitude, Sampled)
    assert amplitude is model.loads[1].amplitude
    with pytest.raises(bf.InputError, match=r"saved as its values from 0 to 0\.02 and cannot be evaluated at 0\.04"):
        amplitude(0.04)


def test_sampled_is_linear_inside_and_raises_outside():
    function = Sampled((0.0, 1.0, 3.0), (0.0, 0.1, 0.5))
    assert [function(at) for at in (0.0, 1.0, 3.0)] == [0.0, 0.1, 0.5]
    assert function(2.0) == pytest.approx(0.3)
    assert Sampled((0.0,), (7.0,))(0.0) == 7.0
    for outside in (-1e-9, 3.1, np.nan):
        with pytest.raises(bf.InputError, match="saved as its values"):
            function(outside)


def test_unknown_part_is_named_and_leaves_an_older_file_alone(tmp_path, monkeypatch):
    solution = static_solution()
    save(solution, tmp_path / "a.h5")
    with monkeypatch.context() as patch:
        patch.delitem(description._CLASSES, "Roller")
        with pytest.raises(bf.InputError, match="knows no Roller"):
            load(tmp_path / "a.h5")
        patch.setattr(own_parts, "find", lambda name: None)
        with pytest.raises(bf.InputError, match="a Roller cannot be saved"):
            save(solution, tmp_path / "a.h5")
    assert_same(solution, load(tmp_path / "a.h5"))


def test_files_that_are_none_of_ours_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="there is no file"):
        load(tmp_path / "none.h5")
    (tmp_path / "text.h5").write_text("no states in here")
    with pytest.raises(bf.InputError, match="no HDF5 file"):
        load(tmp_path / "text.h5")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["at"] = [1.0]
    with pytest.raises(bf.InputError, match="not one that beamfem saved"):
        load(tmp_path / "other.h5")


def test_newer_and_damaged_files_are_refused(tmp_path):
    path = tmp_path / "a.h5"
    save(static_solution(), path)
    content = path.read_bytes()
    for size in (len(content) // 2, len(content) - 8, 100):
        path.write_bytes(content[:size])
        with pytest.raises(bf.InputError, match="truncated, damaged"):
            load(path)
    path.write_bytes(content)
    with h5py.File(path, "r+") as file:
        file.attrs["format_version"] = 2
    with pytest.raises(bf.InputError, match="reads formats up to 1"):
        load(path)
    path.write_bytes(content)
    with h5py.File(path, "r+") as file:
        del file["v"]
    with pytest.raises(bf.InputError, match="truncated, damaged"):
        load(path)
    path.write_bytes(content)
    with h5py.File(path, "r+") as file:
        del file["v"]
        file["v"] = np.zeros((len(file["at"]), 3))
    with pytest.raises(bf.InputError, match="do not fit"):
        load(path)


def test_missing_h5py_names_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(bf.BeamfemError, match=r'pip install "beamfem\[store\]"'):
        load(tmp_path / "a.h5")


KILLED = """
import os, sys
import numpy as np
import beamfem as bf
from beamfem.io import results_hdf5 as results
from beamfem.results.solution import Statistics

rows, blocks = 40, int(sys.argv[2])
one = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.ANCF(), bf.Rectangle(0.1, 0.1), bf.Material(1e7, 0.3, 1e3))
model = bf.Model([one], [bf.Clamp(one.start)])
p = np.arange(rows * model.size, dtype=float).reshape(rows, -1)
solution = bf.Solution(model, False, np.arange(rows) * 0.1, p, -p, 2 * p, Statistics(9, rows - 1, 0, "39 steps"))
results._BLOCK_BYTES = 8 * 8 * model.size
append, done = results._append, []

def killed(file, solution, rows):
    if len(done) == blocks:
        file["at"].resize(rows.stop, axis=0)
        file["p"].resize(rows.stop, axis=0)
        file["p"][rows] = solution.p[rows]
        os._exit(9)
    append(file, solution, rows)
    done.append(rows)

results._append = killed
results.save(solution, sys.argv[1])
"""


@mostly_slow("blocks", [0, 3], quick=(1,))
def test_killed_writer_leaves_the_rows_before(tmp_path, blocks):
    path = tmp_path / "killed.h5"
    ended = subprocess.run([sys.executable, "-c", KILLED, str(path), str(blocks)], check=False)
    assert ended.returncode == 9
    (partial,) = tmp_path.glob("killed.*.part.h5")
    assert not path.exists()
    if blocks == 0:
        with pytest.raises(bf.InputError, match="before the first rows"):
            load(partial)
        return
    solution = load(partial)
    expected = np.arange(24 * solution.model.size, dtype=float).reshape(24, -1)
    for values, factor in ((solution.p, 1), (solution.v, -1), (solution.a, 2)):
        np.testing.assert_array_equal(values, factor * expected)
    np.testing.assert_array_equal(solution.time, np.arange(24) * 0.1)
    assert solution.statistics.ended == "39 steps; the file holds 24 of 40 rows because its writing was cut off"


def test_a_saved_prescribed_motion_cannot_be_run_on(tmp_path):
    """Its linear interpolation would give accelerations of the kinks, 11.7 instead of 0.2 m/s^2 when it was found."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.ANCF(), bf.Rectangle(0.1, 0.1), bf.Material(1e7, 0.3, 1000.0))
    supports = [bf.Prescribed(beam.start, ux=0.0, uy=lambda t: 0.1 * t**2, rotation=0.0)]
    bf.simulate(bf.Model([beam], supports), 0.01, 1e-3).save(tmp_path / "moved.h5")
    with pytest.raises(bf.InputError, match="saved as values"):
        bf.simulate(bf.load(tmp_path / "moved.h5").model, 0.01, 1e-3)


def test_a_saved_table_is_kept_by_its_points_and_can_be_run_on(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.ANCF(), bf.Rectangle(0.1, 0.1), bf.Material(1e7, 0.3, 1000.0))
    table = bf.Interpolated([(0.0, 0.0), (0.0042, 1e-3), (1.0, 0.5)])
    supports = [bf.Prescribed(beam.start, ux=0.0, uy=table, rotation=0.0)]
    before = bf.simulate(bf.Model([beam], supports), 0.01, 1e-3, save_every=5)
    before.save(tmp_path / "moved.h5")
    model = bf.load(tmp_path / "moved.h5").model
    assert model.supports[0].uy == table
    assert np.array_equal(bf.simulate(model, 0.01, 1e-3, save_every=5).p, before.p)


STEEL, RUBBER = bf.Material(2e11, 0.3, 7800.0), bf.Material(1e7, 0.4, 1200.0)


def layers(thickness: float) -> bf.Layered:
    return bf.Layered([bf.Layer(STEEL, 0.02), bf.Layer(RUBBER, thickness)], 0.05, axis=0.03)


CURVES = {
    "arc": bf.Arc((0, 0), 1.0, 0.0, 1.5),
    "polyline": bf.Polyline(((0, 0), (1, 0), (1, 1))),
    "spline": bf.BSpline(2, (0, 0, 0, 1, 1, 1), ((0, 0), (1, 0.5), (1, 1)), (1, 2, 1)),
    "parametric": bf.Parametric(lambda u: (u, 0.3 * np.sin(2 * u)), 0.0, 1.5),
    "chain": bf.Chain((bf.Line((0, 0), (1, 0)), bf.Arc((1, 1), 1.0, -0.5 * np.pi, 0.0))),
}
SECTIONS = {
    "tube": bf.Tube(0.1, 0.01),
    "layers": layers(0.04),
    "stiffness": bf.Section.from_stiffness(1e7, 1e6, 1e4, 1.0, 1.0, coupling=10.0),
    "tapered": lambda s: bf.Rectangle(0.1, 0.1 - 0.02 * s),
    "tapered layers": lambda s: layers(0.04 - 0.01 * s),
}
MADE = [bf.CRBF(3), bf.ANCFCRBF(bf.ElasticLine()), bf.ShearRigid(), bf.CRBF(2, bf.SplitContinuum()), bf.ANCF()]


@mostly_slow("section", SECTIONS, quick=(1, 4))
@mostly_slow("curve", CURVES, quick=(0, 4))
def test_every_curve_section_and_element_comes_back(tmp_path, curve, section):
    material = STEEL if section in ("tube", "tapered") else None
    chosen = [element for element in MADE if section != "stiffness" or not element.forces.fills_body]
    beams = [bf.Beam(CURVES[curve], [0.0, 0.1, 0.4, 1.0], own, SECTIONS[section], material) for own in chosen]
    supports = [bf.Clamp(beam.start) for beam in beams]
    supports += [bf.Foundation(beams[0], (1.0, 1.0)), bf.Spring(beams[0].end, (1.0, 2.0), 3.0)]
    loads = [bf.PointForce(beams[0].at(0.9), (1.0, 10.0), follower=True), bf.Gravity((0.0, -9.81))]
    loads += [bf.DistributedLoad(beam, (0.0, 1.0), follower=True) for beam in beams]
    solution = bf.solve_static(bf.Model(beams, supports, loads))
    solution.save(tmp_path / "first.h5")
    load(tmp_path / "first.h5").save(tmp_path / "second.h5")
    again = load(tmp_path / "second.h5")
    assert np.array_equal(again.p, solution.p)
    np.testing.assert_allclose(again.energy().strain, solution.energy().strain, rtol=1e-10, atol=1e-18)
    for beam, other in zip(beams, again.model.beams, strict=True):
        assert other.element == beam.element
        np.testing.assert_allclose(again.position(other.at(0.37)), solution.position(beam.at(0.37)), atol=1e-13)
        before, after = solution.section_forces(beam), again.section_forces(other)
        np.testing.assert_allclose(after.moment, before.moment, rtol=1e-10, atol=1e-8 * np.abs(before.moment).max())
    known = nullcontext() if section != "stiffness" else pytest.warns(bf.UnknownStressWarning)
    with known:
        again.to_vtk(tmp_path / "body.pvd")
    # what was saved is what a solve on the same mesh needs
    np.testing.assert_allclose(bf.solve_static(again.model).p[-1], solution.p[-1], rtol=1e-9, atol=1e-9)


def test_a_saved_section_is_linear_between_its_values_and_refuses_what_it_cannot_know(tmp_path):
    def jumping(s: float) -> object:
        return bf.Circle(0.1) if s < 0.5 else layers(0.04)

    one = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), lambda s: bf.Rectangle(0.1, 0.1 + s), STEEL)
    undeclared = bf.Piecewise(jumping, ())  # its word is taken: no node at the jump
    two = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), undeclared, STEEL)
    model = bf.Model([one, two], [bf.Clamp(one.start), bf.Clamp(two.start)])
    bf.solve_static(model).save(tmp_path / "solution.h5")
    linear, jump = load(tmp_path / "solution.h5").model.beams
    assert linear.section_at(0.6).area == pytest.approx(0.07, rel=1e-12)
    assert jump.section_at(1.0) == layers(0.04)
    with pytest.raises(bf.InputError, match="different kinds"):
        jump.section_at(0.48)


def test_axes_of_beams_can_be_read_without_beamfem(tmp_path):
    """As netCDF has it: dimension scales, units and names, for `xarray.open_dataset(path, group="beams/1")`."""
    section, steel = bf.Rectangle(width=10.0, height=10.0), bf.Material(2e5, 0.3, 7.8e-9)
    common = {"section": section, "material": steel}
    post = bf.Beam(bf.Line((0, 0), (0, 1000)), elements=3, element=bf.CRBF(3), **common)
    arch = bf.Beam(bf.Arc((500, 1000), 500.0, np.pi, 0.0), elements=5, element=bf.ANCF(), **common)
    model = bf.Model(
        [post, arch],
        joints=[bf.Rigid(post.end, arch.start)],
        supports=[bf.Clamp(post.start)],
        loads=[bf.PointForce(arch.end, (30.0, -20.0))],
        units="N, mm",
    )
    solution = bf.solve_static(model, at=[0.0, 0.5, 1.0])
    solution.save(tmp_path / "frame.h5")
    with h5py.File(tmp_path / "frame.h5", "r") as file:
        assert sorted(file["beams"]) == ["0", "1"]
        group = file["beams/1"]
        assert group["x"].shape == group["rotation"].shape == (3, 6)
        assert [[scale.name.split("/")[-1] for scale in own.values()] for own in group["x"].dims] == [
            ["load_factor"],
            ["arc_length"],
        ]
        assert group["x"].attrs["units"] == group["arc_length"].attrs["units"] == "mm"
        assert group["rotation"].attrs["units"] == "rad"
        np.testing.assert_array_equal(group["load_factor"], [0.0, 0.5, 1.0])
        for station, fraction in enumerate(np.linspace(0.0, 1.0, 6)):
            point = arch.at(fraction)
            np.testing.assert_allclose(group["arc_length"][station], fraction * np.pi * 500.0, atol=1e-8)
            np.testing.assert_allclose(group["x"][:, station], solution.position(point)[:, 0], atol=1e-9)
            np.testing.assert_allclose(group["y"][:, station], solution.position(point)[:, 1], atol=1e-9)
            np.testing.assert_allclose(group["rotation"][:, station], solution.rotation(point), atol=1e-12)
        assert "PointForce" in file["model"][0].decode()
