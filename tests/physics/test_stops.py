"""Stops: walls that points hit, stick to and slip along, against closed forms and an independent integration."""

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from slow_values import mostly_slow

import beamfem as bf
from beamfem.errors import EnergyWarning
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
    mass, stiffness, gravity, height, thread = 2.0, 1e5, 9.81, 0.05, light()
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


def light():
    """A short beam with next to no mass."""
    return bf.Beam(bf.Line((0, 0), (0.1, 0)), 1, ELEMENTS[0], bf.Section.from_stiffness(1e3, 1e3, 1e-2, 1e-9, 1e-12))


@pytest.mark.parametrize("restitution", [0.3, 0.8, 1.0])
@pytest.mark.parametrize(("mass", "speed"), [(2.0, 1.0), (0.5, 0.2)])
def test_a_mass_bounces_with_the_coefficient_of_restitution_at_any_mass_and_speed(restitution, mass, speed):
    thread = light()
    stop = bf.Stop(thread.start, (0.0, -1e-3 * speed), UP, 1e5, restitution=restitution)
    model = bf.Model([thread], connectors=[stop], masses=[bf.PointMass(thread.start, mass)])
    motion = bf.simulate(model, 0.02, 2e-5, velocity=bf.RigidVelocity((0.0, -speed)), integrator=bf.Trapezoidal())
    back = motion.velocity(thread.start)[-1, 1]
    np.testing.assert_allclose(back, restitution * speed, rtol=2e-3)
    energy = motion.energy()
    np.testing.assert_allclose(energy.dissipated[-1], mass / 2 * speed**2 * (1 - restitution**2), rtol=4e-3, atol=1e-9)
    assert np.abs(np.diff(energy.total + energy.dissipated)).max() < 4e-3 * energy.total[0]


@pytest.mark.parametrize("steps", [1, 2, 3, 8])
def test_a_contact_of_a_few_steps_gives_back_no_more_than_its_restitution(steps):
    """It began and ended within the steps that are judged together: 1.56 and 0.89 in place of 0.6."""
    thread = light()
    stop = bf.Stop(thread.start, (0.0, -1e-3), UP, 1e5, restitution=0.6)
    model = bf.Model([thread], connectors=[stop], masses=[bf.PointMass(thread.start, 1.0)])
    step = np.pi * np.sqrt(1.0 / 1e5) / steps
    options = {"duration": 8 * step, "step": step, "velocity": bf.RigidVelocity((0.0, -1.0))}
    motion = bf.simulate(model, **options, integrator=bf.Trapezoidal())
    assert motion.statistics.cuts > 0
    np.testing.assert_allclose(motion.velocity(thread.start)[-1, 1], 0.6, rtol=2e-2)
    damped = bf.simulate(model, **options)  # may lose more
    assert 0.54 < damped.velocity(thread.start)[-1, 1] < 0.69


@pytest.mark.slow
@mostly_slow("bounce", [{"restitution": 0.6}, {"damping": 0.0}])
@mostly_slow("axis", [(1.0, 0.0), (1.0, 0.3)], quick=(1,))
def test_a_slider_that_moves_bounces_off_its_end_stops(bounce, axis):
    """Two bodies on an axis that flies: momentum is kept, and relative speed falls by e each time."""
    angle = np.arctan2(axis[1], axis[0])
    along = np.array([np.cos(angle), np.sin(angle)])
    one, two = (
        bf.Beam(bf.Line(tuple(x * along), tuple((x + 0.1) * along)), 1, ELEMENTS[0], BLOCK, STEEL) for x in (0.0, 0.3)
    )
    joint = bf.Slider(one.end, two.start, axis)
    stop = bf.SliderStop(one.end, two.start, axis, low=-0.01, high=0.01, stiffness=1e6, **bounce)
    model = bf.Model([one, two], joints=[joint], connectors=[stop])
    flight = np.array([0.3, -0.2])

    def velocity(x):
        return flight + (x @ along > 0.2) * 1.0 * along

    motion = bf.simulate(model, 0.1, 2e-5, velocity=velocity, integrator=bf.Trapezoidal())
    relative = (motion.velocity(two.start) - motion.velocity(one.end)) @ along
    gap = (motion.position(two.start) - motion.position(one.end)) @ along - 0.2
    share, free = bounce.get("restitution", 1.0), np.abs(gap) < 0.0095
    rebounds = np.flatnonzero(np.diff(np.sign(relative[free])) != 0)
    speeds = np.abs(relative[free])[np.append(rebounds, free.sum() - 1)]
    assert len(speeds) > 2
    np.testing.assert_allclose(speeds, share ** np.arange(len(speeds)), rtol=2e-2)
    assert np.abs(gap).max() < 0.0125
    momentum = motion.linear_momentum()
    np.testing.assert_allclose(momentum, np.broadcast_to(momentum[0], momentum.shape), rtol=1e-9)


