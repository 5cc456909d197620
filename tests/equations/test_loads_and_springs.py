"""Loads that follow or are spread, springs, foundations and prescribed motions against references without elements."""

import numpy as np
import pytest
from conftest import beam as small_beam
from shooting import Member, solved

import beamfem as bf
from beamfem.element.coordinates import Gradients
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import System


def cantilever(loads, supports=(), slenderness=5000, elements=12, order=4):
    """A cantilever of length 1 with EI = 1 along x; loads and supports: functions of the beam."""
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    beam = bf.Beam(
        bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order), section, bf.Material(1.0 / section.second_moment, 0.3, 1.0)
    )
    return beam, bf.Model([beam], [bf.Clamp(beam.start), *(s(beam) for s in supports)], [f(beam) for f in loads])


def test_a_follower_force_and_a_dead_spread_load_bend_the_elastica():
    """References, families 3 and 4; strains of the load are some 1e-7 at L / h = 5000."""
    beam, model = cantilever([lambda b: bf.PointForce(b.end, (0.0, 5.0), follower=True)])
    solution = bf.solve_static(model)
    assert solution.position(beam.end)[-1] == pytest.approx((0.1722778753991, 0.7806901427781), abs=1e-6)
    assert solution.rotation(beam.end)[-1] == pytest.approx(2.0981572399410, abs=1e-6)
    beam, model = cantilever([lambda b: bf.DistributedLoad(b, (0.0, 5.0))])
    solution = bf.solve_static(model)
    assert solution.displacement(beam.end)[-1] == pytest.approx((-0.1533428200457, 0.4959050446224), abs=1e-6)
    assert solution.rotation(beam.end)[-1] == pytest.approx(0.6970047775365, abs=1e-6)


FLEXIBLE = {"bending": 1.0, "axial": 1 / 1200, "shear": 2.6 * 6 / 5 / 1200}  # L / h = 10


@pytest.mark.parametrize("force", [(0.0, 3.0), (-1.0, 6.0), (2.0, -2.0)])
def test_a_follower_force_on_a_thick_beam(force):
    """By shooting from the tip, where the force is known in the frame of the section."""
    beam, model = cantilever([lambda b: bf.PointForce(b.end, force, follower=True)], slenderness=10)
    solution = bf.solve_static(model)
    back = Member(1.0, np.pi, **FLEXIBLE)  # from the tip to the clamp
    found = back.run((0.0, 0.0, 0.0, -force[0], -force[1], 0.0))
    turn = -found[2]
    c, s = np.cos(turn), np.sin(turn)
    tip = -np.array([[c, -s], [s, c]]) @ found[:2]
    assert solution.position(beam.end)[-1] == pytest.approx(tip, abs=2e-9)
    assert solution.rotation(beam.end)[-1] == pytest.approx(turn, abs=2e-8)


@pytest.mark.parametrize("pressure", [5.0, 20.0, -8.0])
@pytest.mark.parametrize("slenderness", [10, 5000])
def test_a_pressure_follows_the_sections(pressure, slenderness):
    flexible = FLEXIBLE if slenderness == 10 else {}
    member = Member(1.0, 0.0, **flexible)

    def tip(u):
        return member.run((0.0, 0.0, 0.0, *u), pressure=pressure)

    guess = np.zeros(3)
    for share in (0.25, 0.5, 0.75, 1.0):
        guess = solved(lambda u, p=share * pressure: member.run((0.0, 0.0, 0.0, *u), pressure=p)[3:], guess)
    beam, model = cantilever(
        [lambda b: bf.DistributedLoad(b, (0.0, pressure), follower=True)], slenderness=slenderness, elements=16
    )
    solution = bf.solve_static(model)
    assert solution.position(beam.end)[-1] == pytest.approx(tip(guess)[:2], abs=1e-6)
    assert solution.rotation(beam.end)[-1] == pytest.approx(tip(guess)[2], abs=1e-6)
    assert solution.reaction(beam.start)[-1] == pytest.approx(-guess, rel=1e-6, abs=1e-6)


