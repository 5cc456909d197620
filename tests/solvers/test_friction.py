"""Connectors that remember: a rough floor, in statics and motions against the rules of dry friction by hand."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from tests.connectors import AREA, BENDING, Anchor, Rest, beam, cantilever

PUSH, ROUGH = 100.0, 0.3  # [N], and the coefficient of friction
AXIAL = 2e11 * AREA  # [N/m], 1 m long


def pulled(course):
    """A cantilever whose tip is pressed down on the floor, and pulled along it by course(load factor) [N]."""
    own = beam()
    loads = [
        bf.PointForce(own.end, (0.0, -PUSH), scale=False),
        bf.PointForce(own.end, (1.0, 0.0), amplitude=course, scale=False),
    ]
    return own, cantilever(own, loads, [Rest(own.end, 1e-9, 1e9, ROUGH)])


def there_and_back(load_factor):
    return 100.0 * (1.0 - abs(2.0 * load_factor - 1.0))


@pytest.mark.parametrize("steps", [2, 4, 40])
def test_a_tip_pulled_along_a_rough_floor_stays_behind(steps):
    """Pulled by 100 N and let go, friction holds a stretch of mu N / (E A / L); steps are those that are asked for."""
    own, model = pulled(there_and_back)
    found = bf.solve_static(model, steps=steps)
    tip = found.displacement(own.end)[:, 0]
    assert len(found) == steps + 1
    # the beam carries 5e-7 of the push where the floor gives
    assert tip[steps // 2] == pytest.approx((100.0 - ROUGH * PUSH) / AXIAL, rel=1e-5)
    assert tip[-1] == pytest.approx(ROUGH * PUSH / AXIAL, rel=1e-5)
    assert found.connector_force(model.connectors[0])[-1, 0] == pytest.approx([ROUGH * PUSH, PUSH, 0.0], rel=1e-5)


def test_below_the_friction_the_tip_sticks():
    own, model = pulled(lambda load_factor: 0.2 * there_and_back(load_factor))
    tip = bf.solve_static(model, steps=8).displacement(own.end)[:, 0]
    assert tip[4] == pytest.approx(20.0 / (AXIAL + 1e9), rel=1e-5)
    assert tip[-1] == pytest.approx(0.0, abs=1e-6 * tip[4])


def test_a_step_that_is_taken_back_leaves_nothing_behind():
    """A second beam that rolls up on few iterations makes steps fail in which the first one slides."""
    own, model = pulled(there_and_back)
    other = beam(start=(0.0, 1.0), end=(1.0, 1.0))
    supports, moment = [*model.supports, bf.Clamp(other.start)], bf.PointMoment(other.end, 6.0 * BENDING)
    both = bf.Model([own, other], supports, [*model.loads, moment], connectors=model.connectors)
    easy, hard = (bf.solve_static(both, steps=4, newton=bf.Newton(iterations=count)) for count in (30, 4))
    assert hard.statistics.cuts > easy.statistics.cuts == 0
    assert hard.displacement(own.end)[-1] == pytest.approx(easy.displacement(own.end)[-1], rel=1e-9)


def test_a_motion_starts_with_what_another_model_remembers():
    """Without the pull, the stretched tip would swing back by 1.5 um."""
    own, model = pulled(there_and_back)
    stretched = bf.solve_static(model, steps=4)[-1]
    still = bf.Model([own], model.supports, model.loads[:1], connectors=model.connectors)
    tip = bf.simulate(still, 2e-4, 1e-6, start=stretched).displacement(own.end)[:, 0]
    assert tip == pytest.approx(np.full(len(tip), ROUGH * PUSH / AXIAL), rel=1e-5)


def test_a_bar_that_slides_comes_to_rest():
    """With 0.1 m/s and friction 0.3 it goes v^2 / (2 mu g) and swings where it sticks, by mu m g / k at most."""
    bar, speed, stiffness = beam(bf.CRBF(2), elements=2), 0.1, 1e6
    floor = [Rest(point, 1e-7, stiffness, ROUGH) for point in (bar.start, bar.end)]
    model = bf.Model([bar], loads=[bf.Gravity((0.0, -9.81), scale=False)], connectors=floor)
    lying = bf.solve_static(model)[-1]
    motion = bf.simulate(model, 0.05, 1e-4, start=lying, velocity=bf.RigidVelocity((speed, 0.0)))
    gone = motion.position(bar.at(0.5))[:, 0] - 0.5
    give = ROUGH * 7800.0 * AREA * 9.81 / stiffness
    assert gone[-1] == pytest.approx(speed**2 / (2.0 * ROUGH * 9.81), abs=4.0 * give)
    assert motion.energy_drift is None


@dataclass(frozen=True)
class Forgetful(Anchor):
    memory = (1.0,)


@dataclass(frozen=True)
class Confused(Forgetful):
    def remember(self, at):
        return [1.0, 2.0]


@dataclass(frozen=True)
class Unsure(Confused):
    memory = (np.nan,)


def test_what_remembers_is_refused_where_it_cannot_be_taken():
    own, model = pulled(there_and_back)
    for solve in (bf.solve_buckling, bf.trace_equilibrium):
        with pytest.raises(bf.InputError, match="does not support connectors with history, such as Rest"):
            solve(model)
    stiffness = (1.0, 1.0, 1.0)
    for kind, words in (
        (Forgetful, "defines memory but no remember"),
        (Confused, "remember of Confused must return 1 finite numbers"),
        (Unsure, "memory of Unsure"),
    ):
        with pytest.raises(bf.InputError, match=words):
            bf.solve_static(cantilever(own, [], [kind(own.end, stiffness)]))


def test_steps_that_fail_are_named_where_the_past_counts():
    _, model = pulled(lambda load_factor: 1e9 if load_factor > 0.5 else 0.0)
    with pytest.raises(
        bf.ConvergenceError, match="models with connectors that have history are not followed"
    ) as caught:
        bf.solve_static(model, steps=4, newton=bf.Newton(iterations=3))
    assert caught.value.solution.at[-1] == pytest.approx(0.5)


@pytest.mark.parametrize("unit", [1.0, 1e3, 39.37])
@pytest.mark.parametrize("kind", ["hinge", "slider", "wall", "bouncing"])
def test_small_vibrations_about_a_state_that_has_just_slipped_stick(kind, unit):
    """So that modes do not depend on round-off: as with a spring of its stiffness, or that of the way back, in place.

    Loads are so small that the rest of the stiffness is that of the reference.
    """
    small = 1e-6
    square, steel = bf.Rectangle(0.1 * unit, 0.1 * unit), bf.Material(2e11 / unit**2, 0.3, 7800.0 / unit**4)
    own, other = (bf.Beam(bf.Line((0.0, y), (unit, y)), 4, bf.CRBF(3), square, steel) for y in (0.0, unit))
    a, b, axis, k = own.end, other.end, (0.0, 1.0), 1e6 / unit
    torsion, turning = bf.TorsionSpring(a, b, k * unit**2), bf.PointMoment(a, 1e4 * small * unit)
    across, aside = bf.PointForce(a, (0.0, -1e4 * small)), bf.PointForce(b, (1e4 * small, 0.0))
    upright, spring = bf.SpringDamper(a, (unit, -unit), k), bf.SpringDamper(a, (unit, -unit), 4.0 * k)
    rough, stuck, loads = {
        "hinge": (bf.HingeFriction(a, b, 10.0 * small * unit, k * unit**2), [torsion], [turning]),
        "slider": (
            bf.Slider(a, b, axis, friction=0.01, stiffness=k),
            [bf.Slider(a, b, axis), bf.SpringDamper(a, b, k)],
            [across, aside],
        ),
        "wall": (
            bf.Stop(a, (0.0, 0.0), (0.0, 1.0), k, friction=1e-4),
            [upright, bf.SpringDamper(a, (2.0 * unit, 0.0), k)],
            [across, bf.PointForce(a, (1e4 * small, 0.0))],
        ),
        "bouncing": (bf.Stop(a, (0.0, 0.0), (0.0, 1.0), k, restitution=0.5), [spring], [across]),
    }[kind]
    supports = [bf.Clamp(own.start), bf.Clamp(other.start)]
    model, expected = (bf.Model([own, other], supports, loads, connectors=parts) for parts in ([rough], stuck))
    rest = bf.solve_static(model)
    assert rest.energy().dissipated[-1] > 0.0
    expected = bf.solve_modes(expected, 4).frequencies
    assert bf.solve_modes(model, 4, about=rest).frequencies == pytest.approx(expected, rel=1e-6)
    assert bf.linearise(model, about=rest).modes(4).frequencies == pytest.approx(expected, rel=1e-6)