@pytest.mark.parametrize("low", [-0.2, 0.001])
@pytest.mark.parametrize("given", [{"damping": 2.0}, {"restitution": 0.5}])
@pytest.mark.parametrize("kind", ["hinge", "slider"])
def test_end_stops_are_consistent(kind, given, low):
    one, two = block(), block(length=0.3)
    if kind == "hinge":
        check_connector(bf.HingeStop(one.end, two.start, low, 0.3, stiffness=1e4, **given))
    else:
        check_connector(bf.SliderStop(one.end, two.end, (1.0, 0.3), low, 0.3, stiffness=1e4, **given))


def test_a_coefficient_of_restitution_excludes_damping_and_friction():
    one, two = block(), block(length=0.3)
    with pytest.raises(bf.InputError, match="takes a damping or a coefficient of restitution"):
        bf.Stop(one.end, (0, 0), UP, 1e6, damping=1.0, restitution=0.5)
    with pytest.raises(bf.InputError, match="coefficient of restitution or friction"):
        bf.Stop(one.end, (0, 0), UP, 1e6, friction=0.1, restitution=0.5)
    with pytest.raises(bf.InputError, match="restitution of SliderStop is at most 1"):
        bf.SliderStop(one.end, two.end, (1, 0), 0.0, stiffness=1e6, restitution=1.5)
    with pytest.raises(bf.InputError, match="axis of a SliderStop must not be zero"):
        bf.SliderStop(one.end, two.end, (0, 0), 0.0, stiffness=1e6)


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


@pytest.mark.parametrize("duration", [0.3, 0.35, 0.4, 0.45])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6])
@pytest.mark.parametrize("kind", ["slider", "hinge"])
def test_end_stops_give_back_their_share_of_the_speed_at_any_tolerance(kind, tolerance, duration):
    """A body left a stop of 0.5 at 0.53 to 0.99 of its speed, as steps went over the deepest state."""
    stiff = bf.Section.from_stiffness(axial=1e8, shear=1e8, bending=1e5, mass=1e-6, rotary_inertia=1e-9)
    place = ((0.3, 0.0), (0.35, 0.0)) if kind == "slider" else ((0.0, 0.0), (0.0, 0.1))
    base, moved = (bf.Beam(bf.Line(*ends), 1, bf.CRBF(1), stiff) for ends in (((0.0, 0.0), (-0.1, 0.0)), place))
    a, b = base.start, moved.start
    if kind == "slider":
        stop = bf.SliderStop(a, b, (1.0, 0.0), high=0.2, stiffness=1e5, restitution=0.5)
        guide, mass = bf.Prescribed(b, uy=0.0, rotation=0.0), bf.PointMass(b, 1.0, 1e-3)
        model = bf.Model([base, moved], [bf.Clamp(a), guide], connectors=[stop], masses=[mass])
        motion = bf.simulate(model, duration, tolerance=tolerance, velocity=lambda x: (float(x[0] > 0.2), 0.0))
        ratio = -motion.velocity(b)[-1, 0]
    else:
        stop = bf.HingeStop(a, b, high=0.4, stiffness=5e2, restitution=0.5)
        body = bf.RigidBody(b, 1.0, 5e-3)
        model = bf.Model([base, moved], [bf.Clamp(a)], joints=[bf.Hinge(a, b)], connectors=[stop], masses=[body])
        turning = bf.RigidVelocity(angular=2.0)
        motion = bf.simulate(model, duration, tolerance=tolerance, velocity=turning)
        ratio = -motion.angular_velocity(b)[-1] / motion.angular_velocity(b)[0]
    assert ratio == pytest.approx(0.5, abs=10.0 * max(tolerance, 1e-5))  # errors are held to 10 times the tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5])
