"""Pressure normal to the deformed axis: equilibrium, closed forms, shooting, its tangent and its potential."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from conftest import beam as small_beam
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import System
from beamfem.forms import axis_basis, nodal_numbers, pressure_load
from beamfem.results.axis_points import nodal_vectors
from beamfem.solve.newton.newton import NewtonResult, solve_equilibrium
from beamfem.solve.statics.load_steps import skips_limit_points
from beamfem.solve.statics.static_record import StaticRecord

STIFF = bf.Section.from_stiffness(1e9, 1e9, 1e3, 1.0, 1.0)
FORMS = [
    bf.CRBF(1),
    bf.CRBF(4, bf.ContinuumMechanics()),
    bf.ANCF(),
    bf.ANCF(bf.Structural()),
    bf.ANCFCRBF(bf.ElasticLine()),
    bf.ShearRigid(),
    bf.ShearRigid(stretchable=False),
    bf.BilinearANCF(),
]


def half_ring(load, element=None, elements=12):
    ring = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, np.pi), elements, element or bf.CRBF(3), STIFF)
    return ring, bf.Model([ring], [bf.Pin(ring.start), bf.Roller(ring.end)], [load(ring)])


def test_a_half_ring_under_pressure_carries_the_hoop_force_and_no_moment():
    """N = -p R, M = 0; a vector that turns with the sections, (0, -50) at each of them, gives 78.5 N and 16.1 N m."""
    ring, model = half_ring(lambda b: bf.Pressure(b, 50.0))
    solution = bf.solve_static(model)
    forces = solution.section_forces(ring)
    assert forces.normal[-1] == pytest.approx(-50.0, rel=1e-5)
    assert np.abs(forces.moment[-1]).max() < 5e-4  # cubics leave the circle by some 1e-6 of its radius
    assert solution.reaction(ring.start)[-1] == pytest.approx((0.0, 50.0, 0.0), abs=1e-5)
    assert solution.reaction(ring.end)[-1] == pytest.approx((0.0, 50.0, 0.0), abs=1e-5)


def test_a_follower_on_a_curved_beam_keeps_its_angle_to_the_section_and_is_no_pressure():
    """Its resultant is q times the length, pi R q = 157.1 N, half of it at each end."""
    ring, model = half_ring(lambda b: bf.DistributedLoad(b, (0.0, -50.0), follower=True))
    solution = bf.solve_static(model)
    assert solution.reaction(ring.end)[-1, 1] == pytest.approx(25.0 * np.pi, rel=1e-3)
    normal = bf.DistributedLoad(ring, lambda s: (-50.0 * np.cos(s), -50.0 * np.sin(s)), follower=True)
    solution = bf.solve_static(bf.Model([ring], model.supports, [normal]))
    assert solution.reaction(ring.end)[-1, 1] == pytest.approx(50.0, rel=1e-5)
    assert np.abs(solution.section_forces(ring).moment[-1]).max() < 5e-4


@pytest.mark.parametrize("element", FORMS, ids=lambda e: f"{e.name}-{e.forces.name}")
def test_pressure_pushes_on_the_chord_whatever_the_shape(element):
    """The resultant of a pressure on a deformed axis is p times its chord, turned by a right angle."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0.3)), 4, element, bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Pressure(beam, 8.0)])
    solution = bf.solve_static(model)
    chord = solution.position(beam.end)[-1] - solution.position(beam.start)[-1]
    assert np.abs(solution.displacement(beam.end)[-1]).max() > 0.03
    assert solution.reaction(beam.start)[-1, :2] == pytest.approx((8.0 * chord[1], -8.0 * chord[0]), rel=1e-6)


def ring_of(halves, element, section, material=None):
    """A closed ring of radius 1 about the origin, free but for its rigid motions."""
    arcs = [
        bf.Beam(bf.Arc((0, 0), 1.0, begin, begin + np.pi), halves, element, section, material) for begin in (0.0, np.pi)
    ]
    joints = [bf.Rigid(arcs[0].end, arcs[1].start), bf.Rigid(arcs[1].end, arcs[0].start)]
    supports = [bf.Roller(arcs[0].start), bf.Roller(arcs[0].end), bf.Roller(arcs[0].at(0.5), (1.0, 0.0))]
    return arcs, supports, joints


