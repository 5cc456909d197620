"""Section laws on the elements that take them: by linear sections, by differences, by hand and by other elements."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from fields import Equidistant, Quintic
from law_elements import LINE, LOBATTO, NEW, REFUSED, SHEARING, TAKEN, arm, at_tip, ids
from section_laws import LinearLaw, RambergOsgood, Softening
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.strain_rates import strain_rates
from beamfem.equations.system import System, system_of
from beamfem.results.postprocess import strain_energies
from beamfem.section import StiffnessSection

SECTION = {"axial": 1e6, "shear": 4e5, "bending": 100.0, "mass": 1.0, "rotary_inertia": 1e-4}
COUPLED = {**SECTION, "coupling": 3000.0}
every = pytest.mark.parametrize("element", TAKEN, **ids)
new = pytest.mark.parametrize("element", NEW, **ids)


def shares_rule(element, values):
    """Whether the linear section is integrated as laws are: on "lobatto" only if it couples stretch and curvature."""
    return element.integration != LOBATTO or values is COUPLED


@dataclass(frozen=True)
class Interacting(StiffnessSection):
    """s = f'(u) C eps with the energy f(u) of u = eps C eps / 2: all strains are coupled, but not at zero strain."""

    limit: float = 1.0

    def _linear(self, strain):
        return strain * np.array([self.axial, self.shear, self.bending])

    def resultants(self, strain, material):
        linear = self._linear(strain)
        return linear / np.sqrt(1.0 + (linear * strain).sum(axis=-1, keepdims=True) / self.limit)

    def energy(self, strain, material):
        return self.limit * (np.sqrt(1.0 + (self._linear(strain) * strain).sum(axis=-1) / self.limit) - 1.0)


def results(kind, element, values, curve=LINE):
    """Tip, energy, tip under imposed strains and in motion, and frequencies about the bent arm."""
    beam, model = arm(kind(**values), element, at_tip(0.0, 200.0, 5.0), curve=curve)
    bent = bf.solve_static(model, steps=2)
    stretch = 0.0 if element.coordinates == bf.ShearFree(stretchable=False) else 1e-3
    free = replace(model, loads=[bf.Actuation(beam, stretch=stretch, curvature=0.5), *model.loads])
    swung = bf.simulate(model, duration=0.01, step=1e-3)
    return [
        *bent.displacement(beam.end)[-1],
        bent.energy().total[-1],
        *bent.section_forces(beam).moment[-1],
        *bf.solve_static(free).displacement(beam.end)[-1],
        *swung.displacement(beam.end)[-1],
        *(bf.solve_modes(model, count=3, about=bent).frequencies / 1e3),
    ]


@mostly_slow("values", [SECTION, COUPLED], quick=(1,), ids=["plain", "coupled"])
@every
def test_a_linear_law_is_the_linear_section(element, values):
    if shares_rule(element, values):
        expected, found = (results(kind, element, values) for kind in (StiffnessSection, LinearLaw))
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-11)


@pytest.mark.parametrize("field", [Equidistant(), Quintic()], ids=["equidistant", "quintic"])
@pytest.mark.parametrize("coordinates", [bf.Gradients(), bf.Rotation()], ids=["gradients", "rotation"])
def test_a_linear_law_is_the_linear_section_on_fields_of_users(field, coordinates):
    element = bf.Element(field, coordinates, bf.Structural(), "reduced")
    expected, found = (results(kind, element, COUPLED) for kind in (StiffnessSection, LinearLaw))
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-11)