def test_springs_at_the_tip_share_the_load():
    """Large deflection by shooting: the springs act as a force and a moment of the place they are taken to."""
    kx, ky, k, load = 0.7, 2.0, 0.5, np.array([0.4, 3.0])
    member = Member(1.0, 0.0, **FLEXIBLE)

    def left(u):
        end = member.run((0.0, 0.0, 0.0, *u))
        return np.array([end[3] - load[0] + kx * (end[0] - 1.0), end[4] - load[1] + ky * end[1], end[5] + k * end[2]])

    start = solved(left, [*load, 1.0])
    x, y, turn = member.run((0.0, 0.0, 0.0, *start))[:3]
    beam, model = cantilever(
        [lambda b: bf.PointForce(b.end, tuple(load))], [lambda b: bf.Spring(b.end, (kx, ky), k)], slenderness=10
    )
    solution = bf.solve_static(model)
    assert solution.position(beam.end)[-1] == pytest.approx((x, y), abs=1e-9)
    assert solution.reaction(beam.end)[-1] == pytest.approx((-kx * (x - 1.0), -ky * y, -k * turn), abs=1e-8)
    assert solution.reaction(beam.start)[-1] == pytest.approx(-start, abs=1e-8)


@pytest.mark.parametrize("element", [bf.CRBF(4), bf.ANCF(bf.Structural()), bf.ANCFCRBF(bf.ElasticLine())])
def test_a_beam_on_a_winkler_foundation(element):
    """Free ends, force P at the middle: w = P b (2 + cosh b L + cos b L) / (2 k (sinh b L + sin b L)); Hetenyi 1946."""
    b, force = 6.0, 1e-4
    foundation = 4 * b**4
    section = bf.Section.from_stiffness(1e6, 1e6, 1.0, 1.0, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 16, element, section)
    model = bf.Model(
        [beam],
        [bf.Foundation(beam, (0.0, foundation)), bf.Prescribed(beam.start, ux=0.0)],
        [bf.PointForce(beam.at(0.5), (0.0, -force))],
    )
    solution = bf.solve_static(model)
    below = np.sinh(b) + np.sin(b)
    exact = force * b / (2 * foundation) * (2 + np.cosh(b) + np.cos(b)) / below
    tolerance = 1e-4 if element == bf.CRBF(4) else 2e-2
    assert -solution.displacement(beam.at(0.5))[-1, 1] == pytest.approx(exact, rel=tolerance)
    at_end = force * b / (2 * foundation) * 4 * np.cosh(b / 2) * np.cos(b / 2) / below
    assert -solution.displacement(beam.end)[-1, 1] == pytest.approx(at_end, abs=tolerance * exact)


def model_with_everything(element):
    """Two members under an angle with everything that has a tangent of its own."""
    first, second = small_beam(element, 2), small_beam(element, 2, (1.0, 0.5), (1.2, 1.3))
    supports = [
        bf.Clamp(first.start),
        bf.Spring(first.at(0.5), (30.0, 20.0), 0.7),
        bf.Foundation(second, (5.0, 9.0)),
    ]
    loads = [
        bf.PointForce(first.at(0.3), (2.0, -3.0), follower=True),
        bf.PointForce(second.end, (1.0, 2.5), follower=True),
        bf.PointMoment(second.at(0.6), 0.4),
        bf.PointMoment(first.end, -0.3),
        bf.DistributedLoad(second, (0.5, 3.0), follower=True),
        bf.DistributedLoad(first, (0.5, -2.0)),
    ]
    return bf.Model([first, second], supports, loads, [bf.Rigid(first.end, second.start)])


