"""Links: conditions with a multiplier, in statics and motions."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import system_of
from tests.connectors import (
    AREA,
    BENDING,
    KINDS,
    PointMass,
    RigidLink,
    SpringDamper,
    beam,
    cantilever,
    crossbar,
    portal,
)

names = pytest.mark.parametrize("element", KINDS, ids=lambda element: element.name)


@names
def test_tangents_are_derivatives_of_the_residual(element):
    one, two = beam(element), beam(element, (0.0, 0.5), (1.0, 0.8))
    model = bf.Model(
        [one, two],
        [bf.Clamp(one.start), bf.Clamp(two.start)],
        connectors=[
            SpringDamper(one.end, two.at(0.5), 1e3, 2.0),
            RigidLink(one.at(0.5), two.end),
            PointMass(two.end, 0.3),
        ],
    )
    system, rng = system_of(model, static=True), np.random.default_rng(1)
    p, step, zeros = system.reference, np.zeros(model.size), np.zeros(model.size)
    p = p + 1e-3 * rng.standard_normal(model.size)
    step[system.free_dofs] = rng.standard_normal(len(system.free_dofs))
    tangent = linearise(system, p, zeros, zeros, 1.0, STATICS)[1].sparse(system.rotated)
    ends = [residual(system, p + side * 1e-6 * step, zeros, zeros, 1.0) for side in (1.0, -1.0)]
    differences = ((ends[0] - ends[1]) / 2e-6)[system.free_dofs]
    assert tangent @ step[system.free_dofs] == pytest.approx(differences, abs=1e-6 * np.abs(differences).max())


@pytest.mark.parametrize("turn", [0.0, 0.7, 3.0])
def test_a_column_that_only_a_link_holds_stands(turn):
    left, right, model = portal(turn)
    solution = bf.solve_static(model)
    heads = solution.position(left.end)[-1], solution.position(right.end)[-1]
    assert np.linalg.norm(heads[1] - heads[0]) == pytest.approx(2.0, rel=1e-11)
    pull = solution.multipliers(model.connectors[0])[-1, 0] * (heads[1] - heads[0]) / 2.0
    # the column on the pin is a pendulum: no moment about its foot
    foot, load = solution.position(right.start)[-1], 0.5 * BENDING * np.array([np.cos(turn), np.sin(turn)])
    arm, net = heads[1] - foot, load - pull
    assert abs(arm[0] * net[1] - arm[1] * net[0]) < 1e-7 * BENDING
    reaction = solution.reaction(left.start)[-1]
    assert reaction[:2] == pytest.approx(-pull, abs=1e-6 * BENDING)
    assert solution.stability[-1]
    alone = bf.solve_static(cantilever(left, [bf.PointForce(left.end, tuple(pull))]))
    assert alone.position(left.end)[-1] == pytest.approx(heads[0], abs=1e-8)


def test_a_column_on_a_link_sways_at_its_critical_load():
    """The column on the pin carries N down: its link pulls the cantilever aside by N / L, against 3 EI / L^3.

    It shortens, which tilts the link: the bifurcation is imperfect by 1e-10 of the length.
    """
    swayed = []
    for size in (2.98, 3.02):
        _, right, model = portal()
        down = [bf.PointForce(right.end, (0.0, -size * BENDING))]
        solution = bf.solve_static(bf.Model(model.beams, model.supports, down, connectors=model.connectors))
        swayed.append(abs(float(solution.displacement(right.end)[-1, 0])))
        assert solution.stability[-1]
    assert swayed[0] < 1e-6
    assert swayed[1] > 0.02


def test_without_its_link_the_column_can_move():
    _, _, model = portal()
    with pytest.raises(bf.FreeMotionError, match="beam 1 can move freely"):
        bf.solve_static(bf.Model(model.beams, model.supports, model.loads))


def test_a_link_to_a_support_that_begins_to_move_is_met():
    one, two = beam(elements=2), beam(start=(0.0, 0.5), end=(1.0, 0.5), elements=2)
    moving = bf.Prescribed(two.start, ux=0.0, uy=lambda t: 2.5 * t * t, rotation=0.0)
    model = bf.Model([one, two], [bf.Clamp(one.start), moving], connectors=[RigidLink(one.end, two.start)])
    motion = bf.simulate(model, 0.05, 1e-3)
    gap = np.linalg.norm(motion.position(one.end) - motion.position(two.start), axis=1)
    assert np.abs(gap - gap[0]).max() < 1e-10


@pytest.mark.parametrize("turn", [0.0, 1.0])
def test_a_link_in_motion_keeps_its_length_and_the_energy(turn):
    """Of nearly rigid arms it is a pendulum: w' = -g (2 m L / 2 + M L) cos(angle) / (2 m L^2 / 3 + M L^2)."""
    two, model = crossbar(RigidLink, turn)
    motion = bf.simulate(model, 0.4, 5e-4)
    one = model.beams[0]
    gap = np.linalg.norm(motion.position(two.end) - motion.position(one.end), axis=1)
    assert np.abs(gap - 0.5).max() < 1e-10
    total = motion.energy().total
    assert np.abs(total - total[0]).max() < 2e-4 * np.ptp(motion.energy().potential)
    assert motion.energy_drift is not None
    mass = 7800.0 * AREA
    speed = 9.81 * (mass + 0.3) / (2 * mass / 3 + 0.3)

    def fall(_, state):
        return state[1], -speed * np.cos(state[0])

    angle = solve_ivp(fall, (0.0, 0.4), (0.0, 0.0), rtol=1e-9, atol=1e-12).y[0, -1]
    moved = motion.position(two.end)[-1] - motion.position(two.start)[-1]
    assert np.arctan2(moved[1], moved[0]) - turn == pytest.approx(angle, abs=2e-3)
    # the bar's force: it carries what one arm needs more than gravity gives it, of either sign
    assert np.ptp(motion.multipliers(model.connectors[0])) > 0.1


