"""A motion does not begin with a jump: what its supports prescribe at time 0 is what its start has there."""

import numpy as np
import pytest
from connectors import Anchor, RigidLink

import beamfem as bf
from beamfem.equations.system import System
from beamfem.solve.motion.constraints import impact

STEEL = bf.Material(2e11, 0.3, 7800.0)


def straight(element=None, size=1.0):
    section = bf.Rectangle(0.01 * size, 0.01 * size)
    return bf.Beam(bf.Line((0.0, 0.0), (size, 0.0)), 4, element or bf.CRBF(3), section, STEEL)


def bent(own, force):
    return bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [bf.PointForce(own.end, (0.0, force))]))


def go_on(own, state, *supports, **given):
    return bf.simulate(bf.Model([own], [bf.Clamp(own.start), *supports]), 2e-4, 1e-4, start=state, **given)


ROD = straight()
BENT = bent(ROD, 5.0)
UX, UY = BENT.displacement(ROD.end)[-1].tolist()
TURN = float(BENT.rotation(ROD.end)[-1])

ELSEWHERE = {
    "pin": (bf.Pin(ROD.end), r"Pin at \(1, 0\), fraction 1 of .* prescribes ux = 0 m, uy = 0 m .* jump by 0.01 m"),
    "roller": (bf.Roller(ROD.end), r"Roller at .* prescribes uy = 0 m .* start has uy = 0.00999975 m there"),
    "inclined roller": (bf.Roller(ROD.end, (3, 4)), r"Roller at .* along \(0.6, 0.8\) at 0, but start has 0.007964 m"),
    "displacement": (bf.Prescribed(ROD.end, uy=0.0), r"Prescribed support with uy = 0.0099997\d+; or start from what"),
    "rotation": (bf.Prescribed(ROD.end, rotation=1.0), r"rotation = 1 rad .* has rotation = 0.01\d+ rad .* 0.985 rad"),
    "clamp": (bf.Clamp(ROD.end), r"Clamp at .* jump by 0.01 m and 0.015 rad"),
    "function": (bf.Prescribed(ROD.end, uy=lambda t: 0.1 * t), r"uy = 0 m .* to continue a motion, shift the time"),
}


@pytest.mark.parametrize(("support", "told"), ELSEWHERE.values(), ids=ELSEWHERE)
def test_a_support_that_would_move_a_point_of_the_start_at_once_is_refused(support, told):
    """A bent rod of 0.025 J had 5556 J in the first row, in silence."""
    with pytest.raises(bf.InputError, match=told):
        go_on(ROD, BENT[-1], support)


HELD = {
    "position": bf.Prescribed(ROD.end, ux=UX, uy=UY),
    "all": bf.Prescribed(ROD.end, ux=UX, uy=UY, rotation=TURN),
    "function": bf.Prescribed(ROD.end, uy=lambda t: UY + 0.1 * t),
}


@pytest.mark.parametrize("support", HELD.values(), ids=HELD)
def test_a_support_that_holds_the_start_where_it_is_keeps_its_energy(support):
    motion = go_on(ROD, BENT[-1], support)
    assert motion.energy().strain[0] == pytest.approx(BENT.energy().strain[-1], rel=1e-9)


def test_the_displacements_that_the_message_names_are_taken():
    with pytest.raises(bf.InputError) as refused:
        go_on(ROD, BENT[-1], bf.Clamp(ROD.end))
    named = str(refused.value).partition("use a Prescribed support with ")[2].partition(";")[0]
    values = {name: float(value) for name, value in (pair.split(" = ") for pair in named.split(", "))}
    motion = go_on(ROD, BENT[-1], bf.Prescribed(ROD.end, **values))
    assert motion.energy().strain[0] == pytest.approx(BENT.energy().strain[-1], rel=1e-6)


