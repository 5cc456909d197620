"""Masses, springs, dampers and links of the package: compiled, consistent, and right by closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from connectors import PointMass, RigidLink, SpringDamper
from eccentric import Eccentric
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import beamfem as bf
from beamfem.testing import check_connector

SQUARE, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)
GRAVITY = bf.Gravity((0.3, -9.81))
ELEMENTS = [
    bf.CRBF(2),
    bf.ANCF(),
    bf.ANCFCRBF(),
    bf.BilinearANCF(),
    bf.BilinearCRBF(bf.Structural(), "reduced"),
    bf.ShearRigid(),
    bf.ANCF(bf.ElasticLine()),
]


class MassInPython(PointMass):
    rotations = False


class SpringInPython(SpringDamper):
    rotations = False


class LinkInPython(RigidLink):
    rotations = False


def rods(element=ELEMENTS[0], elements=4):
    """Two rods that hang beside each other."""
    ends = [((0.0, 0.0), (0.0, -1.0)), ((0.5, 0.0), (0.6, -0.9))]
    return [bf.Beam(bf.Line(*pair), elements, element, SQUARE, STEEL) for pair in ends]


def parts(one, two):
    """One of each part, with the same part written in Python where there is one."""
    return {
        "mass": (bf.PointMass(one.end, 2.0), MassInPython(one.end, 2.0)),
        "flywheel": (bf.PointMass(one.end, 2.0, 0.3), None),
        "body": (bf.RigidBody(one.end, 2.0, 0.0, (0.05, 0.0)), Eccentric(one.end, 2.0, 0.05)),
        "spring": (bf.SpringDamper(one.end, two.end, 150.0, 3.0), SpringInPython(one.end, two.end, 150.0, 3.0)),
        "preloaded": (bf.SpringDamper(one.end, two.at(0.5), 150.0, 3.0, 0.3), None),
        "grounded": (bf.SpringDamper(one.end, (1.0, 0.3), 150.0, 3.0), None),
        "torsion": (bf.TorsionSpring(one.end, two.end, 5.0, 0.2), None),
        "cable": (bf.Cable(one.end, two.end, 200.0, 5.0), None),
        "guy": (bf.Cable(one.end, (1.0, 0.3), 200.0, 5.0), None),
        "bushing": (bf.Bushing(one.end, two.end, (90.0, 40.0, 3.0), (1.0, 2.0, 0.1)), None),
        "slider": (bf.Slider(one.end, two.end, (1.0, 2.0)), None),
        "weld": (bf.Weld(one.end, two.end), None),
        "gear": (bf.Gear(one.end, two.end, -1.5), None),
        "link": (bf.Link(one.end, two.end), LinkInPython(one.end, two.end)),
    }


NAMES = list(parts(*rods()))
IN_PYTHON = [name for name, (_, other) in parts(*rods()).items() if other is not None]


def hanging(one, two, part):
    return bf.Model([one, two], [bf.Pin(one.start), bf.Pin(two.start)], [GRAVITY], connectors=[part])


@pytest.mark.parametrize("name", NAMES)
def test_each_part_is_consistent(name):
    """Analytic, with energies that match its forces, and constraint forces that do no work."""
    check_connector(parts(*rods())[name][0])


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
@pytest.mark.parametrize("name", IN_PYTHON)
def test_each_part_moves_as_if_it_were_written_in_python(name, element):
    one, two = rods(element)
    ends = []
    for part in parts(one, two)[name]:
        motion = bf.simulate(hanging(one, two, part), 0.05, 1e-3, velocity=bf.RigidVelocity((0.0, 0.0)))
        ends.append([motion.displacement(beam.end)[-1] for beam in (one, two)])
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-6, atol=1e-10)


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_all_parts_together_keep_the_energy(element):
    """Swinging rods with masses, a body and undamped springs, statically at rest where they start."""
    one, two = rods(element)
    springs = [bf.SpringDamper(one.end, two.end, 50.0), bf.SpringDamper(two.at(0.5), (1.0, -0.5), 20.0)]
    springs.append(bf.TorsionSpring(one.at(0.5), two.end, 0.5))
    masses = [bf.PointMass(one.end, 0.5), bf.RigidBody(two.end, 0.3, 1e-3, (0.0, -0.05))]
    model = bf.Model([one, two], [bf.Pin(one.start), bf.Pin(two.start)], [GRAVITY], connectors=springs, masses=masses)
    motion = bf.simulate(model, 0.2, 1e-3)
    total, kinetic = motion.energy().total, motion.energy().kinetic
    assert kinetic.max() > 1e-3
    assert np.ptp(total) < 2e-3 * kinetic.max()


def test_a_mass_weighs_m_g():
    """The reaction of a clamp is the weight of all that hangs on it, to round-off."""
    rod = rods()[0]
    masses = [
        bf.PointMass(rod.end, 2.0),
        bf.PointMass(rod.at(0.5), 1.0, 0.1),
        bf.RigidBody(rod.end, 0.5, 0.1, (0, -0.1)),
    ]
    model = bf.Model([rod], [bf.Clamp(rod.start)], [bf.Gravity((0.0, -9.81))], masses=masses)
    reaction = bf.solve_static(model).reaction(rod.start)[-1]
    assert reaction[1] == pytest.approx(9.81 * (3.5 + 7850.0 * 1e-4), rel=1e-10)


def test_an_eccentric_body_bends_its_beam_by_its_weight_times_the_offset():
    rod = rods()[0]
    body = bf.RigidBody(rod.end, 0.02, 0.0, (0.1, 0.0))
    light = bf.Beam(rod.curve, 4, rod.element, SQUARE, bf.Material(2.1e11, 0.3, 1e-6))
    body = bf.RigidBody(light.end, 0.02, 0.0, (0.1, 0.0))
    model = bf.Model([light], [bf.Clamp(light.start)], [bf.Gravity((0.0, -9.81))], masses=[body])
    moment = bf.solve_static(model).reaction(light.start)[-1, 2]
    assert moment == pytest.approx(0.02 * 9.81 * 0.1, rel=1e-3)  # and a little more as the tip moves aside


@pytest.mark.parametrize("ratio", [0.1, 1.0, 100.0])
def test_a_cantilever_with_a_tip_mass_has_the_frequency_of_the_closed_form(ratio):
    """1 + cos cosh + ratio k (cos sinh - sin cosh) = 0 (Euler-Bernoulli); L/h = 1000, so shear counts for 1e-6."""
    thin = bf.Rectangle(0.01, 0.001)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), thin, STEEL)
    line_mass, bending = 7850.0 * 1e-5, 2.1e11 * 0.01 * 1e-9 / 12

    def condition(k):
        c, s, ch, sh = np.cos(k), np.sin(k), np.cosh(k), np.sinh(k)
        return 1.0 + c * ch + ratio * k * (c * sh - s * ch)

    k = brentq(condition, 0.05, 1.88)
    model = bf.Model([beam], [bf.Clamp(beam.start)], masses=[bf.PointMass(beam.end, ratio * line_mass)])
    frequency = bf.solve_modes(model, 1).frequencies[0]
    assert frequency == pytest.approx(k**2 / (2 * np.pi) * np.sqrt(bending / line_mass), rel=1e-5)


def test_an_eccentric_pendulum_moves_as_the_rigid_body_equation_says():
    """(J_total) phi'' = -g S sin(phi - phi_c), integrated independently; the rod bends by 5e-6 rad."""
    thick = bf.Rectangle(0.05, 0.05)
    stiff = bf.Material(2.1e13, 0.3, 7850.0)
    rod = bf.Beam(bf.Line((0, 0), (0, -1)), 2, bf.CRBF(3), thick, stiff)
    mass, inertia, offset = 30.0, 0.5, np.array([0.2, -0.1])
    model = bf.Model(
        [rod], [bf.Pin(rod.start)], [bf.Gravity((0.0, -9.81))], masses=[bf.RigidBody(rod.end, mass, inertia, offset)]
    )
    motion = bf.simulate(model, 0.6, 5e-4)
    rod_mass, centre = 7850.0 * 0.05**2, np.array([0.0, -1.0]) + offset
    about_pin = rod_mass / 3 + 7850.0 * 0.05**4 / 12 + inertia + mass * centre @ centre
    first = rod_mass * np.array([0.0, -0.5]) + mass * centre

    def rate(_, state):
        c, s = np.cos(state[0]), np.sin(state[0])
        return [state[1], -9.81 * (c * first[0] - s * first[1]) / about_pin]

    by_hand = solve_ivp(rate, (0.0, 0.6), [0.0, 0.0], rtol=1e-10, atol=1e-12).y[0, -1]
    assert abs(by_hand) > 0.1
    assert motion.rotation(rod.start)[-1] == pytest.approx(by_hand, rel=1e-4)


@pytest.mark.parametrize("damping", [0.0, 4.0])
def test_a_mass_on_a_spring_swings_as_its_closed_form(damping):
    """A mass at the free end of a rod that can only stretch: m x'' + c x' + k x = 0 with a rod of 1e-9 of its mass."""
    rod = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), SQUARE, bf.Material(1e4, 0.0, 1e-5))
    rod_stiffness, mass, stiffness = 1e4 * 1e-4, 2.0, 50.0
    spring = bf.SpringDamper(rod.end, (2.0, 0.0), stiffness, damping)
    guides = [bf.Clamp(rod.start), bf.Prescribed(rod.end, uy=0.0, rotation=0.0)]
    model = bf.Model([rod], guides, connectors=[spring], masses=[bf.PointMass(rod.end, mass)])
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        motion = bf.simulate(model, 1.0, step, velocity=lambda r: np.stack([0.1 * r[..., 0], 0.0 * r[..., 0]], axis=-1))
        rate = damping / (2.0 * mass)
        swing = np.sqrt((stiffness + rod_stiffness) / mass - rate**2)
        expected = 0.1 / swing * np.exp(-rate * motion.at) * np.sin(swing * motion.at)
        errors.append(np.abs(motion.displacement(rod.end)[:, 0] - expected).max())
    assert errors[2] < 2e-6
    assert 3.5 < errors[0] / errors[1] < 4.5
    assert 3.5 < errors[1] / errors[2] < 4.5
    motion = bf.simulate(
        model,
        1.0,
        1e-2,
        velocity=lambda r: np.stack([0.1 * r[..., 0], 0.0 * r[..., 0]], axis=-1),
        integrator=bf.Gauss(4),
    )
    expected = 0.1 / swing * np.exp(-rate * motion.at) * np.sin(swing * motion.at)
    # a third of the mass of the rod swings too, 2e-10 of that of the ball
    assert motion.displacement(rod.end)[:, 0] == pytest.approx(expected, abs=1e-10)


