"""Reactions of supports that share a coordinate, rows at given load factors, and paths in files."""

import h5py
import numpy as np
import pytest

import beamfem as bf
from beamfem.cli.model_file import ModelFileError, read_model_file

STIFF = bf.Section.from_stiffness(1e9, 1e9, 1.0, 1.0, 1.0)


def two_beams(supports, loads, element=None):
    """Two beams of length 1 along x that are joined in the middle."""
    beams = [bf.Beam(bf.Line((x, 0), (x + 1, 0)), 2, element or bf.CRBF(3), STIFF) for x in (0, 1)]
    model = bf.Model(beams, supports(*beams), loads(*beams), [bf.Rigid(beams[0].end, beams[1].start)])
    return *beams, bf.solve_static(model)


def test_two_springs_on_one_coordinate_share_its_reaction():
    """At one point both answer together: k1 + k2 times the displacement."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), STIFF)
    springs = [bf.Spring(beam.end, (0.0, 2.0)), bf.Spring(beam.end, (0.0, 5.0), 3.0)]
    model = bf.Model([beam], [bf.Clamp(beam.start), *springs], [bf.PointForce(beam.end, (0.0, 1e-4))])
    solution = bf.solve_static(model)
    moved, turned = solution.displacement(beam.end)[-1, 1], solution.rotation(beam.end)[-1]
    force = solution.reaction(beam.end)[-1]
    assert force == pytest.approx((0.0, -7.0 * moved, -3.0 * turned), rel=1e-9, abs=1e-15)
    # slope deflection of a cantilever, EI = L = 1, under the force and the moment that are left
    left, moment = 1e-4 - 7.0 * moved, -3.0 * turned
    assert moved == pytest.approx(left / 3 + moment / 2, rel=1e-6)
    assert turned == pytest.approx(left / 2 + moment, rel=1e-6)


@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(bf.Structural())])
def test_springs_on_both_sides_of_a_joint_report_their_own_force(element):
    one, two, solution = two_beams(
        lambda a, b: [bf.Clamp(a.start), bf.Spring(a.end, (0.0, 2.0), 1.5), bf.Spring(b.start, (0.0, 5.0))],
        lambda a, b: [bf.PointForce(b.end, (0.0, 1e-4))],
        element,
    )
    moved, turned = solution.displacement(one.end)[-1, 1], solution.rotation(one.end)[-1]
    assert solution.reaction(one.end)[-1] == pytest.approx((0.0, -2.0 * moved, -1.5 * turned), rel=1e-9, abs=1e-15)
    assert solution.reaction(two.start)[-1] == pytest.approx((0.0, -5.0 * moved, 0.0), rel=1e-9, abs=1e-15)
    total = sum(solution.reaction(point)[-1] for point in (one.start, one.end, two.start))
    assert total[:2] == pytest.approx((0.0, -1e-4), abs=1e-12)


def test_supports_on_both_sides_of_a_joint_report_what_they_hold():
    one, two, solution = two_beams(
        lambda a, b: [
            bf.Pin(a.start),
            bf.Roller(a.end),
            bf.Prescribed(b.start, rotation=0.0),
            bf.Spring(b.start, (4, 9)),
        ],
        lambda a, b: [bf.PointForce(b.end, (0.0, 1e-4)), bf.PointForce(a.at(0.5), (2e-4, 0.0))],
    )
    assert solution.reaction(one.end)[-1, 0] == 0.0
    assert solution.reaction(one.end)[-1, 2] == 0.0
    moved = solution.displacement(two.start)[-1]
    assert solution.reaction(two.start)[-1, :2] == pytest.approx((-4.0 * moved[0], 0.0), abs=1e-14)
    # rotation held at the joint: force 1e-4 at the arm 1 beyond it
    assert solution.reaction(two.start)[-1, 2] == pytest.approx(-1e-4, rel=1e-6)
    assert solution.reaction(one.end)[-1, 1] == pytest.approx(-1e-4, rel=1e-6)


MODEL = """
[beams.arm]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 2
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.1, height = 0.1 }
material = { youngs_modulus = 1e6, poisson_ratio = 0.3, density = 1.0 }

[[supports]]
kind = "clamp"
point = "arm.start"

[[loads]]
kind = "force"
point = "arm.end"
vector = [0.0, 5.0]

