"""Full turns of beams whose coordinates do not count them: counted by the solver from step to step."""

from itertools import pairwise

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.io.table import arrays
from beamfem.io.vtk_cells import centrelines

MOMENT = 4.0
INERTIA = 0.5 * (1.0 + 0.05**2) / 3  # of a bar of 0.5 kg about its end
SECTION, SOFT = bf.Rectangle(0.05, 0.05), bf.Material(1e8, 0.3, 200.0)
KINDS = {
    "ANCF": bf.ANCF,
    "elastic line": lambda: bf.ANCF(bf.ElasticLine()),
    "structural": lambda: bf.ANCF(bf.Structural()),
    "bilinear": bf.BilinearANCF,
}


def spun(element, save_every, parts=1):
    """A pinned bar of one beam, or of several that are joined, that a moment at its end spins up, and its motion."""
    ends = np.linspace(0.0, 1.0, parts + 1)
    beams = [bf.Beam(bf.Line((start, 0), (end, 0)), 3, element, SECTION, SOFT) for start, end in pairwise(ends)]
    joints = [bf.Rigid(one.end, next_one.start) for one, next_one in pairwise(beams)]
    model = bf.Model(beams, [bf.Pin(beams[0].start)], [bf.PointMoment(beams[-1].end, MOMENT)], joints)
    return beams, bf.simulate(model, 1.0, 1e-3, save_every=save_every)


@pytest.mark.parametrize("kind", KINDS)
def test_turns_between_saved_rows_are_counted(kind):
    """The bar turns by M t^2 / (2 I), but for what it bends, and the moment does the work M times its turn.

    Rows are half a second apart: from one to the next the rotation was taken within half a turn.
    """
    (beam,), motion = spun(KINDS[kind](), 500)
    assert len(motion) == 3
    rigid = MOMENT * motion.time**2 / (2 * INERTIA)
    assert rigid[-1] > 11.0
    assert motion.rotation(beam.at(0.5)) == pytest.approx(rigid, abs=0.3)
    energy = motion.energy()
    assert energy.kinetic[-1] + energy.strain[-1] == pytest.approx(MOMENT * motion.rotation(beam.end)[-1], rel=2e-3)
    assert energy.total == pytest.approx(0.0, abs=2e-3 * energy.kinetic[-1])
    assert motion.angular_momentum()[-1] == pytest.approx(MOMENT, rel=1e-3)


def test_rotations_do_not_depend_on_which_rows_are_saved():
    (beam,), every = spun(bf.ANCF(), 1)
    for save_every in (2, 250, 333, 1000):
        (other,), some = spun(bf.ANCF(), save_every)
        rows = np.round(some.time * 1e3).astype(int)
        assert some.rotation(other.at(0.7)) == pytest.approx(every.rotation(beam.at(0.7))[rows], abs=1e-9)


def test_every_beam_of_a_chain_is_counted():
    beams, motion = spun(bf.ANCF(), 500, parts=3)
    ends = [motion.rotation(beam.end)[-1] for beam in beams]
    assert ends[0] > 10.0
    assert ends == pytest.approx([ends[0]] * 3, abs=0.3)


def test_slices_and_files_keep_the_turns(tmp_path):
    (beam,), motion = spun(bf.ANCF(), 500)
    last = motion.rotation(beam.end)[-1]
    assert motion[2:].rotation(beam.end)[0] == pytest.approx(last, abs=1e-12)
    assert motion[::2].rotation(beam.end)[-1] == pytest.approx(last, abs=1e-12)
    motion.save(tmp_path / "spun.h5")
    loaded = bf.load(tmp_path / "spun.h5")
    assert loaded.rotation(loaded.model.beams[0].end)[-1] == pytest.approx(last, abs=1e-12)
    assert loaded.energy().total == pytest.approx(motion.energy().total, abs=1e-9)