def test_a_rod_on_a_torsion_spring_swings_as_its_closed_form():
    """J phi'' + c phi' + k phi = 0 of a rod in a hinge with a torsion spring, at large angles."""
    stiff = bf.Material(2.1e15, 0.3, 7850.0)
    post = bf.Beam(bf.Line((0, -0.1), (0, 0)), 1, bf.CRBF(2), SQUARE, stiff)
    rod = bf.Beam(bf.Line((0, 0), (0.5, 0)), 1, bf.CRBF(2), SQUARE, stiff)
    spring, inertia, area = bf.TorsionSpring(post.end, rod.start, 20.0, 0.1), 0.05, 1e-4
    about = 7850.0 * area * (0.5**3 / 3 + 0.5 * area / 12) + inertia
    disc, joint = bf.PointMass(rod.start, 1e-6, inertia), bf.Hinge(post.end, rod.start)
    model = bf.Model([post, rod], [bf.Clamp(post.start)], joints=[joint], connectors=[spring], masses=[disc])
    start = bf.solve_static(model.with_loads([bf.PointMoment(rod.end, 12.0)]))[-1]
    motion = bf.simulate(model, 0.5, 5e-4, start=start)
    rate = 0.1 / (2 * about)
    swing = np.sqrt(20.0 / about - rate**2)
    expected = np.cos(swing * motion.at) + rate / swing * np.sin(swing * motion.at)
    expected *= 12.0 / 20.0 * np.exp(-rate * motion.at)
    assert motion.rotation(rod.start) == pytest.approx(expected, abs=1e-4)