@pytest.mark.filterwarnings("ignore::beamfem.errors.EnergyWarning")  # a step is a period of the smallest beam
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("deflection", [1e-7, 1e-5, 1e-2])
def test_a_jump_is_measured_by_the_displacements_of_the_start(size, deflection):
    """A tenth of a small deflection is a jump too: held at the reference, its energy would be another."""
    own = straight(size=size)
    force = 3.0 * STEEL.youngs_modulus * own.section.second_moment / size**2 * deflection
    static = bent(own, force)
    up = static.displacement(own.end)[-1, 1]
    assert up == pytest.approx(deflection * size, rel=0.05)
    go_on(own, static[-1], bf.Prescribed(own.end, uy=up * (1.0 + 5e-7)))
    with pytest.raises(bf.InputError, match="it would jump by"):
        go_on(own, static[-1], bf.Prescribed(own.end, uy=0.9 * up))


def test_a_state_at_half_the_load_is_not_where_a_prescribed_number_begins():
    """Numbers grow with the load factor in statics, but are constant in a motion."""
    model = bf.Model([ROD], [bf.Clamp(ROD.start), bf.Prescribed(ROD.end, uy=0.02)])
    path = bf.solve_static(model, at=[0.5, 1.0])
    bf.simulate(model, 2e-4, 1e-4, start=path[-1])
    with pytest.raises(bf.InputError, match=r"prescribes uy = 0.02 m .* start has uy = 0.01 m there"):
        bf.simulate(model, 2e-4, 1e-4, start=path[-2])


def test_a_driven_motion_goes_on_where_the_time_of_its_function_is_shifted():
    def driven(begin):
        lift = bf.Prescribed(ROD.start, ux=0.0, uy=lambda t: 0.01 * np.sin(50.0 * (t + begin)), rotation=0.0)
        return bf.Model([ROD], [lift])

    first = bf.simulate(driven(0.0), 0.02, 1e-3)
    rest = bf.simulate(driven(0.02), 0.01, 1e-3, start=first[-1])
    assert rest.displacement(ROD.start)[0] == pytest.approx(first.displacement(ROD.start)[-1], abs=1e-14)
    with pytest.raises(bf.InputError, match="shift the time of its functions, which begins at 0 again"):
        bf.simulate(driven(0.0), 0.01, 1e-3, start=first[-1])


@pytest.mark.parametrize("hinged", [False, True])
@pytest.mark.parametrize("speed", [3.0, lambda t: 3.0])
def test_a_motor_whose_speed_is_given_goes_on_by_its_angle(hinged, speed):
    """A speed moves from the reference, and the message once advised to shift its function of time."""
    other = bf.Beam(bf.Line((1, 0), (2, 0)), 2, bf.CRBF(order=3), ROD.section, ROD.material)
    beams, joints = ([ROD, other], [bf.Hinge(ROD.end, other.start)]) if hinged else ([ROD], [])
    supports = [bf.Clamp(ROD.start)] if hinged else [bf.Pin(ROD.start)]
    at = joints[0] if hinged else ROD.start

    def driven(**how):
        return bf.Model(beams, supports, [bf.Motor(at, **how)], joints)

    first = bf.simulate(driven(speed=speed), 0.02, 1e-3)
    with pytest.raises(bf.InputError, match="in place of its rate: where start has it, and the integral of the rate"):
        bf.simulate(driven(speed=speed), 0.02, 1e-3, start=first[-1])
    rest = bf.simulate(driven(angle=lambda t: 0.06 + 3.0 * t), 0.02, 1e-3, start=first[-1])
    turned = rest.rotation(other.start) - rest.rotation(ROD.end) if hinged else rest.rotation(ROD.start)
    assert turned == pytest.approx(0.06 + 3.0 * rest.at, abs=1e-9)


def test_a_crank_begins_each_period_anew_unless_a_spring_or_a_connector_counts_its_turns():
    """After a full turn the section is where it was; a torsion spring is not."""
    crank = bf.Prescribed(ROD.start, ux=0.0, uy=0.0, rotation=lambda t: 2.0 * np.pi * t / 0.1)
    model = bf.Model([ROD], [crank])
    first = bf.simulate(model, 0.1, 5e-4)
    assert first.rotation(ROD.start)[-1] == pytest.approx(2.0 * np.pi)
    second = bf.simulate(model, 0.01, 5e-4, start=first[-1])
    assert second.energy().total[0] == pytest.approx(first.energy().total[-1], rel=1e-9)
    wound = (
        bf.Model([ROD], [crank, bf.Spring(ROD.start, rotational=1.0)]),
        bf.Model([ROD], [crank], connectors=[Anchor(ROD.start, (0.0, 0.0, 1.0))]),
    )
    for other in wound:
        with pytest.raises(bf.InputError, match=r"it would jump by 6.283 rad"):
            bf.simulate(other, 0.01, 5e-4, start=first[-1])


