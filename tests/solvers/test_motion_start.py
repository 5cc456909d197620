"""What a motion starts from: velocities, accelerations, states of other models."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import beam

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SQUARE = bf.Rectangle(0.01, 0.01)


def straight(element, elements, start=(0.0, 0.0), end=(1.0, 0.0)):
    return bf.Beam(bf.Line(start, end), elements, element, SQUARE, STEEL)


@pytest.mark.parametrize("stretchable", [True, False])
@pytest.mark.parametrize("elements", [1, 2, 4])
def test_a_velocity_field_turns_sections_that_have_no_shear(stretchable, elements):
    """Kinetic energy of a rigid turn was 1.114, 1.029 and 1.007 of the exact one."""
    one = straight(bf.ShearRigid(stretchable=stretchable), elements, end=(0.6, 0.8))
    field = bf.simulate(bf.Model([one]), 1e-6, 1e-6, velocity=lambda x: (-3.0 * x[1], 3.0 * x[0]))
    mass = 7800.0 * 1e-4
    exact = 0.5 * 9.0 * mass * (1.0 / 3.0 + 1e-4 / 12.0)
    assert field.energy().kinetic[0] == pytest.approx(exact, rel=1e-12)


def test_a_velocity_field_stretches_sections_that_can_be():
    one = straight(bf.ShearRigid(), 2)
    state = bf.simulate(bf.Model([one]), 1e-6, 1e-6, velocity=lambda x: (x[0] ** 2, 0.0))[0]
    mesh = state.model.mesh_of(one.start)
    rates = [state.v[mesh.coordinates_of(node)["s"]] for node in range(3)]
    assert rates == pytest.approx([0.0, 1.0, 2.0], abs=1e-10)


@pytest.mark.parametrize("elements", [1, 2, 5])
def test_slopes_of_a_velocity_field_are_exact_at_the_ends_as_well(elements):
    """v = x^2 gave 1.5 instead of 2 at the end of two elements; the field is asked on the beam only."""
    asked = []

    def field(x):
        asked.append(x[0])
        return (0.0, x[0] ** 2)

    one = straight(bf.ANCF(), elements)
    state = bf.simulate(bf.Model([one]), 1e-6, 1e-6, velocity=field)[0]
    mesh = state.model.mesh_of(one.start)
    slopes = [state.v[mesh.coordinates_of(node)["r_x^y"]] for node in range(mesh.nodes)]
    assert slopes == pytest.approx(2.0 * mesh.arc, abs=1e-10)
    assert min(asked) >= 0.0
    assert max(asked) <= 1.0 + 1e-12


def test_slopes_of_a_velocity_field_are_by_knots_where_elements_are():
    """r_x is the derivative by the mesh coordinate, which a spline runs through at another speed."""
    spline = bf.BSpline(3, (0, 0, 0, 0, 1, 1, 1, 1), ((0, 0), (0.1, 0), (0.5, 0), (1, 0)))
    one = bf.Beam(spline, "knots", bf.ANCF(), SQUARE, STEEL)
    state = bf.simulate(bf.Model([one]), 1e-6, 1e-6, velocity=lambda x: (0.0, 3.0 * x[0]))[0]
    rigid = bf.simulate(bf.Model([one]), 1e-6, 1e-6, velocity=bf.RigidVelocity(angular=3.0))[0]
    mesh = state.model.mesh_of(one.start)
    for node in range(mesh.nodes):
        dof = mesh.coordinates_of(node)["r_x^y"]
        assert state.v[dof] == pytest.approx(rigid.v[dof], rel=1e-9)


def test_a_spinning_beam_without_shear_starts_with_the_acceleration_of_its_spin():
    """Found by mutation: velocity terms left out of the first acceleration went unnoticed."""
    one = straight(bf.ShearRigid(), 2, start=(-0.5, 0.0), end=(0.5, 0.0))
    state = bf.simulate(bf.Model([one]), 1e-6, 1e-6, velocity=bf.RigidVelocity(angular=10.0))[0]
    mesh = state.model.mesh_of(one.start)
    # an unstretched rigid body would have -w^2 x; the free beam is not held together yet, so it has none
    for node in range(3):
        names = mesh.coordinates_of(node)
        assert abs(state.a[names["r^x"]]) < 1e-6
        # s (cos, sin) turns without a force only if s'' = s theta'^2
        assert state.a[names["s"]] == pytest.approx(100.0, rel=1e-6)
        assert abs(state.a[names["theta"]]) < 1e-6


def test_a_spring_acts_on_the_first_acceleration():
    """Found by mutation: a rigid body on a spring starts with -k u / m, in every way to carry it."""
    one = straight(bf.CRBF(1), 1)
    springs = [bf.Spring(point, stiffness=(50.0, 0.0)) for point in (one.start, one.end)]
    moved = bf.simulate(bf.Model([one]), 0.1, 0.1, velocity=bf.RigidVelocity((1.0, 0.0)))[-1]
    state = bf.simulate(bf.Model([one], springs), 1e-6, 1e-6, start=moved, velocity=bf.RigidVelocity())[0]
    mesh = state.model.mesh_of(one.start)
    found = [state.a[mesh.coordinates_of(node)["r^x"]] for node in (0, 1)]
    assert found == pytest.approx([-100.0 * 0.1 / (7800.0 * 1e-4)] * 2, rel=1e-9)


def test_a_start_is_put_back_onto_the_plane_of_an_inclined_roller():
    """Found by mutation: it has slid by 0.1 m along the plane, and lies half of what is tolerated beside it."""
    one = straight(bf.CRBF(2), 2)
    slid = bf.RigidVelocity((0.8 + 0.6 * 5e-7, -0.6 + 0.8 * 5e-7))
    moved = bf.simulate(bf.Model([one]), 0.1, 0.1, velocity=slid)[-1]
    state = bf.simulate(bf.Model([one], [bf.Roller(one.start, (3, 4))]), 1e-6, 1e-6, start=moved)
    assert state.displacement(one.start)[0] == pytest.approx([0.08, -0.06], abs=1e-15)
    assert state.velocity(one.start)[0] @ [3.0, 4.0] == pytest.approx(0.0, abs=1e-15)


def two_beams():
    return straight(bf.CRBF(2), 2), straight(bf.CRBF(2), 2, (0.0, 1.0), (1.0, 1.0))


def test_a_start_knows_its_beams_in_any_order():
    """With [b, a] for [a, b] each beam started where the other was, 1 m away."""
    a, b = two_beams()
    bent = bf.solve_static(
        bf.Model([a, b], [bf.Clamp(a.start), bf.Clamp(b.start)], [bf.PointForce(a.end, (0.0, 10.0))])
    )
    swapped = bf.simulate(bf.Model([b, a], [bf.Clamp(a.start), bf.Clamp(b.start)]), 1e-6, 1e-6, start=bent[-1])
    for one in (a, b):
        assert swapped.displacement(one.end)[0] == pytest.approx(bent.displacement(one.end)[-1], abs=1e-14)
    assert swapped.energy().strain[0] == pytest.approx(bent.energy().strain[-1], rel=1e-9)


def test_a_start_from_a_copy_of_the_model_is_matched_by_where_its_beams_lie():
    a, b = two_beams()
    c, d = two_beams()
    bent = bf.solve_static(
        bf.Model([a, b], [bf.Clamp(a.start), bf.Clamp(b.start)], [bf.PointForce(a.end, (0.0, 10.0))])
    )
    copied = bf.simulate(bf.Model([d, c], [bf.Clamp(c.start), bf.Clamp(d.start)]), 1e-6, 1e-6, start=bent[-1])
    assert copied.displacement(c.end)[0] == pytest.approx(bent.displacement(a.end)[-1], abs=1e-14)


OTHERS = {
    "moved": straight(bf.CRBF(2), 2, (0.0, 0.5), (1.0, 0.5)),
    "turned": straight(bf.CRBF(2), 2, (0.0, 0.0), (0.6, 0.8)),
    "turned round": straight(bf.CRBF(2), 2, (1.0, 0.0), (0.0, 0.0)),
    "of another mesh": straight(bf.CRBF(2), 3),
    "of unequal elements": bf.Beam(bf.Line((0, 0), (1, 0)), [0.0, 0.4, 1.0], bf.CRBF(2), SQUARE, STEEL),
    "of other vectors": straight(bf.ANCF(), 2),
}


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS)
def test_a_start_of_other_beams_is_refused_by_name(other):
    a, b = two_beams()
    state = bf.simulate(bf.Model([a, b]), 1e-3, 1e-3)[-1]
    with pytest.raises(bf.InputError, match=r"start does not have the \d nodes of .* on beam 1 from"):
        bf.simulate(bf.Model([b, other]), 1e-3, 1e-3, start=state)


def test_a_start_with_a_beam_too_many_is_refused_by_name():
    a, b = two_beams()
    state = bf.simulate(bf.Model([a, b]), 1e-3, 1e-3)[-1]
    with pytest.raises(bf.InputError, match=r"this model does not have the 5 nodes of CRBF-2 on beam 0 from \(0, 0\)"):
        bf.simulate(bf.Model([b]), 1e-3, 1e-3, start=state)


FORCE = (0.0, 5.0)
NODES_APART = {
    "a load is gone": (lambda b: [bf.PointForce(b.at(0.3), FORCE)], lambda b: [], 0.3, "PointForce", "this model"),
    "an end of elements was moved to it": (
        lambda b: [bf.PointForce(b.at(0.501), FORCE)],
        lambda b: [],
        0.501,
        "PointForce",
        "this model",
    ),
    "a load begins inside": (
        lambda b: [bf.DistributedLoad(b, lambda s: (0.0, 1.0 if s > 0.3 else 0.0))],
        lambda b: [],
        0.3,
        "DistributedLoad",
        "this model",
    ),
    "a support comes": (
        lambda b: [bf.PointForce(b.end, FORCE)],
        lambda b: [bf.Spring(b.at(0.3), (1.0, 1.0))],
        0.3,
        "Spring",
        "the model of start",
    ),
}


def parts_of_a_rod(own, parts):
    loads = [part for part in parts if not isinstance(part, bf.Spring)]
    return bf.Model([own], [bf.Clamp(own.start), *(part for part in parts if part not in loads)], loads)


@pytest.mark.parametrize(("before", "after", "at", "part", "lacks"), NODES_APART.values(), ids=NODES_APART)
def test_a_start_whose_nodes_a_part_placed_names_it_and_what_keeps_them(before, after, at, part, lacks):
    """It told the numbers of nodes only, and to keep the supports, where a load was gone."""
    own, copy = straight(bf.CRBF(3), 4), straight(bf.CRBF(3), 4)
    state = bf.solve_static(parts_of_a_rod(own, before(own)))[-1]
    told = f"on beam 0 for {part} at fraction {at}, and {lacks} has none there; add a PointForce .* to {lacks}"
    for other in (own, copy):
        with pytest.raises(bf.InputError, match=told):
            bf.simulate(parts_of_a_rod(other, after(other)), 1e-4, 1e-4, start=state)
    # as it says
    kept = [bf.PointForce(own.at(at), (0.0, 0.0))]
    here, there = (kept, []) if lacks == "this model" else ([], kept)
    static = bf.solve_static(parts_of_a_rod(own, [*before(own), *there]))
    motion = bf.simulate(parts_of_a_rod(own, [*after(own), *here]), 1e-4, 1e-4, start=static[-1])
    assert motion.displacement(own.end)[0] == pytest.approx(static.displacement(own.end)[-1], abs=1e-15)


def test_of_many_points_that_placed_nodes_the_first_is_named():
    own = straight(bf.CRBF(3), 4)
    loads = [bf.PointForce(own.at(share), FORCE) for share in (0.1, 0.2, 0.3, 0.4, 0.6)]
    state = bf.solve_static(parts_of_a_rod(own, loads))[-1]
    with pytest.raises(bf.InputError, match=r"PointForce at fraction 0\.1, .* at this point to this model"):
        bf.simulate(parts_of_a_rod(own, []), 1e-4, 1e-4, start=state)


def test_a_motion_whose_duration_is_no_multiple_of_the_step_has_a_row_more():
    """Found by mutation: 1.1 / 0.1 is 11.000000000000002."""
    model = bf.Model([beam(bf.CRBF(1))])
    assert len(bf.simulate(model, 1.1, 0.1)) == 12
    assert len(bf.simulate(model, 1.05, 0.1)) == 12


def test_an_ancf_beam_is_rolled_up_backwards():
    """Found by mutation: a full turn back needs load steps that gradients can follow."""
    one = straight(bf.ANCF(), 24)
    hold = [bf.Clamp(one.start), bf.Prescribed(one.end, rotation=-2.0 * np.pi)]
    solution = bf.solve_static(bf.Model([one], hold))
    assert solution.rotation(one.at(0.5))[-1] == pytest.approx(-np.pi, abs=1e-2)
    stiffness = 2e11 * 1e-8 / 12.0 * 0.7 / (1.3 * 0.4)  # of the continuum
    assert solution.reaction(one.end)[-1, 2] == pytest.approx(-2.0 * np.pi * stiffness, rel=5e-2)


@pytest.mark.parametrize("rho_inf", [0.0, 0.3, 0.7, 0.9])
def test_a_stiff_mode_decays_by_the_spectral_radius_in_a_step(rho_inf, uncut_steps):
    """Found by mutation: alpha_m may be wrong and the order still two."""
    one = straight(bf.CRBF(1), 1)
    hold = [bf.Clamp(one.start), bf.Prescribed(one.end, uy=0.0, rotation=0.0)]
    pulled = bf.solve_static(bf.Model([one], hold, [bf.PointForce(one.end, (2e4, 0.0))]))
    with pytest.warns(bf.errors.EnergyWarning, match="rises by"):
        motion = bf.simulate(bf.Model([one], hold), 2.0, 0.1, bf.GeneralizedAlpha(rho_inf), start=pulled[-1])
    a = motion.a[:, motion.model.mesh_of(one.end).coordinates_of(1)["r^x"]]
    # all roots are -rho at infinite frequency, here 880 in a step
    left = a[4:8] + 3.0 * rho_inf * a[3:7] + 3.0 * rho_inf**2 * a[2:6] + rho_inf**3 * a[1:5]
    assert np.abs(left).max() < 1e-4 * np.abs(a[1:8]).max()


def test_a_long_motion_says_how_much_energy_it_lost():
    one = bf.Beam(
        bf.Line((0, 0), (1.2, 0)), 4, bf.ANCF(), bf.Section(1.6e-3, 8.533e-6), bf.Material(0.7e6, 0.3, 5540.0)
    )
    motion = bf.simulate(bf.Model([one], [bf.Pin(one.start)], [bf.Gravity((0, -9.81))]), 1.0, 1e-3)
    energy, drift = motion.energy(), motion.energy_drift
    assert drift.change == pytest.approx(energy.total[-1] - energy.total[0], rel=1e-12)
    assert drift.exchanged >= 0.99 * energy.kinetic.max()
    assert drift.digits == pytest.approx(np.log10(drift.exchanged / abs(drift.change)))
    assert f"energy drifts by {drift.change:.2g} J of" in repr(motion)


def test_the_energy_of_springs_and_foundations_is_part_of_the_balance():
    """A rigid body on both swings with no loss but that of the steps."""
    one = straight(bf.CRBF(1), 1)
    model = bf.Model([one], [bf.Foundation(one, (50.0, 0.0)), bf.Spring(one.start, (50.0, 0.0))])
    motion = bf.simulate(model, 0.5, 1e-3, bf.GeneralizedAlpha(1.0), velocity=bf.RigidVelocity((1.0, 0.0)))
    assert np.ptp(motion.energy().kinetic) > 0.3
    assert motion.energy_drift.digits > 4.0


def test_motions_that_something_drives_have_no_drift():
    one = straight(bf.CRBF(1), 1)
    push = bf.PointForce(one.end, (1.0, 0.0), amplitude=np.cos)
    for model in (
        bf.Model([one], loads=[push]),
        bf.Model([one], loads=[bf.PointForce(one.end, (1.0, 0.0), follower=True)]),
        bf.Model([one], [bf.Prescribed(one.start, ux=lambda t: t, uy=0.0)]),
    ):
        motion = bf.simulate(model, 1e-3, 1e-3)
        assert motion.energy_drift is None
        assert "drift" not in repr(motion)


def test_a_velocity_field_is_that_of_the_field_where_beams_are_joined():
    """Three beams share a node: its rates are the mean of what they say, which is one."""
    ends = [(1.0, 0.0), (0.0, 1.0), (-0.6, 0.8)]
    beams = [straight(bf.CRBF(2), 2, end=end) for end in ends]
    joints = [bf.Rigid(beams[0].start, other.start) for other in beams[1:]]
    motion = bf.simulate(bf.Model(beams, joints=joints), 1e-6, 1e-6, velocity=lambda x: (2.0 + x[1], 3.0 * x[0] - 1.0))
    for one, (x, y) in zip(beams, ends, strict=True):
        assert motion.velocity(one.start)[0] == pytest.approx([2.0, -1.0], abs=1e-12)
        assert motion.velocity(one.end)[0] == pytest.approx([2.0 + y, 3.0 * x - 1.0], abs=1e-12)


def test_a_start_from_gradients_that_thinned_keeps_the_stretch_of_the_axis():
    """Poisson contraction shortens r_y; the stretch along the section's normal is r_x itself."""
    pulled, tied = straight(bf.ANCF(), 2, end=(0.6, 0.8)), straight(bf.ShearRigid(), 2, end=(0.6, 0.8))
    force = 0.02 * STEEL.youngs_modulus * SQUARE.area
    load = bf.PointForce(pulled.end, (0.6 * force, 0.8 * force))
    bent = bf.solve_static(bf.Model([pulled], [bf.Clamp(pulled.start)], [load]))
    model = bf.Model([tied], [bf.Clamp(tied.start)])
    started = bf.simulate(model, 1e-7, 1e-7, start=bent[-1])
    for node in range(3):
        own, other = (solution.model.meshes[0].coordinates_of(node) for solution in (started, bent))
        r_x = np.hypot(*(bent.p[-1][other[name]] for name in ("r_x^x", "r_x^y")))
        assert r_x > 1.01
        assert started.p[0][own["s"]] == pytest.approx(r_x, rel=1e-9)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_a_start_whose_nodes_are_elsewhere_is_refused_in_any_unit_of_length(unit):
    """A millionth of the length is another place, whatever the length; a copy of the beam has the same places."""

    def model(middle):
        line, section = bf.Line((0, 0), (unit, 0)), bf.Rectangle(0.01 * unit, 0.01 * unit)
        own = bf.Beam(line, [0.0, middle, 1.0], bf.CRBF(2), section, STEEL)
        return bf.Model([own])

    state = bf.simulate(model(0.5), 1e-6, 1e-6)[-1]
    bf.simulate(model(0.5), 1e-6, 1e-6, start=state)
    with pytest.raises(bf.InputError, match="nodes elsewhere"):
        bf.simulate(model(0.5 + 1e-6), 1e-6, 1e-6, start=state)