def test_a_torsion_spring_in_a_hinge_turns_by_the_moment_over_its_stiffness():
    stiff = bf.Rectangle(0.2, 0.2)
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), stiff, STEEL)
    two = bf.Beam(bf.Line((1, 0), (2, 0)), 2, bf.CRBF(2), stiff, STEEL)
    spring = bf.TorsionSpring(one.end, two.start, 40.0)
    model = bf.Model(
        [one, two],
        [bf.Clamp(one.start)],
        [bf.PointMoment(two.end, 30.0)],
        [bf.Hinge(one.end, two.start)],
        [spring],
    )
    solution = bf.solve_static(model)
    turn = solution.rotation(two.start)[-1] - solution.rotation(one.end)[-1]
    assert turn == pytest.approx(30.0 / 40.0, rel=1e-9)
    assert solution.connector_force(spring)[-1, :, 2] == pytest.approx([30.0, -30.0], rel=1e-9)


def test_a_link_carries_the_tension_that_a_very_stiff_spring_has():
    one, two = rods()
    supports, loads = [bf.Clamp(one.start), bf.Clamp(two.start)], [bf.PointForce(one.end, (-20.0, 0.0))]
    link, spring = bf.Link(one.end, two.end), bf.SpringDamper(one.end, two.end, 1e9)
    rigid = bf.solve_static(bf.Model([one, two], supports, loads, connectors=[link]))
    stiff = bf.solve_static(bf.Model([one, two], supports, loads, connectors=[spring]))
    np.testing.assert_allclose(rigid.displacement(two.end)[-1], stiff.displacement(two.end)[-1], rtol=1e-6)
    pull = stiff.connector_force(spring)[-1, 0, :2]
    assert rigid.multipliers(link)[-1, 0] == pytest.approx(np.hypot(*pull), rel=1e-6)


