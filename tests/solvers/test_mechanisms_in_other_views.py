"""Random mechanisms with masses, springs, dampers and links: rotated, in other units, and in another order."""

from dataclasses import replace

import numpy as np
import pytest

import beamfem as bf

KINDS = [bf.CRBF(1), bf.CRBF(2), bf.CRBF(3), bf.ANCFCRBF(bf.Structural()), bf.ANCF(bf.Structural()), bf.ShearRigid()]
SEEDS = [
    *range(12),
    *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(12, 300)),
]


class Units:
    """Factors by which numbers in SI are multiplied."""

    def __init__(self, length=1.0, force=1.0):
        self.length, self.force = length, force

    def of(self, force=0, length=0):
        return self.force**force * self.length**length


SI = Units()


def mechanism(seed, angle=0.0, units=SI, backwards=False):
    """A random chain or group of two to four beams with up to six parts between them."""
    rng = np.random.default_rng(seed)
    c, s, unit = np.cos(angle), np.sin(angle), units.of
    m = unit(length=1)

    def place(point):
        x, y = point
        return (float(m * (c * x - s * y)), float(m * (s * x + c * y)))

    def turned(vector, factor):
        return tuple(float(factor * x) for x in (c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]))

    kind, count = KINDS[rng.integers(len(KINDS))], int(rng.integers(2, 5))
    width, height = rng.uniform(0.01, 0.03, 2)
    steel = bf.Material(2.1e11 * unit(1, -2), 0.3, 7850.0 * unit(1, -4))  # seconds stay seconds
    section = bf.Rectangle(width * m, height * m)
    feet = np.cumsum(rng.uniform(0.3, 0.8, count))
    lines = [((x, rng.uniform(-0.1, 0.1)), (x + rng.uniform(-0.4, 0.4), rng.uniform(0.6, 1.2))) for x in feet]
    beams = [bf.Beam(bf.Line(*map(place, line)), 3, kind, section, steel) for line in lines]
    supports = [bf.Clamp(beam.start) for beam in beams]
    bending = 2.1e11 * width * height**3 / 12
    parts, masses = [], []
    for _ in range(int(rng.integers(2, 7))):
        one, two = rng.choice(count, 2, replace=False)
        a, b = beams[one].end, beams[two].at(float(rng.choice([1 / 3, 1.0])))
        match int(rng.integers(6)):
            case 0:
                masses.append(
                    bf.PointMass(a, rng.uniform(0.1, 3.0) * unit(1, -1), rng.choice([0.0, 0.02]) * unit(1, 1))
                )
            case 1:
                offset = turned(rng.uniform(-0.1, 0.1, 2), m)
                masses.append(bf.RigidBody(a, rng.uniform(0.1, 3.0) * unit(1, -1), 0.01 * unit(1, 1), offset))
            case 2:
                stiffness, damping = bending * rng.uniform(0.1, 20.0), rng.choice([0.0, 5.0])
                parts.append(bf.SpringDamper(a, b, stiffness * unit(1, -1), damping * unit(1, -1)))
            case 3:
                ground = place((feet[one] + 0.5, 1.5))
                parts.append(bf.SpringDamper(a, ground, bending * unit(1, -1), 0.0, 0.9 * m))
            case 4:
                parts.append(bf.TorsionSpring(a, b, bending * rng.uniform(0.1, 1.0) * unit(1, 1)))
            case _:
                if not any(isinstance(part, bf.Link) for part in parts):
                    parts.append(bf.Link(a, b))
    loads = [bf.Gravity(turned((1.0, -9.81), m))]
    loads.append(bf.PointForce(beams[0].end, turned(0.3 * bending * rng.uniform(-1, 1, 2), unit(1))))
    listed = beams[::-1] if backwards else beams
    return bf.Model(listed, supports, loads, connectors=parts[:: -1 if backwards else 1], masses=masses), beams