def test_pressure_acts_per_deformed_length():
    """An inflated ring: N = p r = EA (r / R - 1), r = R / (1 - p R / EA); per reference length 1 + p R / EA."""
    arcs, supports, joints = ring_of(8, bf.CRBF(4), bf.Section.from_stiffness(100.0, 100.0, 1.0, 1.0, 1.0))
    model = bf.Model(arcs, supports, [bf.Pressure(arc, -20.0) for arc in arcs], joints)
    solution = bf.solve_static(model)
    assert np.linalg.norm(solution.position(arcs[0].at(0.25))[-1]) == pytest.approx(1.25, rel=1e-6)
    assert solution.section_forces(arcs[1]).normal[-1] == pytest.approx(25.0, rel=1e-5)


def test_a_ring_buckles_at_three_times_its_stiffness():
    """p = 3 EI / R^3 under pressure (Levy 1884); forces that keep their direction would give 4."""
    arcs, supports, joints = ring_of(8, bf.CRBF(4), bf.Section.from_stiffness(1e6, 1e6, 1.0, 1.0, 1.0))
    model = bf.Model(arcs, supports, [bf.Pressure(arc, 1.0) for arc in arcs], joints)
    found = bf.solve_buckling(model, count=1)
    assert found.load_factors[0] == pytest.approx(3.0, rel=1e-4)


@pytest.mark.parametrize(("angle", "expected"), [(np.pi / 2, 3.0), (np.pi / 3, 8.0)])
def test_a_pinned_arch_buckles_sideways_under_pressure(angle, expected):
    """p R^3 / EI = (pi / alpha)^2 - 1 of an arch of half angle alpha; Timoshenko and Gere 1961, 7.5."""
    arc = bf.Arc((0, 0), 1.0, np.pi / 2 - angle, np.pi / 2 + angle)
    arch = bf.Beam(arc, 12, bf.CRBF(4), bf.Section.from_stiffness(1e7, 1e7, 1.0, 1.0, 1.0))
    model = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [bf.Pressure(arch, 1.0)])
    assert bf.solve_buckling(model, count=1).load_factors[0] == pytest.approx(expected, rel=1e-4)


FLEXIBLE = {"axial": 1 / 400, "shear": 1 / 150}


def pressed_cantilever(pressure):
    """Tip x, y, theta and the forces at the clamp of a Reissner cantilever, EI = 1, under p(s) per deformed length."""

    def slope(s, y):
        c, d = np.cos(y[2]), np.sin(y[2])
        e = 1.0 + FLEXIBLE["axial"] * (y[3] * c + y[4] * d)
        g = FLEXIBLE["shear"] * (y[4] * c - y[3] * d)
        x_s, y_s = e * c - g * d, e * d + g * c
        return x_s, y_s, y[5], pressure(s) * y_s, -pressure(s) * x_s, y[3] * y_s - y[4] * x_s

    def run(u):
        return solve_ivp(slope, (0.0, 1.0), (0.0, 0.0, 0.0, *u), method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]

    guess = fsolve(lambda u: run(u)[3:], (0.0, 1.0, 1.0), xtol=1e-12)
    assert np.abs(run(guess)[3:]).max() < 1e-8
    return run(guess)[:3], guess


@pytest.mark.parametrize("pressure", [lambda s: 6.0, lambda s: 12.0 * s, lambda s: 6.0 + 6.0 * np.cos(5.0 * s)])
def test_a_thick_cantilever_under_a_pressure_that_varies(pressure):
    tip, clamp = pressed_cantilever(pressure)
    section = bf.Section.from_stiffness(400.0, 150.0, 1.0, 1.0, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), section)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.Pressure(beam, pressure)]))
    assert solution.position(beam.end)[-1] == pytest.approx(tip[:2], abs=1e-8)
    assert solution.rotation(beam.end)[-1] == pytest.approx(tip[2], abs=1e-8)
    assert solution.reaction(beam.start)[-1] == pytest.approx(-clamp, abs=1e-7)