def test_a_preloaded_stay_pulls_before_anything_acts():
    """A stay shorter than its distance lifts the tip of a cantilever: the force is k (l - l0) along it."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SQUARE, STEEL)
    stay = bf.SpringDamper(beam.end, (1.0, 1.0), 200.0, length=0.9)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], connectors=[stay]))
    x, y = solution.position(beam.end)[-1]
    along = np.array([1.0 - x, 1.0 - y])
    length = np.hypot(*along)
    pull = solution.connector_force(stay)[-1, 0, :2]
    np.testing.assert_allclose(pull, 200.0 * (length - 0.9) * along / length, rtol=1e-9)
    np.testing.assert_allclose(solution.reaction(beam.start)[-1, :2], -pull, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda p, q: bf.PointMass(p, -1.0), "mass of PointMass must be greater than zero"),
        (lambda p, q: bf.PointMass(p, 1.0, -1.0), "inertia of PointMass must not be negative"),
        (lambda p, q: bf.RigidBody(p, 1.0, 1.0, (1.0,)), "offset of RigidBody must be two finite numbers"),
        (lambda p, q: bf.SpringDamper(p, q, -1.0), "stiffness of SpringDamper must not be negative"),
        (lambda p, q: bf.SpringDamper(p, p, 1.0), "needs two places that are apart, .*; a Hinge or a Rigid joins them"),
        (lambda p, q: bf.SpringDamper(p, q, 1.0, length=-1.0), "length of SpringDamper must not be negative"),
        (lambda p, q: bf.SpringDamper(p, "wall", 1.0), "b of SpringDamper must be two"),
        (lambda p, q: bf.TorsionSpring(p, q, float("nan")), "stiffness of TorsionSpring must be finite"),
        (lambda p, q: bf.Link(p, p), "a Hinge or a Rigid joins them"),
        (lambda p, q: bf.Link(p, (1.0, 0.0)), "b of Link"),
    ],
)
def test_bad_parts_are_refused_where_they_are_made(make, message):
    one, two = rods()
    with pytest.raises(bf.InputError, match=message):
        make(one.end, two.end)


def test_models_with_parts_are_saved_and_loaded(tmp_path):
    one, two = rods()
    own = parts(one, two)
    masses = [own[name][0] for name in ("mass", "body")]
    connectors = [own[name][0] for name in ("spring", "grounded", "torsion")]
    supports = [bf.Clamp(one.start), bf.Clamp(two.start)]
    model = bf.Model([one, two], supports, [GRAVITY], connectors=connectors, masses=masses)
    solution = bf.solve_static(model)
    solution.save(tmp_path / "parts.h5")
    loaded = bf.load(tmp_path / "parts.h5")
    assert repr(loaded.model) == "Model(2 beams, 2 supports, 1 load, 3 connectors, 2 masses)"
    again = bf.solve_static(loaded.model)
    assert np.array_equal(again.p, solution.p)


def test_a_model_with_parts_shares_its_tables_and_follows_another_gravity():
    rod = rods()[0]
    model = bf.Model([rod], [bf.Clamp(rod.start)], [bf.Gravity((0.0, -9.81))], masses=[bf.PointMass(rod.end, 2.0)])
    bf.solve_static(model)
    twice = bf.solve_static(model.with_loads([bf.Gravity((0.0, -19.62))]))
    assert twice.reaction(rod.start)[-1, 1] == pytest.approx(19.62 * (2.0 + 0.785), rel=1e-10)


def test_parts_are_drawn_where_they_are(tmp_path):
    one, two = rods()
    own = [part for part, _ in parts(one, two).values()]
    supports = [bf.Clamp(one.start), bf.Clamp(two.start)]
    model = bf.Model([one, two], supports, connectors=[part for part in own if part not in own[:3]], masses=own[:3])
    (axes,) = model.plot(tmp_path / "parts.png").axes
    ends = np.concatenate([line.get_xydata()[[0, -1]] for line in axes.lines])
    for place in ((0.0, -1.0), (0.05, -1.0), (0.6, -0.9), (1.0, 0.3)):
        assert np.linalg.norm(ends - place, axis=1).min() < 1e-9


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_a_falling_beam_reaches_the_speed_of_its_drag(element):
    """A free beam that falls across itself: v = v_end tanh(g t / v_end) with v_end^2 = (m / L) g / c."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, SQUARE, STEEL)
    coefficient = 0.6
    fluid = bf.Drag(beam, coefficient)
    motion = bf.simulate(bf.Model([beam], loads=[bf.Gravity((0.0, -9.81))], connectors=[fluid]), 0.5, 1e-3)
    last = np.sqrt(0.785 * 9.81 / coefficient)
    speed = motion.velocity(beam.at(1 / 3))[-1]
    np.testing.assert_allclose(speed, [0.0, -last * np.tanh(9.81 * 0.5 / last)], rtol=1e-5, atol=1e-6)
    force = motion.connector_force(fluid)[-1, :, :2].sum(axis=0)
    np.testing.assert_allclose(force, [0.0, coefficient * speed[1] ** 2], rtol=1e-4, atol=1e-6)