def test_steps_do_not_crawl_up_to_where_a_soft_beam_turns_back_on_a_stop(tolerance):
    """Its end vibrates on the stop; steps once ended again and again where it was as deep as it had been."""
    rubber = bf.Material(1e8, 0.3, 1100.0)
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 12, bf.CRBF(2), bf.Rectangle(0.02, 0.02), rubber)
    stop = bf.Stop(beam.end, (0.0, -0.3), (0.0, 1.0), 1e4, restitution=0.6)
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))], connectors=[stop])
    statistics = bf.simulate(model, 0.5, tolerance=tolerance, integrator=bf.Radau(3)).statistics
    assert statistics.iterations < 17 * statistics.steps


INTEGRATORS = [bf.Bathe(), bf.Radau(2), bf.Radau(3), bf.Gauss(1), bf.Gauss(2), bf.Gauss(3)]


@pytest.mark.filterwarnings("ignore:accelerations in the rows:beamfem.TimeStepWarning")
@pytest.mark.parametrize("how", [{}, {"damping": 0.2}, {"restitution": 0.5}], ids=["elastic", "damped", "lossy"])
@pytest.mark.parametrize("step", [1e-3, 2e-4])
@pytest.mark.parametrize("integrator", INTEGRATORS, ids=repr)
def test_steps_longer_than_contacts_do_not_gain_energy(integrator, step, how):
    """With steps of stages it rose to the eightfold without a warning; contacts last for 70 us here."""
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.02, 0.02), bf.Material(7e10, 0.3, 2700.0))
    stops = [bf.Stop(point, (0.0, -0.05), UP, 1e9, **how) for point in (bar.start, bar.end)]
    model = bf.Model([bar], [], [bf.Gravity((0.0, -9.81))], connectors=stops)
    falling = bf.RigidVelocity((0.0, -1.0))
    with warnings.catch_warnings():  # that numerical damping removes much
        warnings.simplefilter("ignore", EnergyWarning)
        motion = bf.simulate(model, 0.08, step, integrator, velocity=falling)
    energy = motion.energy()
    assert energy.total.max() < energy.total[0] + 0.02 * energy.kinetic.max()


@pytest.mark.parametrize("integrator", [bf.GeneralizedAlpha(), bf.Trapezoidal(), bf.Radau(3)], ids=repr)
@pytest.mark.parametrize("step", [2e-3, 1e-3, 5e-4])
@pytest.mark.parametrize("restitution", [0.2, 0.5])
def test_steps_of_contacts_give_back_no_more_than_what_the_stop_does_not_record(restitution, step, integrator):
    """Up to 71 % of the kinetic energy was recorded as dissipated and still there; the contact lasts for 1.6 ms."""
    body = block(length=0.01)
    guided = bf.Prescribed(body.start, uy=0.0, rotation=0.0)
    wall = bf.Stop(body.start, (-0.01, 0.0), (1, 0), 1e6, restitution=restitution)
    model = bf.Model([body], [guided], connectors=[wall])
    with warnings.catch_warnings():  # that numerical damping removes much
        warnings.simplefilter("ignore", EnergyWarning)
        motion = bf.simulate(model, 0.015, step, integrator, velocity=bf.RigidVelocity((-2.0, 0.0)))
    energy = motion.energy()
    assert energy.error.min() > -0.03 * energy.kinetic[0]
    if not isinstance(integrator, bf.Radau):  # whose damping these steps do not resolve
        assert motion.velocity(body.end)[-1, 0] == pytest.approx(2.0 * restitution, rel=0.2)
