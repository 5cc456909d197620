"""Conditions that come and go: beams on rigid, frictionless floors, against closed forms."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
SECTION = bf.Rectangle(0.02, 0.01)
BENDING = 2.1e11 * 0.02 * 0.01**3 / 12


@dataclass(frozen=True)
class Floor:
    """A point stays above a level; its multiplier is the force of the floor [N]."""

    point: bf.Point
    level: float
    unknowns = 1
    conservative = True
    rotations = False
    one_sided = True

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        return np.array([0.0 * at.own[0], -at.own[0], 0.0 * at.own[0], self.level - at.q[0, 1]])

    def energy(self, at):
        return 0.0, 0.0


def laid(elements, height, load, clamped=True):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(2), SECTION, STEEL)
    floors = [Floor(beam.at(k / elements), -height) for k in range(1, elements + 1)]
    supports = [bf.Clamp(beam.start)]
    return bf.Model([beam], supports, [bf.DistributedLoad(beam, (0.0, -load))], connectors=floors), beam, floors


@pytest.mark.parametrize("elements", [10, 40])
def test_a_heavy_cantilever_is_laid_onto_a_floor(elements):
    """Free length a = (72 EI h / q)^(1/4), with force 2 q a / 3 and moment q a^2 / 6 at the clamp."""
    height, free = 1e-4, 0.6
    load = 72.0 * BENDING * height / free**4
    model, beam, floors = laid(elements, height, load)
    solution = bf.solve_static(model)
    forces = np.array([solution.multipliers(floor)[-1, 0] for floor in floors])
    heights = np.array([solution.position(floor.point)[-1, 1] for floor in floors])
    assert solution.statistics.iterations <= 8
    assert len(solution) == 2
    assert solution.stable[-1]
    assert (forces >= 0.0).all()
    assert heights.min() >= -height * (1.0 + 1e-9)
    assert np.all((forces == 0.0) | (np.abs(heights + height) < 1e-12))
    touching = np.flatnonzero(forces > 0.0)
    assert (touching[0] + 1) / elements == pytest.approx(free, abs=1.0 / elements)
    reaction = solution.reaction(beam.start)[-1]
    assert reaction[1] + forces.sum() == pytest.approx(load, rel=1e-9)
    assert reaction[1] == pytest.approx(2.0 * load * free / 3.0, rel=0.3 / elements)
    assert reaction[2] == pytest.approx(load * free**2 / 6.0, rel=1.0 / elements)


@pytest.mark.parametrize("elements", [10, 40])
def test_a_strip_is_lifted_from_a_floor_over_twice_the_force_by_its_weight(elements):
    """It lifts off over a = 2 F / q, and its end rises by q a^4 / (24 EI)."""
    load, free = 2.0, 0.5
    model, beam, floors = laid(elements, 0.0, load)
    lift = bf.PointForce(beam.end, (0.0, 0.5 * load * free))
    lifted = bf.solve_static(model.with_(loads=[*model.loads, lift]))
    forces = np.array([lifted.multipliers(floor)[-1, 0] for floor in floors])
    assert lifted.statistics.iterations <= 10
    assert np.flatnonzero(forces > 0.0)[-1] + 1 == pytest.approx((1.0 - free) * elements, abs=1.01)
    assert lifted.displacement(beam.end)[-1, 1] == pytest.approx(load * free**4 / (24.0 * BENDING), rel=1.5 / elements)


def test_open_conditions_are_no_conditions():
    """Modes, buckling loads and paths of a column beside a wall that it does not touch, and of one that it does."""
    found = []
    for wall in (False, True):
        column = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(2), SECTION, STEEL)
        walls = [Floor(column.at(0.5), -0.5), Floor(column.end, -0.5)] if wall else []
        push = [bf.PointForce(column.end, (-0.5 * BENDING, 1e-3 * BENDING))]
        model = bf.Model([column], [bf.Clamp(column.start)], push, connectors=walls)
        rest, path = bf.solve_static(model), bf.trace_equilibrium(model, until=1.0)
        modes = bf.solve_modes(model, 3, about=rest[-1]).frequencies
        straight = model.with_loads([bf.PointForce(column.end, (-BENDING, 0.0))])
        damped = bf.linearise(model, rest).modes(3).frequencies
        ends = [one.displacement(column.end)[-1] for one in (rest, path)]
        found.append([*ends, modes, damped, bf.solve_buckling(straight, 1).load_factors])
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(other, one, rtol=1e-8, atol=1e-12)


def test_a_path_goes_on_as_conditions_close():
    model, beam, _ = laid(8, 3e-3, 2000.0)
    path, static = bf.trace_equilibrium(model, until=1.0), bf.solve_static(model)
    np.testing.assert_allclose(path.position(beam.end)[-1], static.position(beam.end)[-1], rtol=0, atol=1e-10)


def test_a_beam_that_touches_a_floor_vibrates_and_is_stable_as_on_a_roller():
    height, load = 1e-3, 20.0 * BENDING * 1e-3
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(2), SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.DistributedLoad(beam, (0.0, -load))])
    held = model.with_(connectors=[Floor(beam.end, -height)])
    moved = bf.Prescribed(beam.end, uy=-height)
    propped = model.with_(supports=[bf.Clamp(beam.start), moved])
    states = [bf.solve_static(each) for each in (held, propped)]
    touching, supported = (one.displacement(beam.at(0.5))[-1] for one in states)
    np.testing.assert_allclose(touching, supported, rtol=1e-8, atol=1e-12)
    modes = [bf.solve_modes(one.model, 3, about=one[-1]).frequencies for one in states]
    np.testing.assert_allclose(*modes, rtol=1e-8)
    assert states[0].stable[-1]


def test_motions_refuse_conditions_that_come_and_go():
    model, _, _ = laid(4, 1e-3, 1.0)
    with pytest.raises(bf.InputError, match="Floor are one-sided"):
        bf.simulate(model, 0.01, 1e-3)


@pytest.mark.parametrize("level", [0.0, -1e-3])
@pytest.mark.parametrize("places", [2, 9])
def test_a_strip_is_held_by_floors_alone(places, level):
    """Floors at its ends and, with more of them, in between, touched at once or a little below."""
    strip = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(2), SECTION, STEEL)
    floors = [Floor(strip.at(x), level) for x in np.linspace(0.0, 1.0, places)]
    loads = [bf.DistributedLoad(strip, (0.0, -3.0))]
    solution = bf.solve_static(bf.Model([strip], [bf.Roller(strip.start, normal=(1, 0))], loads, connectors=floors))
    forces = [solution.multipliers(floor)[-1, 0] for floor in floors]
    assert sum(forces) == pytest.approx(3.0, rel=1e-9)
    assert min(forces) >= 0.0
    assert forces == pytest.approx(forces[::-1], rel=1e-6)
    sag = 5.0 * 3.0 / (384.0 * BENDING) if places == 2 else 0.0
    assert solution.displacement(strip.at(0.5))[-1, 1] == pytest.approx(level - sag, rel=1e-3, abs=1e-12)
    assert solution.stable[-1]


@pytest.mark.parametrize("load", [bf.DistributedLoad, bf.PointForce])
def test_a_strip_that_leaves_its_floors_is_told_to_be_held(load):
    """It lifts off, or tips over the edge of the last floor."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), SECTION, STEEL)
    acting = load(beam, (0.0, 5.0)) if load is bf.DistributedLoad else load(beam.end, (0.0, -5.0))
    floors = [Floor(beam.at(k / 8), 0.0) for k in range(4)]
    model = bf.Model([beam], [bf.Roller(beam.start, (1, 0))], [acting], connectors=floors)
    words = r"one way only are open \(Floor at .*\), beam 0 can move freely: it translates along y, .*: add a support"
    with pytest.raises(bf.ConvergenceError, match=words):
        bf.solve_static(model)