def test_drag_damps_no_small_vibration_about_rest_and_is_in_tables_and_pictures(tmp_path):
    """A rate of 1e-150 of the free rotation took the place of the first vibration."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SQUARE, STEEL)
    fluid = bf.Drag(beam, 0.7)
    model = bf.Model([beam], [bf.Pin(beam.start)], [GRAVITY], connectors=[fluid])
    linear = bf.linearise(model)
    assert not abs(linear.damping).max()
    assert linear.modes(2).frequencies == pytest.approx(bf.solve_modes(model, 2).frequencies, rel=1e-9, abs=1e-6)
    motion = bf.simulate(model, 1e-2, 1e-3, velocity=bf.RigidVelocity(angular=3.0))
    table = motion.to_pandas(forces=True)
    forces = table[table["kind"] == "Drag"].xs(0.0, level="time")[["fx", "fy", "moment"]].to_numpy()
    assert forces == pytest.approx(motion.connector_force(fluid)[0])
    assert forces[:, 1].sum() == pytest.approx(-0.7 * 9.0 / 3, rel=1e-12)
    dots = [line.get_marker() for line in model.plot(tmp_path / "a.png").axes[0].lines]
    assert dots.count("o") == 3
    with pytest.raises(bf.InputError, match="is neither a joint, a motor nor a connector of two points"):
        motion.joint_force(fluid)


@pytest.mark.parametrize(("order", "elements"), [(2, 1), (3, 1), (4, 2)])
def test_drag_of_a_spinning_beam_is_integrated_exactly(order, elements):
    """The torque about a pin of w^2 c s^2 s is c w^2 L^4 / 4, of degree 3 in s: exact from order 2 on."""
    beam = bf.Beam(bf.Line((0, 0), (2, 0)), elements, bf.CRBF(order), SQUARE, STEEL)
    fluid = bf.Drag(beam, 0.7)
    model = bf.Model([beam], [bf.Pin(beam.start)], connectors=[fluid])
    start = bf.simulate(model, 1e-6, 1e-6, velocity=bf.RigidVelocity(angular=3.0))
    forces = start.connector_force(fluid)[0]
    places = np.sort(beam.element.field.nodes)
    fractions = np.unique([(i + place) / elements for i in range(elements) for place in places])
    torque = (2.0 * fractions * forces[:, 1]).sum()
    assert torque == pytest.approx(-0.7 * 9.0 * 2.0**4 / 4, rel=1e-12)


def arms(gap=0.0):
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(3), SQUARE, STEEL)
    return one, bf.Beam(bf.Line((1 + gap, 0), (2 + gap, 0)), 3, bf.CRBF(3), SQUARE, STEEL)


def test_a_slider_is_a_bushing_that_is_soft_along_its_axis():
    """A telescope between a clamp and a roller, bent far: nothing but the slider lets it get longer. Also turned."""
    ends = []
    for sliding, angle in ((True, 0.0), (False, 0.0), (True, 0.6)):
        c, s = np.cos(angle), np.sin(angle)
        one, two = (
            bf.Beam(bf.Line((x * c, x * s), (x * c + c, x * s + s)), 3, bf.CRBF(3), SQUARE, STEEL) for x in (0.0, 1.0)
        )
        soft = bf.Bushing(one.end, two.start, (1e-6, 1e9, 1e9))
        joint = bf.Slider(one.end, two.start, (c, s)) if sliding else soft
        supports = [bf.Clamp(one.start), bf.Roller(two.end, (c, s))]
        model = bf.Model([one, two], supports, [bf.PointForce(two.end, (-30.0 * s, 30.0 * c))], connectors=[joint])
        solution = bf.solve_static(model)
        x, y = solution.displacement(two.end)[-1]
        ends.append((c * x + s * y, c * y - s * x, solution.rotation(two.end)[-1]))
    assert ends[0][1] > 0.4
    np.testing.assert_allclose(ends[1], ends[0], rtol=2e-5, atol=1e-9)
    np.testing.assert_allclose(ends[2], ends[0], rtol=1e-8, atol=1e-9)


def test_a_slider_moves_apart_under_a_force_along_it_and_carries_moment():
    one, two = arms()
    slider, spring = bf.Slider(one.end, two.start, (1, 0)), bf.SpringDamper(two.end, (3.0, 0.0), 50.0)
    loads = [bf.PointForce(two.end, (10.0, 0.0)), bf.PointMoment(two.end, 2.0)]
    solution = bf.solve_static(bf.Model([one, two], [bf.Clamp(one.start)], loads, connectors=[slider, spring]))
    across, moment = solution.multipliers(slider)[-1]
    pull = solution.connector_force(spring)[-1, 0]
    assert solution.displacement(two.end)[-1, 0] > 0.15
    reaction = solution.reaction(one.start)[-1]
    np.testing.assert_allclose(reaction[:2], -(pull[:2] + np.array([10.0, 0.0])), atol=1e-7)
    forces = solution.connector_force(slider)[-1]
    np.testing.assert_allclose(forces[0, :2], -forces[1, :2], atol=1e-9)
    assert abs(across) < 10.0
    assert moment == pytest.approx(-forces[1, 2], rel=1e-12)


@pytest.mark.parametrize("ratio", [2.0, -0.5])
def test_a_gear_turns_the_moment_by_the_square_of_its_ratio(ratio):
    """A spring k holds b: M t_a = k (r t_a)^2, so t_a = M / (k r^2)."""
    one, two = arms(0.5)
    spring = bf.Spring(two.start, rotational=30.0)
    model = bf.Model(
        [one, two],
        [bf.Pin(one.start), bf.Pin(two.start), spring],
        [bf.PointMoment(one.start, 5.0)],
        connectors=[bf.Gear(one.start, two.start, ratio)],
    )
    solution = bf.solve_static(model)
    assert solution.rotation(one.start)[-1] == pytest.approx(5.0 / (30.0 * ratio**2), rel=1e-9)
    assert solution.rotation(two.start)[-1] == pytest.approx(5.0 / (30.0 * ratio), rel=1e-9)


def test_two_geared_flywheels_swing_as_one():
    """J_a + r^2 J_b on a torsion spring k: the frequency is that of the reduced inertia."""
    light = bf.Material(2.1e11, 0.3, 1e-4)
    one, two = (bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), 1, bf.CRBF(2), SQUARE, light) for x in (0.0, 1.0))
    wheels = [bf.PointMass(beam.start, 1.0, inertia) for beam, inertia in ((one, 0.2), (two, 0.05))]
    supports = [bf.Pin(one.start), bf.Pin(two.start), bf.Spring(one.start, rotational=40.0)]
    model = bf.Model([one, two], supports, connectors=[bf.Gear(one.start, two.start, 3.0)], masses=wheels)
    frequency = bf.solve_modes(model, 1).frequencies[0]
    assert frequency == pytest.approx(np.sqrt(40.0 / (0.2 + 9.0 * 0.05)) / (2 * np.pi), rel=1e-6)


@pytest.mark.parametrize(("force", "taut"), [(-40.0, True), (40.0, False)])
def test_a_cable_pulls_and_does_not_push(force, taut):
    """A stay above the tip of a cantilever: down it carries k (l - l0), up it is as if it were not there."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), SQUARE, STEEL)
    stay = bf.Cable(beam.end, (1.0, 0.5), 2e3)
    load = [bf.PointForce(beam.end, (0.0, force))]
    stayed = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], load, connectors=[stay]))
    alone = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], load))
    pull = stayed.connector_force(stay)[-1, 0, :2]
    if not taut:
        assert not pull.any()
        np.testing.assert_allclose(stayed.displacement(beam.end), alone.displacement(beam.end), rtol=1e-9, atol=1e-12)
        return
    along = np.array([1.0, 0.5]) - stayed.position(beam.end)[-1]
    length = np.hypot(*along)
    np.testing.assert_allclose(pull, 2e3 * (length - 0.5) * along / length, rtol=1e-9)
    assert 0.0 > stayed.displacement(beam.end)[-1, 1] > 0.5 * alone.displacement(beam.end)[-1, 1]