def model_under_pressure(element):
    """Two members under an angle, held so that some pressures have a potential and some have not."""
    first, second = small_beam(element, 2), small_beam(element, 2, (1.0, 0.5), (1.2, 1.3))
    loads = [
        bf.Pressure(first, 3.0),
        bf.Pressure(first, lambda s: 2.0 - s),
        bf.Pressure(second, -2.5),
        bf.DistributedLoad(second, lambda s: (1.0 + s, -2.0 * s), follower=True),
        bf.DistributedLoad(first, lambda s: (s, 1.0 - s**2)),
    ]
    supports = [bf.Clamp(first.start), bf.Foundation(first, (5.0, 9.0))]
    return bf.Model([first, second], supports, loads, [bf.Rigid(first.end, second.start)])


def test_the_tangent_of_pressures_is_the_derivative_of_their_residual(element, rng):
    """Central differences of the loads alone, at twice the load factor less none, for whatever carries the nodes."""
    model = model_under_pressure(element)
    system = System(model, static=True)
    assert not system.symmetric
    p = system.reference + 0.05 * rng.standard_normal(model.size)
    rest, free = np.zeros(model.size), system.free_dofs
    change = rng.standard_normal(len(free))
    step = np.zeros(model.size)
    step[free] = change
    tangents = [linearise(system, p, rest, rest, at, STATICS)[1].sparse(system.rotated) for at in (2.0, 0.0)]
    slopes = []
    for at in (2.0, 0.0):
        ends = [residual(system, p + side * 1e-4 * step, rest, rest, at)[free] for side in (1, -1)]
        slopes.append((ends[0] - ends[1]) / 2e-4)
    acting = slopes[0] - slopes[1]
    assert np.abs(acting).max() > 0.1
    assert (tangents[0] - tangents[1]) @ change == pytest.approx(acting, abs=2e-6 * np.abs(acting).max())


@pytest.mark.parametrize("element", FORMS, ids=lambda e: f"{e.name}-{e.forces.name}")
def test_compiled_pressure_is_the_readable_form(element, rng):
    """The nodal forces are those of the integral of p (-y', x') . v over the length, in scikit-fem's assembly."""
    beam = bf.Beam(bf.Line((0, 0), (1.0, 0.0)), 3, element, bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1.0))
    model = bf.Model([beam], loads=[bf.Pressure(beam, 7.0)])
    system = System(model, static=True)
    mesh = model.meshes[0]
    p = system.reference + 0.1 * rng.standard_normal(model.size)
    rest = np.zeros(model.size)
    force = residual(system, p, rest, rest, 0.0) - residual(system, p, rest, rest, 1.0)
    e = nodal_vectors(mesh, p[None])[0].ravel()
    basis = axis_basis(mesh)
    numbers = nodal_numbers(basis)
    nodal = pressure_load.assemble(basis, u=basis.interpolate(e[numbers]), pressure=7.0)
    for _ in range(3):
        rate = rng.standard_normal(model.size)
        moving = nodal_vectors(mesh, p[None], v=rate[None])[0].ravel()
        assert force @ rate == pytest.approx(nodal @ moving[numbers], rel=1e-9)


PRESCRIBED = {
    "clamped and pinned": (lambda b: [bf.Clamp(b.start), bf.Pin(b.end)], True),
    "on rollers": (lambda b: [bf.Pin(b.start), bf.Roller(b.end)], True),
    "on an inclined roller": (lambda b: [bf.Pin(b.start), bf.Roller(b.end, (1.0, 2.0))], True),
    "free at one end": (lambda b: [bf.Clamp(b.start)], False),
    "on a spring": (lambda b: [bf.Clamp(b.start), bf.Spring(b.end, (5.0, 5.0))], False),
}


