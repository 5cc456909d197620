"""Random frames with conditions: the same as with shared coordinates, with stiff springs, turned, in other units."""

from itertools import pairwise

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf
from tests.solvers.test_conditions import HingeOfConditions


def seeds(quick):
    """300 seeds, of which the first few are no long verification."""
    return [*range(quick), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(quick, 300))]


class View:
    """How a frame is described: turned by an angle, mirrored, in other units, its beams listed backwards."""

    def __init__(self, angle=0.0, mirrored=False, length=1.0, force=1.0, backwards=False):
        c, s, self.side = np.cos(angle), np.sin(angle), -1.0 if mirrored else 1.0
        self.turn = np.array([[c, -s], [s, c]]) @ np.diag([1.0, self.side])
        self.length, self.force, self.backwards = length, force, backwards

    def place(self, point):
        return tuple((self.length * self.turn @ point).tolist())

    def pull(self, force):
        return tuple((self.force * self.turn @ force).tolist())


PLAIN = View()


def frame(seed, view=PLAIN, conditions=True, stiff=0.0):
    """A chain of two or three beams with a hinge, held by posts on links, gears and sliders, and a motor in a hinge.

    conditions: whether the hinge is made of them; stiff: stiffness of a spring in place of the link, relative to the
    axial one of a post.
    """
    rng, unit = np.random.default_rng(seed), view.length
    count, order = int(rng.integers(2, 4)), int(rng.integers(1, 5))
    height = rng.uniform(0.01, 0.04)
    material = bf.Material(2.1e11 * view.force / unit**2, 0.3, 7850.0 * view.force / unit**4)
    section = bf.Rectangle(0.02 * unit, height * unit)
    bending = 2.1e11 * 0.02 * height**3 / 12

    def beam(*ends):
        return bf.Beam(bf.Line(*map(view.place, ends)), 4, bf.CRBF(order), section, material)

    corners = np.column_stack([np.arange(count + 1.0), rng.uniform(-0.5, 0.8, count + 1)])
    chain = [beam(*ends) for ends in pairwise(corners)]
    beams, joints, connectors, loads = [*chain], [], [], []
    supports = [bf.Clamp(chain[0].start), bf.Clamp(chain[-1].end)]
    hinged = int(rng.integers(count - 1))
    for number, (one, two) in enumerate(pairwise(chain)):
        if number != hinged:
            joints.append(bf.Rigid(one.end, two.start))
        elif conditions:
            connectors.append(HingeOfConditions(one.end, two.start))
        else:
            joints.append(bf.Hinge(one.end, two.start))
    point = chain[hinged].at(0.5)
    post = beam(corners[0] + (0.3, 1.0), corners[0] + (0.3 + rng.uniform(-0.2, 0.5), 2.0))
    beams.append(post)
    supports.append(bf.Clamp(post.end))
    if stiff:
        axial = 2.1e11 * 0.02 * height
        connectors.append(bf.SpringDamper(post.start, point, stiff * axial * view.force / unit))
    else:
        connectors.append(bf.Link(post.start, point))
    kind = int(rng.integers(4))
    if kind == 1:
        connectors.append(bf.Gear(post.start, chain[-1].at(0.5), float(rng.choice([-2.0, 0.7]))))
    elif kind == 2:
        rod = beam(corners[-1] + (0.0, 1.0), corners[-1] + (0.8, 1.0 + rng.uniform(-0.3, 0.3)))
        beams.append(rod)
        supports.append(bf.Pin(rod.end))
        axis = view.turn @ rng.standard_normal(2)
        connectors += [bf.Slider(chain[-1].at(0.5), rod.start, tuple(axis.tolist()))]
    elif kind == 3:
        arm = beam(corners[-1] + (0.2, 1.0), corners[-1] + (1.0, 1.3))
        crank = beam(corners[-1] + (0.2, 1.0), corners[-1] + (0.4, 1.9))
        hinge = bf.Hinge(arm.start, crank.start)
        beams += [arm, crank]
        joints.append(hinge)
        supports += [bf.Pin(arm.end), bf.Pin(crank.end), bf.Pin(crank.start)]
        turn = view.side * rng.uniform(-0.3, 0.3)
        loads.append(bf.Motor(hinge, angle=lambda t: turn * t**2))
    size = bending * rng.uniform(-1.0, 1.0, (2, 2)) - (0.0, 0.3 * bending)
    loads += [bf.PointForce(one, view.pull(own)) for one, own in zip((point, post.start), size, strict=True)]
    listed = beams[::-1] if view.backwards else beams
    return bf.Model(listed, supports, loads, joints, connectors), chain, post