def test_guys_with_pretension_hold_a_mast_until_one_is_slack():
    """Two guys share a small horizontal force by their stiffness; the pretension only presses on the mast."""
    mast = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(3), SQUARE, STEEL)
    guys = [bf.Cable(mast.end, (x, 0.0), 5e4, 50.0) for x in (-1.0, 1.0)]
    model = bf.Model([mast], [bf.Clamp(mast.start)], [bf.PointForce(mast.end, (20.0, 0.0))], connectors=guys)
    solution = bf.solve_static(model)
    tension = [np.hypot(*solution.connector_force(guy)[-1, 0, :2]) for guy in guys]
    bending = 3 * 2.1e11 * 1e-8 / 12
    share = 20.0 * 5e4 / (5e4 + bending)  # two guys at 45 degrees have the stiffness k along x
    assert tension[0] - tension[1] == pytest.approx(share * np.sqrt(2.0), rel=2e-2)
    assert tension[0] > 50.0 > tension[1] > 0.0
    assert solution.reaction(mast.start)[-1, 1] == pytest.approx(sum(tension) / np.sqrt(2.0), rel=1e-2)


def test_a_mass_bounces_on_a_cable_without_losing_energy():
    """It is thrown up, falls, stretches the cable and is thrown up again: slack and taut by turns."""
    rod = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), SQUARE, bf.Material(1e7, 0.3, 1.0))
    cable = bf.Cable(rod.end, (1.0, 1.0), 400.0)
    supports = [bf.Pin(rod.start)]
    masses, gravity = [bf.PointMass(rod.end, 0.5)], [bf.Gravity((0.0, -9.81))]
    model = bf.Model([rod], supports, gravity, connectors=[cable], masses=masses)
    motion = bf.simulate(model, 0.6, 5e-4)
    tension = np.linalg.norm(motion.connector_force(cable)[:, 0, :2], axis=1)
    assert (tension == 0.0).any()
    assert tension.max() > 8.0
    energy = motion.energy()
    assert np.ptp(energy.total) < 1e-2 * energy.kinetic.max()