@pytest.mark.parametrize("element", [bf.ShearRigid(), bf.ANCFCRBF()], ids=["shear-rigid", "rotation"])
def test_a_velocity_field_turns_the_sections_of_a_stretched_beam(element):
    """A rigid turn of a bar that is stretched by a fifth or so: theta' = r_x x v' / |r_x|^2."""
    rubber = bf.Material(1e6, 0.3, 1000.0)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, bf.Rectangle(0.01, 0.01), rubber)
    held = [bf.Pin(bar.start), bf.Roller(bar.end)]
    pulled = bf.solve_static(bf.Model([bar], held, [bf.PointForce(bar.end, (20.0, 0.0))]))
    stretch = float(pulled.position(bar.end)[-1, 0])
    assert stretch > 1.1
    free = bf.Model([bar])
    by_field, rigid = (
        bf.simulate(free, 1e-6, 1e-6, start=pulled[-1], velocity=velocity)[0].v
        for velocity in (lambda x: (0.0, 3.0 * stretch * x[0]), bf.RigidVelocity((0.0, 0.0), 3.0, (0.0, 0.0)))
    )
    mesh = free.meshes[0]
    names = (
        [name for name in mesh.coordinates_of(0) if name == "theta"]
        if isinstance(element.coordinates, bf.ShearFree)
        else []
    )
    columns = [mesh.coordinates_of(node)[name] for node in range(mesh.nodes) for name in ("r^x", "r^y", *names)]
    assert by_field[columns] == pytest.approx(rigid[columns], abs=1e-9)