def test_multipliers_of_a_motion_converge_with_the_square_of_the_step():
    found = []
    for step in (4e-3, 2e-3, 1e-3):
        _, model = crossbar(RigidLink)
        motion = bf.simulate(model, 0.2, step, integrator=bf.GeneralizedAlpha(0.6))
        found.append((motion.p[-1, -1], *motion.position(model.beams[1].end)[-1]))
    coarse, fine = np.abs(np.diff(found, axis=0))
    assert np.all(fine < 0.35 * coarse)


def test_a_stiff_spring_moves_like_a_link():
    two, linked = crossbar(RigidLink)
    three, sprung = crossbar(lambda a, b: SpringDamper(a, b, stiffness=1e8))
    motions = [
        bf.simulate(model, 0.2, 5e-4).position(point)[-1] for model, point in ((linked, two.end), (sprung, three.end))
    ]
    assert motions[1] == pytest.approx(motions[0], abs=1e-5)


def test_a_motion_with_a_link_goes_on_where_another_one_ended():
    """Velocities satisfy conditions to the order of the step only; what they are off by is lost as in an impact."""
    two, model = crossbar(RigidLink)
    whole = bf.simulate(model, 0.2, 1e-3)
    half = bf.simulate(model, 0.1, 1e-3)
    rest = bf.simulate(model, 0.1, 1e-3, start=half)
    assert rest.position(two.end)[-1] == pytest.approx(whole.position(two.end)[-1], abs=2e-5)


def test_a_link_that_is_set_between_moving_points_stops_their_distance_at_once():
    """Two free masses on light beams of gradients: momentum stays, and half of the energy of the relative motion."""
    one, other = (beam(bf.ANCF(), (x, 0.0), (x + 1.0, 0.0), 1) for x in (0.0, 2.0))
    free = bf.Model([one, other])
    flight = bf.simulate(free, 1e-3, 1e-3, velocity=lambda at: (1.0, 0.0) if at[0] < 1.5 else (0.0, 0.0))
    linked = bf.Model([one, other], connectors=[RigidLink(one.end, other.start)])
    motion = bf.simulate(linked, 1e-4, 1e-5, start=flight[0])
    apart = motion.velocity(other.start)[0] - motion.velocity(one.end)[0]
    assert apart[0] == pytest.approx(0.0, abs=1e-12)
    assert motion.linear_momentum()[:, 0] == pytest.approx(
        np.full(len(motion), flight.linear_momentum()[0, 0]), rel=1e-9
    )
    assert motion.energy().kinetic[0] < flight.energy().kinetic[0]
