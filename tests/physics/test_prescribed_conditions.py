"""Conditions whose value is prescribed, such as those of drives and cylinders: against supports that move."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from integrators import Radau
from slow_values import mostly_slow

import beamfem as bf

STEEL, SQUARE = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.02, 0.02)


def _turned(q, data, f):
    return (q[1][2] - q[0][2],)


TURNED = bf.Connection("turned", 2, 3, (), conditions=_turned, multipliers=1, prescribed=1)


@dataclass(frozen=True)
class Driven(bf.PartAtPoints):
    a: bf.Point
    b: bf.Point
    value: Any
    connection: bf.Connection = TURNED
    numbers: tuple[float, ...] = ()

    @property
    def points(self):
        return self.a, self.b

    @property
    def prescribed(self):
        return (self.value,)

    def data(self, reference):
        return self.numbers


def _length(q, data, f):
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return (f.sqrt(x * x + y * y) - data[0],)


CYLINDER = bf.Connection("cylinder", 2, 2, ("length",), conditions=_length, multipliers=1, prescribed=1)


def swing(time):
    return 0.3 * time**2 * np.sin(3.0 * time)


def line(start, end):
    return bf.Beam(bf.Line(start, end), 2, bf.CRBF(3), SQUARE, STEEL)


def driven(value, **other):
    """A link that is driven in the hinge at a beam whose end does not move, and the same link driven by a support."""
    arm, link = line((0, 0), (1, 0)), line((1, 0), (1.8, 0.2))
    hinge, ends = bf.Hinge(arm.end, link.start), [bf.Clamp(arm.start), bf.Clamp(arm.end)]
    gravity = [bf.Gravity((0, -9.81))]
    joined = bf.Model([arm, link], ends, gravity, [hinge], [Driven(arm.end, link.start, value)])
    held = bf.Model([link], [bf.Prescribed(link.start, ux=0.0, uy=0.0, rotation=value)], gravity)
    return joined, held, link


@mostly_slow("integrator", [None, bf.GeneralizedAlpha(0.0), Radau()], quick=(0, 1))
@pytest.mark.parametrize("value", [swing, lambda time: 2.0 * time], ids=["smooth", "with an impact"])
def test_driven_hinge_moves_as_a_support_does(value, integrator):
    joined, held, link = driven(value)
    duration = 0.5 if integrator is None else 0.1
    one, other = (bf.simulate(model, duration, 1e-3, integrator=integrator) for model in (joined, held))
    assert one.position(link.end) == pytest.approx(other.position(link.end), abs=1e-8)
    assert one.velocity(link.end) == pytest.approx(other.velocity(link.end), abs=1e-5)
    torque, needed = one.joint_force(joined.connectors[0])[:, 2], other.reaction(link.start)[:, 2]
    assert torque == pytest.approx(needed, abs=1e-4 * np.abs(needed).max())
    assert one.multipliers(joined.connectors[0])[:, 0] == pytest.approx(-torque)
    assert not one.warnings


@pytest.mark.parametrize("value", [0.7, lambda load: 0.7 * load**2], ids=["number", "function"])
def test_driven_hinge_in_statics_paths_and_modes(value):
    joined, held, link = driven(value)
    one, other = (bf.solve_static(model, steps=2) for model in (joined, held))
    assert one.position(link.end) == pytest.approx(other.position(link.end), abs=1e-9)
    assert one.joint_force(joined.connectors[0])[:, 2] == pytest.approx(other.reaction(link.start)[:, 2], rel=1e-6)
    tips = [bf.trace_equilibrium(model, until=1.0).position(link.end)[-1] for model in (joined, held)]
    assert tips[0] == pytest.approx(tips[1], abs=1e-7)
    assert tips[0] == pytest.approx(one.position(link.end)[-1], abs=1e-7)
    own, frequencies = (
        bf.solve_modes(model, 6, about=about[-1]).frequencies for model, about in ((joined, one), (held, other))
    )
    assert np.abs(own[:, None] / frequencies[:2] - 1.0).min(axis=0) == pytest.approx(0.0, abs=1e-7)


@dataclass(frozen=True)
class OwnCondition:
    """A drive in a hinge, t_b - t_a = u(time), by a condition that depends on time itself."""

    a: bf.Point
    b: bf.Point
    value: Any
    unknowns = 1
    conservative = True

    @property
    def points(self):
        return self.a, self.b

    def force(self, at):
        turn = at.q[1, 2] - at.q[0, 2] - self.value(at.time)
        return np.array([0.0, 0.0, -at.own[0], 0.0, 0.0, at.own[0], turn])

    def energy(self, at):
        return 0.0, 0.0


@pytest.mark.parametrize("value", [swing, lambda time: 2.0 * time], ids=["smooth", "with an impact"])
def test_conditions_that_depend_on_time_drive_a_motion_as_prescribed_values_do(value):
    """With g_t in the first velocity, and g_tt in the first acceleration and multiplier."""
    joined, _, link = driven(value)
    drive = joined.connectors[0]
    own = joined.with_(connectors=[OwnCondition(drive.a, drive.b, value)])
    one, other = (bf.simulate(model, 0.2, 1e-3) for model in (joined, own))
    assert other.velocity(link.end)[0] == pytest.approx(one.velocity(link.end)[0], abs=1e-8)
    first = [solution.a[0, : joined.coordinates] for solution in (one, other)]
    assert first[1] == pytest.approx(first[0], abs=1e-3 * np.abs(first[0]).max())
    assert other.position(link.end) == pytest.approx(one.position(link.end), abs=1e-10)
    torques = [solution.multipliers(solution.model.connectors[0])[:, 0] for solution in (one, other)]
    assert torques[1] == pytest.approx(torques[0], abs=1e-6 * np.abs(torques[0]).max())


def test_jumping_drive_is_refused_and_a_state_is_continued():
    joined, _, link = driven(lambda time: 0.4 + time)
    with pytest.raises(bf.InputError, match=r"Driven at .* prescribes 0\.4 when .* reference has 0, .* jump by 0\.4"):
        bf.simulate(joined, 0.01, 1e-3)
    bent = bf.solve_static(driven_again(joined, lambda load: 0.4 * load))
    on = bf.simulate(joined, 0.01, 1e-3, start=bent)
    assert on.rotation(link.start)[[0, -1]] == pytest.approx([0.4, 0.41], abs=1e-9)


def driven_again(model, value):
    """The same model with another drive."""
    drive = model.connectors[0]
    return model.with_(connectors=[Driven(drive.a, drive.b, value)])


def test_cylinder_of_a_prescribed_length_lifts_a_boom():
    boom = line((0, 0), (2, 0))
    ram = line((0.5, -0.8), (0.5, -0.81))
    cylinder = Driven(ram.start, boom.at(0.5), lambda time: 0.2 * time, CYLINDER, (np.hypot(0.5, 0.8),))
    model = bf.Model([boom, ram], [bf.Pin(boom.start), bf.Clamp(ram.start)], [bf.Gravity((0, -9.81))], (), [cylinder])
    static, motion = bf.solve_static(model), bf.simulate(model, 1.0, 1e-3)
    for solution in (static, motion):
        apart = solution.position(boom.at(0.5)) - solution.position(ram.start)
        assert np.hypot(*apart.T) == pytest.approx(np.hypot(0.5, 0.8) + 0.2 * solution.at, abs=1e-9)
    push, arm = static.joint_force(cylinder)[-1, :2], static.position(boom.at(0.5))[-1]
    weight, centre = 2.0 * 7850 * 0.0004 * 9.81, static.position(boom.at(0.5))[-1, 0]
    assert arm[0] * push[1] - arm[1] * push[0] == pytest.approx(weight * centre, rel=1e-3)
