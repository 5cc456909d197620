"""Forces that joints transmit: section forces beside them, balance where beams meet, rigid bodies, conditions."""

import numpy as np
import pytest
import pyvista
from rigid_rods import AREA, DENSITY, DEPTH, LENGTHS, double_pendulum
from scipy.integrate import solve_ivp

import beamfem as bf

SECTION = bf.Rectangle(0.1, 0.1)
STEEL = bf.Material(1.2e5, 0.3, 10.0)
EI = 1.2e5 * SECTION.second_moment


def line(start, end, element=None, elements=4, **other):
    return bf.Beam(bf.Line(start, end), elements, element or bf.CRBF(3), SECTION, STEEL, **other)


def in_axes(solution, point, angle):
    """Force of the part towards the beam's end on a cut just behind its start, or before its end, in global axes."""
    forces = solution.section_forces(point.beam)
    station = 0 if point.fraction == 0.0 else -1
    turned = solution.rotation(point) + angle
    normal, shear = forces.normal[:, station], forces.shear[:, station]
    c, s = np.cos(turned), np.sin(turned)
    return np.column_stack([c * normal - s * shear, s * normal + c * shear, forces.moment[:, station]])


@pytest.mark.parametrize("kind", [bf.Hinge, bf.Rigid])
@pytest.mark.parametrize("backwards", [False, True])
def test_joint_force_is_the_section_force_beside_it(element, kind, backwards):
    column = line((0, 0), (0, 1), element)
    bar = line((1, 1.2), (0, 1), element) if backwards else line((0, 1), (1, 1.2), element)
    inner, outer = (bar.end, bar.start) if backwards else (bar.start, bar.end)
    joint = kind(column.end, inner)
    loads = [bf.DistributedLoad(bar, (0.0, -2.0 * EI)), bf.PointForce(outer, (0.3 * EI, 0.0))]
    supports = [bf.Clamp(column.start), bf.Roller(outer)]
    model = bf.Model([column, bar], supports, loads, [joint])
    for solution in (bf.solve_static(model), bf.simulate(model, duration=0.05, step=1e-3, save_every=10)):
        force = solution.joint_force(joint)
        scale = np.abs(force).max()
        beside = in_axes(solution, column.end, np.pi / 2)
        assert force == pytest.approx(-beside, abs=1e-6 * scale)
        along = -in_axes(solution, inner, np.arctan2(0.2, 1.0) + np.pi * backwards) * (-1 if backwards else 1)
        assert force[:, :2] == pytest.approx(along[:, :2], abs=1e-6 * scale)
        assert force[:, 2] == pytest.approx(along[:, 2], abs=1e-6 * scale)
        assert kind is bf.Rigid or not force[:, 2].any()


def crossing(kinds, extra=()):
    """Three beams that meet at the origin, with a load, a spring and a mass there."""
    beams = [line(end, (0, 0)) for end in ((-1, 0), (1, 0.3), (0.2, 1))]
    joints = [kinds[0](beams[0].end, beams[1].end), kinds[1](beams[1].end, beams[2].end)]
    loads = [
        bf.PointForce(beams[1].end, (0.4 * EI, -0.9 * EI), follower=True),
        bf.PointMoment(beams[2].end, 0.2 * EI),
        bf.Gravity((0.3, -9.81)),
    ]
    supports = [bf.Clamp(beams[0].start), bf.Pin(beams[2].start), bf.Spring(beams[2].end, (0.0, EI), 0.3 * EI)]
    masses = [bf.RigidBody(beams[1].end, 0.4, 0.01, (0.1, 0.0))]
    return bf.Model(beams, supports, loads, joints, masses=masses, connectors=extra)


@pytest.mark.parametrize("kinds", [(bf.Rigid, bf.Rigid), (bf.Hinge, bf.Rigid), (bf.Rigid, bf.Hinge)])
def test_joint_forces_balance_what_acts_on_each_beam_where_three_meet(kinds):
    model = crossing(kinds)
    first, second, third = model.beams
    for solution in (bf.solve_static(model), bf.simulate(model, duration=0.1, step=1e-3, save_every=5)):
        one, other = (solution.joint_force(joint) for joint in model.joints)
        scale = np.abs(one).max() + np.abs(other).max()
        assert one == pytest.approx(-in_axes(solution, first.end, 0.0), abs=1e-7 * scale)
        factor = (solution.at if solution.static else np.ones(len(solution)))[:, None]
        moment = factor * np.array([0.0, 0.0, 0.2 * EI])
        spring = -EI * solution.displacement(third.end)[:, 1], -0.3 * EI * solution.rotation(third.end)
        held = np.column_stack([np.zeros(len(solution)), *spring])
        cut = in_axes(solution, third.end, np.arctan2(-1.0, -0.2))
        assert other + moment + held == pytest.approx(cut, abs=1e-7 * scale)
        turn = solution.rotation(second.end)
        c, s = np.cos(turn), np.sin(turn)
        follower = factor * EI * np.column_stack([0.4 * c + 0.9 * s, 0.4 * s - 0.9 * c, 0.0 * c])
        body = solution.connector_force(model.masses[0])[:, 0]
        cut = in_axes(solution, second.end, np.arctan2(-0.3, -1.0))
        assert one - other + follower + body == pytest.approx(cut, abs=1e-7 * scale)


