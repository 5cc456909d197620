"""Actuation and heat in time, in files, in chains cut in two, of slender beams, and what is refused of them."""

import numpy as np
import pytest
from integrators import Radau

import beamfem as bf
from beamfem.cli.model_file import read_model_file
from beamfem.equations.equations import residual
from beamfem.equations.system import system_of

STEEL = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5)
SQUARE = bf.Rectangle(0.01, 0.01)
EA, EI = 2e11 * 1e-4, 2e11 * 1e-8 / 12.0


def straight(element=None, elements=6, start=(0.0, 0.0), end=(1.0, 0.0), material=STEEL, section=SQUARE):
    return bf.Beam(bf.Line(start, end), elements, element or bf.CRBF(order=3), section, material)


def clamped(own, *loads):
    return bf.Model([own], [bf.Clamp(own.start)], loads)


def wave(own, **more):
    return bf.Actuation(own, curvature=lambda s: 2.0 * np.cos(3.0 * s), amplitude=lambda t: np.sin(40.0 * t), **more)


def left_over(solution):
    """The largest unbalanced force of the rows of a motion, over the largest force of inertia."""
    system = system_of(solution.model, static=False)
    rows = list(zip(solution.p, solution.v, solution.a, solution.time, strict=True))
    unbalanced = [np.abs(residual(system, *row)[system.free_dofs]).max() for row in rows]
    still = [(p, v, 0 * a, time) for p, v, a, time in rows]
    inertia = [np.abs(residual(system, *row)[system.free_dofs]).max() for row in still]
    return max(unbalanced) / max(inertia)


def two_kinds(joined):
    """Beams of two groups, only the second of which has muscles; joined or each held by itself."""
    first, second = straight(bf.CRBF(2)), straight(bf.ANCF(), 5, (1.0, 0.0), (1.6, 0.4))
    held = [bf.Clamp(first.start)] if joined else [bf.Clamp(first.start), bf.Clamp(second.start)]
    joints = [bf.Rigid(first.end, second.start)] if joined else []
    loads = [wave(second), bf.Temperature(second, change=200.0, amplitude=lambda t: t), bf.Gravity((0.0, -9.81))]
    return bf.Model([first, second], held, loads, joints)


@pytest.mark.parametrize("joined", [True, False])
def test_every_step_balances_what_is_imposed_then(joined):
    """Compiled steps find the strains of each step and group; what they leave is evaluated apart from them."""
    solution = bf.simulate(two_kinds(joined), duration=0.05, step=5e-4)
    assert left_over(solution) < 1e-7
    assert np.abs(solution.displacement(solution.model.beams[1].end)).max() > 1e-2


def test_a_beam_that_moves_slowly_is_where_statics_put_it():
    own = straight(bf.CRBF(order=4), material=bf.Material(2e11, 0.3, 7800.0, retardation_time=0.02))
    ramp = bf.Interpolated(((0.0, 0.0), (2.0, 1.0), (3.0, 1.0)))
    moved = bf.simulate(clamped(own, bf.Actuation(own, curvature=2.0, amplitude=ramp)), duration=3.0, step=2e-3)
    solved = bf.solve_static(clamped(own, bf.Actuation(own, curvature=2.0)))
    assert moved.position(own.end)[-1] == pytest.approx(solved.position(own.end)[-1], abs=1e-6)


def test_a_constant_curvature_that_acts_at_once_keeps_the_energy():
    own = straight()
    model = clamped(own, bf.Actuation(own, curvature=0.5))
    motion = bf.simulate(model, duration=5e-3, step=1e-5, integrator=bf.GeneralizedAlpha(1.0))
    energy = motion.energy()
    assert energy.strain[0] == pytest.approx(0.5 * EI * 0.25, rel=1e-9)
    assert np.ptp(energy.total) < 2e-5 * energy.strain[0]
    assert energy.kinetic.max() > 0.1 * energy.strain[0]
    # the same as a moment at the free end, but for the quadrature of the curvature
    pushed = bf.simulate(clamped(own, bf.PointMoment(own.end, 0.5 * EI)), duration=5e-3, step=1e-5)
    assert motion.rotation(own.end)[100] == pytest.approx(pushed.rotation(own.end)[100], rel=5e-2)