def test_a_slice_of_a_static_solution_keeps_the_turns():
    """The end of a beam is led round its pinned start by 4 rad, the whole of it turns."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.ANCF(bf.Structural()), SECTION, SOFT)
    led = bf.Prescribed(beam.end, ux=lambda t: np.cos(4.0 * t) - 1.0, uy=lambda t: np.sin(4.0 * t))
    solution = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), led]), steps=16)
    assert solution.rotation(beam.at(0.5))[-1] == pytest.approx(4.0, abs=1e-6)
    assert solution[-1:].rotation(beam.at(0.5))[0] == pytest.approx(4.0, abs=1e-6)


def test_steps_that_a_kink_divides_are_counted_too():
    """The moment stops at a kink between two steps, and the bar spins on."""
    stop = 0.5005
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.ANCF(), SECTION, SOFT)
    until = bf.Piecewise(lambda t: 1.0 if t < stop else 0.0, [stop])
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.PointMoment(beam.end, MOMENT, amplitude=until)])
    motion = bf.simulate(model, 1.0, 1e-3, save_every=1000)
    rate = MOMENT * stop / INERTIA
    assert motion.rotation(beam.at(0.5))[-1] == pytest.approx(rate * (0.5 * stop + 1.0 - stop), abs=0.3)


def test_beams_of_a_model_without_a_narrow_band_are_counted():
    """A wheel of 40 spokes spins about its hub; some of them start on the far side of the cut of the angle."""
    angles = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    ends = [(float(np.cos(angle)), float(np.sin(angle))) for angle in angles]
    spokes = [bf.Beam(bf.Line((0, 0), end), 1, bf.ANCF(), SECTION, SOFT) for end in ends]
    joints = [bf.Rigid(spokes[0].start, spoke.start) for spoke in spokes[1:]]
    loads = [bf.PointMoment(spoke.end, MOMENT) for spoke in spokes]
    model = bf.Model(spokes, [bf.Pin(spokes[0].start)], loads, joints)
    motion = bf.simulate(model, 1.0, 5e-3, save_every=100)
    for spoke in (spokes[0], spokes[17], spokes[20], spokes[39]):
        assert motion.rotation(spoke.at(0.5))[-1] == pytest.approx(MOMENT / (2 * INERTIA), abs=0.3)


def test_tables_and_paraview_files_have_the_turns():
    """The same in all of them as `rotation` says, whatever rows are written at once."""
    (beam,), motion = spun(bf.ANCF(), 500)
    expected = motion.rotation(beam.end)
    assert arrays(motion, beam)[0]["rotation"][1][:, -1] == pytest.approx(expected, abs=1e-9)
    (cells,) = centrelines(motion.model)
    for rows in (slice(0, 3), slice(2, 3)):
        assert cells.arrays(motion, rows)["rotation"][:, -1] == pytest.approx(expected[rows], abs=1e-9)


def test_each_of_several_beams_has_turns_of_its_own():
    """Two pinned bars that turn by M t^2 / (2 I), the second four times as far."""
    beams = [bf.Beam(bf.Line((0, y), (1, y)), 3, bf.ANCF(), SECTION, SOFT) for y in (0.0, 2.0)]
    loads = [bf.PointMoment(beam.end, moment) for beam, moment in zip(beams, (1.0, 4.0), strict=True)]
    motion = bf.simulate(bf.Model(beams, [bf.Pin(beam.start) for beam in beams], loads), 1.0, 1e-3, save_every=500)
    for beam, moment in zip(beams, (1.0, 4.0), strict=True):
        assert motion.rotation(beam.start)[-1] == pytest.approx(moment / (2 * INERTIA), abs=0.1)


def test_a_motion_from_a_rolled_up_state_starts_with_its_rotations():
    """Moments at both ends turn them by -2 and 2 rad: the start's own rotation is what turns are counted from."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.ANCF(bf.Structural()), SECTION, SOFT)
    moment = 4.0 * SOFT.youngs_modulus * SECTION.second_moment
    loads = [bf.PointMoment(beam.start, -moment), bf.PointMoment(beam.end, moment)]
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], loads)
    rolled = bf.solve_static(model, steps=8)
    assert rolled.rotation(beam.end)[-1] - rolled.rotation(beam.start)[-1] == pytest.approx(4.0, rel=1e-3)
    motion = bf.simulate(model, 1e-5, 1e-5, start=rolled[-1])
    for point in (beam.start, beam.end):
        assert motion.rotation(point)[0] == pytest.approx(rolled.rotation(point)[-1], abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_a_motion_that_goes_on_from_another_keeps_its_turns(kind):
    """In two parts the motion is that in one; its rotation fell back by two turns, its energy by the moment's work."""
    (beam,), whole = spun(KINDS[kind](), 500)
    model = whole.model
    first = bf.simulate(model, 0.9, 1e-3, save_every=450)
    held = bf.Model([beam], [bf.Pin(beam.start), bf.Spring(beam.end, rotational=1e-9)], model.loads)
    for other in (model, held):
        rest = bf.simulate(other, 0.1, 1e-3, save_every=50, start=first[-1])
        assert first.rotation(beam.end)[-1] > np.pi + 6.0
        # a node that angles carry ties the direction of r_x to that of r_y
        assert rest.rotation(beam.end)[0] == pytest.approx(first.rotation(beam.end)[-1], abs=1e-4)
        assert rest.rotation(beam.end)[-1] == pytest.approx(whole.rotation(beam.end)[-1], abs=1e-3)
        assert rest.energy().total == pytest.approx(0.0, abs=2e-3 * whole.energy().kinetic[-1])


def test_the_acceleration_of_a_point_is_the_second_rate_of_its_position(element):
    bar = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 1.5), 3, element, SECTION, SOFT)
    model, random, step = bf.Model([bar], [bf.Clamp(bar.start)]), np.random.default_rng(0), 1e-3
    rest = system_of(model, static=False).reference
    p, v, a = rest + 0.05 * random.standard_normal(len(rest)), *random.standard_normal((2, len(rest)))

    def motion(time):
        state = bf.State(p + time * v + 0.5 * time**2 * a, v + time * a, a, 0.0, model)
        return state.as_row(static=False)

    for point in (bar.end, bar.at(0.45)):
        before, now, after = (motion(time).position(point) for time in (-step, 0.0, step))
        assert motion(0.0).acceleration(point) == pytest.approx(
            (after - 2.0 * now + before) / step**2, rel=1e-5, abs=1e-6
        )


def test_the_acceleration_of_a_driven_point_is_that_of_its_motion():
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(3), SECTION, SOFT)
    shaken = bf.Prescribed(bar.start, ux=0.0, uy=lambda t: 0.01 * np.sin(40.0 * t), rotation=0.0)
    seen = bf.Event("turns", lambda state: state.acceleration(bar.start)[1] + 8.0)
    motion = bf.simulate(bf.Model([bar], [shaken]), 0.1, 1e-3, events=[seen])
    assert motion.acceleration(bar.start)[5:, 1] == pytest.approx(-16.0 * np.sin(40.0 * motion.time[5:]), abs=0.1)
    assert motion.events[0].time == pytest.approx(np.pi / 6.0 / 40.0, abs=2e-4)
    assert motion.plot_history(bar.start, "acceleration").axes[0].get_ylabel() == "acceleration [m/s^2]"
