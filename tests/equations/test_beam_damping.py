"""Damping of beams proportional to mass and stiffness."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from conftest import USUAL, beam, identify
from integrators import Radau
from scipy.linalg import eig, eigh
from section_laws import RambergOsgood

import beamfem as bf
from beamfem.cli.model_file import read_model_file
from beamfem.equations.equations import linearise, residual
from beamfem.equations.system import system_of
from beamfem.io.parts_in_words import beam_in_words
from beamfem.linalg.tangent import UNROTATED
from beamfem.solve.motion.initial_velocity import start_velocity

BOTH = bf.Rayleigh(mass=0.8, stiffness=0.02)
RUBBER, SQUARE = bf.Material(1e7, 0.3, 1000.0), bf.Rectangle(0.02, 0.02)
SOME = [bf.CRBF(order=3), bf.ANCF(), bf.BilinearCRBF(forces=bf.Structural(), integration="reduced"), bf.ShearRigid()]
some = pytest.mark.parametrize("element", SOME, ids=identify)


def cantilever(element=SOME[0], elements=4, damping=None, **given):
    arm = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SQUARE, RUBBER, damping=damping)
    return arm, bf.Model([arm], [bf.Clamp(arm.start)], **given)


def matrices(model, p=None):
    """Return M, C and K (unknown, unknown) at rest in p."""
    system, zeros = system_of(model, static=False), np.zeros(model.size)
    p = system.reference if p is None else p
    every = [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)]
    return [linearise(system, p, zeros, zeros, 0.0, weights)[1].sparse(UNROTATED).toarray() for weights in every]


@pytest.mark.parametrize("element", USUAL, ids=identify)
def test_the_damping_matrix_is_proportional_to_mass_and_stiffness(element):
    mass, damping, stiffness = matrices(bf.Model([replace(beam(element), damping=BOTH)]))
    expected = BOTH.mass * mass + BOTH.stiffness * stiffness
    assert damping == pytest.approx(expected, abs=1e-12 * np.abs(expected).max())


def by_differences(model, rng, spread=0.02):
    """Return the tangents of a moving model times a step, and what differences of the residual give."""
    system = system_of(model, static=False)
    p = system.reference + spread * rng.standard_normal(model.size)
    v, a, step = rng.standard_normal((3, model.size))
    free, h, found, expected = system.free_dofs, 1e-5, [], []
    step[np.setdiff1d(np.arange(model.size), free)] = 0.0
    for weights in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.3, 0.7, 0.2)):
        found.append(linearise(system, p, v, a, 0.0, weights, moving=True)[1].sparse(UNROTATED) @ step[free])
        after, before = (
            residual(system, *(x + s * h * w * step for x, w in zip((p, v, a), weights, strict=True)), 0.0)
            for s in (1, -1)
        )
        expected.append(((after - before) / (2 * h))[free])
    return np.array(found), np.array(expected)


@pytest.mark.parametrize("element", USUAL, ids=identify)
@pytest.mark.parametrize("damping", [bf.Rayleigh(mass=0.8), BOTH], ids=["mass", "both"])
def test_the_tangent_of_a_damped_beam_is_that_of_differences(element, damping, rng):
    found, expected = by_differences(bf.Model([replace(beam(element), damping=damping)]), rng)
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("element", USUAL, ids=identify)
def test_an_arm_that_turns_rigidly_loses_nothing(element, rng):
    """In any deformed state: the strain rates of a rigid velocity vanish, and nothing resists it."""
    plain = bf.Model([beam(element)])
    damped = bf.Model([replace(beam(element), damping=bf.KelvinVoigt(0.5))])
    (bare, own), zeros = (system_of(model, static=False) for model in (plain, damped)), np.zeros(plain.size)
    p = bare.reference + 0.05 * rng.standard_normal(plain.size)
    v = start_velocity(bare, p, bf.RigidVelocity((0.3, -0.2), angular=2.0, about=(0.1, 0.4)), None)
    viscous = residual(own, p, v, zeros, 0.0) - residual(bare, p, v, zeros, 0.0)
    other = v * rng.uniform(0.5, 1.5, len(v))
    straining = residual(own, p, other, zeros, 0.0) - residual(bare, p, other, zeros, 0.0)
    assert np.abs(viscous).max() < 1e-12 * np.abs(straining).max()


def released(damping, periods=3.0, steps=1000, element=SOME[0]):
    """Return times, the tip relative to its start, and the frequency [rad/s] of a cantilever let go in mode 1."""
    arm, model = cantilever(element, damping=damping)
    mass, _, stiffness = matrices(model)
    square, shapes = eigh(stiffness, mass, subset_by_index=[0, 0])
    omega, system = float(np.sqrt(square[0])), system_of(model, static=False)
    start = bf.simulate(model, 1e-6, 1e-6)[0]
    p = start.p.copy()
    p[system.free_dofs] += 1e-6 * shapes[:, 0] / np.abs(shapes[:, 0]).max()
    duration = 2 * np.pi / omega
    motion = bf.simulate(
        model,
        periods * duration,
        duration / steps,
        bf.GeneralizedAlpha(1.0),
        start=replace(start, p=p, v=0.0 * p, a=0.0 * p),
    )
    tip = motion.displacement(arm.end)[:, 1]
    return motion.at, tip / tip[0], omega


@some
@pytest.mark.parametrize("part", ["mass", "stiffness", "both", "time"])
def test_a_cantilever_decays_as_the_closed_form(element, part):
    """exp(-z w t) (cos wd t + z / sqrt(1 - z^2) sin wd t) with wd = w sqrt(1 - z^2), let go at rest in mode 1."""
    omega, z = released(None, 0.01, 100, element)[2], 0.05
    damping = {
        "mass": bf.Rayleigh(mass=2 * z * omega),
        "stiffness": bf.Rayleigh(stiffness=2 * z / omega),
        "both": bf.Rayleigh(mass=z * omega, stiffness=z / omega),
        "time": bf.KelvinVoigt(2 * z / omega),
    }[part]
    at, tip, _ = released(damping, element=element)
    root = np.sqrt(1 - z**2)
    swung = np.cos(root * omega * at) + z / root * np.sin(root * omega * at)
    assert tip == pytest.approx(np.exp(-z * omega * at) * swung, abs=1e-4)


@some
def test_a_free_beam_slows_down_by_the_damping_of_its_mass(element):
    """Velocities of all points, of the motion and the rotation, are those of the start times exp(-a t)."""
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, element, SQUARE, bf.Material(1e9, 0.3, 1000.0), damping=bf.Rayleigh(1.5))
    motion = bf.simulate(bf.Model([bar]), 1.0, 1e-3, velocity=bf.RigidVelocity((3.0, -2.0), 0.5, (0.5, 0.0)))
    momentum, turn = motion.linear_momentum(), motion.angular_momentum()
    assert momentum == pytest.approx(np.exp(-1.5 * motion.at)[:, None] * momentum[0], rel=1e-5)
    moment = (
        turn - motion.position(bar.at(0.5))[:, 0] * momentum[:, 1] + motion.position(bar.at(0.5))[:, 1] * momentum[:, 0]
    )
    assert moment == pytest.approx(np.exp(-1.5 * motion.at) * moment[0], rel=1e-5)


def test_ratios_are_those_of_the_first_two_modes():
    """By the eigenvalues -z w +- i w sqrt(1 - z^2) of M x'' + C x' + K x = 0."""
    bare = bf.solve_modes(cantilever()[1], 2).frequencies
    damping = bf.Rayleigh.from_ratios((bare[0], 0.03), (bare[1], 0.01 + 0.03))
    mass, lossy, stiffness = matrices(cantilever(damping=damping)[1])
    zero, one = np.zeros_like(mass), np.eye(len(mass))
    inverse = np.linalg.inv(mass)
    roots = eig(np.block([[zero, one], [-inverse @ stiffness, -inverse @ lossy]]))[0]
    roots = roots[roots.imag > 0.0]
    roots = roots[np.argsort(np.abs(roots))][:2]
    assert np.abs(roots) / (2 * np.pi) == pytest.approx(bare, rel=1e-7)
    assert -roots.real / np.abs(roots) == pytest.approx([0.03, 0.04], rel=1e-6)