@pytest.mark.slow
def test_other_ways_to_take_steps_agree():
    """A model whose tangent is sparse, and an integrator of one's own."""
    own = straight(bf.CRBF(2), elements=4)
    model = clamped(own, wave(own))
    tips = [
        bf.simulate(model, duration=0.02, step=step, integrator=integrator).position(own.end)[-1]
        for step, integrator in ((1e-5, bf.GeneralizedAlpha(1.0)), (2.5e-5, Radau()))
    ]
    assert tips[0] == pytest.approx(tips[1], abs=5e-7)
    halves = [straight(bf.CRBF(2), 2, (x, 0.0), (x + 0.5, 0.0)) for x in (0.0, 0.5)]
    shifted = bf.Actuation(
        halves[1], curvature=lambda s: 2.0 * np.cos(3.0 * (s + 0.5)), amplitude=lambda t: np.sin(40.0 * t)
    )
    joined = bf.Model(
        halves, [bf.Clamp(halves[0].start)], [wave(halves[0]), shifted], [bf.Rigid(halves[0].end, halves[1].start)]
    )
    parts = bf.simulate(joined, duration=0.02, step=1e-5, integrator=bf.GeneralizedAlpha(1.0))
    assert parts.position(halves[1].end)[-1] == pytest.approx(tips[0], abs=1e-9)


def test_a_saved_model_has_the_same_strains(tmp_path):
    own = straight()
    loads = bf.Actuation(own, curvature=lambda s: 1.0 + s, stretch=0.01), bf.Temperature(own, 30.0, lambda s: 100.0 * s)
    solution = bf.solve_static(clamped(own, *loads, bf.PointForce(own.end, (0.0, EI))))
    solution.save(tmp_path / "curled.h5")
    loaded = bf.load(tmp_path / "curled.h5")
    for one, other in ((solution, loaded),):
        beams = one.model.beams[0], other.model.beams[0]
        assert other.energy().strain == pytest.approx(one.energy().strain, rel=1e-12)
        forces = (each.section_forces(beam).moment for each, beam in zip((one, other), beams, strict=True))
        assert next(forces) == pytest.approx(next(forces), rel=1e-9, abs=1e-9 * EI)
    again = bf.solve_static(loaded.model)
    assert again.position(loaded.model.beams[0].end)[-1] == pytest.approx(solution.position(own.end)[-1], abs=1e-9)


@pytest.mark.parametrize("slenderness", [1e2, 1e4, 1e5])
def test_slender_beams_keep_their_digits(slenderness):
    """A free beam has no moment, a held one E I kappa, however large E A is beside E I."""
    height = 1.0 / slenderness
    own = straight(bf.CRBF(order=4), 10, section=bf.Rectangle(height, height))
    curl = bf.Actuation(own, curvature=0.8)
    free = bf.solve_static(clamped(own, curl))
    assert free.rotation(own.end)[-1] == pytest.approx(0.8, rel=1e-7)
    held = bf.solve_static(bf.Model([own], [bf.Clamp(own.start), bf.Clamp(own.end)], [curl]))
    bending = 2e11 * height**4 / 12.0
    assert held.reaction(own.start)[-1, 2] == pytest.approx(0.8 * bending, rel=1e-6)


def test_units_do_not_matter():
    tips = []
    for metre, newton in ((1.0, 1.0), (1e3, 1.0), (1.0, 1e-6)):
        material = bf.Material(2e11 * newton / metre**2, 0.3, 7800.0 * newton / metre**4)
        section = bf.Rectangle(0.01 * metre, 0.01 * metre)
        own = straight(end=(metre, 0.0), material=material, section=section)
        load = bf.PointForce(own.end, (0.0, 5.0 * EI * newton))
        solution = bf.solve_static(clamped(own, load, bf.Actuation(own, curvature=-2.0 / metre)))
        tips.append(solution.position(own.end)[-1] / metre)
    assert tips[1] == pytest.approx(tips[0], abs=1e-10)
    assert tips[2] == pytest.approx(tips[0], abs=1e-10)


