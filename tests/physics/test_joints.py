"""Rigid joints and hinges: members that are joined against members that are whole, closed forms and shooting."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shooting import Member, solved

import beamfem as bf

SECTION = bf.Rectangle(0.1, 0.1)
STEEL = bf.Material(1.2e5, 0.3, 10.0)
EI, EA, GA = 1.2e5 * SECTION.second_moment, 1.2e5 * SECTION.area, 1.2e5 * SECTION.area / 2.6 * 5 / 6


def line(start, end, elements=4, element=None):
    return bf.Beam(bf.Line(start, end), elements, element or bf.CRBF(4), SECTION, STEEL)


def tip_loads(beam):
    return [bf.PointForce(beam.end, (0.3 * EI, 1.5 * EI)), bf.PointMoment(beam.end, 0.5 * EI)]


def moved(model, point):
    return bf.solve_static(model).displacement(point)[-1]


def joined(element, elements):
    """Tip displacement of a cantilever in one piece, and of the same in two that are joined rigidly."""
    whole = line((0, 0), (1, 0.5), elements, element)
    halves = line((0, 0), (0.5, 0.25), elements // 2, element), line((0.5, 0.25), (1, 0.5), elements // 2, element)
    models = (
        bf.Model([whole], [bf.Clamp(whole.start)], tip_loads(whole)),
        bf.Model(halves, [bf.Clamp(halves[0].start)], tip_loads(halves[1]), [bf.Rigid(halves[0].end, halves[1].start)]),
    )
    return [moved(model, beam.end) for model, beam in zip(models, (whole, halves[1]), strict=True)]


def test_two_halves_joined_are_a_whole_beam(element):
    """A joint shares r and the section's direction; r_x may jump there, as it must where a force acts at the joint.

    So fields that share no r_x inside give the same to round-off, cubic ones with more freedom the same in the limit.
    """
    coarse, fine = (np.abs(np.subtract(*joined(element, count))).max() for count in (4, 8))
    if "r_x" not in element.field.vectors:
        assert fine < 1e-13
    else:
        assert coarse < 2e-3
        assert fine <= 0.25 * coarse + 1e-13


def angled(angle, element, elements, element_after=None, flip=False):
    """Tip displacement of two members of length 1 that meet under an angle; flip: the second is drawn backwards."""
    tip = (1.0 + np.cos(angle), np.sin(angle))
    first = line((0, 0), (1, 0), elements, element)
    ends = [tip, (1.0, 0.0)] if flip else [(1.0, 0.0), tip]
    second = line(*ends, elements, element_after or element)
    inner, outer = (second.end, second.start) if flip else (second.start, second.end)
    loads = [bf.PointForce(outer, (0.2 * EI, 0.6 * EI)), bf.PointMoment(first.at(0.5), -0.3 * EI)]
    solution = bf.solve_static(bf.Model([first, second], [bf.Clamp(first.start)], loads, [bf.Rigid(first.end, inner)]))
    turns = solution.rotation(first.end)[-1], solution.rotation(inner)[-1]
    return solution.displacement(outer)[-1], turns


def angled_exactly(angle):
    flexible = {"bending": EI, "axial": 1 / EA, "shear": 1 / GA}
    first, second = Member(1.0, 0.0, **flexible), Member(1.0, angle, **flexible)

    def run(moment):
        half = first.run((0.0, 0.0, 0.0, 0.2 * EI, 0.6 * EI, moment), 0.5)
        half[5] += 0.3 * EI
        return second.run(first.after(0.5).run(half))

    (moment,) = solved(lambda m: [run(m[0])[5]], [EI])
    return run(moment)[:2] - (1.0 + np.cos(angle), np.sin(angle))


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("angle", np.deg2rad([0.0, 50.0, 90.0, -135.0]))
def test_members_joined_at_an_angle_are_those_of_the_reissner_beam(angle, flip):
    found, turns = angled(angle, bf.CRBF(4), 6, flip=flip)
    assert found == pytest.approx(angled_exactly(angle), abs=2e-8)
    assert turns[0] == pytest.approx(turns[1], abs=1e-14)


STRUCTURAL = bf.Structural()


@pytest.mark.parametrize("after", [None, bf.CRBF(3)])
@pytest.mark.parametrize(
    "element",
    [
        bf.ANCF(STRUCTURAL),
        bf.ANCFCRBF(STRUCTURAL),
        bf.BilinearANCF(bf.SplitContinuum(), "reduced"),
        bf.Element(bf.CRBF(3).field, bf.ANCF().coordinates, STRUCTURAL),
        bf.ShearRigid(),
        bf.ANCFCRBF(bf.ElasticLine()),
        bf.ANCF(bf.ElasticLine()),
    ],
    ids=lambda element: element and f"{element.name}-{element.forces.name}",
)
@pytest.mark.parametrize("angle", np.deg2rad([50.0, 90.0]))
def test_every_element_and_pair_of_elements_converges_to_the_joined_members(element, after, angle):
    exact = angled_exactly(angle)
    # elastic lines have no shear strain from the load: the shear of h / L = 0.1 is missing or stiffer
    limit = 8e-3 if isinstance(element.forces, bf.ElasticLine) or "shear" in element.name else 1e-3
    errors = [np.abs(angled(angle, element, count, after)[0] - exact).max() for count in (8, 32)]
    assert errors[1] < limit
    assert errors[1] < 0.3 * errors[0] or limit == 8e-3


@pytest.mark.parametrize("arms", [3, 4])
@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(STRUCTURAL), bf.BilinearCRBF(bf.SplitContinuum(), "reduced")])
def test_clamped_arms_share_a_moment_at_their_joint(arms, element):
    """A Timoshenko arm resists a turn with (4 + phi) / (1 + phi) EI / L, phi = 12 EI / (k GA L^2)."""
    phi = 12 * EI / GA
    ends = [(np.cos(a), np.sin(a)) for a in 0.5 * np.pi * np.arange(arms)]
    beams = [line((0, 0), end, 16, element) for end in ends]
    model = bf.Model(
        beams,
        [bf.Clamp(beam.end) for beam in beams],
        [bf.PointMoment(beams[0].start, 1e-6 * EI)],
        [bf.Rigid(beams[0].start, other.start) for other in beams[1:]],
    )
    solution = bf.solve_static(model)
    # a lone arm also pushes the joint aside, against the stretch of the others
    exact, tolerance = 1e-6 / (arms * (4 + phi) / (1 + phi)), 4e-3 if arms == 4 else 1e-2
    assert solution.rotation(beams[0].start)[-1] == pytest.approx(exact, rel=tolerance)
    far = exact * EI * (2 - phi) / (1 + phi)
    assert solution.reaction(beams[0].end)[-1, 2] == pytest.approx(far, rel=tolerance)
    if element == bf.CRBF(3) and arms == 4:
        assert solution.rotation(beams[0].start)[-1] == pytest.approx(exact, rel=1e-6)
    turns = [solution.rotation(beam.start)[-1] for beam in beams]
    assert turns == pytest.approx([turns[0]] * arms, rel=1e-6)


def test_bars_with_hinges_carry_normal_forces_only():
    """Von Mises truss: P = 2 EA (1 - l / l0) h / l at the height h of its crown, before its bars buckle."""
    left, right = line((0, 0), (1, 0.3), 2), line((1, 0.3), (2, 0), 2)
    model = bf.Model(
        [left, right],
        [bf.Pin(left.start), bf.Pin(right.end)],
        [bf.PointForce(left.end, (0.0, -0.003 * EA))],
        [bf.Hinge(left.end, right.start)],
    )
    solution = bf.solve_static(model)
    height = solution.position(right.start)[-1, 1]
    assert 0.0 < height < 0.3
    ratio = np.hypot(1.0, height) / np.hypot(1.0, 0.3)
    assert 2 * (1 - ratio) * height / np.hypot(1.0, height) == pytest.approx(0.003, rel=1e-9)
    assert np.abs(solution.section_forces(left).moment[-1]).max() < 1e-9 * EI
    assert solution.rotation(left.end)[-1] == pytest.approx(-solution.rotation(right.start)[-1])
    assert abs(solution.rotation(left.end)[-1]) > 0.01


def test_a_line_with_a_corner_is_two_lines_joined(element):
    """Inside a beam and between two the same joint is made."""
    length = 1 + np.hypot(0.5, 1)
    inside = (0.8 * length - 1) / (length - 1)
    ends = [0, 0.25, 1 / length, 0.8, 1]
    corner = bf.Beam(bf.Polyline([(0, 0), (1, 0), (1.5, 1)]), ends, element, SECTION, STEEL)
    first = line((0, 0), (1, 0), [0, 0.25 * length, 1], element)
    second = line((1, 0), (1.5, 1), [0, inside, 1], element)
    one = bf.Model([corner], [bf.Clamp(corner.start)], tip_loads(corner))
    two = bf.Model([first, second], [bf.Clamp(first.start)], tip_loads(second), [bf.Rigid(first.end, second.start)])
    assert one.size == two.size
    assert moved(one, corner.end) == pytest.approx(moved(two, second.end), abs=1e-9)


def ring(joint, elements=16, force=2.0):
    """A ring of radius 1 pulled apart along y at the quarters, the joint at the right; slender, EI = 1."""
    section = bf.Section.from_stiffness(1e8, 1e8, 1.0, 1.0, 1.0)
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2 * np.pi), elements, bf.CRBF(4), section)
    supports = [bf.Prescribed(beam.at(0.25), ux=0.0), bf.Pin(beam.at(0.75))]
    model = bf.Model([beam], supports, [bf.PointForce(beam.at(0.25), (0.0, force))], [joint(beam.end, beam.start)])
    return beam, bf.solve_static(model)


def test_a_closed_ring_is_a_ring():
    """A quarter of the inextensible ring by shooting: vertical section at the right, horizontal at the top."""
    beam, solution = ring(bf.Rigid)

    def top(moment):
        return Member(0.5 * np.pi, 0.5 * np.pi, 1.0).run((1.0, 0.0, 0.0, 0.0, 1.0, moment))

    (moment,) = solved(lambda m: [top(m[0])[2]], [0.1])
    x, y = top(moment)[:2]
    assert solution.displacement(beam.at(0.25))[-1, 1] == pytest.approx(2 * (y - 1), abs=2e-7)
    assert solution.displacement(beam.start)[-1] == pytest.approx((-x, y - 1), abs=2e-7)
    assert solution.position(beam.end)[-1] == pytest.approx(solution.position(beam.start)[-1], abs=1e-14)
    assert solution.rotation(beam.end)[-1] == pytest.approx(solution.rotation(beam.start)[-1], abs=1e-14)


def test_a_ring_with_a_hinge_opens_there():
    beam, solution = ring(bf.Hinge, force=0.2)
    assert solution.position(beam.end)[-1] == pytest.approx(solution.position(beam.start)[-1], abs=1e-14)
    assert abs(solution.rotation(beam.end)[-1] - solution.rotation(beam.start)[-1]) > 0.01


@pytest.mark.parametrize(
    "element", [bf.CRBF(3), bf.ANCF(STRUCTURAL), bf.ANCFCRBF(bf.ElasticLine())], ids=lambda e: e.name
)
def test_joints_and_supports_at_fractions_stand_on_nodes_of_their_own(element):
    """A member in the middle of another: the same as three members that meet, with a clamp between nodes."""
    through, branch = line((0, 0), (2, 0), 5, element), line((0.5, 0), (0.5, 1), 3, element)
    load = bf.PointForce(branch.end, (0.3 * EI, 0.0))
    supports = [bf.Clamp(through.start), bf.Pin(through.at(0.83)), bf.Spring(through.at(0.37), (0.0, 3 * EI), 0.2 * EI)]
    model = bf.Model([through, branch], supports, [load], [bf.Rigid(through.at(0.25), branch.start)])
    nodes = [0, 0.2, 0.25, 0.37, 0.4, 0.6, 0.8, 0.83, 1.0]
    again = line((0, 0), (2, 0), nodes, element)
    other = [bf.Clamp(again.start), bf.Pin(again.at(0.83)), bf.Spring(again.at(0.37), (0.0, 3 * EI), 0.2 * EI)]
    same = bf.Model([again, branch], other, [load], [bf.Rigid(branch.start, again.at(0.25))])
    assert moved(model, branch.end) == pytest.approx(moved(same, branch.end), abs=1e-10)
    solution = bf.solve_static(model)
    reactions = sum(solution.reaction(support.point)[-1, :2] for support in supports)
    assert reactions == pytest.approx([-0.3 * EI, 0.0], abs=1e-6 * EI)
    assert solution.position(branch.start)[-1] == pytest.approx(solution.position(through.at(0.25))[-1], abs=1e-13)


def chain(*joints):
    beams = [line((0, 0), (1, 0)), line((1, 0), (2, 0))]
    load = [bf.PointForce(beams[1].end, (0.0, -0.1 * EI))]
    return beams, bf.Model(
        beams, [bf.Clamp(beams[0].start)], load, [make(beams[0].end, beams[1].start) for make in joints]
    )


@pytest.mark.parametrize("joints", [(bf.Rigid, bf.Rigid), (bf.Rigid, bf.Hinge), (bf.Hinge, bf.Rigid)])
def test_a_second_joint_of_the_same_points_changes_nothing(joints):
    beams, model = chain(*joints)
    _, once = chain(bf.Rigid)
    assert model.size == once.size
    assert np.array_equal(moved(model, beams[1].end), moved(once, once.beams[1].end))


def test_mechanisms_are_named():
    beams, model = chain(bf.Hinge)
    with pytest.raises(bf.FreeMotionError, match=r"beam 1 .* turns about \(1, 0\); its point \(2, 0\) moves"):
        bf.solve_static(model)
    with pytest.raises(bf.FreeMotionError, match=r"turns about \(0, 0\); its point \(1, 0\) moves"):
        bf.solve_static(bf.Model(beams, [bf.Pin(beams[0].start), bf.Pin(beams[1].end)], model.loads, model.joints))
    corners = [(0, 0), (0, 1), (1, 1), (1, 0)]
    bars = [line(corners[i], corners[i + 1]) for i in range(3)]
    hinges = [bf.Hinge(bars[0].end, bars[1].start), bf.Hinge(bars[1].end, bars[2].start)]
    load = [bf.PointForce(bars[1].start, (1.0, 0.0))]
    with pytest.raises(bf.FreeMotionError, match=r"beam 0 .* turns about \(0, 0\); its point \(0, 1\) moves"):
        bf.solve_static(bf.Model(bars, [bf.Pin(bars[0].start), bf.Pin(bars[2].end)], load, hinges))
    with pytest.raises(bf.FreeMotionError, match="beam 1 can move freely: it translates along x, it tr"):
        bf.solve_static(bf.Model(beams, [bf.Clamp(beams[0].start)], model.loads))


def test_joints_that_join_nothing_are_refused():
    beams, _ = chain()
    for a, b, words in (
        (beams[0].end, beams[1].end, "which are 1 m apart"),
        (beams[0].end, beams[0].end, "with itself"),
        (beams[0].end, line((1, 0), (3, 0)).start, "not in this model"),
    ):
        with pytest.raises(bf.BeamfemError, match=words):
            bf.Model(beams, joints=[bf.Rigid(a, b)])


def double_pendulum(duration):
    """Angles of two uniform rigid rods of length and mass 1 that fall from the horizontal, by Lagrange's equations."""
    g = 9.81

    def slope(t, y):
        a, b, u, v = y
        c, s = np.cos(a - b), np.sin(a - b)
        mass = np.array([[4 / 3, c / 2], [c / 2, 1 / 3]])
        force = [-s / 2 * v**2 - 1.5 * g * np.cos(a), s / 2 * u**2 - 0.5 * g * np.cos(b)]
        return (u, v, *np.linalg.solve(mass, force))

    return solve_ivp(slope, (0, duration), np.zeros(4), rtol=1e-10, atol=1e-10).y[:2, -1]