def test_statics_paths_modes_and_buckling_ignore_damping():
    found = []
    for arm, model in (cantilever(damping=damping) for damping in (None, BOTH)):
        pushed = model.with_loads([bf.PointForce(arm.end, (-0.03, 0.01))])
        static = bf.solve_static(pushed)
        path = bf.trace_equilibrium(pushed, 1.0)
        axial = model.with_loads([bf.PointForce(arm.end, (-0.03, 0.0))])
        found.append(
            [static.p, path.p, bf.solve_modes(pushed, 3).frequencies, bf.solve_buckling(axial, 1).load_factors]
        )
    for one, other in zip(*found, strict=True):
        assert np.array_equal(one, other)


def swing(damping, angle=0.0, mirrored=1.0, metre=1.0, second=1.0, kilogram=1.0):
    """Return the tip of a damped pendulum on its first swing, turned, mirrored or in other units, as it was without."""
    c, s = np.cos(angle), mirrored * np.sin(angle)
    turn = np.array([[c, -mirrored * s], [mirrored * s, c]]) @ np.diag([1.0, mirrored])
    pascal = kilogram / metre / second**2
    material = bf.Material(1e6 * pascal, 0.3, 1000.0 * kilogram / metre**3)
    damping = bf.Rayleigh(damping.mass / second, damping.stiffness * second)
    end = tuple(metre * turn @ (1.0, 0.0))
    arm = bf.Beam(
        bf.Line((0, 0), end), 4, bf.CRBF(2), bf.Rectangle(0.02 * metre, 0.02 * metre), material, damping=damping
    )
    weight = tuple(metre / second**2 * turn @ (0.0, -9.81))
    model = bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity(weight)])
    motion = bf.simulate(model, 0.5 * second, 1e-3 * second)
    return motion.position(arm.end) @ turn / metre