@new
def test_a_linear_law_is_the_linear_section_in_a_frame(element):
    """Of straight and curved beams with a rigid joint and a hinge, where gradients are rotated, by a sparse matrix."""
    found = []
    for kind in (StiffnessSection, LinearLaw):
        left = bf.Beam(bf.Line((0, 0), (0, 1)), 3, element, kind(**COUPLED))
        arch = bf.Beam(bf.Arc((1, 1), 1.0, np.pi, 0.0), 6, element, kind(**COUPLED))
        right = bf.Beam(bf.Line((2, 1), (2, 0)), 3, element, kind(**COUPLED))
        supports = [bf.Clamp(left.start), bf.Clamp(right.end)]
        joints = [bf.Rigid(left.end, arch.start), bf.Hinge(arch.end, right.start)]
        loads = [bf.PointForce(arch.at(0.4), (20.0, -80.0)), bf.Pressure(left, 30.0)]
        model = bf.Model([left, arch, right], supports, loads, joints)
        bent = bf.solve_static(model)
        modes = bf.solve_modes(model, count=4, about=bent).frequencies
        swung = bf.simulate(model, 0.005, 1e-3).displacement(arch.at(0.5))[-1]
        found.append([*bent.displacement(arch.at(0.5))[-1], *bent.section_forces(arch).moment[-1], *modes, *swung])
    assert found[1] == pytest.approx(found[0], rel=1e-7, abs=1e-9)


@new
def test_a_linear_law_is_the_linear_section_on_a_curved_beam(element):
    values, arc = COUPLED, bf.Arc((0, 0), 1.0, np.pi / 2, 0.0)
    expected, found = (results(kind, element, values, arc) for kind in (StiffnessSection, LinearLaw))
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-11)


@every
def test_a_warm_and_damped_linear_law_is_the_linear_section(element):
    """Heat expands the thickness as well, which gradients resist linearly; damping has the stiffness at zero strain."""
    values = COUPLED if element.integration == LOBATTO else SECTION
    lossy = bf.Material(1.0, 0.3, 1.0, retardation_time=0.01, thermal_expansion=1e-5)
    stiff = element.coordinates == bf.ShearFree(stretchable=False)
    found = []
    for kind in (StiffnessSection, LinearLaw):
        beam = bf.Beam(LINE, 4, element, kind(**values), lossy)
        loads = [bf.PointForce(beam.end, (0.0, 50.0)), *(() if stiff else (bf.Temperature(beam, 100.0),))]
        model = bf.Model([beam], [bf.Clamp(beam.start)], loads)
        bent, swung = bf.solve_static(model), bf.simulate(model, 0.01, 1e-3)
        found.append([*bent.p[-1], *swung.p[-1], bent.energy().total[-1]])
    assert found[1] == pytest.approx(found[0], rel=1e-10, abs=1e-12)
    if element.coordinates == bf.Gradients():
        thickness = np.linalg.norm(bent.fields(beam.end).r_y[-1])
        assert thickness == pytest.approx(1.0 + 1e-3, rel=1e-5)


@pytest.mark.parametrize("element", [own for own in NEW if own.integration == LOBATTO], **ids)
def test_a_linear_law_converges_to_the_linear_section_where_its_rule_is_another(element):
    """Curvature at Lobatto in place of Gauss points: of fourth order, as the elements."""
    apart = []
    for elements in (4, 8, 16):
        tips = []
        for kind in (StiffnessSection, LinearLaw):
            beam, model = arm(kind(**SECTION), element, at_tip(0.0, 300.0), elements)
            tips.append(bf.solve_static(model).displacement(beam.end)[-1])
        apart.append(np.abs(tips[1] - tips[0]).max())
    assert apart[0] < 1e-3
    assert np.log2(np.array(apart[:-1]) / apart[1:]) == pytest.approx([4.0, 4.0], abs=0.3)