@pytest.mark.parametrize("element", [bf.CRBF(1), bf.BilinearANCF(bf.SplitContinuum(), "reduced")], ids=lambda e: e.name)
def test_stiff_rods_with_a_hinge_are_a_double_pendulum(element):
    stiff = bf.Material(1e8, 0.3, 100.0)
    section = bf.Rectangle(0.1, 0.1)
    upper = bf.Beam(bf.Line((0, 0), (1, 0)), 2, element, section, stiff)
    lower = bf.Beam(bf.Line((1, 0), (2, 0)), 2, element, section, stiff)
    model = bf.Model(
        [upper, lower], [bf.Pin(upper.start)], [bf.Gravity((0.0, -9.81))], [bf.Hinge(upper.end, lower.start)]
    )
    solution = bf.simulate(model, 0.8, 1e-3)
    a, b = double_pendulum(0.8)
    # rotary inertia of rods 0.1 m thick and their flexibility: parts in a thousand
    assert solution.position(upper.end)[-1] == pytest.approx((np.cos(a), np.sin(a)), abs=1e-2)
    assert solution.position(lower.end)[-1] == pytest.approx((np.cos(a) + np.cos(b), np.sin(a) + np.sin(b)), abs=1e-2)
    total = solution.energy().total
    assert np.abs(total).max() < 1e-3 * solution.energy().kinetic.max()


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF(STRUCTURAL), bf.ANCFCRBF()], ids=lambda e: e.name)
def test_a_flying_frame_keeps_energy_and_momenta(element):
    first, second = line((0, 0), (1, 0), 3, element), line((1, 0), (1.5, 0.8), 3, element)
    third = line((1, 0), (1, -1), 3, element)
    model = bf.Model(
        [first, second, third], joints=[bf.Rigid(first.end, second.start), bf.Hinge(third.start, first.end)]
    )
    motion = bf.RigidVelocity((0.5, 0.3), angular=2.0, about=(1.0, 0.0))
    solution = bf.simulate(model, 0.3, 1e-3, velocity=motion, integrator=bf.GeneralizedAlpha(rho_inf=1.0))
    linear, angular, total = solution.linear_momentum(), solution.angular_momentum(), solution.energy().total
    assert np.abs(linear - linear[0]).max() < 1e-8 * np.hypot(*linear[0])
    assert np.abs(angular / angular[0] - 1).max() < 1e-4
    assert np.abs(total / total[0] - 1).max() < 1e-4
    assert solution.energy().strain.max() > 1e-4 * total[0]