@pytest.mark.parametrize(
    "change",
    [
        {"angle": 0.7},
        {"mirrored": -1.0},
        {"angle": 2.0, "mirrored": -1.0},
        {"metre": 1e3, "second": 1e3},
        {"kilogram": 1e-3},
    ],
    ids=str,
)
def test_a_motion_is_the_same_turned_mirrored_and_in_other_units(change):
    assert swing(BOTH, **change) == pytest.approx(swing(BOTH), abs=1e-8)


def test_beams_with_different_damping_share_a_node():
    """Halves of one beam: the damping matrix is the sum of theirs, and they move as one beam if it is the same."""
    halves = [bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), 2, SOME[0], SQUARE, RUBBER) for x in (0.0, 0.5)]

    def joined(*damping):
        beams = [replace(half, damping=own) for half, own in zip(halves, damping, strict=True)]
        ends = [bf.Clamp(beams[0].start)], [bf.Gravity((0.0, -9.81))], [bf.Rigid(beams[0].end, beams[1].start)]
        return beams[1], bf.Model(beams, *ends)

    other = bf.Rayleigh(3.0, 1e-3)
    each = [matrices(joined(*pair)[1])[1] for pair in ((BOTH, None), (None, other), (BOTH, other))]
    assert each[0] + each[1] == pytest.approx(each[2], abs=1e-12 * np.abs(each[2]).max())
    (tip, model), (arm, whole) = joined(BOTH, BOTH), cantilever(damping=BOTH, loads=[bf.Gravity((0.0, -9.81))])
    one, two = (bf.simulate(each, 0.3, 1e-3).position(end) for each, end in ((model, tip.end), (whole, arm.end)))
    assert one == pytest.approx(two, abs=1e-9)


