"""Sections: moments, layers against transformed sections, sections by stiffness, tapered beams, mass."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import dblquad, quad

import beamfem as bf
from beamfem.equations.equations import INERTIA, linearise
from beamfem.equations.system import System

STEEL = bf.Material(2e11, 0.3, 7800.0)
ALUMINIUM = bf.Material(7e10, 0.33, 2700.0)


def solve(section, loads, element=None, elements=4, material=None, start=(0.0, 0.0), end=(1.0, 0.0)):
    beam = bf.Beam(bf.Line(start, end), elements, element or bf.CRBF(4), section, material)
    return beam, bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load(beam) for load in loads]))


@pytest.mark.parametrize("thickness", [0.05, 0.02, 0.001])
def test_moments_of_a_circle_and_of_tubes(thickness):
    outer, inner = 0.05, 0.05 - thickness

    def moment(power):
        def disc(radius):
            return dblquad(lambda r, a: r * (r * np.sin(a)) ** power, 0, 2 * np.pi, 0, radius)[0] if radius else 0.0

        return disc(outer) - disc(inner)

    section = bf.Tube(0.1, thickness) if inner else bf.Circle(0.1)
    assert section.area == pytest.approx(moment(0), rel=1e-9)
    assert section.second_moment == pytest.approx(moment(2), rel=1e-9)
    assert section.fourth_moment == pytest.approx(moment(4), rel=1e-9)
    assert section.shear_factor == (0.5 if inner else 0.9)


def test_shear_factor_of_a_circle_by_the_energy_of_its_stress():
    """Jourawski: tau = Q S / (I b) with S = 2/3 (r^2 - y^2)^(3/2), b = 2 sqrt(r^2 - y^2), of its vertical part."""
    second = np.pi / 4.0
    energy = quad(lambda y: (2 / 3 * (1 - y**2) ** 1.5 / second) ** 2 / (2 * np.sqrt(1 - y**2)), -1, 1)[0]
    assert bf.Circle(2.0).shear_factor == pytest.approx(1.0 / (np.pi * energy), rel=1e-9)


# steel 2 cm below aluminium 6 cm, 5 cm wide: the transformed section, by hand, heights above the bottom
LAYERS = bf.Layered((bf.Layer(STEEL, 0.02), bf.Layer(ALUMINIUM, 0.06)), 0.05)
AXIAL = 2e11 * 0.001 + 7e10 * 0.003
NEUTRAL = (2e11 * 0.001 * 0.01 + 7e10 * 0.003 * 0.05) / AXIAL
BENDING = sum(
    modulus * (0.05 * t**3 / 12 + 0.05 * t * (centre - NEUTRAL) ** 2)
    for modulus, t, centre in ((2e11, 0.02, 0.01), (7e10, 0.06, 0.05))
)
SHEAR = 5 / 6 * (STEEL.shear_modulus * 0.001 + ALUMINIUM.shear_modulus * 0.003)
BELOW = 0.04 - NEUTRAL  # of the neutral axis under the beam's axis


def test_the_layers_are_the_transformed_section():
    assert pytest.approx(0.030487804878048780) == NEUTRAL
    rigidity = LAYERS.rigidity()
    assert rigidity.axial == pytest.approx(AXIAL, rel=1e-14)
    assert rigidity.shear == pytest.approx(SHEAR, rel=1e-14)
    assert rigidity.bending - rigidity.coupling**2 / rigidity.axial == pytest.approx(BENDING, rel=1e-13)
    assert replace(LAYERS, axis=NEUTRAL).rigidity().coupling == pytest.approx(0.0, abs=1e-10 * AXIAL)
    assert replace(LAYERS, axis=NEUTRAL).rigidity().bending == pytest.approx(BENDING, rel=1e-13)
    assert (LAYERS.area, LAYERS.height, LAYERS.bounds) == (pytest.approx(0.004), pytest.approx(0.08), (-0.04, 0.04))


@pytest.mark.parametrize("forces", [bf.Structural(), bf.ElasticLine()])
def test_a_layered_cantilever_bends_as_the_transformed_section(forces):
    element = bf.CRBF(4) if forces == bf.Structural() else bf.ANCFCRBF(forces)
    force = 1e-3
    beam, solution = solve(LAYERS, [lambda b: bf.PointForce(b.end, (0.0, force))], element, 16)
    u, v = solution.displacement(beam.end)[-1]
    sheared = force / SHEAR if forces == bf.Structural() else 0.0
    assert v == pytest.approx(force / (3 * BENDING) + sheared, rel=1e-6)
    assert solution.rotation(beam.end)[-1] == pytest.approx(force / (2 * BENDING), rel=1e-6)
    # the axis lies above the neutral axis, on the side that a beam bent upwards compresses
    assert u == pytest.approx(-BELOW * force / (2 * BENDING), rel=1e-5)


@pytest.mark.parametrize(
    "element",
    [
        bf.CRBF(4),
        bf.ANCFCRBF(bf.ElasticLine()),
        bf.ANCF(bf.Structural()),
        bf.ShearRigid(),
        bf.CRBF(3, bf.SplitContinuum()),
    ],
    ids=lambda element: f"{element.name}-{element.forces.name}",
)
def test_pulled_above_its_neutral_axis_a_layered_beam_bends_down(element):
    """A pull P at the axis is P at the neutral axis and a moment -P BELOW."""
    pull = 1.0
    beam, solution = solve(LAYERS, [lambda b: bf.PointForce(b.end, (pull, 0.0))], element, 8)
    turn = -pull * BELOW / BENDING
    assert turn < 0.0
    assert solution.rotation(beam.end)[-1] == pytest.approx(turn, rel=3e-6)
    assert solution.displacement(beam.end)[-1] == pytest.approx([pull / AXIAL - turn * BELOW, 0.5 * turn], rel=3e-6)
    forces = solution.section_forces(beam)
    assert forces.normal[-1] == pytest.approx(pull, rel=1e-5)
    assert np.abs(forces.moment[-1]).max() < 1e-5 * pull


def test_a_layered_body_is_the_layered_beam_in_the_slender_limit():
    """Without Poisson's ratio and shear factor they are the same at small strain.

    At large strain the quadratic terms of Green's strain see the third moment of stiffness: first order in h / L.
    """
    steel, aluminium = replace(STEEL, poisson_ratio=0.0), replace(ALUMINIUM, poisson_ratio=0.0)

    def difference(thickness, size):
        layers = (bf.Layer(steel, 0.25 * thickness), bf.Layer(aluminium, 0.75 * thickness))
        section = bf.Layered(layers, 0.05, shear_factor=1.0)
        rigidity = section.rigidity()
        load = size * (rigidity.bending - rigidity.coupling**2 / rigidity.axial)
        tips = []
        for forces in (bf.ContinuumMechanics(), bf.Structural()):
            element = bf.CRBF(5, forces)
            beam, solution = solve(
                section, [lambda b, load=load: bf.PointForce(b.end, (-0.5 * load, load))], element, 6
            )
            tips.append(np.append(solution.displacement(beam.end)[-1], solution.rotation(beam.end)[-1]))
        return np.abs(tips[0] - tips[1]).max() / np.abs(tips[1]).max()

    assert difference(0.08, 1e-6) < 1e-6
    thick, thin = difference(8e-3, 2.0), difference(8e-4, 2.0)
    assert thin < 3e-4
    assert thick / thin == pytest.approx(10.0, rel=0.05)


ELEMENTS = [bf.CRBF(3), bf.ANCF(bf.Structural()), bf.ANCFCRBF(bf.ElasticLine()), bf.ShearRigid(False)]


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: f"{element.name}-{element.forces.name}")
def test_a_section_by_its_stiffness_is_the_section(element):
    section = bf.Rectangle(0.1, 0.2)
    same = bf.Section.from_stiffness(
        axial=2e11 * section.area,
        shear=5 / 6 * STEEL.shear_modulus * section.area,
        bending=2e11 * section.second_moment,
        mass=7800.0 * section.area,
        rotary_inertia=7800.0 * section.second_moment,
    )
    if element.forces == bf.ElasticLine():  # it knows no shear factor: r_y is held across r_x by G A
        same = replace(same, shear=STEEL.shear_modulus * section.area)
    found = []
    for own, material in ((section, STEEL), (same, None)):
        loads = [lambda b: bf.PointForce(b.end, (1e7, 1e8)), lambda b: bf.Gravity((0, -9.81))]
        beam, solution = solve(own, loads, element, 6, material)
        system = System(solution.model, static=False)
        rest = np.zeros(system.model.size)
        mass = linearise(system, system.reference, rest, rest, 0.0, INERTIA)[1].rows
        modes = bf.solve_modes(solution.model, 4).frequencies
        found.append((solution.p[-1], mass, modes, solution.section_forces(beam).moment[-1]))
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-12 * np.abs(one).max())


def test_a_coupling_by_hand_and_the_largest_there_can_be():
    section = bf.Section.from_stiffness(AXIAL, SHEAR, BENDING + AXIAL * BELOW**2, 1.0, 1.0, coupling=AXIAL * BELOW)
    for load in ((1e-2, 0.0), (0.0, 1e-3)):
        one, other = (solve(own, [lambda b: bf.PointForce(b.end, load)]) for own in (section, LAYERS))  # noqa: B023
        np.testing.assert_allclose(one[1].p[-1], other[1].p[-1], rtol=1e-12, atol=1e-16)
    for coupling in (10.0, -10.0, 11.0):
        with pytest.raises(bf.InputError, match="coupling"):
            bf.Section.from_stiffness(50.0, 1.0, 2.0, 1.0, 1.0, coupling=coupling)
    assert bf.Section.from_stiffness(50.0, 1.0, 2.0, 1.0, 1.0, coupling=-9.99).coupling == -9.99


@pytest.mark.parametrize("element", ELEMENTS[:3], ids=lambda element: f"{element.name}-{element.forces.name}")
def test_a_tapered_cantilever(element):
    """Virtual work: v = integral of P (1 - s)^2 / EI + P / (k_s G A), theta = integral of P (1 - s) / EI."""
    height, force = lambda s: 0.1 - 0.06 * s, 1e-2
    beam, solution = solve(
        lambda s: bf.Rectangle(0.05, height(s)), [lambda b: bf.PointForce(b.end, (0.0, force))], element, 64, STEEL
    )
    bending = lambda s: 2e11 * 0.05 * height(s) ** 3 / 12  # noqa: E731
    shear = quad(lambda s: force / (5 / 6 * STEEL.shear_modulus * 0.05 * height(s)), 0, 1)[0]
    sheared = 0.0 if element.forces == bf.ElasticLine() else shear
    v = quad(lambda s: force * (1 - s) ** 2 / bending(s), 0, 1, epsrel=1e-12)[0] + sheared
    turn = quad(lambda s: force * (1 - s) / bending(s), 0, 1, epsrel=1e-12)[0]
    rel = 1e-8 if element == bf.CRBF(3) else 5e-4
    assert solution.displacement(beam.end)[-1, 1] == pytest.approx(v, rel=rel)
    assert solution.rotation(beam.end)[-1] == pytest.approx(turn, rel=rel)


def test_mass_first_moment_and_rotary_inertia_of_layers():
    inertia = LAYERS.inertia()
    moments = [
        quad(lambda y: 0.05 * 7800.0 * y**n, -0.04, -0.02)[0] + quad(lambda y: 0.05 * 2700.0 * y**n, -0.02, 0.04)[0]  # noqa: B023
        for n in range(3)
    ]
    assert (inertia.mass, inertia.first_moment, inertia.rotary) == pytest.approx(moments, rel=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.5 * np.pi, 2.0])
def test_a_layered_beam_hangs_by_its_centre_of_mass(angle):
    """The moment of the weight about the clamp has the centre of mass as its lever, off the axis."""
    along = np.array([np.cos(angle), np.sin(angle)])
    beam, solution = solve(LAYERS, [lambda b: bf.Gravity((0.0, -1e-2))], end=tuple(along))
    inertia = LAYERS.inertia()
    offset = inertia.first_moment / inertia.mass
    assert offset < 0.0  # steel is at the bottom
    centre = 0.5 * along + offset * np.array([-along[1], along[0]])
    weight = 1e-2 * inertia.mass
    assert solution.reaction(beam.start)[-1] == pytest.approx(
        [0.0, weight, weight * centre[0]], rel=2e-6, abs=2e-6 * weight
    )


def test_a_layered_beam_that_spins_has_the_momentum_of_its_mass():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), LAYERS)
    spin = bf.RigidVelocity((0.0, 0.0), angular=0.1)
    solution = bf.simulate(bf.Model([beam]), 1e-6, 1e-6, velocity=spin)
    inertia = LAYERS.inertia()
    assert solution.linear_momentum()[0] == pytest.approx([-0.1 * inertia.first_moment, 0.05 * inertia.mass], rel=1e-9)
    assert solution.angular_momentum()[0] == pytest.approx(0.1 * (inertia.mass / 3 + inertia.rotary), rel=1e-9)
    assert solution.energy().kinetic[0] == pytest.approx(0.005 * (inertia.mass / 3 + inertia.rotary), rel=1e-9)


def a_beam(section, element=None, elements=2, material=STEEL, curve=None):
    return bf.Beam(curve or bf.Line((0, 0), (1, 0)), elements, element or bf.CRBF(2), section, material)


def run(section):
    beam = a_beam(section)
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)]))


SQUARE = bf.Rectangle(0.1, 0.1)
BAD = {
    "no layers": (lambda: bf.Layered((), 0.1), "layers"),
    "a layer of a number": (lambda: bf.Layered((0.1,), 0.1), "Layer"),
    "one layer, no list": (lambda: bf.Layered(bf.Layer(STEEL, 0.1), 0.1), "layers"),
    "layer without thickness": (lambda: bf.Layer(STEEL, 0.0), "thickness"),
    "layer of words": (lambda: bf.Layer("steel", 0.1), "material of a Layer"),
    "layers without width": (lambda: bf.Layered((bf.Layer(STEEL, 0.1),), 0.0), "width"),
    "negative diameter": (lambda: bf.Circle(-1.0), "diameter"),
    "wall too thick": (lambda: bf.Tube(0.1, 0.06), "half its diameter"),
    "no wall": (lambda: bf.Tube(0.1, 0.0), "thickness"),
    "stiffness of zero": (lambda: bf.Section.from_stiffness(1.0, 0.0, 1.0, 1.0, 1.0), "shear"),
    "stiffness for a body": (lambda: a_beam(bf.Section.from_stiffness(1, 1, 1, 1, 1), bf.ANCF()), "Structural"),
    "no material": (lambda: a_beam(SQUARE, material=None), "needs a material"),
    "a function that gives a number": (lambda: a_beam(lambda s: 0.1), r"arc length 0 must be a section"),
    "a height below zero at the end": (
        lambda: a_beam(lambda s: bf.Rectangle(0.1, 0.1 - 0.2 * s)),
        r"section\(0\.5\) .*height",
    ),
    "a height below zero between": (
        lambda: run(lambda s: bf.Rectangle(0.1, 1.0 if abs(s - 0.7) > 0.1 else -1.0)),
        r"section\(0\.\d+\) .*height",
    ),
    "no material somewhere": (lambda: run(lambda s: LAYERS if s > 0.5 else "steel"), "arc length 0"),
    "elements that fall": (lambda: a_beam(SQUARE, elements=[0.0, 0.5, 0.4, 1.0]), "rise"),
    "elements that stop short": (lambda: a_beam(SQUARE, elements=[0.0, 0.5]), "from 0 to 1"),
    "elements of words": (lambda: a_beam(SQUARE, elements=["a", "b"]), "elements"),
    "elements of nan": (lambda: a_beam(SQUARE, elements=[0.0, float("nan"), 1.0]), "elements"),
    "elements by name": (lambda: a_beam(SQUARE, elements="many"), "elements"),
    "no curve": (lambda: a_beam(SQUARE, curve=((0, 0), (1, 0))), "curve of a Beam"),
    "an elastic line without r_x": (lambda: bf.CRBF(3, bf.ElasticLine()), "r_xx"),
    "shear-rigid without r_x": (
        lambda: bf.Element(bf.CRBF(2).field, bf.ShearRigid().coordinates, bf.Structural()),
        "no r_x",
    ),
    "an element of order 9": (lambda: bf.CRBF(9), "at most 8"),
    "an element of order 0": (lambda: bf.CRBF(0), "order"),
    "an element of order 2.5": (lambda: bf.CRBF(2.5), "order"),
    "forces as a class": (lambda: bf.ANCF(forces=bf.Structural), "forces of an element"),
    "a field as a name": (lambda: bf.Element("cubic", bf.ANCF().coordinates, bf.Structural()), "field of an element"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_named(case):
    make, words = BAD[case]
    with pytest.raises(bf.InputError, match=words):
        make()


def test_the_stress_of_a_layer_is_that_of_its_own_material():
    """Pulled off its neutral axis, the axis stretches alike in both layers and each answers with its own modulus."""
    soft, stiff = bf.Material(1e9, 0.0, 1000.0), bf.Material(3e9, 0.0, 1000.0)
    for axis, modulus in ((0.019, 1e9), (0.021, 3e9)):
        section = bf.Layered([bf.Layer(soft, 0.02), bf.Layer(stiff, 0.01)], width=0.05, axis=axis)
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), section)
        state = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (1.0, 0.0))]))
        fields = state.fields(beam.at(0.3))
        assert fields.stress.xx[-1] == pytest.approx(modulus * fields.green_strain.xx[-1], rel=1e-4)
