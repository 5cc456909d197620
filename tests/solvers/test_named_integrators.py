"""Integrators by name: linear vibrations against their recursions, and their order in large motions."""

import numpy as np
import pytest

import beamfem as bf

STEEL, SECTION = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)


def vibration(omega, step, count, alpha_m, alpha_f, gamma, beta):
    """Return x (count + 1,) of x'' = -omega^2 x from x = 1 at rest by the generalized-alpha recursion."""
    # unknowns x1, v1, w1 = x'', a1 of a step; see `Scheme`
    after = np.array(
        [
            [1.0, 0.0, 0.0, -(step**2) * beta],
            [0.0, 1.0, 0.0, -step * gamma],
            [omega**2, 0.0, 1.0, 0.0],
            [0.0, 0.0, -(1.0 - alpha_f), 1.0 - alpha_m],
        ]
    )
    before = np.array(
        [
            [1.0, step, 0.0, step**2 * (0.5 - beta)],
            [0.0, 1.0, 0.0, step * (1.0 - gamma)],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, alpha_f, -alpha_m],
        ]
    )
    state, result = np.array([1.0, 0.0, -(omega**2), -(omega**2)]), [1.0]
    for _ in range(count):
        state = np.linalg.solve(after, before @ state)
        result.append(state[0])
    return np.array(result)


# alpha_m, alpha_f, gamma, beta of the papers
RULES = {
    "HHT": (bf.HHT(-0.2), (0.0, 0.2, 0.7, 0.36)),
    "damped Newmark": (bf.Newmark(0.3025, 0.6), (0.0, 0.0, 0.6, 0.3025)),
    "trapezoidal rule": (bf.Trapezoidal(), (0.0, 0.0, 0.5, 0.25)),
}


@pytest.mark.parametrize("name", RULES)
def test_small_vibrations_follow_the_recursion_of_the_method(name):
    integrator, numbers = RULES[name]
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    modes = bf.solve_modes(model, 1)
    step = 0.15 / modes.frequencies[0]
    # accelerations at the start are those of the equations, as in the recursion
    motion = bf.simulate(model, 12 * step, step, integrator, start=modes.start(0, 1e-7))
    found = motion.displacement(beam.end)[:, 1]
    expected = vibration(2.0 * np.pi * modes.frequencies[0], step, 12, *numbers)
    assert found / found[0] == pytest.approx(expected, abs=1e-5)


def test_the_damping_of_high_frequencies_is_that_of_the_parameter():
    """Amplification at infinite frequency: (1 + alpha) / (1 - alpha), by Hilber, Hughes and Taylor."""
    x = vibration(1e4, 1.0, 60, 0.0, 0.1, 0.6, 0.3025)
    rule = bf.HHT(-0.1).rule(1.0)
    assert rule[1:] == pytest.approx((0.0, 0.1, 0.6, 0.3025))
    assert abs(x[60] / x[40]) ** (1 / 20) == pytest.approx(0.9 / 1.1, rel=0.05)


ROTATIONS, GRADIENTS = bf.CRBF(2), bf.ANCF(bf.Structural())
ORDERS = [
    (bf.HHT(-0.1), ROTATIONS, 2.0),
    (bf.HHT(-0.1), GRADIENTS, 2.0),
    (bf.Newmark(0.3025, 0.6), ROTATIONS, 1.0),
    (bf.Newmark(0.3025, 0.6), GRADIENTS, 1.0),
    (bf.Trapezoidal(), ROTATIONS, 2.0),
    (bf.Trapezoidal(), GRADIENTS, 2.0),
]


def errors(integrator, element, steps, moved):
    """Return the errors (steps,) of the free end of two hinged arms.

    Loads begin smoothly, as vibrations that steps do not resolve have no order.
    """
    soft, section = bf.Material(2e6, 0.3, 1000.0), bf.Rectangle(0.05, 0.1)
    upper = bf.Beam(bf.Line((0, 0), (1, 0)), 2, element, section, soft)
    lower = bf.Beam(bf.Line((1, 0), (2, 0)), 2, element, section, soft)
    support = bf.Prescribed(upper.start, ux=0.0, uy=lambda t: 2.0 * t**4) if moved else bf.Pin(upper.start)
    weight = bf.Gravity((0, -9.81), amplitude=lambda t: (t / 0.2) ** 3)
    model = bf.Model([upper, lower], [support], [weight], [bf.Hinge(upper.end, lower.start)])
    exact = bf.simulate(model, 0.2, 2e-4, bf.Radau(3)).position(lower.end)[-1]
    return np.array([bf.simulate(model, 0.2, step, integrator).position(lower.end)[-1] - exact for step in steps])


@pytest.mark.parametrize(("integrator", "element", "order"), ORDERS)
def test_each_has_its_order_with_hinges_and_prescribed_motion(integrator, element, order):
    coarse, fine = np.linalg.norm(errors(integrator, element, (2e-3, 1e-3), moved=True), axis=1)
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("moved", [False, True])
@pytest.mark.parametrize("element", [ROTATIONS, GRADIENTS])
def test_the_midpoint_rule_is_of_second_order_with_hinges_and_moved_supports(element, moved):
    """A part of first order would be small beside the other at two steps; at five it is seen."""
    steps = np.array([4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4])
    found = errors(bf.Midpoint(), element, steps, moved)
    size = np.linalg.norm(found, axis=1)[:, None]
    powers = steps[:, None] ** 2
    factors = np.linalg.lstsq(powers / size, found / size)[0]
    assert np.max(np.linalg.norm((powers @ factors - found) / size, axis=1)) < 0.01


def test_bad_parameters_are_refused():
    with pytest.raises(bf.InputError, match=r"alpha of HHT lies between -1/3 and 0, got 0\.1"):
        bf.HHT(0.1)
    with pytest.raises(bf.InputError, match=r"beta above 0 and gamma of at least 1/2, got beta 0\.0"):
        bf.Newmark(beta=0.0)