@pytest.mark.parametrize("part", ["link", "slider", "gear"])
def test_conditions_may_stand_among_the_joints(part, tmp_path):
    one, two = rods()
    own = parts(one, two)[part][0]
    supports, load = [bf.Clamp(one.start), bf.Clamp(two.start)], [bf.PointForce(one.end, (2.0, 1.0))]
    found = []
    for lists in ({"joints": [own]}, {"connectors": [own]}):
        solution = bf.solve_static(bf.Model([one, two], supports, load, **lists))
        solution.save(tmp_path / "joined.h5")
        assert np.array_equal(bf.solve_static(bf.load(tmp_path / "joined.h5").model).p, solution.p)
        found.append(solution.displacement(two.end)[-1])
    np.testing.assert_allclose(found[0], found[1], rtol=1e-12)


@pytest.mark.parametrize("joint", [bf.Link, bf.Weld])
def test_an_initial_velocity_that_a_joint_prevents_is_lost_by_its_impulses(joint):
    """Impulses of a joint between free beams keep all momenta, and take the energy of what they stop (Carnot)."""
    one, other = (bf.Beam(bf.Line((0, y), (1, y)), 2, bf.CRBF(3), SQUARE, STEEL) for y in (0.0, 1.0))
    apart, joined = (bf.Model([one, other], connectors=parts) for parts in ([], [joint(one.end, other.end)]))
    options = {"duration": 1e-6, "step": 1e-6, "velocity": lambda x: (0.3 + 0.5 * x[1], x[0] * x[1])}
    before = bf.simulate(apart, **options)
    with pytest.warns(bf.EnergyWarning, match=r"does not satisfy .* (Link|Weld): impulses .* change it by up to"):
        after = bf.simulate(joined, **options)
    for own, others in zip(before.linear_momentum()[0], after.linear_momentum()[0], strict=True):
        assert own == pytest.approx(others, rel=1e-12)
    assert before.angular_momentum()[0] == pytest.approx(after.angular_momentum()[0], rel=1e-12)
    ends = np.diff([after.position(beam.end)[0] for beam in (one, other)], axis=0)[0]
    assert abs(ends @ np.diff([after.velocity(beam.end)[0] for beam in (one, other)], axis=0)[0]) < 1e-12
    stopped = replace(before[0], v=before[0].v - after[0].v[: len(before[0].v)])
    lost = bf.simulate(apart, 1e-6, 1e-6, start=stopped)
    energies = [motion.energy().kinetic[0] for motion in (before, after, lost)]
    assert energies[0] - energies[1] == pytest.approx(energies[2], rel=1e-10)