def found(seed, angle=0.0, units=SI, backwards=False):
    """Displacements at rest and in motion in the frame of the mechanism [m], frequencies [Hz], and kinetic energy [J].

    Empty arrays where loads are beyond a limit point, or a preload is beyond a buckling load.
    """
    model, beams = mechanism(seed, angle, units, backwards)
    c, s = np.cos(angle), np.sin(angle)
    back = np.array([[c, s], [-s, c]]) / units.length
    try:
        rest = bf.solve_static(model)
    except bf.ConvergenceError:
        return (np.empty(0),) * 4
    motion = bf.simulate(model, 0.02, 1e-3)
    undamped = [replace(part, damping=0.0) if hasattr(part, "damping") else part for part in model.connectors]
    free = model.with_(connectors=undamped)
    moved = [[back @ solution.displacement(beam.end)[-1] for beam in beams] for solution in (rest, motion)]
    kinetic = motion.energy().kinetic[-1] / units.of(1, 1)
    return np.array(moved[0]), np.array(moved[1]), bf.solve_modes(free, 4, about=rest[-1]).frequencies, kinetic


@pytest.mark.parametrize("seed", SEEDS)
def test_mechanisms_are_the_same_rotated_in_other_units_and_in_another_order(seed):
    plain = found(seed)
    others = [
        found(seed, angle=0.7),
        found(seed, units=Units(1e3)),
        found(seed, units=Units(39.37, 0.2248)),
        found(seed, backwards=True),
    ]
    for other in others:
        for one, two, accuracy in zip(plain, other, (1e-7, 1e-5, 1e-6, 1e-4), strict=True):
            np.testing.assert_allclose(two, one, rtol=0.0, atol=accuracy * np.abs(one).max(initial=0.0))


def started(how, seed, angle=0.0, units=SI, backwards=False):
    """Displacements in a motion from a start [m], in the frame of the mechanism, and kinetic energies [J].

    Initial velocities that no link permits; or the first mode about the equilibrium, which bends links at second order.
    """
    model, beams = mechanism(seed, angle, units, backwards)
    c, s = np.cos(angle), np.sin(angle)
    there, back = np.array([[c, -s], [s, c]]) * units.length, np.array([[c, s], [-s, c]]) / units.length
    spread, mean = np.split(np.random.default_rng(seed).uniform(-1.0, 1.0, (3, 2)), [2])
    options = {}
    if how == "velocity":
        options["velocity"] = lambda place: tuple(there @ (spread @ (back @ place) + mean[0]))
    else:
        undamped = [replace(part, damping=0.0) if hasattr(part, "damping") else part for part in model.connectors]
        try:
            rest = bf.solve_static(model)
        except bf.ConvergenceError:
            return np.empty(0), np.empty(0)
        modes = bf.solve_modes(model.with_(connectors=undamped), 1, about=rest)
        options["start"] = modes.start(0, 0.05 * units.length)
    motion = bf.simulate(model, 0.02, 1e-3, **options)
    moved = [motion.displacement(beam.end) @ back.T for beam in beams]
    return np.array(moved), motion.energy().kinetic / units.of(1, 1)


@pytest.mark.filterwarnings("ignore:the initial velocity does not satisfy the conditions:beamfem.EnergyWarning")
@pytest.mark.filterwarnings("ignore:the energy:beamfem.EnergyWarning")  # steps do not resolve stiff modes
@pytest.mark.parametrize("how", ["velocity", "mode"])
@pytest.mark.parametrize("seed", SEEDS)
def test_motions_from_velocities_and_modes_are_the_same_in_every_view(seed, how):
    plain = started(how, seed)
    views = [{"units": Units(1e3)}, {"units": Units(39.37, 0.2248)}, {"backwards": True}]
    if how == "velocity":  # the sign of a mode is that of a coordinate, which may be one along an axis
        views.append({"angle": 0.7})
    for view in views:
        for one, two, accuracy in zip(plain, started(how, seed, **view), (1e-5, 1e-4), strict=True):
            np.testing.assert_allclose(two, one, rtol=0.0, atol=accuracy * np.abs(one).max(initial=0.0))


