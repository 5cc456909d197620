"""A mechanism whose cause is a forgotten joint: the message names both points and what would join them."""

import re

import numpy as np
import pytest
from connectors import SpringDamper

import beamfem as bf
from beamfem.equations.connector_traits import lets_go
from beamfem.equations.system import system_of
from beamfem.model.missing_joints import unjoined_ends

SECTION, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)


def line(start, end, name=None):
    return bf.Beam(bf.Line(start, end), 4, bf.CRBF(2), SECTION, STEEL, name)


def said(*parts, **more):
    with pytest.raises(bf.FreeMotionError) as caught:
        bf.solve_static(bf.Model(*parts, **more))
    return str(caught.value)


LEFT, RIGHT = line((0, 0), (1, 0), "left"), line((1, 0), (2, 0), "right")


@pytest.mark.parametrize("beams", [[LEFT, RIGHT], [RIGHT, LEFT]], ids=["in order", "reversed"])
def test_ends_without_a_joint_are_named(beams):
    message = said(beams, [bf.Clamp(LEFT.start)])
    ends = {"left": "end", "right": "start"}
    one, two = (f"he {ends[beam.name]} of beam '{beam.name}'" for beam in beams)
    assert f"T{one} and t{two} are both at (1, 0), but no joint connects them: add a Rigid or a Hinge" in message
    assert "Otherwise a static solve needs supports that hold it" in message


def test_an_end_on_the_inside_of_a_beam_is_found():
    hanger = line((0.3, 0), (0.3, -1))
    assert "Fraction 0.3 of beam 'left' and the start of beam 1 are both at (0.3, 0)" in said(
        [LEFT, hanger], [bf.Clamp(LEFT.start)]
    )


def test_an_end_on_a_curved_element_is_found():
    arch = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, np.pi), 3, bf.CRBF(2), SECTION, STEEL)
    rod = line((np.cos(1.0), np.sin(1.0)), (0, 3))
    assert "Fraction 0.31831 of beam 0 and the start of beam 1" in said([arch, rod], [bf.Clamp(arch.start)])


def test_a_third_beam_at_a_joint_is_found():
    post = line((1, 0), (1, 1), "post")
    message = said([LEFT, post, RIGHT], [bf.Clamp(LEFT.start)], joints=[bf.Rigid(LEFT.end, post.start)])
    assert re.search("of beam '(left|post)' and the start of beam 'right' are both", message)


def test_beams_that_a_third_connects_are_joined():
    post = line((1, 0), (1, 1))
    joints = [bf.Rigid(LEFT.end, post.start), bf.Hinge(post.start, RIGHT.start)]
    model = bf.Model([LEFT, post, RIGHT], [bf.Clamp(LEFT.start)], joints=joints)
    assert list(unjoined_ends(model)) == []
    assert "no joint" not in said(model.beams, model.supports, joints=joints)


def test_places_that_the_motion_does_not_part_are_no_cause():
    """Two beams clamped at one place need no joint; a third one that flies elsewhere has none to forget."""
    up, away = line((0, 0), (0, 1)), line((5, 5), (6, 5))
    clamped = [bf.Clamp(LEFT.start), bf.Clamp(up.start)]
    assert len(list(unjoined_ends(bf.Model([LEFT, up, away], clamped)))) > 0
    assert "no joint" not in said([LEFT, up, away], clamped)


def test_pinned_ends_that_only_turn_differently_are_a_cause():
    supports = [bf.Clamp(LEFT.start), bf.Pin(RIGHT.start)]
    assert "The end of beam 'left' and the start of beam 'right'" in said([LEFT, RIGHT], supports)


def test_the_first_of_very_many_is_found_at_once():
    bars = [line((i, j), (i + 1, j)) for i in range(40) for j in range(40)]
    pairs = unjoined_ends(bf.Model(bars, [bf.Clamp(bars[0].start)]))
    end, other = next(pairs)
    assert end.reference == pytest.approx(other.reference)
    assert sum(1 for _ in pairs) > 2 * 39 * 40 - 2


FRAME = [line((0, 0), (0, 1)), line((0, 1), (1, 1)), line((1, 1), (1, 0))]
FEET = [bf.Clamp(FRAME[0].start), bf.Clamp(FRAME[2].end)]
PUSH = [bf.PointForce(FRAME[0].end, (1.0, 0.0))]
JOINTS = [bf.Rigid(FRAME[0].end, FRAME[1].start), bf.Rigid(FRAME[1].end, FRAME[2].start)]


