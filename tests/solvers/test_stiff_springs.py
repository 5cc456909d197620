"""Springs that stand for something rigid: as a link while digits last, named where they do not."""

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf

ALUMINIUM, SECTION = bf.Material(7e10, 0.3, 2700.0), bf.Rectangle(0.02, 0.005)
CUBIC = bf.CRBF(3)
ELEMENTS = [CUBIC, bf.CRBF(1), bf.CRBF(2), bf.ANCFCRBF(bf.Structural()), bf.ANCF(bf.Structural()), bf.ShearRigid()]


def spring(stiffness):
    return lambda a, b: bf.SpringDamper(a, b, stiffness=stiffness)


def two_arms(part, turned=0.0, element=CUBIC):
    """Two clamped arms whose ends a part holds at a distance, the first one pushed along and across."""
    x, y = np.array([np.cos(turned), np.sin(turned)]), np.array([-np.sin(turned), np.cos(turned)])
    left, right = (
        bf.Beam(bf.Line(tuple(s * x), tuple((s + 0.5) * x)), 4, element, SECTION, ALUMINIUM) for s in (0, 0.7)
    )
    loads = [bf.PointForce(left.end, tuple(-20.0 * y)), bf.PointForce(left.at(0.5), tuple(-100.0 * x))]
    model = bf.Model(
        [left, right], [bf.Clamp(left.start), bf.Clamp(right.end)], loads, connectors=[part(left.end, right.start)]
    )
    return model, left.end


def pendulum(part):
    """Two bars that fall from horizontal, held together by a part."""
    upper, lower = (bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), 4, bf.CRBF(1), SECTION, ALUMINIUM) for x in (0.0, 0.7))
    return bf.Model(
        [upper, lower], [bf.Pin(upper.start)], [bf.Gravity((0.0, -9.81))], connectors=[part(upper.end, lower.start)]
    )


@mostly_slow("turned", [0.0, 0.7])
@pytest.mark.parametrize("stiffness", [1e14, 1e16])
def test_an_arm_turns_away_from_a_stiff_spring_as_from_a_link(stiffness, turned):
    """Round-off of its force was expected along its axis in the reference only, and the iteration never ended."""
    (linked, end), (sprung, other) = two_arms(bf.Link, turned), two_arms(spring(stiffness), turned)
    exact = bf.solve_static(linked).displacement(end)[-1]
    for found in (bf.solve_static(sprung), bf.trace_equilibrium(sprung, until=1.0)):
        assert found.displacement(other)[-1] == pytest.approx(exact, rel=1e-6, abs=1e-9)


@mostly_slow("element", ELEMENTS[1:], ids=lambda element: element.name)
def test_arms_of_any_element_turn_away_from_a_stiff_spring(element):
    (linked, end), (sprung, other) = (two_arms(part, 0.2, element) for part in (bf.Link, spring(5e15)))
    exact, found = (bf.solve_static(model).displacement(tip)[-1] for model, tip in ((linked, end), (sprung, other)))
    assert found == pytest.approx(exact, abs=1e-9)


def test_a_static_solve_that_a_spring_leaves_no_digits_names_it():
    with pytest.raises(bf.ConvergenceError, match=r"round-off of SpringDamper at \(0.5, 0\) and .* by a Link"):
        bf.solve_static(two_arms(spring(1e22))[0])


def test_a_motion_that_round_off_of_a_spring_shakes_says_so():
    linked, sprung = (bf.simulate(pendulum(part), 0.2, 1e-3) for part in (bf.Link, spring(1e16)))
    assert sprung.p[-1] == pytest.approx(linked.p[-1, : sprung.p.shape[1]], abs=1e-6)
    with pytest.warns(bf.RoundOffWarning, match="force of SpringDamper at .* uncertain"):
        bf.simulate(pendulum(spring(1e20)), 0.02, 1e-3)
