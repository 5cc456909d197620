"""Motions of long chains, in tiles and halves: one thread, two threads and no tiles find the same."""

import os
import signal
import threading
from dataclasses import replace

import numpy as np
import pytest
from section_laws import RambergOsgood

import beamfem as bf
from beamfem.assembly import tiles
from beamfem.assembly.system import system_of
from beamfem.kernels import record, two_threads
from beamfem.kernels.band import KNOWN
from beamfem.solve.motion import second_thread
from beamfem.solve.motion.compiled_steps import CompiledSteps
from beamfem.solve.motion.march import initial_acceleration
from beamfem.solve.newton import cut_chain

RUBBER = bf.Material(5e6, 0.3, 1000.0)
DAMPED = bf.Material(5e6, 0.3, 1000.0, retardation_time=0.002)
SECTION = bf.Rectangle(0.02, 0.02)
LINE = bf.Line((0.0, 0.0), (1.0, 0.0))
ELEMENTS = (
    bf.CRBF(1, integration="reduced"),
    bf.CRBF(2),
    bf.CRBF(4),
    bf.ANCF(),
    bf.ANCFCRBF(),
    bf.ANCFCRBF(bf.ElasticLine()),
)
NAMES = [element.name for element in ELEMENTS]
GRAVITY = bf.Gravity((0.0, -9.81))


def beam(element=ELEMENTS[0], elements=300, curve=LINE, section=SECTION, material=RUBBER):
    return bf.Beam(curve, elements, element, section, material)


def pendulum(element, **given):
    own = beam(element, **given)
    return bf.Model([own], [bf.Pin(own.start)], [GRAVITY])


def loaded(element, **given):
    """Loads vary in time, on points and along the beam; one point stands on springs, one is held."""
    own = beam(element, **given)
    loads = (
        bf.PointForce(own.end, (0.0, 1.0), amplitude=lambda t: np.sin(50.0 * t), follower=True),
        bf.PointForce(own.at(0.5), (0.0, -2.0)),
        bf.PointMoment(own.at(0.71), 0.02, amplitude=lambda t: t),
        bf.DistributedLoad(own, (0.0, -3.0), amplitude=lambda t: 1.0 - 10.0 * t),
    )
    held = bf.Clamp(own.start), bf.Roller(own.at(0.8)), bf.Spring(own.at(0.5), (40.0, 90.0), 0.2)
    return bf.Model([own], held, loads)


def shaken(element, **given):
    own = beam(element, **given)
    foot = bf.Prescribed(own.start, ux=0.0, uy=lambda t: 0.01 * (1.0 - np.cos(60.0 * t)), rotation=0.0)
    return bf.Model([own], [foot], [GRAVITY])


def actuated(element):
    own = beam(element)
    load = bf.Actuation(own, curvature=lambda s: 2.0 * np.cos(3.0 * s), amplitude=lambda t: np.sin(40.0 * t))
    return bf.Model([own], [bf.Clamp(own.start)], [load])


def thrown(element):
    """A free beam with a corner."""
    own = beam(element, curve=bf.Polyline([(0.0, 0.0), (0.5, 0.0), (0.5, 0.5)]))
    return bf.Model([own], [], [bf.PointForce(own.end, (2.0, 1.0)), GRAVITY])


def tapered(element):
    """On an arc, in three stretches of constant height, so that tiles have one class of elements, or two, or many."""
    heights = lambda s: bf.Rectangle(0.02, 0.02 - 0.004 * np.floor(3.0 * s))  # noqa: E731
    own = beam(element, curve=bf.Arc((0.0, 0.0), 2.0, 0.0, 0.5), section=heights)
    return bf.Model([own], [bf.Pin(own.start)], [GRAVITY, bf.PointForce(own.end, (3.0, 1.0))])


def law(element):
    own = beam(element, section=RambergOsgood(2e3, 700.0, 0.065, 0.4, 1e-5, knee=0.03))
    return bf.Model([own], [bf.Clamp(own.start)], [GRAVITY])


CASES = {
    "pendulum": pendulum,
    "damped": lambda element: pendulum(element, material=DAMPED),
    "loaded": loaded,
    "shaken": shaken,
    "actuated": actuated,
    "thrown": thrown,
    "tapered": tapered,
}