def test_joints_in_a_loop_have_no_force_of_their_own():
    beams = [line(end, (0, 0)) for end in ((-1, 0), (1, 0.3), (0.2, 1))]
    ends = [beam.end for beam in beams]
    joints = [bf.Rigid(ends[0], ends[1]), bf.Rigid(ends[1], ends[2]), bf.Hinge(ends[0], ends[2])]
    solution = bf.solve_static(bf.Model(beams, [bf.Clamp(beams[0].start)], [bf.Gravity((0, -1))], joints))
    with pytest.raises(bf.InputError, match=r"other joints connect the points of Rigid at .* by n - 1 joints"):
        solution.joint_force(joints[0])
    with pytest.raises(bf.InputError, match=r"is neither a joint, a motor nor a connector .* model\.joints"):
        solution.joint_force(bf.Rigid(ends[0], ends[1]))


def test_hinge_and_conditions_transmit_the_same_force():
    """Shared coordinates and the multipliers of a short link, each against the other beam's reaction."""
    left, right, over = line((0, 0), (0, 1)), line((2, 0), (2, 1)), line((0, 1), (2, 1))
    feet, loads = [bf.Clamp(left.start), bf.Clamp(right.start)], [bf.PointForce(left.end, (0.2 * EI, 0.0))]
    link, hinges = bf.Link(left.end, right.end), [bf.Hinge(left.end, over.start), bf.Hinge(over.end, right.end)]
    tied = bf.solve_static(bf.Model([left, right], feet, loads, [link]))
    framed = bf.solve_static(bf.Model([left, right, over], feet, loads, hinges))
    (pull, held), (push, foot) = (
        (solution.joint_force(part)[:, :2], solution.reaction(right.start)[:, :2])
        for solution, part in ((tied, link), (framed, hinges[1]))
    )
    assert pull == pytest.approx(-held, rel=1e-6, abs=1e-8)
    assert push == pytest.approx(-foot, rel=1e-6, abs=1e-8)
    assert framed.joint_force(hinges[0]) == pytest.approx(framed.joint_force(hinges[1]), rel=1e-6, abs=1e-8)


def test_slider_transmits_what_its_second_party_needs():
    arm, rod = line((0, 0), (1, 0)), line((1, 0), (2, 0))
    slider = bf.Slider(arm.end, rod.start, axis=(1, 0))
    loads = [bf.PointForce(rod.end, (0.0, -0.1 * EI))]
    model = bf.Model([arm, rod], [bf.Clamp(arm.start), bf.Prescribed(rod.start, ux=0.3)], loads, [slider])
    force, moved = bf.solve_static(model), slider
    own, needed = force.joint_force(moved)[-1], -in_axes(force, rod.start, 0.0)[-1]
    assert own[2] == pytest.approx(needed[2], rel=1e-7)
    assert own[1] == pytest.approx(0.1 * EI, rel=1e-7)


def test_double_pendulum_of_stiff_beams_is_that_of_rigid_rods():
    section, stiff = bf.Rectangle(0.01, DEPTH), bf.Material(2.1e14, 0.3, DENSITY)
    upper = bf.Beam(bf.Line((0, 0), (1.0, 0)), 1, bf.CRBF(3), section, stiff)
    lower = bf.Beam(bf.Line((1.0, 0), (1.7, 0)), 1, bf.CRBF(3), section, stiff)
    hinge = bf.Hinge(upper.end, lower.start)
    model = bf.Model([upper, lower], [bf.Pin(upper.start)], [bf.Gravity((0, -9.81))], [hinge])
    motion = bf.simulate(model, duration=1.0, step=1e-4, save_every=250, integrator=bf.GeneralizedAlpha(0.0))
    rods = solve_ivp(double_pendulum, (0, 1), [0.0, 0.0, 0.0, 0.0], "DOP853", motion.time, rtol=1e-12, atol=1e-12)
    for beam, angle in zip(model.beams, rods.y[:2], strict=True):
        assert motion.rotation(beam.start) == pytest.approx(angle, abs=1e-5)
    rates = np.array([double_pendulum(0.0, state)[2:] for state in rods.y.T]).T
    (first, second), (w1, w2), (l1, l2) = rods.y[:2], rods.y[2:], LENGTHS
    along, across = np.array([np.cos(first), np.sin(first)]), np.array([-np.sin(first), np.cos(first)])
    below, beside = np.array([np.cos(second), np.sin(second)]), np.array([-np.sin(second), np.cos(second)])
    centre = l1 * (rates[0] * across - w1**2 * along) + 0.5 * l2 * (rates[1] * beside - w2**2 * below)
    force = DENSITY * AREA * l2 * (centre.T + np.array([0.0, 9.81]))
    later = slice(2, None)  # rods that are let go at once vibrate at first
    assert motion.joint_force(hinge)[later, :2] == pytest.approx(force[later], abs=1e-5 * np.abs(force).max())