def test_the_tangent_of_all_that_acts_is_the_derivative_of_the_residual(element, rng):
    """Central differences of whatever carries the nodes: gradients, angles, stretches, vectors turned at the joint."""
    model = model_with_everything(element)
    system = System(model, static=True)
    p = system.reference + 0.05 * rng.standard_normal(model.size)
    rest, free = np.zeros(model.size), system.free_dofs
    tangent = linearise(system, p, rest, rest, 1.0, STATICS)[1].sparse(system.rotated).toarray()
    change = rng.standard_normal(len(free))
    step = np.zeros(model.size)
    step[free] = change
    slope = []
    for h in (1e-4, 2e-4):
        ends = [residual(system, p + side * h * step, rest, rest, 1.0)[free] for side in (1, -1)]
        slope.append((ends[0] - ends[1]) / (2 * h))
    expected = (4 * slope[0] - slope[1]) / 3
    assert tangent @ change == pytest.approx(expected, rel=1e-6, abs=1e-7 * np.abs(expected).max())
    # loads alone, so that the stiffness of the beams hides nothing
    loads = linearise(system, p, rest, rest, 0.0, STATICS)[1].sparse(system.rotated).toarray()
    unloaded = [residual(system, p + side * 1e-4 * step, rest, rest, 0.0)[free] for side in (1, -1)]
    loaded = [residual(system, p + side * 1e-4 * step, rest, rest, 1.0)[free] for side in (1, -1)]
    acting = ((loaded[0] - unloaded[0]) - (loaded[1] - unloaded[1])) / 2e-4
    assert (tangent - loads) @ change == pytest.approx(acting, abs=1e-5 * np.abs(acting).max())
    assert np.abs(acting).max() > 0.1


def test_reactions_balance_everything_that_acts(element):
    """Forces of all kinds and the moment about the origin, in the deformed state."""
    model = model_with_everything(element)
    first = model.beams[0]
    loads = [_times(load, 0.05) for load in model.loads]
    solution = bf.solve_static(bf.Model(model.beams, model.supports[:2], loads, model.joints))
    total = np.zeros(3)
    for point in (first.start, first.at(0.5)):
        force = solution.reaction(point)[-1]
        total += (*force[:2], force[2] + _moment(solution.position(point)[-1], force[:2]))
    for load in solution.model.loads:
        total += _resultant(solution, load)
    assert total[:2] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert total[2] == pytest.approx(0.0, abs=1e-6)


def _times(load, factor):
    value = (
        {"moment": factor * load.moment}
        if isinstance(load, bf.PointMoment)
        else {"vector": tuple(factor * np.array(load.vector))}
    )
    return type(load)(**{**vars(load), **value})


def _moment(place, force):
    return place[0] * force[1] - place[1] * force[0]


def _resultant(solution, load):
    """Force and moment about the origin of a load in the last state, by Gauss quadrature along its beam."""
    if isinstance(load, bf.PointMoment):
        return np.array([0.0, 0.0, load.moment])
    if isinstance(load, bf.PointForce):
        points = [(load.point, 1.0)]
    else:
        xi, weight = np.polynomial.legendre.leggauss(12)
        halves = [(0.25 + 0.25 * x, 0.25 * w) for x, w in zip(xi, weight, strict=True)]
        points = [(load.beam.at(a + b), w * load.beam.curve.length) for a, w in halves for b in (0.0, 0.5)]
    result = np.zeros(3)
    for point, weight in points:
        turn = solution.rotation(point)[-1] if load.follower else 0.0
        c, s = np.cos(turn), np.sin(turn)
        force = weight * np.array([[c, -s], [s, c]]) @ load.vector
        result += (*force, _moment(solution.position(point)[-1], force))
    return result


@pytest.mark.parametrize("solve", [bf.solve_static, bf.trace_equilibrium], ids=["load steps", "path"])
def test_a_prescribed_displacement_needs_the_force_that_causes_it(solve):
    """Displacement control: the tip is taken to where P L^2 / EI = 5 takes it at L / h = 10 (references, family 1)."""
    beam, model = cantilever(
        [], [lambda b: bf.Prescribed(b.end, ux=-0.38922722797924, uy=0.72054526137677)], slenderness=10
    )
    solution = solve(model) if solve is bf.solve_static else solve(model, 1.0)
    assert solution.reaction(beam.end)[-1] == pytest.approx((0.0, 5.0, 0.0), abs=1e-6)
    assert solution.rotation(beam.end)[-1] == pytest.approx(1.21246073906392, abs=1e-8)