def test_a_model_file_has_them(tmp_path):
    path = tmp_path / "strip.toml"
    path.write_text(
        """
[materials.steel]
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
thermal_expansion = 1.2e-5
[sections.strip]
kind = "rectangle"
width = 0.01
height = 0.01
[beams.strip]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 4
element = { kind = "CRBF", order = 4 }
section = "strip"
material = "steel"
[[supports]]
kind = "clamp"
point = "strip.start"
[[loads]]
kind = "temperature"
beam = "strip"
change = 20.0
gradient = 500.0
[[loads]]
kind = "actuation"
beam = "strip"
curvature = 0.3
"""
    )
    model = read_model_file(path).model
    turned = bf.solve_static(model).rotation(model.beams[0].end)[-1]
    assert turned == pytest.approx(0.3 - 1.2e-5 * 500.0, rel=1e-9)


BRASS = bf.Material(1e11, 0.3, 8500.0, thermal_expansion=1.9e-5)


def strip(upper):
    return bf.Layered([bf.Layer(STEEL, 0.001), bf.Layer(upper, 0.001)], 0.01)


def uneven_at_its_end():
    return straight(
        bf.CRBF(2, forces=bf.SplitContinuum()), material=None, section=lambda s: strip(BRASS if s > 0.9 else STEEL)
    )


def test_a_beam_may_expand_in_a_part_of_it_only():
    cold = bf.Material(2e11, 0.3, 7800.0)
    own = straight(
        material=None, section=lambda s: strip(STEEL) if s > 0.25 else bf.Layered([bf.Layer(cold, 0.002)], 0.01)
    )
    state = bf.solve_static(clamped(own, bf.Temperature(own, 100.0)))
    assert state.displacement(own.end)[-1, 0] == pytest.approx(0.75 * 1.2e-3, rel=1e-8)


REFUSED = {
    "no beam": (lambda own: bf.Actuation("beam", 1.0), "beam of Actuation must be a Beam"),
    "nan": (lambda own: bf.Actuation(own, curvature=np.nan), "curvature of Actuation"),
    "no number": (lambda own: bf.Temperature(own, change="hot"), "change of Temperature"),
    "no expansion": (
        lambda own: bf.Temperature(straight(material=bf.Material(2e11, 0.3, 7800.0)), 10.0),
        "thermal_expansion",
    ),
    "of two arguments": (lambda own: bf.Actuation(own, curvature=lambda s, t: s), "curvature of Actuation"),
    "gives none": (lambda own: bf.Actuation(own, curvature=lambda s: None), "curvature of Actuation"),
    "rigid in shear": (lambda own: bf.Actuation(straight(bf.ShearRigid()), shear=0.1), "do not shear"),
    "inextensible": (lambda own: bf.Actuation(straight(bf.ShearRigid(False)), stretch=0.1), "do not stretch"),
    "another beam": (lambda own: clamped(own, bf.Actuation(straight(), 1.0)), "is on a beam that is not in this model"),
    "layers of a continuum": (
        lambda own: bf.Temperature(
            straight(
                bf.CRBF(2, forces=bf.SplitContinuum()),
                material=None,
                section=bf.Layered([bf.Layer(STEEL, 0.001), bf.Layer(bf.Material(1e11, 0.3, 8500.0), 0.001)], 0.01),
            ),
            10.0,
        ),
        "layers that expand differently",
    ),
    "uneven further on": (lambda own: bf.Temperature(uneven_at_its_end(), 10.0), "layers that expand differently"),
    "inextensible but bent": (
        lambda own: bf.Temperature(straight(bf.ShearRigid(False), material=None, section=strip(BRASS)), 0.0, 100.0),
        "do not stretch",
    ),
    "amplitude": (lambda own: bf.Actuation(own, 1.0, amplitude=3.0), "amplitude of Actuation"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_bad_input_is_refused(name):
    make, said = REFUSED[name]
    with pytest.raises((bf.InputError, bf.UnknownPointError), match=said):
        make(straight())