def unbalanced(solution, beam, ground, pretension, force):
    """Return the moment about the pin of a bar with a cable of 1e5 N/m at its end and a force downwards there."""
    end, start = solution.position(beam.end)[-1], np.array(beam.end.reference)
    way = np.array(ground) - end
    free = np.linalg.norm(np.array(ground) - start) - pretension / 1e5
    pull = 1e5 * (np.linalg.norm(way) - free) * way / np.linalg.norm(way)
    return end[0] * (pull[1] - force) - end[1] * pull[0]


@pytest.mark.filterwarnings("ignore:round-off leaves")  # what is left of the pretension in the cable
@pytest.mark.parametrize("pretension", [1e-3, 1.0, 100.0])
@pytest.mark.parametrize("ground", [(1.0, 1.0), (2.0, 1.0)])
def test_a_pretension_that_turns_a_bar_until_its_cable_is_slack_is_no_equilibrium(pretension, ground):
    """A pinned bar hangs on a cable that nothing holds taut, unless its load acts from the start."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, STEEL)
    cable = bf.Cable(beam.end, ground, 1e5, pretension)
    pinned = bf.Model([beam], [bf.Pin(beam.start)], [bf.PointForce(beam.end, (0.0, -500.0))], connectors=[cable])
    words = r"^no unique equilibrium at load factor 0; where .* open \(Cable at .*with scale=False"
    for solve in (bf.solve_static, lambda model: bf.trace_equilibrium(model, until=1.0)):
        with pytest.raises(bf.ConvergenceError, match=words):
            solve(pinned)
    hung = bf.solve_static(pinned.with_loads([bf.PointForce(beam.end, (0.0, -500.0), scale=False)]))
    assert unbalanced(hung, beam, ground, pretension, 500.0) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("pretension", [1.0, 100.0])
def test_a_pretension_along_a_bar_holds_it(pretension):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, STEEL)
    cable = bf.Cable(beam.end, (2.0, 0.0), 1e5, pretension)
    loads = [bf.PointForce(beam.end, (0.0, -10.0))]
    held = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start)], loads, connectors=[cable]))
    assert unbalanced(held, beam, (2.0, 0.0), pretension, 10.0) == pytest.approx(0.0, abs=1e-6)
    assert held.displacement(beam.end)[-1, 1] < -0.01