ANALYSIS
[[outputs]]
point = "arm.end"
quantities = ["uy"]
"""


def model_file(folder, analysis, at):
    path = folder / "arm.toml"
    path.write_text(MODEL.replace("ANALYSIS", analysis) + f"at = {at}\n")
    return read_model_file(path)


def rows_of(job):
    return job.outputs[0].rows(job.solve().solution)


def test_a_static_solve_has_a_row_at_every_load_factor_that_is_asked_for(tmp_path):
    """It made one step, and at = [0.5] printed the row at 0; half the load gives the same state."""
    job = model_file(tmp_path, "", "[0.5, 0.25, 1.0, 0.0]")
    rows = rows_of(job)
    assert [row["load_factor"] for row in rows] == pytest.approx([0.5, 0.25, 1.0, 0.0], abs=1e-12)
    arm = job.model.beams[0]
    half = bf.Model([arm], job.model.supports, [bf.PointForce(arm.end, (0.0, 2.5))])
    assert rows[0]["uy"] == pytest.approx(bf.solve_static(half).displacement(arm.end)[-1, 1], rel=1e-9)


@pytest.mark.parametrize(("at", "analysis"), [("[1.5]", ""), ("[-0.1]", ""), ("[0.3]", "MOTION")])
def test_states_beyond_the_end_are_refused(at, analysis, tmp_path):
    motion = '[analysis]\nkind = "dynamics"\nduration = 0.2\nstep = 0.01\n'
    with pytest.raises(ModelFileError, match="there is no state at"):
        model_file(tmp_path, motion if analysis else "", at)


def test_a_motion_gives_the_nearest_saved_state(tmp_path):
    motion = '[analysis]\nkind = "dynamics"\nduration = 0.2\nstep = 0.001\nsave_every = 50\n'
    rows = rows_of(model_file(tmp_path, motion, "[0.07, 0.08, 0.2, 0.0]"))
    assert [row["time"] for row in rows] == pytest.approx([0.05, 0.1, 0.2, 0.0])


@pytest.mark.parametrize(("side", "sign"), [("above", 1.0), ("below", -1.0)])
def test_a_path_ends_where_a_displacement_is_above_or_below_a_value(side, sign, tmp_path):
    until = f'until = {{ point = "arm.end", quantity = "uy", {side} = {sign * 0.2} }}\n'
    job = model_file(tmp_path, f'[analysis]\nkind = "path"\n{until}', '"all"')
    path_file = tmp_path / "arm.toml"
    path_file.write_text(path_file.read_text().replace("[0.0, 5.0]", f"[0.0, {sign * 5.0}]"))
    job = read_model_file(path_file)
    way = sign * np.array([row["uy"] for row in rows_of(job)])
    assert way[-1] > 0.2
    assert np.all(way[:-1] <= 0.2)


def test_a_saved_path_has_its_critical_points(tmp_path):
    """A shallow two-bar truss: limit points at load factors +- P, as they were; a column with a bifurcation."""
    bar = bf.Section.from_stiffness(1e3, 1e3, 1e3, 1.0, 1.0)
    left = bf.Beam(bf.Line((-1, 0), (0, 0.2)), 1, bf.CRBF(2), bar)
    right = bf.Beam(bf.Line((0, 0.2), (1, 0)), 1, bf.CRBF(2), bar)
    supports = [bf.Pin(left.start), bf.Pin(right.end), bf.Prescribed(left.end, ux=0.0)]
    truss = bf.Model([left, right], supports, [bf.PointForce(left.end, (0.0, -1.0))], [bf.Hinge(left.end, right.start)])
    path = bf.trace_equilibrium(truss, until=lambda state: state.displacement(left.end)[1] < -0.45)
    assert len(path.limit_points) == 2
    path.save(tmp_path / "path.h5")
    loaded = bf.load(tmp_path / "path.h5")
    assert isinstance(loaded, bf.Path)
    assert [point.load_factor for point in loaded.limit_points] == [point.load_factor for point in path.limit_points]
    top = loaded.model.beams[0].end
    for one, other in zip(loaded.limit_points, path.limit_points, strict=True):
        assert one.displacement(top) == pytest.approx(other.displacement(left.end), abs=1e-15)
    column = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), STIFF)
    pressed = bf.Model(
        [column], [bf.Pin(column.start), bf.Roller(column.end)], [bf.PointForce(column.end, (-12.0, 0.0))]
    )
    path = bf.trace_equilibrium(pressed, until=1.0)
    path.save(tmp_path / "column.h5")
    loaded = bf.load(tmp_path / "column.h5")
    crossing = loaded.bifurcations[0]
    assert crossing.load_factor == pytest.approx(np.pi**2 / 12.0, rel=1e-5)
    assert np.array_equal(crossing.mode, path.bifurcations[0].mode)
    assert np.array_equal(loaded.stable, path.stable)
    branch = bf.trace_equilibrium(loaded.model, start=crossing, points=3)
    assert abs(branch.displacement(loaded.model.beams[0].at(0.5))[-1, 1]) > 0.01


def test_a_saved_vibration_keeps_the_loads_of_its_equilibrium(tmp_path):
    """About half of its load: a motion has all of it otherwise. Vibration of 1e-6 of the length hardly changes that."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.DistributedLoad(beam, (500.0, 0.0))])
    half = bf.solve_static(model, steps=2)[1]
    assert half.at == 0.5
    vibration = bf.solve_modes(model, 1, about=half).solution(amplitude=1e-6)
    vibration.save(tmp_path / "mode.h5")
    again = bf.load(tmp_path / "mode.h5")
    for solution in (vibration, again):
        forces = solution.section_forces(solution.model.beams[0])
        expected = np.broadcast_to(250.0 * (1.0 - forces.arc_length), forces.normal.shape)
        np.testing.assert_allclose(forces.normal, expected, atol=0.1)


def test_a_saved_motion_keeps_its_events(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Section.from_stiffness(1e3, 1e3, 1.0, 1.0, 1.0))
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])
    turns = [bf.Event(name, lambda state: state.velocity(beam.end)[1]) for name in ("turns", "kehrt um, übrigens")]
    motion = bf.simulate(model, 3.0, 0.01, events=turns)
    motion.save(tmp_path / "swing.h5")
    assert bf.load(tmp_path / "swing.h5").events == motion.events
    assert len(motion.events) >= 2
    with h5py.File(tmp_path / "swing.h5", "r+") as file:
        file["events/time"][0] += 1e-9
    with pytest.raises(bf.InputError, match="its time is damaged"):
        bf.load(tmp_path / "swing.h5")