@pytest.mark.parametrize("support", [bf.Pin, bf.Roller, lambda point: bf.Roller(point, (3, 4))])
def test_an_impact_onto_a_support_is_plastic(support):
    """Velocities that a support stops are lost at once, with their kinetic energy; nothing is strained by that."""
    free = bf.simulate(bf.Model([ROD]), 1e-6, 1e-6, velocity=bf.RigidVelocity((0.0, -1e-4)))[0]
    motion = bf.simulate(bf.Model([ROD], [support(ROD.end)]), 1e-6, 1e-6, start=free)
    assert motion.energy().strain[0] == pytest.approx(0.0, abs=1e-15)
    assert 0.0 < motion.energy().kinetic[0] < 0.5 * 7800.0 * 1e-4 * 1e-8


OFF_THE_REFERENCE = {
    "number": (
        bf.Prescribed(ROD.end, uy=0.01),
        r"Use a function of time that begins at 0, or start from what solve_",
    ),
    "function": (bf.Prescribed(ROD.end, uy=lambda t: 0.01 + t), r"Subtract from its functions their values at time 0"),
    "rotation": (bf.Prescribed(ROD.end, rotation=-0.2), r"rotation = 0 rad there: it would jump by 0.2 rad"),
}


@pytest.mark.parametrize(("support", "told"), OFF_THE_REFERENCE.values(), ids=OFF_THE_REFERENCE)
def test_a_support_that_is_not_at_the_reference_needs_a_start(support, told):
    """It began with 5556 J in one stretched element, for 0.025 J of a cantilever with this deflection, in silence."""
    model = bf.Model([ROD], [bf.Clamp(ROD.start), support])
    with pytest.raises(bf.InputError, match=rf"Prescribed at \(1, 0\), .* but the reference has .*{told}"):
        bf.simulate(model, 2e-4, 1e-4)


def test_a_motion_whose_support_is_off_the_reference_starts_from_its_static_state():
    model = bf.Model([ROD], [bf.Clamp(ROD.start), bf.Prescribed(ROD.end, uy=0.01)])
    static = bf.solve_static(model)
    motion = bf.simulate(model, 0.01, 1e-4, start=static[-1])
    assert motion.energy().total == pytest.approx(np.full(101, static.energy().strain[-1]), rel=1e-6)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("elements", [1, 3])
def test_a_falling_bar_that_is_caught_at_one_end_keeps_its_moment_of_momentum_about_it(elements, unit):
    """m v L / 2 before and after; only what the support exerts stops it. It was a third less with one element."""
    bar = bf.Beam(bf.Line((0, 0), (unit, 0)), elements, bf.CRBF(1), bf.Rectangle(0.1 * unit, 0.1 * unit), STEEL)
    model = bf.Model([bar], [bf.Pin(bar.start)])
    caught = bf.simulate(model, 1e-6, 1e-6, velocity=bf.RigidVelocity((0.0, -2.0 * unit)))
    mass = 7800.0 * 0.01 * unit**3
    assert caught.angular_momentum()[0] == pytest.approx(-mass * 2.0 * unit * unit / 2.0, rel=1e-12)
    assert caught.energy().kinetic[0] < 0.5 * mass * (2.0 * unit) ** 2
    if elements == 1:  # r turns about the pin, with no inertia of rotating sections in its way
        assert caught.velocity(bar.end)[0, 1] == pytest.approx(-3.0 * unit, rel=1e-12)