@pytest.mark.parametrize("offset", [(0.0, 0.0), (0.2, -0.1)])
def test_a_pendulum_with_a_mass_at_its_tip_swings_as_a_rigid_body(offset):
    """A stiff rod falls from the horizontal to the other side; integrated independently."""
    thick, stiff = bf.Rectangle(0.05, 0.05), bf.Material(2.1e13, 0.3, 7850.0)
    rod = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(3), thick, stiff)
    inertia = 0.5 if any(offset) else 0.0
    part = bf.RigidBody(rod.end, 30.0, inertia, offset) if inertia else bf.PointMass(rod.end, 30.0)
    model = bf.Model([rod], [bf.Pin(rod.start)], [bf.Gravity((0, -9.81))], masses=[part])
    motion = bf.simulate(model, 1.0, 0.02, integrator=bf.Radau(3))
    own, centre = 7850.0 * 0.05**2, np.array([1.0, 0.0]) + offset
    about = own * (1.0 / 3.0 + 0.05**2 / 12.0) + inertia + 30.0 * centre @ centre
    x, y = own * np.array([0.5, 0.0]) + 30.0 * centre

    def rate(_, state):
        return [state[1], -9.81 * (np.cos(state[0]) * x - np.sin(state[0]) * y) / about]

    exact = solve_ivp(rate, (0.0, 1.0), [0.0, 0.0], rtol=1e-11, atol=1e-12, t_eval=motion.at).y[0]
    assert motion.rotation(rod.start) == pytest.approx(exact, abs=1e-5)
