"""Friction and end stops in hinges, against closed forms and an independent integration."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beamfem as bf
from beamfem.testing import check_connector

STEEL, SQUARE = bf.Material(2.1e13, 0.3, 7850.0), bf.Rectangle(0.02, 0.02)
LENGTH = 0.5
MASS = 7850.0 * 0.02**2 * LENGTH
INERTIA = MASS * (LENGTH**2 + 0.02**2 / 4) / 3


def hinged(make, gravity=0.0, *loads):
    """A stiff rod hinged to a stub that is clamped at both ends."""
    stub = bf.Beam(bf.Line((-0.1, 0), (0, 0)), 1, bf.CRBF(2), SQUARE, STEEL)
    rod = bf.Beam(bf.Line((0, 0), (LENGTH, 0)), 2, bf.CRBF(3), SQUARE, STEEL)
    ends, hinge = [bf.Clamp(stub.start), bf.Clamp(stub.end)], bf.Hinge(stub.end, rod.start)
    parts = [make(stub.end, rod.start)]
    loads = [bf.Gravity((0, -gravity)), *(load(rod) for load in loads)]
    return bf.Model([stub, rod], ends, loads, [hinge], connectors=parts), rod


def friction(a, b):
    return bf.HingeFriction(a, b, torque=0.5, stiffness=1e4)


@pytest.mark.parametrize(
    "make",
    [
        friction,
        lambda a, b: bf.HingeStop(a, b, low=-1e-4, high=1e-4, stiffness=1e3, damping=2.0),
        lambda a, b: bf.HingeStop(a, b, high=-1e-3, stiffness=1e3),
    ],
)
def test_consistent(make):
    check_connector(hinged(make)[0].connectors[0])


def test_a_turning_rod_stops_where_its_kinetic_energy_is_dissipated():
    """w^2 J / (2 T) from the start; then it rests."""
    model, rod = hinged(friction)
    speed = 5.0
    motion = bf.simulate(
        model, 1.5, 2e-4, velocity=lambda place: (0.0, speed * max(place[0], 0.0)), integrator=bf.GeneralizedAlpha(0.5)
    )
    turned, energy = motion.rotation(rod.end), motion.energy()
    started = 0.5 * INERTIA * speed**2
    assert turned[-1] == pytest.approx(started / 0.5, rel=2e-3)
    assert np.ptp(turned[-500:]) < 2.1 * 0.5 / 1e4  # the spring that sticks
    assert energy.dissipated[-1] == pytest.approx(energy.kinetic[0], rel=2e-3)
    assert np.all(np.diff(energy.dissipated) >= 0.0)
    assert np.abs(motion.connector_force(model.connectors[0])[:, 1, 2]).max() == pytest.approx(0.5, rel=1e-9)


def test_friction_holds_a_rod_and_dissipates_the_work_of_a_motor():
    """The torque of a motor that turns the rod forth and back in statics is the friction torque."""
    path = bf.Interpolated([(0.0, 0.0), (0.25, 0.3), (0.75, -0.3), (1.0, 0.3)])
    model, rod = hinged(friction)
    driven = model.with_loads([bf.Motor(model.joints[0], angle=path)])
    solution = bf.solve_static(driven, at=np.linspace(0, 1, 41))
    torque = solution.joint_force(driven.loads[0])[:, 2]
    assert torque[[5, 10, 15, 30, 35, 40]] == pytest.approx([0.5, 0.5, -0.5, -0.5, 0.5, 0.5], rel=1e-6)
    slipped = 0.3 + 0.6 + 0.6 - 5 * 0.5 / 1e4
    assert solution.energy().dissipated[-1] == pytest.approx(0.5 * slipped, rel=1e-6)
    recorded, part = solution.history(driven.connectors[0]), driven.connectors[0]
    assert recorded["dissipated"][-1] == pytest.approx(0.5 * slipped, rel=1e-6)
    turned = solution.rotation(rod.start) - solution.rotation(driven.beams[0].end)
    assert 1e4 * (turned - recorded["slip"]) == pytest.approx(-solution.joint_force(part)[:, 2], abs=1e-8)
    stopped, _ = hinged(lambda a, b: bf.HingeStop(a, b, 0.1, stiffness=1e3))
    moved = bf.simulate(stopped, 1e-3, 1e-3)
    with pytest.raises(bf.InputError, match="HingeStop has no history"):
        moved.history(stopped.connectors[0])
    held, rod = hinged(friction, 0.0, lambda rod: bf.PointForce(rod.end, (0.0, -0.9 * 0.5 / LENGTH)))
    assert bf.solve_static(held).rotation(rod.start)[-1] == pytest.approx(-0.9 * 0.5 / 1e4, rel=1e-6)


@pytest.mark.parametrize("damping", [0.0, 0.2])
def test_a_falling_rod_bounces_at_its_stop_as_an_independent_integration_says(damping):
    stiffness, low = 2e3, -0.4
    model, rod = hinged(lambda a, b: bf.HingeStop(a, b, low=low, high=2.0, stiffness=stiffness, damping=damping), 9.81)

    def rate(_, state):
        depth = max(low - state[0], 0.0)
        moment = stiffness * depth * (1.0 - damping * state[1])
        return [state[1], (moment - MASS * 9.81 * LENGTH / 2 * np.cos(state[0])) / INERTIA]

    motion = bf.simulate(model, 0.5, 2e-5, save_every=50, integrator=bf.GeneralizedAlpha(0.0))
    rods = solve_ivp(rate, (0.0, 0.5), [0.0, 0.0], "DOP853", motion.time, rtol=1e-10, atol=1e-12, max_step=1e-4)
    assert rods.y[0].min() < low
    assert motion.rotation(rod.end) == pytest.approx(rods.y[0], abs=3e-3)


def test_a_weight_leans_on_an_end_stop():
    """A weight that scaled would leave every angle beyond the stop in equilibrium at load factor 0."""
    model, rod = hinged(lambda a, b: bf.HingeStop(a, b, low=0.1, stiffness=1e3))
    rested = bf.solve_static(model.with_loads([bf.Gravity((0, -9.81), scale=False)]))
    turn, moment = rested.rotation(rod.start)[-1], rested.joint_force(model.connectors[0])[-1, 2]
    assert moment == pytest.approx(1e3 * (0.1 - turn), rel=1e-6)
    assert moment == pytest.approx(MASS * 9.81 * LENGTH / 2 * np.cos(turn), rel=1e-3)


STOPS = {
    "stop that is pressed": lambda a, b: bf.HingeStop(a, b, low=0.1, stiffness=1e3),
    "wall that is pressed": lambda a, b: bf.Stop(b.beam.end, (0.0, 1e-3), (0, 1), 1e5),
    "stop that touches": lambda a, b: bf.HingeStop(a, b, low=0.0, stiffness=1e3),
    "stop apart": lambda a, b: bf.HingeStop(a, b, -0.1, 0.1, stiffness=1e3),
    "slack stay": lambda a, b: bf.Cable(b.beam.end, (LENGTH, 1.0), 1e5),
    "law that only pulls": lambda a, b: bf.SpringDamper(b.beam.end, (LENGTH, 1.0), lambda e, f: 1e5 * f.positive(e)),
}


@pytest.mark.parametrize("name", STOPS)
def test_a_weight_that_scales_leaves_what_holds_one_way_open_at_load_factor_0(name):
    """Every angle beyond the stop is in equilibrium there."""
    model, _ = hinged(STOPS[name], 9.81)
    part = type(model.connectors[0]).__name__
    with pytest.raises((bf.ConvergenceError, bf.FreeMotionError), match=r"turns about \(0, 0\).*scale=False") as caught:
        bf.solve_static(model)
    assert f"{part} at " in str(caught.value)
    with pytest.raises(type(caught.value), match=r"turns about \(0, 0\).*scale=False"):
        bf.trace_equilibrium(model, until=1.0)


FALL = {"touching": 0.0, "a little apart": 1e-3, "far apart": 0.1}


@pytest.mark.parametrize("gap", FALL.values(), ids=FALL)
@pytest.mark.parametrize("kind", ["hinge stop", "wall", "law"])
def test_a_weight_that_acts_from_the_start_closes_what_holds_one_way(kind, gap):
    """The rod falls onto it; the moment of its weight balances its force."""
    made = {
        "hinge stop": lambda a, b: bf.HingeStop(a, b, low=-gap, stiffness=1e4),
        "wall": lambda a, b: bf.Stop(b.beam.end, (0.0, -gap), (0, 1), 1e5),
        "law": lambda a, b: bf.SpringDamper(b.beam.end, (LENGTH, 1e3), lambda e, f: 1e5 * f.positive(e - gap)),
    }
    model, rod = hinged(made[kind], 9.81)
    model = model.with_loads([bf.Gravity((0, -9.81), scale=False)])
    rested = bf.solve_static(model)
    turn, moment = rested.rotation(rod.start)[-1], MASS * 9.81 * LENGTH / 2 * np.cos(rested.rotation(rod.start)[-1])
    down = -rested.displacement(rod.end)[-1, 1]
    force = {"hinge stop": 1e4 * (-gap - turn), "wall": 1e5 * (down - gap), "law": 1e5 * (down - gap)}[kind]
    assert force * (1.0 if kind == "hinge stop" else LENGTH * np.cos(turn)) == pytest.approx(moment, rel=2e-3)


def test_a_bar_without_supports_is_laid_onto_two_rough_stops():
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.02, 0.02), bf.Material(2.1e11, 0.3, 7850.0))
    stops = [bf.Stop(p, (x, -x / 500), (0, 1), 1e6, friction=0.4) for x, p in ((0.0, bar.start), (1.0, bar.end))]
    loads = [bf.Gravity((0, -9.81), scale=False), bf.PointForce(bar.end, (5.0, 0))]
    laid = bf.solve_static(bf.Model([bar], loads=loads, connectors=stops))
    down = laid.model.mass * 9.81 / 2e6
    assert laid.displacement(bar.start)[-1, 1] == pytest.approx(-down, rel=1e-3)
    assert laid.displacement(bar.end)[-1, 1] == pytest.approx(-0.002 - down, rel=1e-3)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda a, b: bf.HingeFriction(a, b, 0.0, 1e4), "torque of HingeFriction"),
        (lambda a, b: bf.HingeFriction(a, b, 1.0, -1.0), "stiffness of HingeFriction"),
        (lambda a, b: bf.HingeStop(a, b, stiffness=1.0), "HingeStop needs one of its limits"),
        (lambda a, b: bf.HingeStop(a, b, 0.2, 0.1, stiffness=1.0), "low of HingeStop must not be above high"),
        (lambda a, b: bf.HingeStop(a, b, 0.2, stiffness=1.0, damping=-1.0), "damping of HingeStop"),
    ],
)
def test_refused_with_a_reason(make, message):
    with pytest.raises(bf.InputError, match=message):
        hinged(make)