@pytest.mark.parametrize(
    "section", [RambergOsgood(**SECTION, knee=20.0), Interacting(**SECTION, limit=3.0)], ids=["bending", "all"]
)
@every
def test_forces_are_derivatives_of_the_energy_and_tangents_of_the_forces(element, section, rng):
    """In states where every coordinate differs, the length of gradients as well; by differences of fourth order."""
    _, model = arm(section, element, elements=2)
    system, mesh = system_of(model, static=True), model.meshes[0]
    p = system.reference + 0.03 * rng.standard_normal(model.size)
    zeros, h = np.zeros(model.size), 3e-5

    def slopes(function):
        def of(dof):
            near, far = (function(p + step * dof) - function(p - step * dof) for step in (h, 2.0 * h))
            return (8.0 * near - far) / (12.0 * h)

        return np.array([of(dof) for dof in np.eye(model.size)[system.free_dofs]])

    force, tangent = linearise(system, p, zeros, zeros, 1.0, STATICS)
    expected = slopes(lambda at: strain_energies(mesh, at[None])[0, 0])
    assert force[system.free_dofs] == pytest.approx(expected, rel=1e-6, abs=1e-8 * np.abs(force).max())
    expected = slopes(lambda at: residual(system, at, zeros, zeros, 1.0)[system.free_dofs])
    found = tangent.sparse(system.rotated).toarray()
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-8 * np.abs(found).max())


@every
def test_an_arm_under_a_moment_is_the_arc_of_the_law(element):
    """Its curvature is that of the law everywhere; the element converges to the tip of the arc."""
    section = RambergOsgood(**SECTION, knee=100.0)
    curvature = section.curvature(90.0)
    tip = np.array([np.sin(curvature) / curvature - 1.0, (1.0 - np.cos(curvature)) / curvature])
    errors = []
    for elements in (8, 16, 32):
        beam, model = arm(section, element, at_tip(0.0, 0.0, 90.0), elements)
        bent = bf.solve_static(model)
        errors.append(np.abs(bent.displacement(beam.end)[-1] - tip).max())
    assert bent.section_forces(beam).moment[-1] == pytest.approx(90.0, rel=1e-8)
    if element.field.degree == 1 and element.integration == "full":  # locks
        assert errors[2] < 0.6 * errors[1] < errors[0]
        return
    order = 2 if element.field.degree == 1 else 4
    assert errors[2] < (2e-3 if order == 2 else 2e-4)
    assert np.log2(errors[0] / errors[2]) / 2.0 > order - 0.2
    # what the moment did along the way: the integral of M over the curvature
    work = section.energy(np.array([[0.0, 0.0, curvature]]), None)[0]
    assert bent.energy().strain[-1] == pytest.approx(work, rel=5e-3 if order == 2 else 2e-3)


@pytest.mark.parametrize("element", [*NEW, TAKEN[-1]], **ids)
def test_laws_that_couple_all_strains_give_one_answer(element):
    """A thick arm whose section gives way in shear, stretch and bending at once; the reference is CRBF(order=5)."""
    section = Interacting(**{**SECTION, "shear": 2000.0, "axial": 4000.0}, limit=10.0)
    tips = []
    for own, elements in ((bf.CRBF(order=5), 8), (element, 8), (element, 32)):
        beam, model = arm(section, own, at_tip(15.0, 25.0), elements)
        tips.append(bf.solve_static(model).displacement(beam.end)[-1])
    errors = [np.abs(tip - tips[0]).max() for tip in tips[1:]]
    # without shear at the nodes, that of the clamped one is missed
    assert errors[1] < (2e-3 if isinstance(element.coordinates, bf.ShearFree) else 6e-5)
    assert errors[1] < 0.25 * errors[0]


@new
def test_a_column_buckles_by_the_tangent_of_its_law(element):
    """Of a pinned column as it is compressed: P (1 + e + P / k_s G A) = pi^2 E I; errors fall by four at least."""
    section, by_hand, loads = Softening(**SECTION, limit=1500.0), 985.0, []
    for _ in range(20):
        stretch = np.arctanh(-by_hand / section.limit) * section.limit / section.axial
        by_hand = np.pi**2 * section.bending / (1.0 + stretch + by_hand / section.shear)
    for elements in (8, 16):
        beam = bf.Beam(LINE, elements, element, section)
        supports = [bf.Pin(beam.start), bf.Roller(beam.end)]
        model = bf.Model([beam], supports, [bf.PointForce(beam.end, (-1.0, 0.0))])
        loads.append(bf.trace_equilibrium(model, until=1400.0).bifurcations[0].load_factor)
    errors = np.abs(np.array(loads) / by_hand - 1.0)
    assert errors[1] < 0.26 * errors[0] < 5e-3
    assert bf.solve_buckling(model, count=1).load_factors[0] == pytest.approx(loads[1], rel=1e-6)