def test_a_missing_joint_that_leaves_no_mechanism_is_warned_of():
    """The bar is then a cantilever on the left column, and the right column stands alone."""
    (said,) = bf.solve_static(bf.Model(FRAME, FEET, PUSH, JOINTS[:1])).warnings
    assert said.startswith("The end of beam 1 and the start of beam 2 are both at (1, 1), but no joint connects them, ")
    assert re.search(r"they move 0\.00[0-9]+ m apart\. If they belong together, add a Rigid or a Hinge$", said)
    assert bf.solve_static(bf.Model(FRAME, FEET, PUSH, JOINTS)).warnings == ()
    assert bf.simulate(bf.Model(FRAME, FEET, PUSH, JOINTS[1:]), 0.01, 1e-3).warnings[-1].startswith("The end of beam 0")


def test_ends_that_stay_together_or_that_a_connector_ties_are_not_warned_of():
    pinned = [*FEET, bf.Pin(FRAME[1].end), bf.Pin(FRAME[2].start)]
    assert bf.solve_static(bf.Model(FRAME, pinned, PUSH, JOINTS[:1])).warnings == ()
    tie = SpringDamper(FRAME[1].at(0.5), FRAME[2].start, stiffness=10.0)
    assert bf.solve_static(bf.Model(FRAME, FEET, PUSH, JOINTS[:1], [tie])).warnings == ()


RING = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2 * np.pi), 24, bf.CRBF(2), SECTION, STEEL)
RING_PULLED = [bf.Clamp(RING.at(0.5))], [bf.PointForce(RING.start, (0.01, 0.0))]


def test_a_closed_axis_whose_ends_are_not_joined_is_warned_of():
    """A slit ring: the force at its start bends half of it alone, and (pi / 2) F R^3 / (E I) is how far this goes."""
    slit = bf.solve_static(bf.Model([RING], *RING_PULLED))
    (said,) = slit.warnings
    assert said.startswith("The start of beam 0 and the end of beam 0 are both at (1, 0), but no joint connects them, ")
    moved = np.hypot(*slit.displacement(RING.start)[-1])
    assert f"they move {moved:.3g} m apart. If they belong together, add a Rigid or a Hinge" in said
    for joint in (bf.Rigid, bf.Hinge):
        assert bf.solve_static(bf.Model([RING], *RING_PULLED, [joint(RING.end, RING.start)])).warnings == ()
    tie = SpringDamper(RING.end, RING.start, stiffness=10.0)
    assert bf.solve_static(bf.Model([RING], *RING_PULLED, connectors=[tie])).warnings == ()


def test_an_end_that_comes_back_to_its_own_beam_is_found():
    """The outline of a 6; a joint of the other end with another beam joins nothing here."""
    six = bf.Beam(bf.Polyline([(0, 3), (0, 0), (1, 0), (1, 1), (0, 1)]), 24, bf.CRBF(2), SECTION, STEEL, "six")
    post = line((0, 3), (0, 4))
    model = bf.Model([six, post], [bf.Clamp(post.end)], joints=[bf.Rigid(six.start, post.start)])
    ((end, other),) = unjoined_ends(model)
    assert (end, other.beam, other.fraction) == (six.end, six, pytest.approx(2.0 / 6.0, abs=1e-5))
    fine = bf.Beam(six.curve, bf.graded(40, 1e9), bf.CRBF(1), SECTION, STEEL)
    assert len({other.fraction for _, other in unjoined_ends(bf.Model([fine], [bf.Clamp(fine.start)]))}) == 1


@pytest.mark.parametrize(
    ("make", "opens"),
    [
        (lambda a, b: bf.HingeFriction(a, b, 0.5, 1e4), False),
        (lambda a, b: bf.TorsionSpring(a, b, 1e3), False),
        (lambda a, b: bf.SpringDamper(a, b, lambda e, f: 1e3 * (f.positive(e) + e)), False),
        (lambda a, b: bf.PointMass(a, 2.0), False),
        (lambda a, b: bf.HingeStop(a, b, 0.1, stiffness=1e3, restitution=0.5), True),
        (lambda a, b: bf.Stop(a, (0, 0), (0, 1), 1e3, friction=0.3), True),
        (lambda a, b: bf.Cable(a, b, 1e3, pretension=5.0), True),
        (lambda a, b: bf.SpringDamper(a, b, lambda e, f: 1e3 * f.positive(e)), True),
    ],
)
def test_parts_that_let_go(make, opens):
    square, steel = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)
    one, two = (bf.Beam(bf.Line((x, 0), (x, 1)), 1, bf.CRBF(2), square, steel) for x in (0.0, 0.5))
    part = make(one.end, two.end)
    (item,) = system_of(bf.Model([one, two], connectors=[part]), static=True).connectors.items
    assert lets_go(item) is opens
