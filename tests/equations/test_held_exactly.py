"""Supports, joints and refusals that a small change in the code could break unnoticed."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.model.time_functions import Interpolated

SECTION = bf.Rectangle(0.02, 0.02)
RUBBER = bf.Material(1e6, 0.3, 1000.0)


def line(start=(0, 0), end=(1, 0), elements=4):
    return bf.Beam(bf.Line(start, end), elements, bf.CRBF(2), SECTION, RUBBER)


@pytest.mark.parametrize("tilt", [0.3, 1e-3, 1e-5, 1e-8, -1e-6])
def test_a_roller_tilted_by_little_leads_the_beam_along_its_plane(tilt):
    """Pulled by N, loaded by P at the middle: the roller gives P / 2 across and the share tan(tilt) of it along."""
    beam = line()
    normal = (np.sin(tilt), np.cos(tilt))
    loads = [bf.PointForce(beam.end, (20.0, 0.0)), bf.PointForce(beam.at(0.5), (0.0, -1e-2))]
    solution = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end, normal)], loads))
    ux, uy = solution.displacement(beam.end)[-1]
    assert ux > 0.04
    assert uy == pytest.approx(-ux * np.tan(tilt), rel=1e-6, abs=1e-16)
    fx, fy, _ = solution.reaction(beam.end)[-1]
    assert fx == pytest.approx(fy * np.tan(tilt), rel=1e-6, abs=1e-12)
    x, y = solution.position(beam.end)[-1]
    mx = solution.position(beam.at(0.5))[-1, 0]
    assert x * fy - y * fx - mx * 1e-2 - y * 20.0 == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("length", [1e-3, 1.0, 1e3])
def test_points_are_joined_within_a_hundred_thousandth_of_the_longer_beam(length):
    def joined(gap):
        first, second = line((0, 0), (length, 0)), line((length, gap), (1.5 * length, length))
        return bf.Model([first, second], joints=[bf.Rigid(first.end, second.start)])

    assert joined(0.9e-5 * length).size < joined(0.0).size + 1
    with pytest.raises(bf.InputError, match="a joint needs points that coincide"):
        joined(1.2e-5 * length)


@pytest.mark.parametrize("stiffness", [(-1.0, 5.0), (5.0, -1.0), (0.0, 0.0)])
def test_a_spring_without_stiffness_or_with_a_negative_one_is_refused(stiffness):
    with pytest.raises(bf.InputError, match="stiffness of a Spring must not be negative"):
        bf.Spring(line().end, stiffness)


def test_a_spring_with_a_negative_rotational_stiffness_is_refused():
    with pytest.raises(bf.InputError, match="stiffness of a Spring must not be negative"):
        bf.Spring(line().end, (1.0, 1.0), -0.1)


@pytest.mark.parametrize("held", [{"ux": 0.0}, {"uy": 0.0}, {"ux": 0.0, "uy": 0.1}])
def test_an_inclined_roller_beside_a_prescribed_displacement_is_refused(held):
    beam = line()
    supports = [bf.Clamp(beam.start), bf.Roller(beam.end, (1.0, 1.0)), bf.Prescribed(beam.end, **held)]
    model = bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), (0.0, 1.0))])
    with pytest.raises(bf.InputError, match="inclined Roller stands where another support already constrains"):
        bf.solve_static(model)


def test_two_inclined_rollers_at_one_point_are_refused():
    beam = line()
    rollers = [bf.Roller(beam.end, (1.0, 1.0)), bf.Roller(beam.end, (1.0, -1.0))]
    model = bf.Model([beam], [bf.Clamp(beam.start), *rollers])
    with pytest.raises(bf.InputError, match="two inclined Rollers stand at the same point; one support"):
        bf.solve_static(model)


@pytest.mark.parametrize("moving", ["v", "a"])
def test_vibration_about_a_state_with_a_velocity_or_only_an_acceleration_is_refused(moving):
    beam = line()
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    rates = {"v": np.zeros(model.size), "a": np.zeros(model.size)}
    rates[moving][-1] = 1e-3
    state = bf.State(bf.solve_static(model)[-1].p, rates["v"], rates["a"], 0.0, model)
    with pytest.raises(bf.InputError, match="about must be a state at rest"):
        bf.solve_modes(model, 1, about=state)


@pytest.mark.parametrize("value", [True, np.True_, 2.0, 0, -3, "2"])
def test_a_count_is_a_whole_number_of_at_least_one_and_no_truth(value):
    beam = line()
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1e-3))])
    for ask in (
        lambda: bf.solve_static(model, steps=value),
        lambda: bf.solve_modes(model, value),
        lambda: bf.trace_equilibrium(model, 1.0, points=value),
        lambda: bf.simulate(model, 1.0, 0.1, save_every=value),
        lambda: bf.Newton(iterations=value),
        lambda: bf.CRBF(value),
        lambda: line(elements=value),
    ):
        with pytest.raises(bf.InputError):
            ask()


@pytest.mark.parametrize("times", [(0.0, 0.0), (0.0, 1.0, 1.0), (1.0, 0.5)])
def test_a_table_of_equal_or_falling_times_is_refused(times):
    with pytest.raises(bf.InputError, match="increasing times"):
        Interpolated([(time, 1.0) for time in times])


@pytest.mark.parametrize("name", ["motion.pvd", "motion.vtkhdf"])
def test_an_export_that_fails_leaves_no_temporary_file(tmp_path, name):
    pytest.importorskip("h5py")
    beam = line()
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1e-3))]))
    (tmp_path / name).mkdir()  # what is to be replaced is a folder
    with pytest.raises(bf.FileError, match="is a folder"):
        solution.to_vtk(tmp_path / name)
    assert not list(tmp_path.glob("*.part*"))


@pytest.mark.parametrize("slenderness", [10, 100, 1000])
def test_a_cantilever_under_five_takes_eight_or_nine_iterations_in_one_load_step(slenderness):
    section = bf.Rectangle(0.01, 1.0 / slenderness)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), section, bf.Material(1e9, 0.3, 1000.0))
    force = 5e9 * section.second_moment
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))]))
    assert solution.statistics.steps == 1
    assert solution.iterations in (8, 9)


@pytest.mark.parametrize("slenderness", [10, 100, 1000])
def test_a_roll_up_into_a_full_circle_takes_five_iterations(slenderness):
    section = bf.Rectangle(0.01, 1.0 / slenderness)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), section, bf.Material(1e9, 0.3, 1000.0))
    moment = 2e9 * np.pi * section.second_moment
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, moment)]))
    assert solution.statistics.steps == 1
    assert solution.iterations <= 5
    assert solution.rotation(beam.end)[-1] == pytest.approx(2.0 * np.pi, abs=1e-6)