@pytest.mark.parametrize("slenderness", [1e3, 1e5])
@pytest.mark.parametrize("element", [NEW[0], *NEW[2:]], **ids)  # the other one locks
def test_slender_arms_keep_their_digits(element, slenderness):
    """Their tangents have stress resultants as unknowns; tip and frequencies are those of CRBF(order=3)."""
    thin = dict(SECTION, axial=100.0 * slenderness**2, shear=40.0 * slenderness**2, rotary_inertia=slenderness**-2)
    found = []
    for own in (bf.CRBF(order=3), element):
        beam, model = arm(RambergOsgood(**thin, knee=100.0), own, at_tip(0.0, 80.0), elements=32)
        bent = bf.solve_static(model)
        modes = bf.solve_modes(model, count=2, about=bent).frequencies
        found.append([*bent.displacement(beam.end)[-1], *modes])
    # 32 elements with a linear director, of second order: 2e-3
    assert found[1] == pytest.approx(found[0], rel=3e-3)


@new
def test_iterations_are_those_of_the_linear_section(element):
    """Independent stresses keep them few: as many as with a linear section that is as stiff."""
    counts = []
    for section in (StiffnessSection(**SECTION), RambergOsgood(**SECTION, knee=1000.0)):
        _, model = arm(section, element, at_tip(0.0, 200.0))
        counts.append(bf.solve_static(model).statistics.iterations)
    assert counts[1] <= counts[0] + 2


@pytest.mark.parametrize("element", SHEARING, **ids)
def test_what_locks_with_a_law_is_told(element):
    """The estimate is made with the law, on the rule of the element that does not lock."""
    said = []
    for kind in (StiffnessSection, LinearLaw):
        _, model = arm(kind(**COUPLED), element, at_tip(0.0, 200.0))
        said.append(bf.solve_static(model).warnings)
    assert said[1] == said[0]


@pytest.mark.parametrize("element", REFUSED, **ids)
def test_elements_that_scale_a_strain_or_take_it_elsewhere_are_refused(element):
    with pytest.raises(
        bf.InputError, match="takes some of them at other points or scales them, since its nodes do not"
    ):
        arm(LinearLaw(**SECTION), element)


def test_a_law_on_elements_without_shear_at_the_nodes_says_nothing_of_locking():
    """There is no locking-free rule to compare with that takes a law."""
    _, model = arm(LinearLaw(**SECTION), TAKEN[-2], at_tip(0.0, 200.0))
    assert not bf.solve_static(model).warnings


@pytest.mark.parametrize("coordinates", [bf.Gradients(), bf.Rotation()], ids=["gradients", "rotation"])
def test_strains_by_which_tangents_are_mixed_are_those_of_the_linear_section(coordinates, rng):
    """A linear law resists thickness stretches, too; they were not seen to be left out."""
    element = bf.Element(bf.Cubic(), coordinates, bf.Structural(), "full")
    found = []
    for kind in (StiffnessSection, LinearLaw):
        system = System(bf.Model([bf.Beam(LINE, 2, element, kind(**COUPLED))]), static=True)
        p = system.reference + 0.05 * np.random.default_rng(7).standard_normal(system.model.size)
        table = strain_rates(system.blocks[0], system.unknowns.free)
        found.append(table.at(p, system.loads.imposing(0.0)).strain)
    assert np.abs(found[0]).max() > 1e-3
    assert found[1] == pytest.approx(found[0], rel=1e-9, abs=1e-12)
