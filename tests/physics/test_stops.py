"""Stops: walls that points hit, stick to and slip along, against closed forms and an independent integration."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beamfem as bf
from beamfem.testing import check_connector

STEEL, BLOCK = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.05, 0.05)
ELEMENTS = [bf.CRBF(2), bf.ANCF(), bf.ANCFCRBF(), bf.BilinearANCF(), bf.ShearRigid()]
UP = (0.0, 1.0)


def block(element=ELEMENTS[0], length=0.2, turned=0.0):
    """A short, stiff beam along a table that is turned by an angle [rad]."""
    return bf.Beam(bf.Line((0, 0), (length * np.cos(turned), length * np.sin(turned))), 1, element, BLOCK, STEEL)


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("damping", [0.0, 2.0])
@pytest.mark.parametrize("height", [-0.1, 0.001])
def test_consistent_in_contact_and_out_of_it(height, damping, friction):
    beam = block()
    check_connector(bf.Stop(beam.end, (0.1, height), (0.2, 1.0), 1e6, damping, friction))


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
@pytest.mark.parametrize("turned", [0.0, 0.7])
def test_a_block_that_is_pulled_forth_and_back_sticks_and_slips(element, turned):
    """With the pressure N the force is at most mu N, turns by 2 mu N, and its work is dissipated."""
    beam, (along, normal) = block(element, turned=turned), _axes(turned)
    stops = [bf.Stop(point, (0, 0), normal, 1e6, friction=0.3) for point in (beam.start, beam.end)]
    press = [bf.PointForce(beam.end, -50.0 * normal, scale=False)]
    path = lambda t: float(np.interp(t, [0.0, 0.2, 0.6, 1.0], [0.0, 2e-3, -2e-3, 2e-3]))  # noqa: E731
    place = lambda t: path(t) * along - 50.0 / 1e6 * normal  # noqa: E731
    pulled = bf.Prescribed(beam.start, ux=lambda t: place(t)[0], uy=lambda t: place(t)[1])
    at = np.linspace(0.0, 1.0, 51)
    solution = bf.solve_static(bf.Model([beam], [pulled], press, connectors=stops), at=at)
    force = -sum(solution.connector_force(stop)[:, 0, :2] @ along for stop in stops)
    np.testing.assert_allclose(force[[5, 10, 15, 29, 40, 50]], [30.0, 30.0, -30.0, -30.0, 30.0, 30.0], rtol=1e-5)
    assert np.all(np.abs(force) < 30.0 * (1 + 1e-5))
    slipped = 10e-3 - (1 + 2 + 2) * 15.0 / 1e6
    np.testing.assert_allclose(solution.energy().dissipated[-1], 30.0 * slipped, rtol=1e-5)


def _axes(turned):
    c, s = np.cos(turned), np.sin(turned)
    return np.array([c, s]), np.array([-s, c])


def test_a_sliding_block_stops_where_its_kinetic_energy_is_dissipated():
    """v^2 / (2 mu g) from the start; then it rests."""
    beam, gravity, speed, friction = block(), 9.81, 0.5, 0.25
    sunk = 7850.0 * 0.05**2 * 0.2 * gravity / 2 / 1e7
    stops = [bf.Stop(point, (0, sunk), UP, 1e7, damping=5.0, friction=friction) for point in (beam.start, beam.end)]
    model = bf.Model([beam], loads=[bf.Gravity((0, -gravity))], connectors=stops)
    motion = bf.simulate(model, duration=0.4, step=2e-4, velocity=bf.RigidVelocity((speed, 0.0)))
    x = motion.displacement(beam.start)[:, 0]
    np.testing.assert_allclose(x[-1], speed**2 / (2 * friction * gravity), rtol=2e-3)
    assert np.ptp(x[-500:]) < 1e-5


@pytest.mark.parametrize("damping", [0.0, 0.4])
def test_a_falling_mass_bounces_as_an_independent_integration_says(damping):
    mass, stiffness, gravity, height = 2.0, 1e5, 9.81, 0.05
    thread = bf.Beam(bf.Line((0, 0), (0.1, 0)), 1, ELEMENTS[0], bf.Section.from_stiffness(1e3, 1e3, 1e-2, 1e-9, 1e-12))
    stop = bf.Stop(thread.start, (0.0, -height), UP, stiffness, damping)
    ball = bf.PointMass(thread.start, mass)
    model = bf.Model([thread], loads=[bf.Gravity((0, -gravity))], connectors=[stop], masses=[ball])

    def rate(t, state):
        depth = max(-height - state[0], 0.0)
        return [state[1], -gravity + stiffness * depth * (1 - damping * state[1]) / mass]

    times = np.linspace(0.0, 0.3, 3001)
    expected = solve_ivp(rate, (0.0, 0.3), [0.0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12, max_step=1e-4).y[0]
    motion = bf.simulate(model, duration=0.3, step=1e-4, integrator=bf.GeneralizedAlpha(1.0))
    np.testing.assert_allclose(motion.displacement(thread.start)[:, 1], expected, atol=2e-4 * height)


def test_a_damped_stop_is_known_to_dissipate_before_it_is_hit():
    beam = block()
    model = bf.Model([beam], loads=[bf.Gravity((0, -9.81))], connectors=[bf.Stop(beam.end, (0, -0.1), UP, 1e6, 2.0)])
    motion = bf.simulate(model, duration=1e-3, step=1e-4)
    assert motion.energy_drift is None
    assert not motion.energy().dissipated.any()


def test_a_stop_without_friction_has_no_history_and_counts_in_paths_and_buckling():
    """A column whose middle lies against a wall: pushed onto it, it buckles at four times the load."""
    column = bf.Beam(bf.Line((0, 0), (0, 1)), 8, bf.CRBF(3), bf.Rectangle(0.01, 0.01), STEEL)
    wall = bf.Stop(column.at(0.5), (-1e-9, 0.0), (1.0, 0.0), 1e8)
    support = [bf.Pin(column.start), bf.Roller(column.end, (1, 0))]
    push = bf.PointForce(column.at(0.5), (-1.0, 0.0), scale=False)
    load = bf.PointForce(column.end, (0.0, -1.0))
    loads = [load, push]
    euler = np.pi**2 * 2.1e11 * 0.01**4 / 12
    found = bf.solve_buckling(bf.Model([column], support, loads, connectors=[wall]), 1).load_factors[0]
    np.testing.assert_allclose(found, 4 * euler, rtol=2e-2)
    path = bf.trace_equilibrium(bf.Model([column], support, loads, connectors=[wall]), until=euler / 2)
    np.testing.assert_allclose(path.load_factor[-1], euler / 2, rtol=1e-9)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (((0, 0), (0, 0), 1e6), "normal of a Stop must not be zero"),
        (((0, 0), UP, 0.0), "stiffness of Stop must be greater than zero"),
        (((0, 0), UP, 1e6, -1.0), "damping of Stop"),
        (((0, 0), UP, 1e6, 0.0, -0.1), "friction of Stop"),
        (((0, np.nan), UP, 1e6), "place of Stop"),
    ],
)
def test_refused_with_a_reason(values, message):
    with pytest.raises(bf.InputError, match=message):
        bf.Stop(block().end, *values)