def test_a_bar_that_is_caught_by_an_inclined_roller_keeps_its_momentum_along_it():
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.1, 0.1), STEEL)
    model = bf.Model([bar], [bf.Roller(bar.start, (3, 4))])
    caught = bf.simulate(model, 1e-6, 1e-6, velocity=bf.RigidVelocity((1.0, -2.0)))
    along = np.array([0.8, -0.6])
    assert caught.velocity(bar.start)[0] @ [0.6, 0.8] == pytest.approx(0.0, abs=1e-12)
    assert caught.linear_momentum()[0] @ along == pytest.approx(78.0 * (along @ [1.0, -2.0]), rel=1e-12)


@pytest.mark.parametrize("way", ["ux", "uy", "rotation"])
@pytest.mark.parametrize(("elements", "order"), [(1, 1), (2, 2)])
def test_a_support_that_sets_off_at_once_does_what_it_does_a_little_later(way, elements, order):
    """The first node alone had its velocity: one element moved by twice as much as after a corner of the function."""
    step, later = 1e-6, 20

    def tip(begin):
        post = bf.Beam(bf.Line((0, 0), (0, 1)), elements, bf.CRBF(order), bf.Rectangle(0.05, 0.05), STEEL)
        moved = {"ux": 0.0, "uy": 0.0, "rotation": 0.0, way: lambda t: 0.1 * max(t - begin, 0.0)}
        model = bf.Model([post], [bf.Prescribed(post.start, **moved)])
        motion = bf.simulate(model, begin + 500 * step, step, bf.GeneralizedAlpha(1.0))
        return motion.displacement(post.end)

    at_once, after = tip(0.0), tip(later * step)[later:]
    assert np.abs(at_once - after).max() < 1e-3 * np.abs(after).max()


def test_a_link_between_bars_passes_an_impact_on():
    """Two bars in a row on an undeformable link: stopping one end stops what momentum says, and the link holds."""
    left, right = (bf.Beam(bf.Line((x, 0), (x + 1, 0)), 1, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL) for x in (0, 2))
    link = RigidLink(left.end, right.start)
    model = bf.Model([left, right], [bf.Pin(left.start)], connectors=[link])
    caught = bf.simulate(model, 1e-6, 1e-6, velocity=bf.RigidVelocity((-1.0, 0.0)))
    u = [caught.velocity(point)[0, 0] for point in (left.start, left.end, right.start, right.end)]
    # changes c: c1 + 2 c2 + 2 c3 + c4 = 0 and c3 + 2 c4 = 0, times m / 6, with c1 = 1 and c2 = c3
    assert u == pytest.approx([0.0, -9.0 / 7.0, -9.0 / 7.0, -6.0 / 7.0], abs=1e-9)


def test_an_impact_of_a_stretched_bar_keeps_its_digits():
    """Momentum is found beside forces of 1e7 N, though the velocity is 1e-9 m/s: m v L / 2 about the pin, as above."""
    bar = bf.Beam(bf.Line((0, 0), (0.6, 0.8)), 1, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL)
    held = [bf.Pin(bar.start), bf.Roller(bar.end, (-0.8, 0.6))]
    pulled = bf.solve_static(bf.Model([bar], held, [bf.PointForce(bar.end, (0.6e7, 0.8e7))]))
    length = float(np.linalg.norm(pulled.position(bar.end)[-1]))
    model = bf.Model([bar], [bf.Pin(bar.start)])
    caught = bf.simulate(model, 1e-9, 1e-9, start=pulled[-1], velocity=bf.RigidVelocity((0.8e-9, -0.6e-9)))
    assert caught.angular_momentum()[0] == pytest.approx(-78.0 * 1e-9 * length / 2.0, rel=1e-7)


def test_impulses_of_multipliers_are_no_velocities():
    left, right = (bf.Beam(bf.Line((x, 0), (x + 1, 0)), 1, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL) for x in (0, 2))
    link = RigidLink(left.end, right.start)
    system = System(bf.Model([left, right], [bf.Pin(left.start)], connectors=[link]), static=False)
    change = np.zeros(system.model.size)
    change[system.prescribed_dofs[0]] = 1.0
    found = impact(system, system.reference.copy(), change)
    assert np.abs(found).max() > 0.1
    assert found[system.connectors.multipliers] == 0.0