def thrust(model):
    """The same frame under forces against those of `frame`, and its motor."""
    loads = [*(load for load in model.loads if isinstance(load, bf.Motor))]
    loads += [bf.PointForce(load.point, tuple(-30.0 * np.array(load.vector))) for load in model.loads[-2:]]
    return model.with_loads(loads)


def found(seed, view=PLAIN, **options):
    """Results by name, lengths [m], forces [N] and rates in the frame of the plain view."""
    model, chain, post = frame(seed, view, **options)
    back = view.turn.T / view.length

    def moved(solution):
        points = (*(beam.at(0.5) for beam in chain), post.start)
        return np.array([back @ solution.displacement(point)[-1] for point in points])

    try:
        rest = bf.solve_static(model)
    except bf.ConvergenceError as error:
        return {"ended": np.array([float(isinstance(error, bf.LimitPointError))])}
    result = {"rest": moved(rest), "stable": rest.stable[-1:].astype(float)}
    path = bf.trace_equilibrium(model, until=1.0)
    result |= {"path": moved(path), "path stable": path.stable[-1:].astype(float)}
    result["about the reference"] = bf.solve_modes(model, 4).frequencies
    if rest.stable[-1]:
        result["about rest"] = bf.solve_modes(model, 3, about=rest[-1]).frequencies
    result["motion"] = moved(bf.simulate(model, 0.01, 1e-3))
    try:
        buckled = bf.solve_buckling(thrust(model), 2)
    except (bf.InputError, bf.ConvergenceError):
        return result
    return result | {"buckling": buckled.load_factors, "linearised": buckled.linearised}


ACCURACY = {"path": 1e-6, "motion": 1e-5, "buckling": 1e-5, "linearised": 1e-5, "about rest": 1e-6}


def compare(one, other, factor=1.0):
    assert one.keys() == other.keys()
    for name, values in one.items():
        size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
        accuracy = factor * ACCURACY.get(name, 2e-7) * size
        np.testing.assert_allclose(other[name], values, rtol=0.0, atol=accuracy, err_msg=name)


@pytest.mark.parametrize("seed", seeds(3))
def test_frames_with_hinges_of_conditions_are_those_with_shared_coordinates(seed):
    compare(found(seed, conditions=False), found(seed))


VIEWS = View(0.7), View(mirrored=True), View(length=1e3), View(-2.0, True, 39.37, 0.2248, True)


@pytest.mark.parametrize("seed", seeds(3))
def test_frames_are_the_same_turned_mirrored_in_other_units_and_in_another_order(seed):
    compare(found(seed), found(seed, VIEWS[seed % len(VIEWS)]))


@pytest.mark.slow
@pytest.mark.parametrize("seed", seeds(2))
def test_links_are_the_limit_of_stiff_springs(seed):
    """The difference is proportional to the compliance of the spring: two springs are extrapolated to a rigid one.

    Sudden loads excite a spring, and its link at once, so motions are compared elsewhere with finer steps.
    """
    linked, soft, stiff = found(seed), found(seed, stiff=1e1), found(seed, stiff=1e2)
    for each in (linked, soft, stiff):
        each.pop("motion", None)
    limit = {name: stiff[name] + (stiff[name] - soft[name]) / 9.0 for name in linked}
    compare(linked, limit, factor=100.0)


@pytest.mark.slow
@mostly_slow("seed", [1, 3, 5])
@pytest.mark.parametrize("stiff", [1e4, 1e5])
def test_linearised_critical_loads_beside_a_very_stiff_spring_are_those_of_a_link(seed, stiff):
    """Its elongation is a billionth of the displacements, and its force is still that of the link."""
    linked, sprung = (bf.solve_buckling(thrust(frame(seed, **own)[0]), 2).linearised for own in ({}, {"stiff": stiff}))
    assert sprung == pytest.approx(linked, rel=1e-6)


@pytest.mark.parametrize("steps", [1, 2, 4, 8])
@pytest.mark.parametrize("load", [1500.0, 1700.0])
def test_a_leaning_column_is_solved_by_any_number_of_steps(load, steps):
    """Short steps by a nearly perfect bifurcation were once taken for the pace of all that follow."""
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    columns = [bf.Beam(bf.Line((x, 0.0), (x, 1.0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), steel) for x in (0.0, 0.5)]
    held, leaning = columns
    supports = [bf.Clamp(held.start), bf.Pin(leaning.start)]
    push, tie = bf.PointForce(leaning.end, (0.0, -load)), bf.Link(held.end, leaning.end)
    model = bf.Model(columns, supports, [push], connectors=[tie])
    traced = bf.trace_equilibrium(model, until=1.0)[-1].displacement(leaning.end)
    assert bf.solve_static(model, steps=steps).displacement(leaning.end)[-1] == pytest.approx(traced, rel=1e-6)
