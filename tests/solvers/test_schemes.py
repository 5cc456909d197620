"""User-defined methods of the generalized-alpha family, whose steps are compiled."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import beamfem as bf

SECTION, RUBBER = bf.Rectangle(0.02, 0.02), bf.Material(5e6, 0.3, 1000.0)


@dataclass(frozen=True)
class Newmark:
    gamma: float = 0.5
    beta: float = 0.25

    def rule(self, step):
        return np.array([step, 0.0, 0.0, self.gamma, self.beta])


@dataclass(frozen=True)
class HHT:
    """Hilber, Hughes and Taylor 1977, in the form of Arnold and Bruels; alpha from 0 to 1/3."""

    alpha: float

    def rule(self, step):
        return np.array([step, 0.0, self.alpha, 0.5 + self.alpha, 0.25 * (1.0 + self.alpha) ** 2])


@dataclass(frozen=True)
class Given:
    values: object

    def rule(self, step):
        return self.values


def pendulum():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(2), SECTION, RUBBER)
    return bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])


def test_newmark_with_the_mean_acceleration_is_the_trapezoidal_rule():
    model = pendulum()
    one, other = (bf.simulate(model, 0.2, 1e-3, scheme) for scheme in (Newmark(), bf.GeneralizedAlpha(1.0)))
    np.testing.assert_allclose(one.p, other.p, rtol=0.0, atol=1e-9)


def test_the_rule_of_generalized_alpha_gives_the_same_motion_to_the_last_digit():
    model, rule = pendulum(), bf.GeneralizedAlpha(0.7)
    one, other = (bf.simulate(model, 0.1, 1e-3, scheme) for scheme in (Given(rule.rule(1e-3)), rule))
    np.testing.assert_array_equal(one.p, other.p)


@pytest.mark.parametrize("retardation_time", [0.0, 1e-3])
@pytest.mark.parametrize("scheme", [HHT(0.1), HHT(0.3), Newmark(), Newmark(0.5, 0.3)], ids=repr)
def test_methods_of_second_order_have_it(scheme, retardation_time):
    """A beam spins and is stretched by it; steps resolve all modes of so few elements."""
    soft = bf.Material(1e5, 0.3, 1000.0, retardation_time=retardation_time)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(1), bf.Rectangle(0.1, 0.1), soft)
    model, spin = bf.Model([beam], [bf.Pin(beam.start)]), bf.RigidVelocity((0.0, 0.0), angular=3.0)

    def end(rule, step):
        return bf.simulate(model, 0.1, step, rule, velocity=spin, save_every=round(0.1 / step))[-1].p

    exact = end(bf.GeneralizedAlpha(1.0), 2e-5)
    errors = [np.abs(end(scheme, step) - exact).max() for step in (1e-3, 5e-4)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)


def test_moving_supports_and_frames_are_taken():
    beams = [bf.Beam(bf.Line((x, 0), (x, 1)), 2, bf.CRBF(2), SECTION, RUBBER) for x in (0.0, 1.0)]
    tie = bf.Beam(bf.Line((0, 1), (1, 1)), 2, bf.CRBF(2), SECTION, RUBBER)
    shaken = [bf.Prescribed(one.start, ux=lambda t: 0.01 * np.sin(30.0 * t), uy=0.0, rotation=0.0) for one in beams]
    joints = [bf.Rigid(beams[0].end, tie.start), bf.Rigid(tie.end, beams[1].end)]
    model = bf.Model([*beams, tie], shaken, joints=joints)
    one, other = (bf.simulate(model, 0.1, 1e-3, scheme) for scheme in (Newmark(), bf.GeneralizedAlpha(1.0)))
    np.testing.assert_allclose(one.p, other.p, rtol=0.0, atol=1e-9)
    assert np.ptp(one.displacement(tie.end)[:, 0]) > 1e-3


@pytest.mark.parametrize("scheme", [HHT(0.1), HHT(0.3), bf.GeneralizedAlpha(0.5)], ids=repr)
def test_momentum_is_the_impulse_of_a_load_whose_kinks_lie_within_steps(scheme):
    """Each kink begins a new stretch of steps."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), SECTION, RUBBER)
    times, factors = [0.0, 0.0103, 0.0217, 0.0351], [0.0, 1.0, 0.4, 0.0]
    pulse = bf.Interpolated(list(zip(times, factors, strict=True)))
    model = bf.Model([beam], loads=[bf.PointForce(beam.at(0.5), (0.0, 2.0), amplitude=pulse)])
    motion = bf.simulate(model, 0.05, 1e-3, scheme)
    impulse = 2.0 * np.trapezoid(factors, times)
    assert motion.linear_momentum()[-1, 1] == pytest.approx(impulse, rel=1e-9)


def test_an_integrator_with_a_step_of_its_own_takes_it_whatever_its_rule_is():
    @dataclass(frozen=True)
    class Resting:
        rule: object = (0.5, 0.5)

        def step(self, motion, begin, end):
            return replace(begin, at=end)

    moved = bf.simulate(pendulum(), 0.01, 1e-3, Resting())
    np.testing.assert_array_equal(moved.p, np.broadcast_to(moved.p[0], moved.p.shape))


@pytest.mark.parametrize(
    "values",
    [
        np.array([1e-3, 0.0, 0.0, 0.5]),
        np.array([1e-3, 0.0, 0.0, 0.5, 0.0]),
        np.array([1e-3, 1.0, 0.0, 0.5, 0.25]),
        np.array([2e-3, 0.0, 0.0, 0.5, 0.25]),
        np.array([1e-3, 0.0, np.nan, 0.5, 0.25]),
        None,
        "rule",
    ],
)
def test_a_rule_of_no_implicit_method_is_refused_before_the_motion(values):
    with pytest.raises(bf.InputError, match="rule of Given must return"):
        bf.simulate(pendulum(), 0.1, 1e-3, Given(values))


def test_a_class_instead_of_an_object_is_refused():
    with pytest.raises(bf.InputError, match="integrator must be"):
        bf.simulate(pendulum(), 0.1, 1e-3, Newmark)