@pytest.fixture
def long(monkeypatch):
    """Chains of 200 elements are long, and their tiles have some 32 nodes."""
    monkeypatch.setattr(tiles, "LONG", 200)
    monkeypatch.setattr(tiles, "_NODES", 32)


def moved(model, cores, monkeypatch, steps=12, step=5e-4):
    """Return the motion with so many cores, or without tiles where there are none."""
    monkeypatch.setattr(cut_chain, "usable_cores", lambda: cores)
    monkeypatch.setattr(tiles, "LONG", 200 if cores else 10**9)
    system_of(model, static=False).spare_motions.clear()
    return bf.simulate(model, steps * step, step)


def assert_near(found, expected):
    """Assert that motions differ by round-off, which stiff short elements make more of in velocities.

    It may decide whether a correction at the limit is the last one.
    """
    assert abs(found.iterations - expected.iterations) <= 1
    assert found.statistics == replace(expected.statistics, iterations=found.iterations)
    for name, allowed in (("p", 1e-10), ("v", 1e-6)):
        one, other = getattr(found, name), getattr(expected, name)
        assert np.abs(one - other).max() < allowed * max(np.abs(other).max(), 1.0)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("element", ELEMENTS, ids=NAMES)
def test_tiles_and_threads_find_the_same_motion(case, element, long, monkeypatch):
    model = CASES[case](element)
    system = system_of(model, static=False)
    known = system.layouts[0].half_width in KNOWN  # corners of gradients widen the band
    assert (tiles.tiles_of(system) is not None) == known
    whole, one, two = (moved(model, cores, monkeypatch) for cores in (0, 1, 2))
    assert_near(one, whole)
    for name in ("p", "v", "a"):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))


def test_which_thread_works_on_a_half_does_not_show(long, monkeypatch):
    """A thread that comes late, or never, leaves its halves to the first one."""
    model, found = pendulum(ELEMENTS[1]), []
    served = second_thread.serve
    for delay in (None, 0.02, 10.0):
        late = threading.Event()

        def serve(job, late=late, delay=delay):
            if delay is not None:
                late.wait(delay)
            served(job)

        monkeypatch.setattr(second_thread, "serve", serve)
        if delay == 10.0:
            monkeypatch.setattr(second_thread, "serve", lambda job: None)
        found.append(moved(model, 2, monkeypatch))
    for other in found[1:]:
        np.testing.assert_array_equal(found[0].p, other.p)
        np.testing.assert_array_equal(found[0].v, other.v)


def helpers():
    return [thread for thread in threading.enumerate() if thread.name == "second half"]


def test_laws_of_sections_keep_to_one_thread(long, monkeypatch):
    model, started = law(bf.CRBF(2)), []
    monkeypatch.setattr(second_thread, "serve", started.append)
    assert_near(moved(model, 2, monkeypatch, steps=3), moved(model, 0, monkeypatch, steps=3))
    assert not started


def test_a_motion_that_fails_keeps_its_states_and_leaves_no_thread(long, monkeypatch):
    """A force of 1e9 N, from the fourth step on, is beyond what a step can follow."""
    own = beam()
    force = bf.PointForce(own.end, (-1e9, 1e9), amplitude=lambda t: float(t > 0.00175))
    model = bf.Model([own], [bf.Clamp(own.start)], [GRAVITY, force])
    with pytest.raises(bf.ConvergenceError, match="did not converge") as caught:
        moved(model, 2, monkeypatch)
    assert not helpers()
    found = caught.value.solution
    assert found.statistics.steps == 3
    before = bf.Model([own], [bf.Clamp(own.start)], [GRAVITY])
    np.testing.assert_array_equal(found.p, moved(before, 1, monkeypatch, steps=3).p)


def test_an_interrupted_motion_keeps_its_states_and_leaves_no_thread(long, monkeypatch):
    """Ctrl-C comes while compiled code is at work."""
    model, advance = pendulum(ELEMENTS[0]), CompiledSteps.advance
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)

    def interrupted(self, *arguments):
        timer = threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        try:
            return advance(self, *arguments)
        finally:
            timer.join()

    monkeypatch.setattr(CompiledSteps, "advance", interrupted)
    monkeypatch.setattr("beamfem.solve.motion.march._FIRST_CHUNK", 40 * model.size)
    try:
        with pytest.raises(KeyboardInterrupt) as caught:
            moved(model, 2, monkeypatch, steps=4000)
    finally:
        signal.signal(signal.SIGINT, handler)
        monkeypatch.setattr(CompiledSteps, "advance", advance)
    assert not helpers()
    found = caught.value.solution
    assert found.status.name == "STOPPED"
    again = moved(model, 1, monkeypatch, steps=max(found.statistics.steps, 1))
    np.testing.assert_array_equal(found.p, again.p[: len(found)])