@pytest.mark.parametrize("solve", [bf.solve_static, bf.trace_equilibrium], ids=["load steps", "path"])
def test_displacement_control_goes_through_both_limit_points_of_a_truss(solve):
    """A bar of E A = 1 that stays straight: reaction E A (1 - l / l0) h / l at every height h."""
    section = bf.Section(area=1.0, second_moment=10.0)
    bar = bf.Beam(bf.Line((0, 0), (1, 0.4)), 1, bf.CRBF(1), section, bf.Material(1.0, 0.0, 1.0))
    model = bf.Model([bar], [bf.Pin(bar.start), bf.Prescribed(bar.end, ux=0.0, uy=-1.0)])
    solution = solve(model, steps=16) if solve is bf.solve_static else solve(model, 1.0)
    height = solution.position(bar.end)[:, 1]
    length = np.hypot(1.0, height)
    exact = (1.0 - length / np.hypot(1.0, 0.4)) * height / length
    assert -solution.reaction(bar.end)[:, 1] == pytest.approx(exact, abs=1e-9)
    assert height[-1] == pytest.approx(-0.6)
    assert solution.load_factor[-1] == 1.0


def test_supports_and_springs_at_one_point_answer_together():
    """A spring where a support holds does nothing; beside it, it does."""
    beam, model = cantilever(
        [lambda b: bf.PointForce(b.at(0.5), (0.0, 1e-3))],
        [lambda b: bf.Prescribed(b.end, uy=0.0), lambda b: bf.Spring(b.end, (0.0, 5.0), 3.0)],
    )
    solution = bf.solve_static(model)
    # propped cantilever with a rotational spring k at the prop: slope deflection, EI = L = 1
    turn = solution.rotation(beam.end)[-1]
    assert 4 * turn + 3 * turn == pytest.approx(-1e-3 / 8, rel=1e-6)
    assert solution.reaction(beam.end)[-1, 2] == pytest.approx(-3 * turn, rel=1e-9)
    assert solution.reaction(beam.start)[-1, 1] + solution.reaction(beam.end)[-1, 1] == pytest.approx(-1e-3, rel=1e-6)


def test_gradients_under_a_moment_or_spring_carry_an_angle_only_where_it_is_held():
    beam = small_beam(bf.ANCF(bf.Structural()))
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Spring(beam.end, rotational=1.0)])
    assert isinstance(beam.element.coordinates, Gradients)
    assert [model.meshes[0].labels(node)[-1] for node in range(4)] == ["theta", "r_y^y", "r_y^y", "theta"]


@pytest.mark.parametrize("support", ["spring", "foundation"])
def test_energy_of_springs_counts_in_the_total(support):
    """Free vibration on springs: what strain and motion lose the springs hold, to the error of the time steps."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.02), bf.Material(2e11, 0.3, 7800.0))
    resting = {
        "spring": [bf.Spring(beam.start, (1e4, 2e4), 50.0), bf.Spring(beam.end, (1e4, 1e4))],
        "foundation": [bf.Foundation(beam, (1e4, 2e4))],
    }
    model = bf.Model([beam], resting[support])
    motion = bf.simulate(model, 0.2, 2e-4, bf.GeneralizedAlpha(1.0), velocity=bf.RigidVelocity((0.1, 0.3), 0.5))
    energy = motion.energy()
    assert np.ptp(energy.potential) > 0.9 * energy.total[0]
    assert energy.total == pytest.approx(energy.total[0], rel=1e-4)


@pytest.mark.parametrize("angle", [0.0, 0.6])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e3])
@pytest.mark.parametrize("weight", [True, False])
def test_a_foundation_alone_bears_a_load_along_its_beam(angle, size, weight):
    """It sinks as it is, by load over stiffness: with no force at any point, all digits seemed to be lost."""
    steel = bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (np.cos(angle), np.sin(angle))), 4, bf.CRBF(3), bf.Rectangle(0.02, 0.02), steel)
    stiffness, mass = 1e5, 7800.0 * 4e-4
    load = bf.Gravity((0.0, -size / mass)) if weight else bf.DistributedLoad(beam, (0.0, -size))
    model = bf.Model([beam], [bf.Foundation(beam, (stiffness, stiffness))], [load])
    solution = bf.solve_static(model)
    assert solution.statistics.digits > 6.0
    sunk = pytest.approx([0.0, -size / stiffness], abs=1e-9 * size / stiffness + 1e-15)  # positions are rounded
    for point in (beam.start, beam.at(0.5), beam.end):
        assert solution.displacement(point)[-1] == sunk
    assert bf.trace_equilibrium(model, 1.0).displacement(beam.end)[-1] == sunk