@pytest.mark.parametrize("seed", SEEDS)
def test_damped_modes_are_the_same_rotated_in_other_units_and_in_another_order(seed):
    rates = []
    for changed in ({}, {"angle": 0.7, "backwards": True}, {"units": Units(1e3)}):
        model, _ = mechanism(seed, **changed)
        try:
            rest = bf.solve_static(model)
        except bf.ConvergenceError:
            return
        modes = bf.linearise(model, rest).modes(4)
        rates.append(np.sort_complex(modes.growth + 2j * np.pi * modes.frequencies))
    for other in rates[1:]:
        assert np.abs(other - rates[0]).max() < 1e-8 * np.abs(rates[0]).max()


@pytest.mark.parametrize("seed", SEEDS)
def test_without_damping_linear_models_have_the_modes_of_solve_modes(seed):
    """With links as conditions on a null space, and with their multipliers as unknowns."""
    model, _ = mechanism(seed)
    try:
        rest = bf.solve_static(model)
    except bf.ConvergenceError:
        return
    undamped = [replace(part, damping=0.0) if hasattr(part, "damping") else part for part in model.connectors]
    model = model.with_(connectors=undamped)
    expected = bf.solve_modes(model, 4, about=rest[-1])
    found = bf.linearise(model, rest[-1]).modes(4)
    if np.all(expected.growth == 0.0):  # a diverging mode has a decaying one beside it
        assert found.frequencies == pytest.approx(expected.frequencies, rel=1e-8)
        assert np.all(found.growth == 0.0)


@pytest.mark.parametrize("length", [1e-6, 1e9])
@pytest.mark.parametrize("kind", ["slider", "gear", "torsion spring"])
def test_parts_on_rotations_hold_and_move_models_in_micrometres_of_metres_and_in_nanometres(kind, length):
    """Rotations have no unit of length: rows of them are small or large beside those of positions in such units."""

    def found(unit):
        steel, square = bf.Material(2.1e11, 0.3, 7850.0 / unit**2), bf.Rectangle(0.02 * unit, 0.02 * unit)
        ends = ((0.0, 0.0), (unit, 0.1 * unit)), ((0.0, unit), (1.1 * unit, unit))
        one, two = (bf.Beam(bf.Line(*each), 3, bf.CRBF(3), square, steel) for each in ends)
        part = {
            "slider": bf.Slider(one.end, two.end, (0.3, 1.0)),
            "gear": bf.Gear(one.end, two.end, -3.0),
            "torsion spring": bf.TorsionSpring(one.end, two.end, 1e4 * unit**3),
        }[kind]
        held = bf.Prescribed(two.end, ux=0.0) if kind == "slider" else bf.Pin(two.start)
        push = bf.PointForce(two.end, (0.0, -100.0 * unit**2))
        model = bf.Model([one, two], [bf.Clamp(one.start), held], [push], connectors=[part])
        motion = bf.simulate(model, 0.02, 1e-3).displacement(two.end)[-1] / unit
        return bf.solve_static(model).displacement(two.end)[-1] / unit, motion

    for own, other in zip(found(length), found(1.0), strict=True):
        assert own == pytest.approx(other, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("low", [None, -1e12])
def test_an_end_stop_without_a_lower_limit_is_none_in_nanometres_either(low):
    unit = 1e9
    steel, square = bf.Material(2.1e11 / unit, 0.3, 7850.0 / unit**3), bf.Rectangle(0.02 * unit, 0.02 * unit)
    one, two = (bf.Beam(bf.Line((x, 0.0), (x + unit, 0.0)), 2, bf.CRBF(2), square, steel) for x in (0.0, unit))
    slider = bf.Slider(one.end, two.start, (1.0, 0.0))
    stop = bf.SliderStop(one.end, two.start, (1.0, 0.0), low=low, high=unit, stiffness=1.0)
    back = bf.Prescribed(two.start, ux=lambda factor: -1.5 * unit * factor)
    found = bf.solve_static(bf.Model([one, two], [bf.Clamp(one.start), back], connectors=[slider, stop]))
    assert not found.connector_force(stop).any()
    assert found.displacement(two.end)[-1, 0] == pytest.approx(-1.5 * unit)