def test_a_thread_that_cannot_be_started_is_done_without(long, monkeypatch):
    def refused(self):
        raise RuntimeError("can't start new thread")

    model = pendulum(ELEMENTS[0])
    expected = moved(model, 1, monkeypatch)
    monkeypatch.setattr(second_thread.Thread, "start", refused)
    np.testing.assert_array_equal(moved(model, 2, monkeypatch).p, expected.p)


def test_tiles_share_tables_and_have_only_their_own_classes(long):
    """Each had those of all elements once: the memory of a tapered chain grew with the square of its length."""
    straight = tiles.tiles_of(system_of(pendulum(ELEMENTS[1]), static=False)).assembler.works
    assert len({int(work.table[record.DOF]) for work in straight}) < 0.5 * len(straight)
    section = lambda s: bf.Rectangle(0.02, 0.02 - 0.01 * s)  # noqa: E731
    found = tiles.tiles_of(system_of(pendulum(ELEMENTS[1], section=section), static=False))
    rows = [int(work.table[record.TABLE_ROWS]) for work in found.assembler.works]
    sizes = [
        next(len(kept) for kept in work.group.kept if kept.ndim == 2 and kept.shape[1] == row)
        for work, row in zip(found.assembler.works, rows, strict=True)
    ]
    assert sum(sizes) == 300


def test_the_first_acceleration_of_a_long_chain_is_that_of_a_short_one(long, monkeypatch):
    """Of a chain that is held, shaken and thrown, in a state that is not at rest."""
    for made in (loaded, shaken, thrown):
        model = made(ELEMENTS[1])
        system = system_of(model, static=False)
        state = np.zeros((4, model.size))
        state[0] = moved(model, 1, monkeypatch, steps=3).p[-1]
        state[2, system.prescribed_dofs] = 1.5
        found = initial_acceleration(system, state, 0.002)
        monkeypatch.setattr(tiles, "LONG", 10**9)
        expected = initial_acceleration(system, state, 0.002)
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max())
        monkeypatch.setattr(tiles, "LONG", 200)


@pytest.mark.parametrize("held", [slice(0, 600), slice(301, None), slice(20, None), slice(2, None)])
def test_unknowns_are_divided_in_halves_wherever_they_are(held, long, monkeypatch):
    """Most nodes of a chain stand on prescribed coordinates; of those with few others it has no tiles."""
    own = beam(ELEMENTS[0])
    nodes = np.arange(301)[held] if held.stop is None else np.arange(1, 301)[: held.stop // 3]
    held_at = [bf.Prescribed(own.at(node / 300.0), ux=0.0, uy=0.0, rotation=0.0) for node in nodes]
    model = bf.Model([own], held_at, [GRAVITY])
    one, two = (moved(model, cores, monkeypatch, steps=4) for cores in (0, 2))
    assert_near(two, one)
    assert (tiles.tiles_of(system_of(model, static=False)) is None) == (len(nodes) > 290)


def test_a_closed_job_ends_at_once():
    job = np.zeros(16, dtype=np.int64)
    job[0] = two_threads.CLOSED
    two_threads.serve(job)


def test_short_chains_joined_beams_and_inclined_rollers_have_no_tiles(long):
    own, other = beam(), beam(curve=bf.Line((1.0, 0.0), (2.0, 0.0)))
    inclined = bf.Model([own], [bf.Pin(own.start), bf.Roller(own.end, (1.0, 1.0))])
    jointed = bf.Model([own, other], [bf.Clamp(own.start)], joints=[bf.Rigid(own.end, other.start)])
    for model in (inclined, jointed, pendulum(ELEMENTS[0], elements=199)):
        assert tiles.tiles_of(system_of(model, static=False)) is None
    found = tiles.tiles_of(system_of(pendulum(ELEMENTS[0]), static=False))
    nodes = [len(work.rows(0, 1)) for work in found.assembler.works]
    assert max(nodes) <= 33
    assert nodes[-1] == 2
