"""Bad input gets an error that names it, before anything is solved."""

import math

import numpy as np
import pytest

import beamfem as bf
from beamfem.installed_memory import installed_memory
from beamfem.solve.start import start_checks as memory

LINE = bf.Line((0, 0), (1, 0))
SECTION = bf.Rectangle(0.01, 0.01)
STEEL = bf.Material(2e11, 0.3, 7800.0)


def a_beam(**changes):
    arguments = {"curve": LINE, "elements": 2, "element": bf.ANCF(), "section": SECTION, "material": STEEL}
    return bf.Beam(**{**arguments, **changes})


BEAM = a_beam()
MODEL = bf.Model([BEAM])


def test_a_support_on_no_beam_of_the_model_is_refused():
    with pytest.raises(bf.UnknownPointError, match=r"Clamp at .* not in this model"):
        bf.Model([BEAM], [bf.Clamp(a_beam().start)])


def test_a_question_about_a_foreign_point_is_refused():
    solution = bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)]))
    with pytest.raises(bf.UnknownPointError):
        solution.position(a_beam().end)


def test_a_reaction_where_no_support_is_is_refused():
    solution = bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)]))
    with pytest.raises(bf.InputError, match="no support"):
        solution.reaction(BEAM.end)


def test_two_supports_of_one_coordinate_are_refused():
    model = bf.Model([BEAM], [bf.Clamp(BEAM.start), bf.Pin(BEAM.start)])
    with pytest.raises(bf.InputError, match="already prescribes"):
        bf.solve_static(model)


def test_an_inclined_roller_at_a_pin_is_refused():
    model = bf.Model([BEAM], [bf.Pin(BEAM.start), bf.Roller(BEAM.start, (1, 1))])
    with pytest.raises(bf.InputError, match="Roller"):
        bf.solve_static(model)


def test_an_amplitude_that_is_not_finite_is_named():
    loads = [bf.PointForce(BEAM.end, (0, 1), amplitude=lambda t: math.nan)]
    with pytest.raises(bf.InputError, match="amplitude"):
        bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)], loads))


def test_a_static_solution_has_no_time_and_a_motion_no_load_factor():
    clamped = bf.Model([BEAM], [bf.Clamp(BEAM.start)])
    with pytest.raises(bf.InputError, match="load_factor"):
        _ = bf.solve_static(clamped).time
    with pytest.raises(bf.InputError, match="time"):
        _ = bf.simulate(clamped, 1e-3, 1e-3).load_factor


def test_a_start_of_another_model_is_refused():
    other = bf.Model([a_beam(elements=3)], [bf.Clamp(BEAM.start)][:0])
    state = bf.simulate(other, 1e-3, 1e-3)[-1]
    with pytest.raises(bf.InputError, match="4 nodes of ANCF on beam 0"):
        bf.simulate(bf.Model([BEAM]), 1e-3, 1e-3, start=state)


class Callable:
    def __call__(self, time: float) -> float:
        return time


@pytest.mark.parametrize("function", [np.sin, math.sin, Callable(), lambda t, scale=2.0: t, lambda *t: 1.0, abs])
def test_functions_of_one_argument_are_taken_as_they_are(function):
    assert bf.PointForce(BEAM.end, (0, 1), amplitude=function).amplitude is function
    assert bf.Prescribed(BEAM.end, uy=function).uy is function


def test_more_states_than_memory_are_refused_with_the_size_and_a_way_out(monkeypatch):
    with pytest.raises(bf.InputError, match=r"1e\+18 steps of 18 coordinates.*GiB, and this computer has .* GiB"):
        bf.simulate(MODEL, 1e15, 1e-3)
    monkeypatch.setattr(memory, "installed_memory", lambda: 2**30)
    # 18 coordinates of 3 x 8 bytes and 64 bytes a step: 1.39 GiB for 3e6 of them, 0.784 GiB where every other is kept
    with pytest.raises(bf.InputError, match=r"every one is kept, need 1\.39 GiB.*has 1 GiB; save_every=2 would fit"):
        bf.simulate(MODEL, 3e6, 1.0)
    memory.require_memory(MODEL.size, 3e6, 1.0, save_every=2)
    with pytest.raises(bf.InputError, match=r"every 1000th is kept, .* take a larger step"):
        bf.simulate(MODEL, 2e7, 1.0, save_every=1000)


def test_memory_that_the_system_does_not_tell_refuses_nothing(monkeypatch):
    def unknown(name):
        raise ValueError(name)

    assert installed_memory() > 2**28
    monkeypatch.setattr("os.sysconf", unknown)
    assert installed_memory() is None
    memory.require_memory(18, 1e15, 1e-3, 1)


def test_a_slice_of_a_solution_is_a_solution_of_these_rows():
    whole = bf.simulate(bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (0, 1))]), 1e-2, 1e-3)
    for rows in (slice(2, 5), slice(None, None, -3), slice(-2, None), slice(0, 99)):
        part = whole[rows]
        assert isinstance(part, bf.Solution)
        np.testing.assert_array_equal(part.time, whole.time[rows])
        np.testing.assert_array_equal(part.position(BEAM.end), whole.position(BEAM.end)[rows])
        np.testing.assert_array_equal(part.reaction(BEAM.start), whole.reaction(BEAM.start)[rows])
        np.testing.assert_allclose(part.energy().strain, whole.energy().strain[rows], rtol=1e-9)
    assert [state.at for state in whole] == whole.time.tolist()
    assert whole[np.int64(-1)].at == whole.time[-1]
    for rows in (slice(5, 5), slice(20, 30), slice(4, 2)):
        with pytest.raises(bf.InputError, match=r"selects no row; this solution has rows 0 to 10"):
            whole[rows]
    for row in ("last", 1.0, None, (0, 1), [0, 1]):
        with pytest.raises(bf.InputError, match="a slice such as solution"):
            whole[row]
    with pytest.raises(IndexError):
        whole[11]


def test_rows_and_slices_of_a_path():
    model = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (0, 1))])
    path = bf.trace_equilibrium(model, points=5)
    assert path[np.int64(-1)].load_factor == path[-1].load_factor == path.load_factor[4]
    part = path[1:3]
    assert (len(part), part.static) == (2, True)
    np.testing.assert_array_equal(part.displacement(BEAM.end), path.displacement(BEAM.end)[1:3])


@pytest.mark.parametrize("place", ["tip", (1.0, 0.0), BEAM, 1.0, None])
def test_a_question_about_what_is_no_point_is_refused(place):
    solution = bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)]))
    for ask in (solution.position, solution.displacement, solution.rotation, solution.fields, solution.reaction):
        with pytest.raises(bf.InputError, match=r"a point is asked for, such as beam\.end"):
            ask(place)


def test_section_forces_are_those_of_a_beam():
    solution = bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)]))
    with pytest.raises(bf.InputError, match="a beam is asked for"):
        solution.section_forces(BEAM.end)
    with pytest.raises(bf.UnknownPointError):
        solution.section_forces(a_beam())


def test_moments_of_a_rectangle():
    section = bf.Rectangle(0.2, 0.3)
    assert section.second_moment == pytest.approx(0.2 * 0.3**3 / 12)
    assert section.fourth_moment == pytest.approx(0.2 * 0.3**5 / 80)
    assert (section.width, section.height) == pytest.approx((0.2, 0.3))
    assert np.isclose(bf.Section(1.0, 1.0, fourth_moment=7.0).fourth_moment, 7.0)