@pytest.mark.parametrize("name", PRESCRIBED)
def test_the_tangent_is_symmetric_where_pressure_has_a_potential(name, rng):
    supports, expected = PRESCRIBED[name]
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1.0))
    system = System(bf.Model([beam], supports(beam), [bf.Pressure(beam, 500.0)]), static=True)
    p = system.reference + 0.05 * rng.standard_normal(system.model.size)
    rest = np.zeros(len(p))
    matrix = linearise(system, p, rest, rest, 1.0, STATICS)[1].sparse(system.rotated).toarray()
    if name == "on an inclined roller":
        first, normal = system.inclined[0]
        place, along = system.unknowns.free[first], np.array([-normal[1], normal[0]])
        turn = np.eye(len(matrix))
        turn[place : place + 2, place] = along
        turn = np.delete(turn, place + 1, axis=1)
        matrix = turn.T @ matrix @ turn
    assert system.symmetric == expected
    assert (np.abs(matrix - matrix.T).max() < 1e-10 * np.abs(matrix).max()) == expected


@pytest.mark.parametrize("other", [500.0, 400.0])
def test_pressures_that_go_on_over_a_joint_have_a_potential(other):
    parts = [
        bf.Beam(bf.Line((x, 0), (x + 1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1.0))
        for x in (0, 1)
    ]
    loads = [bf.Pressure(parts[0], 500.0), bf.Pressure(parts[1], other)]
    supports = [bf.Pin(parts[0].start), bf.Pin(parts[1].end)]
    model = bf.Model(parts, supports, loads, [bf.Hinge(parts[0].end, parts[1].start)])
    assert System(model, static=True).symmetric == (other == 500.0)


def test_pressure_in_a_motion_does_the_work_of_the_area_it_sweeps():
    """A beam between pins under a constant pressure: kinetic and strain energy are p times the area under it."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.1, 0.02), bf.Material(1e7, 0.3, 1000.0))
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Pin(beam.end)], [bf.Pressure(beam, 20.0)])
    motion = bf.simulate(model, 0.5, 5e-4, bf.GeneralizedAlpha(rho_inf=1.0), save_every=100)
    energy = motion.energy()
    xi, weight = np.polynomial.legendre.leggauss(30)
    area = np.zeros(len(motion))
    for x, w in zip(xi, weight, strict=True):
        point = beam.at(0.5 + 0.5 * x)
        area += 0.5 * w * motion.position(point)[:, 1] * motion.fields(point).r_x[:, 0]
    assert area.max() > 0.01
    assert energy.kinetic + energy.strain == pytest.approx(20.0 * area, abs=2e-4 * 20.0 * area.max())
    assert motion.energy_drift is None


def test_vibration_about_a_pressure():
    """A closed ring under external pressure: its slowest mode is slower by what the pressure takes.

    Inextensible ring, mode n = 2: mu omega^2 (n^2 + 1) / n^2 = (n^2 - 1)^2 EI - (n^2 - 1) p; zero at p = 3.
    """
    section = bf.Section.from_stiffness(1e7, 1e7, 1.0, 1.0, 1e-9)
    arcs, supports, joints = ring_of(8, bf.CRBF(4), section)
    for pressure in (0.0, 1.5, -2.0):
        loads = [bf.Pressure(arc, pressure) for arc in arcs]
        held, free = bf.Model(arcs, supports, loads, joints), bf.Model(arcs, loads=loads, joints=joints)
        modes = bf.solve_modes(free, count=5, about=bf.solve_static(held))
        expected = np.sqrt((9.0 - 3.0 * pressure) / 1.25) / (2 * np.pi)
        assert len(modes.rigid) == 3
        assert modes.frequencies[3:] == pytest.approx(expected, rel=1e-4)


def test_a_path_under_pressure_goes_through_the_limit_point_of_a_shallow_arch():
    """Point by point, load steps of a prescribed displacement need the same pressure: the arch is in equilibrium."""
    arc = bf.Arc((0, -4.0), 4.0, np.pi / 2 - 0.3, np.pi / 2 + 0.3)
    arch = bf.Beam(arc, 8, bf.CRBF(3), bf.Section.from_stiffness(300.0, 1e3, 1.0, 1.0, 1.0))
    model = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [bf.Pressure(arch, 1.0)])
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(arch.at(0.5))[1] < -0.3)
    limit = path.limit_points[0].load_factor
    top = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [bf.Pressure(arch, 0.999 * limit)])
    assert bf.solve_static(top).stable[-1]
    beyond = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [bf.Pressure(arch, 1.001 * limit)])
    with pytest.raises(bf.LimitPointError) as caught:
        bf.solve_static(beyond)
    assert caught.value.load_factor * 1.001 * limit == pytest.approx(limit, rel=1e-6)


def test_arrows_of_a_pressure_stand_normal_to_the_deformed_axis():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Section.from_stiffness(1e6, 1e6, 1.0, 1.0, 1.0))
    loads = [bf.Pressure(beam, lambda s: 10.0 * s)]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    figure = solution.plot()
    arrows = next(item for item in figure.axes[0].collections if type(item).__name__ == "Quiver")
    vectors = np.stack([arrows.U, arrows.V], axis=1)
    for share, vector in zip(np.linspace(0.0, 1.0, len(vectors)), vectors, strict=True):
        r_x = solution.fields(beam.at(share)).r_x[-1]
        assert vector == pytest.approx(share * np.linalg.norm(vectors[-1]) * np.array([-r_x[1], r_x[0]]), rel=1e-3)


@pytest.mark.parametrize(("begin", "end", "gap"), [(2.0, 4.2, True), (1.0, 4.6, False)])
def test_a_slow_load_step_looks_half_way_under_the_pressure_there(begin, end, gap):
    """A ring under p R^3 / EI buckles at 3, later if pressure did not turn with it: 3.1 is beyond, 2.8 is not."""
    section = bf.Section.from_stiffness(1e7, 1e7, 1.0, 1.0, 1.0)
    arcs, supports, joints = ring_of(8, bf.CRBF(4), section)
    system = System(bf.Model(arcs, supports, [bf.Pressure(arc, end) for arc in arcs], joints), static=True)
    newton, share = bf.Newton(), begin / end
    ends = [solve_equilibrium(system, system.reference, factor, newton) for factor in (share, 1.0)]
    done = StaticRecord(system.model, system.symmetric)
    done.add(share, ends[0].state, 0, ends[0].ended)
    slow = NewtonResult(ends[1].state, 12, ends[1].ended, 0, first=0.0)
    assert skips_limit_points(system, done, 1.0, slow, newton) == gap


TANGENTIAL = {
    "varies": lambda b: bf.Pressure(b, lambda s: 500.0 * (1.0 + s)),
    "along and across": lambda b: AlongAndAcross(b),
    "along": lambda b: AlongAndAcross(b, normal=0.0),
}


@dataclass(frozen=True)
class AlongAndAcross(bf.LineLoad):
    """Forces along the deformed axis and normal to it, per deformed length."""

    beam: bf.Beam
    tangential: float = 300.0
    normal: float = 500.0
    axes: ClassVar[str] = "axis"

    def forces(self, arc_length):
        return np.tile([self.tangential, self.normal], (len(arc_length), 1))

    @property
    def uniform(self):
        return True


@pytest.mark.parametrize("load", TANGENTIAL.values(), ids=TANGENTIAL)
def test_forces_on_the_deformed_axis_that_are_no_uniform_pressure_have_no_potential(load, rng):
    """Between two clamps, where a uniform pressure has one."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1.0))
    system = System(bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end)], [load(beam)]), static=True)
    p = system.reference + 0.05 * rng.standard_normal(system.model.size)
    rest = np.zeros(len(p))
    matrix = linearise(system, p, rest, rest, 1.0, STATICS)[1].sparse(system.rotated).toarray()
    assert np.abs(matrix - matrix.T).max() > 1e-6 * np.abs(matrix).max()
    assert not system.symmetric