def test_forces_of_parts_in_tables_and_paraview_files_are_in_balance(tmp_path):
    """On each beam of a motion: its supports, joints and connectors, and its inertia and weight."""
    one, two = (line((x, 0), (x + 1, 0)) for x in (0.0, 1.0))
    hinge, spring = bf.Hinge(one.end, two.start), bf.SpringDamper(two.end, (2.0, 1.0), 200.0)
    motor = bf.Motor(hinge, angle=lambda time: time**2)
    model = bf.Model([one, two], [bf.Pin(one.start)], [bf.Gravity((0, -9.81)), motor], [hinge], connectors=[spring])
    motion = bf.simulate(model, duration=0.1, step=2.5e-4)
    table = motion.to_pandas(forces=True)
    last = table.xs(motion.at[-1], level="time")
    assert list(last["kind"]) == ["Pin", "SpringDamper", "Motor", "Motor", "Hinge", "Hinge"]
    assert list(last["role"]) == ["support"] + 5 * ["connector"]
    numbers = last[["fx", "fy", "moment"]].to_numpy()
    assert numbers[5] == pytest.approx(motion.joint_force(hinge)[-1])
    assert numbers[3] == pytest.approx(motion.joint_force(motor)[-1])
    assert numbers[[2, 4]] == pytest.approx(-numbers[[3, 5]])
    assert last[["x", "y"]].to_numpy()[5] == pytest.approx(motion.position(two.start)[-1])
    momentum = motion.linear_momentum()
    gained = np.gradient(momentum[:, 1], motion.at)[-2]
    acting = table.xs(motion.at[-2], level="time")["fy"]
    assert acting.sum() - 9.81 * model.mass == pytest.approx(gained, abs=1e-3 * abs(acting).max())
    motion[-1:].to_vtk(tmp_path / "a.pvd")
    vertices = pyvista.read(next((tmp_path / "a_boundary").iterdir()))
    assert vertices.point_data["force"][-1, :2] == pytest.approx(numbers[5, :2], rel=1e-5)
    assert vertices.point_data["moment"][-3] == pytest.approx(numbers[3, 2], rel=1e-5)


@pytest.mark.parametrize("grounded", [True, False])
def test_the_tension_of_a_cable_is_drawn_and_named_where_multipliers_are_asked_for(grounded):
    post, mast = line((0, 0), (1, 0)), line((1, 2), (2, 2))
    stay = bf.Cable(post.end, (1.0, 2.0) if grounded else mast.start, stiffness=1e4, pretension=5.0)
    supports = [bf.Clamp(post.start), bf.Clamp(mast.start)]
    load = bf.PointForce(post.end, (0.0, -50.0))
    solution = bf.solve_static(bf.Model([post, mast], supports, [load], connectors=[stay]), steps=3)
    length = np.linalg.norm((1.0, 2.0) - solution.position(post.end), axis=1)
    tension = 1e4 * (length - (2.0 - 5e-4))
    assert tension[-1] > 40.0
    force = solution.joint_force(stay)
    assert np.hypot(*force[:, :2].T) == pytest.approx(tension)
    assert (force[:, 1] < 0.0).all()  # on the upper end
    figure = solution.plot_curve("load_factor", ("tension", stay))
    (curve,) = figure.axes[0].lines
    assert curve.get_ydata() == pytest.approx(tension)
    assert figure.axes[0].get_ylabel() == "tension of Cable [N]"
    assert solution.plot_curve("load_factor", ("fy", stay)).axes[0].lines[0].get_ydata() == pytest.approx(force[:, 1])
    with pytest.raises(bf.InputError, match=r"Cable has no multipliers.*solution\.joint_force\(part\)"):
        solution.multipliers(stay)
    with pytest.raises(bf.InputError, match="is no 'mean' of a Cable"):
        solution.plot_curve("load_factor", ("mean", stay))