def bent_at_once(element, elements, moment, step):
    """The tip of a steel cantilever, 0.1 s after a moment [N m] has begun to act on it."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, moment)])
    return bf.simulate(model, duration=0.1, step=step).displacement(beam.end)[-1]


@pytest.mark.parametrize("stretchable", [True, False])
@pytest.mark.parametrize(("moment", "elements"), [(60.0, 12), (100.0, 8), (100.0, 12), (120.0, 12)])
def test_shear_rigid_beams_bear_a_sudden_moment_in_long_steps(stretchable, moment, elements):
    """Their nodes carry mass that turns with them; without a mean acceleration they were thrown aside by up to 0.35 m.

    The reference has no shear-rigid nodes, and a tenth of the step.
    """
    expected = bent_at_once(bf.CRBF(3), 8, moment, 1e-4)
    found = bent_at_once(bf.ShearRigid(stretchable=stretchable), elements, moment, 1e-3)
    assert found == pytest.approx(expected, abs=0.012)


@pytest.mark.parametrize("kind", ["motor", "hinge", "with a link"])
def test_a_damper_at_a_stiff_arm_leaves_steps_of_second_order(kind):
    """A sudden torque and a damper act on a node of small inertia that the arm holds; it turns as a rigid body."""
    from scipy.integrate import solve_ivp

    steel, square = bf.Material(2.1e16, 0.3, 7850.0), bf.Rectangle(0.01, 0.01)
    arm, other = (bf.Beam(bf.Line((0, y), (0.5, y)), 1, bf.CRBF(3), square, steel) for y in (0.0, 1.0))
    stub = bf.Beam(bf.Line((-0.1, 0), (0, 0)), 1, bf.CRBF(2), square, steel)
    beams, supports, joints = [arm], [bf.Pin(arm.start)], []
    loads, connectors = [bf.Motor(arm.start, torque=lambda time, angle, speed: 40.0 * (0.7 - angle) - 2.0 * speed)], []
    if kind == "hinge":
        beams, supports, joints = (
            [stub, arm],
            [bf.Clamp(stub.start), bf.Clamp(stub.end)],
            [bf.Hinge(stub.end, arm.start)],
        )
        loads, connectors = [bf.PointMoment(arm.start, 28.0)], [bf.TorsionSpring(stub.end, arm.start, 40.0, 2.0)]
    elif kind == "with a link":
        beams, connectors = [arm, other], [bf.Link(arm.end, other.end)]
        supports = [bf.Pin(arm.start), bf.Pin(other.start)]
    model = bf.Model(beams, supports, loads, joints, connectors=connectors, masses=[bf.PointMass(arm.end, 1.0)])
    bar = 7850.0 * (1e-4 * 0.5**3 / 3 + 0.5 * 1e-8 / 12)
    inertia = 0.25 + (2.0 if kind == "with a link" else 1.0) * bar
    errors = []
    for step in (2e-3, 1e-3):
        motion = bf.simulate(model, duration=0.2, step=step)
        exact = solve_ivp(
            lambda t, y: [y[1], (28.0 - 40.0 * y[0] - 2.0 * y[1]) / inertia], (0, 0.2), [0, 0], rtol=1e-10, atol=1e-12
        )
        errors.append(abs(motion.rotation(arm.start)[-1] - exact.y[0, -1]))
    assert errors[1] < 3e-5
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.25)


def _with_friction(torque=0.1):
    one, other = (
        bf.Beam(bf.Line((x, 0.0), (x + 0.5, 0.0)), 2, bf.CRBF(2), SQUARE, bf.Material(2e9, 0.3, 1100.0))
        for x in (0.0, 0.5)
    )
    friction = bf.HingeFriction(one.end, other.start, torque=torque, stiffness=20.0)
    joint, weight = bf.Hinge(one.end, other.start), bf.Gravity((0.0, -9.81))
    return bf.Model([one, other], [bf.Clamp(one.start)], [weight], [joint], connectors=[friction])


@pytest.mark.parametrize("how", ["from a file", "of an equal model"])
def test_a_motion_goes_on_with_the_history_of_equal_parts(how, tmp_path):
    """The slip of a hinge began anew without a word, and the motion was off by 27 mm of 1 m."""
    whole = bf.simulate(_with_friction(), 1.6, 1e-3, bf.GeneralizedAlpha(1.0))
    begun = bf.simulate(_with_friction(), 1.5, 1e-3, bf.GeneralizedAlpha(1.0))
    if how == "from a file":
        begun.save(tmp_path / "begun.h5")
        begun = bf.load(tmp_path / "begun.h5")
    model = _with_friction()
    further = bf.simulate(model, 0.1, 1e-3, bf.GeneralizedAlpha(1.0), start=begun)
    slip, expected = (each.history(each.model.connectors[0])["slip"] for each in (further, whole))
    assert abs(expected[1500]) > 0.01
    assert slip == pytest.approx(expected[1500:], abs=1e-5)
    tip, expected = (each.position(each.model.beams[1].end) for each in (further, whole))
    assert tip == pytest.approx(expected[1500:], abs=1e-5)


def test_a_history_that_other_friction_does_not_continue_is_warned_of():
    begun = bf.simulate(_with_friction(), 1.5, 5e-3)
    lost = pytest.warns(UserWarning, match="what the HingeFriction.* remembers in start is lost")
    with lost, pytest.warns(bf.errors.EnergyWarning, match="falls by"):  # of the spring in which it sticks
        bf.simulate(_with_friction(torque=0.2), 5e-3, 5e-3, start=begun)


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF(), bf.ShearRigid()], ids=lambda element: element.label)
@pytest.mark.parametrize("joint", [bf.Hinge, bf.Rigid])
def test_a_start_that_a_joint_of_beams_would_move_is_refused(element, joint):
    """A hinge closed a gap of 24 mm at once, and a rigid joint a bend of 0.6 rad, with up to 19 kJ of strain."""
    first, second = straight(element, 2), straight(element, 2, (1.0, 0.0), (2.0, 0.0))
    hinged = {"joints": [bf.Hinge(first.end, second.start)]} if joint is bf.Rigid else {}
    before = bf.Model([first, second], [bf.Pin(first.start)], [bf.Gravity((0.0, -9.81))], **hinged)
    after = bf.Model(before.beams, before.supports, before.loads, [joint(first.end, second.start)])
    moved = bf.simulate(before, 0.05, 1e-3)
    with pytest.raises(bf.InputError, match=r"undeformed, would change beam [01] by .* at once"):
        bf.simulate(after, 1e-3, 1e-3, start=moved)
    together = bf.simulate(after, 1e-3, 1e-3, start=bf.simulate(after, 0.05, 1e-3))
    assert together.position(first.end) == pytest.approx(together.position(second.start), abs=1e-12)


@pytest.mark.parametrize("joint", [bf.Hinge, bf.Rigid])
def test_a_start_whose_rates_a_joint_of_beams_would_change_is_refused(joint):
    """The joint gave both beams the rates of the second one, and momentum was lost without a word."""
    first, second = straight(bf.CRBF(2), 2), straight(bf.CRBF(2), 2, (1.0, 0.0), (2.0, 0.0))
    apart = bf.Model([first, second])
    rising = bf.simulate(apart, 1e-3, 1e-3, velocity=bf.RigidVelocity((0.0, 1.0)))[0]
    rates = rising.v.copy()
    rates[apart.meshes[1].kinematics.dof.ravel()] = 0.0
    joined = bf.Model(apart.beams, joints=[joint(first.end, second.start)])
    with pytest.raises(bf.InputError, match="by 1 m/s at once"):
        bf.simulate(joined, 1e-3, 1e-3, start=replace(rising, v=rates))
    assert bf.simulate(joined, 1e-3, 1e-3, start=rising).linear_momentum()[:, 1] == pytest.approx(1.56, rel=1e-9)