@pytest.mark.parametrize("damping", [bf.Rayleigh(mass=20.0), bf.Rayleigh(2.0, 0.01)], ids=str)
def test_other_integrators_find_the_same_motion(damping):
    arm, model = cantilever(bf.CRBF(order=2), damping=damping, loads=[bf.Gravity((0.0, -9.81))])
    stages = bf.simulate(model, 0.1, 1e-3, Radau())
    fine = bf.simulate(model, 0.1, 1e-4, bf.GeneralizedAlpha(1.0))
    assert stages.position(arm.end)[-1] == pytest.approx(fine.position(arm.end)[-1], abs=1e-6)


def test_reactions_and_section_forces_hold_the_damping_of_the_mass():
    """A bar that is moved at a steady velocity through what damps it, as a dead load a rho A v would bend it."""
    damping, speed = bf.Rayleigh(mass=5.0), 0.001
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), SQUARE, RUBBER, damping=damping)
    moved = bf.Prescribed(bar.start, ux=0.0, uy=lambda t: speed * t, rotation=0.0)
    motion = bf.simulate(bf.Model([bar], [moved]), 12.0, 5e-3, velocity=bf.RigidVelocity((0.0, speed)))
    per_length = damping.mass * speed * 1000.0 * 0.02**2
    assert motion.reaction(bar.start)[-1, 1:] == pytest.approx([per_length, per_length / 2], rel=1e-4)
    forces = motion.section_forces(bar)
    assert -forces.moment[-1] == pytest.approx(per_length * (1 - forces.arc_length) ** 2 / 2, abs=1e-4 * per_length)


def test_a_damped_model_is_saved_and_described(tmp_path):
    for damping in (BOTH, bf.KelvinVoigt(0.1)):
        _, model = cantilever(damping=damping)
        bf.simulate(model, 0.01, 1e-3).save(tmp_path / "motion.h5")
        assert bf.load(tmp_path / "motion.h5").model.beams[0].damping == damping
    words = [beam_in_words(*cantilever(damping=damping)) for damping in (BOTH, bf.KelvinVoigt(0.1), None)]
    assert words[0].endswith(", density 1000 kg/m^3, Rayleigh damping 0.8 1/s, 0.02 s")
    assert words[1].endswith(", density 1000 kg/m^3, Kelvin-Voigt damping 0.1 s")
    assert words[2].endswith(", density 1000 kg/m^3")


FILE = """
[materials.rubber]
youngs_modulus = 1e7
poisson_ratio = 0.3
density = 1000

[beams.arm]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.02, height = 0.02 }
material = "rubber"
damping = { DAMPING }

[[supports]]
kind = "clamp"
point = "arm.start"
"""


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ('kind = "rayleigh", mass = 0.8, stiffness = 0.02', BOTH),
        ('kind = "kelvin-voigt", time = 0.1', bf.KelvinVoigt(0.1)),
        ('kind = "ratios", first = [8.0, 0.02], second = [50, 0.02]', bf.Rayleigh.from_ratios((8, 0.02), (50, 0.02))),
    ],
)
def test_model_files_have_damping(written, keys, expected):
    model = read_model_file(written(FILE.replace("DAMPING", keys))).model
    assert model.beams[0].damping == expected


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: bf.Rayleigh(mass=-1.0), "mass of Rayleigh must not be negative"),
        (lambda: bf.Rayleigh(stiffness=np.nan), "stiffness of Rayleigh must be finite"),
        (lambda: bf.KelvinVoigt("1"), "time of KelvinVoigt must be a number"),
        (lambda: bf.Rayleigh.from_ratios((8.0, 0.02), (8.0, 0.03)), "different frequencies, both are at 8"),
        (lambda: bf.Rayleigh.from_ratios((8.0, 0.02), (80.0, 0.3)), "0.002 to 0.2 there"),
        (lambda: bf.Rayleigh.from_ratios((8.0, 0.02), 80.0), "second must be a list"),
        (lambda: bf.Rayleigh.from_ratios((8.0,), (80.0, 0.3)), "first must be a frequency and a damping ratio"),
        (lambda: cantilever(damping=0.02), r"damping of a Beam must be a Rayleigh"),
    ],
)
def test_damping_that_is_none_is_refused(make, said):
    with pytest.raises(bf.InputError, match=said):
        make()


