"""Forces that hold conditions do no work in the motions that these allow; friction that grows with them may."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.testing import check_connector
from tests.connectors import SECTION, STEEL, beam

NORMAL, ALONG = np.array([-0.6, 0.8]), np.array([0.8, 0.6])  # of an inclined floor


@dataclass(frozen=True)
class Offset:
    """A rigid arm between two nodes; `arm` is the part of it that the moment has."""

    a: bf.Point
    b: bf.Point
    arm: float = 1.0
    conservative: bool = False
    stiffness: float = 0.0
    unknowns = 3

    @property
    def points(self):
        return self.a, self.b

    def force(self, at):
        before = at.reference[1, :2] - at.reference[0, :2]
        c, s = np.cos(at.q[0, 2]), np.sin(at.q[0, 2])
        apart = np.array([c * before[0] - s * before[1], s * before[0] + c * before[1]])
        gap, turn = at.q[1, :2] - at.q[0, :2] - apart, at.q[1, 2] - at.q[0, 2]
        pull, moment = at.own[:2], at.own[2]
        around = self.arm * self.turning(at, apart, pull) + moment
        spring = self.stiffness * at.q[0, 0]
        return np.concatenate([-pull + [spring, 0.0], [-around], pull, [moment], gap, [turn]])

    def turning(self, at, apart, pull):
        return apart[0] * pull[1] - apart[1] * pull[0]

    def energy(self, at):
        return 0.0, 0.5 * self.stiffness * float(at.q[0, 0]) ** 2


class OnItsConditions(Offset):
    """The moment of the distance between the nodes, which is the arm where the conditions are met."""

    def turning(self, at, apart, pull):
        way = at.q[1, :2] - at.q[0, :2]
        return way[0] * pull[1] - way[1] * pull[0]


class InAnotherUnit(Offset):
    def force(self, at):
        found = super().force(at)
        return np.concatenate([1e3 * found[:6], found[6:]])


class OfTheOtherSign(Offset):
    def force(self, at):
        found = super().force(at)
        return np.concatenate([-found[:6], found[6:]])


class InAnotherOrder(Offset):
    def force(self, at):
        return super().force(at)[[0, 1, 2, 3, 4, 5, 7, 6, 8]]


@dataclass(frozen=True)
class Wheel:
    """A foot below a node on an inclined floor, with friction."""

    point: bf.Point
    radius: float = 0.05
    unknowns = 1
    conservative = False

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        s, c = np.sin(at.q[0, 2]), np.cos(at.q[0, 2])
        arm = self.radius * np.array([s, -c])
        moved = at.q[0, :2] - at.reference[0, :2] + arm + [0.0, self.radius]
        rate = ALONG @ (at.v[0, :2] + at.v[0, 2] * np.array([-arm[1], arm[0]]))
        push, condition = at.own[0], NORMAL @ moved
        if self.open(push):
            return np.array([0.0 * push, 0.0 * push, 0.0 * push, push])
        force = push * NORMAL + self.friction(at, push, ALONG @ moved, rate) * ALONG
        return np.array([*force, self.moment(self.lever(arm), force), condition])

    def moment(self, lever, force):
        return lever[0] * force[1] - lever[1] * force[0]

    def lever(self, arm):
        return arm

    def open(self, push):
        return False

    def friction(self, at, push, moved, rate):
        return 0.0 * push

    def energy(self, at):
        return 0.0, 0.0


class HalfLever(Wheel):
    def lever(self, arm):
        return 0.5 * arm


class HalfLeverOnADamper(HalfLever):
    def friction(self, at, push, moved, rate):
        return 5.0 * rate


class SmoothFriction(Wheel):
    def friction(self, at, push, moved, rate):
        return 1e-6 * np.sqrt(push * push + 1e-6) * np.tanh(rate / 1e-3)


class FrictionOfAContact(Wheel):
    def open(self, push):
        return push.real < 0.0

    def friction(self, at, push, moved, rate):
        return 0.3 * push * (1.0 if rate.real > 0.0 else -1.0)


class FrictionOfWhatHasMoved(Wheel):
    def friction(self, at, push, moved, rate):
        return 0.3 * push * np.tanh(moved / 1e-3)


class FrictionOneWay(Wheel):
    def friction(self, at, push, moved, rate):
        return 0.3 * np.sqrt(push * push)


class StickingFriction(Wheel):
    memory = (0.01,)

    def friction(self, at, push, moved, rate):
        held, most = 1e6 * (moved - at.memory[0]), 0.3 * np.sqrt(push * push)
        return held if abs(held.real) < most.real else most * np.sign(held.real)

    def remember(self, at):
        return at.memory


class FrictionWithADirection(StickingFriction):
    def friction(self, at, push, moved, rate):
        return 0.3 * push * at.memory[0]


class HalfLeverWithAPast(StickingFriction):
    """Its memory has nothing to do with its multiplier."""

    def lever(self, arm):
        return 0.5 * arm

    def friction(self, at, push, moved, rate):
        return 0.0 * push + at.memory[0]


def bracket(kind, *arguments, **options):
    """A cantilever whose end carries another beam by a rigid arm upward, loaded at its tip."""
    lower, upper = beam(), beam(start=(1.0, 0.3), end=(2.0, 0.3))
    loads = [bf.PointForce(upper.end, (0.0, -20.0))]
    arm = kind(lower.end, upper.start, *arguments, **options)
    return upper, bf.Model([lower, upper], [bf.Clamp(lower.start)], loads, connectors=[arm])


@pytest.mark.parametrize("options", [{}, {"stiffness": 1e9, "conservative": True}])
def test_half_the_arm_in_the_moment_of_a_rigid_offset_is_refused(options):
    """Declared conservative, a stiff spring beside it hid what its stiffness lacks in symmetry."""
    _, model = bracket(Offset, 0.5, **options)
    with pytest.raises(
        AssertionError,
        match=r"force of Offset: the forces of its multipliers do work in motions that its conditions allow; the moment"
        r" at points\[\d\] is not the multipliers times the derivatives of the conditions by q there",
    ):
        check_connector(model.connectors[0])


@pytest.mark.parametrize("kind", [Offset, OnItsConditions, InAnotherUnit])
def test_a_rigid_offset_that_does_no_work_is_in_balance(kind):
    upper, model = bracket(kind)
    check_connector(model.connectors[0])
    solution = bf.solve_static(model)
    tip = solution.position(upper.end)[-1]
    assert solution.warnings == ()
    assert solution.reaction(model.beams[0].start)[-1] == pytest.approx([0.0, 20.0, 20.0 * tip[0]], abs=1e-6)
    rigid = bf.Material(STEEL.youngs_modulus * 1e4, 0.3, 1.0)
    post = bf.Beam(bf.Line((1.0, 0.0), (1.0, 0.3)), 4, bf.CRBF(3), SECTION, rigid)
    joints = [bf.Rigid(model.beams[0].end, post.start), bf.Rigid(post.end, upper.start)]
    peer = bf.solve_static(bf.Model([model.beams[0], post, upper], model.supports, model.loads, joints))
    assert tip == pytest.approx(peer.position(upper.end)[-1], abs=2e-4)


@pytest.mark.parametrize("kind", [OfTheOtherSign, InAnotherOrder])
def test_multipliers_against_their_conditions_are_refused(kind):
    """The equilibrium would be right, but a determinant of the other sign made it unstable in a warning."""
    with pytest.raises(AssertionError, match=r"multiplier 0 does not act along the derivative of its condition by q"):
        check_connector(bracket(kind)[1].connectors[0])


@pytest.mark.parametrize("kind", [HalfLever, HalfLeverOnADamper, HalfLeverWithAPast])
def test_half_the_lever_of_a_contact_is_refused_whatever_damps_beside_it(kind):
    with pytest.raises(AssertionError, match=rf"force of {kind.__name__}: the forces of its multipliers do work"):
        check_connector(kind(beam().end))


@pytest.mark.parametrize(
    "kind",
    [
        Wheel,
        SmoothFriction,
        FrictionOfAContact,
        FrictionOfWhatHasMoved,
        FrictionOneWay,
        StickingFriction,
        FrictionWithADirection,
    ],
)
def test_friction_that_grows_with_a_multiplier_is_accepted(kind):
    check_connector(kind(beam().end))