def test_a_bent_corner_of_gradients_keeps_its_state_when_its_support_goes():
    """The vector that both sides of a corner share is that of the first, in the reference as in a state handed on."""
    corner = bf.Beam(bf.Polyline([(0, 0), (1, 0), (1, 1)]), 4, bf.ANCF(STRUCTURAL), SECTION, STEEL)
    held = bf.Model([corner], [bf.Clamp(corner.start)], [bf.PointForce(corner.end, (-EI, 0.0))])
    state = bf.solve_static(held)
    free = bf.Model([corner], [bf.Pin(corner.start)])
    motion = bf.simulate(free, 1e-4, 1e-4, start=state[-1])
    for share in (0.25, 0.499, 0.501, 0.75, 1.0):
        assert motion.position(corner.at(share))[0] == pytest.approx(state.position(corner.at(share))[-1], abs=1e-12)
    turning = bf.simulate(free, 1e-4, 1e-4, velocity=bf.RigidVelocity((0.0, 0.0), 3.0))
    assert turning.velocity(corner.end)[0] == pytest.approx((-3.0, 3.0), abs=1e-12)
    assert turning.velocity(corner.at(0.75))[0] == pytest.approx((-1.5, 3.0), abs=1e-12)


@pytest.mark.parametrize(
    "element", [bf.CRBF(2), bf.ANCF(bf.Structural()), bf.ShearRigid()], ids=["CRBF", "ANCF", "ShearRigid"]
)
def test_a_gap_that_a_joint_closes_strains_nothing(element):
    """Ends that are 5e-10 m apart are one point of the reference: EA 2e9 times the gap would be some newtons."""
    common = (2, element, bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
    left = bf.Beam(bf.Line((0, 0), (1, 0)), *common)
    right = bf.Beam(bf.Line((1 + 5e-10, 3e-10), (2, 0)), *common)
    model = bf.Model(
        [left, right], [bf.Clamp(left.start), bf.Clamp(right.end)], joints=[bf.Rigid(left.end, right.start)]
    )
    forces = bf.solve_static(model).section_forces(right)
    assert np.abs(forces.normal).max() < 1e-3
    assert np.abs(forces.moment).max() < 1e-3