@some
@pytest.mark.parametrize("banded", [True, False], ids=["band", "sparse"])
def test_the_tangent_of_a_frame_is_that_of_differences(element, banded, rng, widest_band):
    """Joined at an angle, hinged and clamped: nodes of different kinds, and for gradients with a rotated frame."""
    if not banded:
        widest_band(0)
    points = [(0.0, 0.0), (0.3, 1.0), (1.2, 0.8), (1.5, 0.0)]
    legs = [
        bf.Beam(bf.Line(a, b), 2, element, SQUARE, RUBBER, damping=bf.Rayleigh(number, 0.01 * (3 - number)))
        for number, (a, b) in enumerate(pairwise(points))
    ]
    joints = [bf.Rigid(legs[0].end, legs[1].start), bf.Hinge(legs[1].end, legs[2].start)]
    found, expected = by_differences(bf.Model(legs, [bf.Clamp(legs[0].start), bf.Pin(legs[2].end)], joints=joints), rng)
    assert found == pytest.approx(expected, rel=1e-6, abs=2e-6 * np.abs(expected).max())


def test_the_tangent_of_a_damped_section_law_is_that_of_differences(rng):
    """Damped by its stiffness at zero strain."""
    given = {"axial": 1e4, "shear": 4e3, "bending": 10.0, "mass": 1.0, "rotary_inertia": 1e-4}
    section = RambergOsgood(**given, knee=2.0, exponent=3)
    arm = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(order=2), section, damping=BOTH)
    found, expected = by_differences(bf.Model([arm], [bf.Clamp(arm.start)]), rng, spread=1e-3)
    assert found == pytest.approx(expected, rel=1e-6, abs=2e-6 * np.abs(expected).max())


@pytest.mark.parametrize("time", [1e-2, 0.1, 1.0])
@pytest.mark.parametrize("rho", [0.9, 1.0])
def test_a_strongly_damped_bar_turns_in_steps_of_a_few_degrees(time, rho):
    """Of 5 degrees: without the resultants that damping predicts, the iterations of these steps do not converge."""
    material, section = bf.Material(2.5e9, 0.35, 1150.0), bf.Rectangle(0.02, 0.005)
    bar = bf.Beam(bf.Line((0, 0), (0.5, 0)), 4, bf.CRBF(order=3), section, material, damping=bf.KelvinVoigt(time))
    spin = bf.RigidVelocity(angular=8.0)
    found = []
    for step in (1e-2, 2.5e-3):
        model = bf.Model([bar], [bf.Pin(bar.start)], [bf.Gravity((0, -9.81))])
        motion = bf.simulate(model, 0.3, step, bf.GeneralizedAlpha(rho), velocity=spin)
        assert motion.statistics.iterations < 12 * motion.statistics.steps
        found.append(motion.rotation(bar.start)[-1])
    assert found[0] == pytest.approx(found[1], rel=1e-2)


def test_members_of_a_mesh_are_damped():
    lines = bf.LineMesh([(0, 0), (0, 3), (4, 3)], [(0, 1, -1), (1, 2, -1)], {"post": [0], "bar": [1]}, {})
    given = 4, bf.CRBF(order=3), SQUARE, RUBBER
    assert [beam.damping for beam in lines.frame(*given, damping=BOTH).beams] == [BOTH, BOTH]
    by_name = lines.frame(*given, damping={"post": None, "bar": BOTH})
    assert [beam.damping for beam in by_name.beams] == [None, BOTH]
