"""Cubic elements on slender beams: nothing locks by default, and where a choice locks the result says so."""

import re
from itertools import product

import numpy as np
import pytest
from conftest import COORDINATES, ELEMENTS, FORCES, identify
from shooting import Member, solved
from slow_values import mostly_slow

import beamfem as bf
from beamfem.element.coordinates import Gradients, ShearFree
from beamfem.element.fields import Cubic
from beamfem.equations.equations import linearise
from beamfem.equations.system import System
from beamfem.kernels import block
from beamfem.results.axis_points import axis, nodal_vectors
from beamfem.results.postprocess import strain_energies
from beamfem.results.status import Statistics

STEEL = bf.Material(2e11, 0.3, 7800.0)
LINES = (bf.Structural(), bf.ElasticLine())
DEFAULTS = [
    make(forces)
    for forces in LINES
    for make in (bf.ANCF, bf.ANCFCRBF, lambda f: bf.ShearRigid(True, f), lambda f: bf.ShearRigid(False, f))
]
LOBATTO = [element for element in ELEMENTS if element.integration == "lobatto"]
each_default = pytest.mark.parametrize("element", DEFAULTS, ids=identify)


def locks(solution):
    """Whether a solution says that its elements lock; a coarse mesh is another matter."""
    return any("elements lock" in sentence for sentence in solution.warnings)


def cantilever(element, elements, slenderness, *loads):
    """Solution and beam of length 1, clamped at its start; loads(beam, E I)."""
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section, STEEL)
    acting = [load(beam, 2e11 * section.second_moment) for load in loads]
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], acting)), beam


def tip_force(beam, bending):
    return bf.PointForce(beam.end, (0.0, 5.0 * bending))


@pytest.fixture(scope="module")
def elastica():
    """Tip displacement of the inextensible elastica under P L^2 / (E I) = 5, by shooting from the clamp."""
    rod = Member(1.0, 0.0)
    (moment,) = solved(lambda m: rod.run((0.0, 0.0, 0.0, 0.0, 5.0, m[0]))[5:], [3.0])
    return rod.run((0.0, 0.0, 0.0, 0.0, 5.0, moment))[:2] - [1.0, 0.0]


@each_default
def test_a_slender_cantilever_is_as_exact_as_a_thick_one(element, elastica):
    """With Gauss points the error of the tip grows to 1.6e-2 to 4e-2 at L/h = 1e4 and to 0.2 at 1e5."""
    allowed = 3.2e-4 if element.forces.name == "structural" else 4e-6
    for slenderness in (1e3, 1e4, 1e5):
        solution, beam = cantilever(element, 20, slenderness, tip_force)
        # stretch and shear of the beam, of the order of (h / L)^2, are not in the elastica
        physical = 10.0 / slenderness**2
        assert np.abs(solution.displacement(beam.end)[-1] - elastica).max() < allowed + physical
        assert solution.iterations <= 20
        assert solution.warnings == ()


@each_default
@pytest.mark.parametrize("slenderness", [1e2, 1e4])
def test_the_tip_of_a_slender_cantilever_keeps_its_order(element, slenderness):
    """Order 2 with the linear director, 4 where the curvature comes from r_xx."""
    order, meshes = (2, (10, 20, 40)) if element.forces.name == "structural" else (4, (6, 12, 24))
    values = [cantilever(element, count, slenderness, tip_force) for count in meshes]
    tips = [solution.displacement(beam.end)[-1] for solution, beam in values]
    found = np.log2(np.abs(tips[1] - tips[0]).max() / np.abs(tips[2] - tips[1]).max())
    assert order - 0.3 < found < order + 0.6


@pytest.mark.parametrize("make", [bf.ANCF, bf.ANCFCRBF], ids=["ANCF", "ANCF-CRBF"])
@pytest.mark.parametrize("forces", LINES, ids=lambda forces: forces.name)
def test_a_slender_roll_up_of_five_turns_closes(make, forces):
    """L/h = 1e4, 100 elements; it ended 4.6 and 5.1 rad off, and said that it had converged."""
    turns = 10.0 * np.pi
    solution, beam = cantilever(make(forces), 100, 1e4, lambda b, bending: bf.PointMoment(b.end, turns * bending))
    assert solution.rotation(beam.end)[-1] == pytest.approx(turns, abs=1e-2)
    assert np.linalg.norm(solution.position(beam.end)[-1]) < 1e-3


@pytest.mark.parametrize("element", [e for e in DEFAULTS if e.forces.name == "elastic-line"], ids=identify)
@pytest.mark.parametrize("slenderness", [10, 1e4])
def test_one_element_of_the_elastic_line_bends_as_its_cubic_does(element, slenderness):
    """P L^3 / (3 E I) exactly; r_x . d between the nodes held the curvature constant, which is 25 % too stiff."""
    solution, beam = cantilever(element, 1, slenderness, lambda b, bending: bf.PointForce(b.end, (0, 3e-6 * bending)))
    assert solution.displacement(beam.end)[-1, 1] == pytest.approx(1e-6, rel=1e-9)
    forces = solution.section_forces(beam)
    exact = 3e-6 * 2e11 * beam.section.second_moment
    np.testing.assert_allclose(forces.moment[-1], exact * (1.0 - forces.arc_length), rtol=1e-8, atol=1e-8 * exact)


@each_default
def test_a_free_thin_ring_rings_at_its_lowest_frequency(element):
    """Hoppe 1871: 6.2426 Hz; with Gauss points 12 elements gave 10.2 to 12.1 Hz."""
    section = bf.Rectangle(0.01, 0.01)
    ring = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2 * np.pi), 24, element, section, STEEL)
    modes = bf.solve_modes(bf.Model([ring], joints=[bf.Rigid(ring.start, ring.end)]), 5)
    exact = 6.0 / np.sqrt(5.0) * np.sqrt(2e11 * section.second_moment / (7800.0 * section.area)) / (2 * np.pi)
    assert modes.frequencies[3:] == pytest.approx(exact, rel=1.5e-2 if element.forces.name == "structural" else 3e-4)
    assert modes.warnings == ()


@pytest.mark.parametrize(("forces", "coordinates"), list(product(FORCES, COORDINATES)), ids=str)
@pytest.mark.parametrize("curve", [bf.Line((0, 0), (1, 0.5)), bf.Arc((0, 0), 1.0, 0.0, 1.0)], ids=["line", "arc"])
@pytest.mark.parametrize("elements", [1, 3])
def test_only_rigid_motions_cost_nothing(forces, coordinates, curve, elements):
    element = bf.Element(Cubic(), coordinates, forces, "lobatto")
    beam = bf.Beam(curve, elements, element, bf.Rectangle(0.1, 0.1), bf.Material(2e5, 0.3, 1.0))
    system = System(bf.Model([beam]), static=True)
    rest = np.zeros(system.model.size)
    tangent = linearise(system, system.reference, rest, rest, 0.0, (1.0, 0.0, 0.0))[1]
    found = np.linalg.eigvalsh(tangent.sparse(system.rotated).toarray())
    assert np.abs(found[:3]).max() < 1e-12 * found[-1]
    assert found[3] > 1e-5 * found[-1]


@mostly_slow("slenderness", [1e2, 1e4], quick=(1,))
@pytest.mark.parametrize("element", [e for e in LOBATTO if e.forces.name != "elastic-line"], ids=identify)
def test_section_forces_of_a_slender_beam_have_no_waves(element, slenderness):
    """Those of the deformed beam cut by hand, within the first order that 40 elements have; waves grow with (L / h)^2.

    Of a body, c = d'.d' / 2 steps from element to element while the stretch of their node is one.
    """
    allowed = 0.07 if element.forces.fills_body else 0.025
    solution, beam = cantilever(element, 40, slenderness, tip_force)
    forces = solution.section_forces(beam)
    load = 5.0 * 2e11 * beam.section.second_moment
    places = [beam.at(float(arc)) for arc in forces.arc_length]
    angle = np.array([solution.rotation(place)[-1] for place in places])
    arm = solution.position(beam.end)[-1, 0] - np.array([solution.position(place)[-1, 0] for place in places])
    for found, exact in (
        (forces.normal, load * np.sin(angle)),
        (forces.shear, load * np.cos(angle)),
        (forces.moment, load * arm),
    ):
        assert np.abs(found[-1] - exact).max() < allowed * load


def readable_energy(mesh, p):
    """Strain energy of a straight beam of one section, term by term from nodal vectors and what an element assumes."""
    element, section, material = mesh.beam.element, mesh.beam.section, mesh.beam.material
    forces, coordinates = element.forces, element.coordinates
    gradients, fixed = isinstance(coordinates, Gradients), coordinates == ShearFree(stretchable=False)
    vectors, total = nodal_vectors(mesh, p[None]), 0.0
    simpson, gauss = (np.array([0, 0.5, 1]), np.array([1, 4, 1]) / 6), np.polynomial.legendre.leggauss(3)
    for number in range(mesh.elements):
        length = mesh.lengths[number]

        def at(xi, number=number):
            return axis(mesh, vectors, np.full(len(xi), number), xi)

        points = forces.strains(at(simpson[0]))[0]
        mean = length * simpson[1]

        def integral(values, bubble=False, mean=mean):
            """Of a square; a bubble by the square of its mean."""
            if bubble:
                return mean.sum() * (simpson[1] @ values) ** 2
            return mean @ values**2

        free = not isinstance(coordinates, ShearFree)
        if forces.name in ("structural", "elastic-line"):
            rigidity = section.rigidity(material)
            total += 0.5 * rigidity.axial * integral(points[:, 0], fixed)
            if gradients:
                total += 0.25 * length * rigidity.axial * (points[[0, 2], 3] ** 2).sum()
        if forces.name == "structural":
            total += 0.5 * rigidity.shear * integral(points[:, 1], not free)
            turning = forces.strains(at(0.5 + 0.5 * gauss[0]))[0][:, 2]
            total += 0.25 * length * rigidity.bending * gauss[1] @ turning**2
        elif forces.name == "elastic-line":
            total += 0.5 * rigidity.bending * integral(points[:, 1])
            total += 0.25 * length * rigidity.shear / section.shear_factor * (points[[0, 2], 2] ** 2).sum()
        else:
            a, b, c, eyy, g0, _ = points.T
            eyy = np.array([eyy[0], 0.5 * (eyy[0] + eyy[2]), eyy[2]])
            g1 = np.full(3, (eyy[2] - eyy[0]) / length)
            lam, mu = material.lame_lambda(forces.plane_stress), material.shear_modulus
            ((_, moments),) = section.moments(material)
            area, second, fourth = moments[0], moments[2], moments[4]
            axial = lam + 2 * mu
            # exx = a + b y + c y^2; a that is a bubble counts with the square of its mean
            total += 0.5 * axial * (area * integral(a, fixed) + second * integral(b) + fourth * integral(c))
            total += axial * second * (mean @ (a * c))
            total += 0.5 * axial * area * integral(eyy) + lam * (area * (mean @ (a * eyy)) + second * mean @ (c * eyy))
            total += 0.5 * mu * (area * integral(g0, not free) + second * integral(g1))
    return total


@pytest.mark.parametrize("element", [e for e in LOBATTO if e.forces.name != "split"], ids=identify)
def test_the_strain_energy_is_the_one_written_by_hand(element, rng):
    beam = bf.Beam(bf.Line((0, 0), (1, 0.5)), 2, element, bf.Rectangle(0.1, 0.2), bf.Material(2e5, 0.3, 1.0))
    system = System(bf.Model([beam]), static=True)
    mesh, p = system.model.meshes[0], system.reference + 0.05 * rng.standard_normal(system.model.size)
    assert strain_energies(mesh, p[None])[0, 0] == pytest.approx(readable_energy(mesh, p), rel=1e-11)


LOCKING = [
    make(forces, integration)
    for forces in LINES
    for integration in ("full", "reduced")
    for make in (bf.ANCF, bf.ANCFCRBF, lambda f, i: bf.ShearRigid(True, f, i), lambda f, i: bf.ShearRigid(False, f, i))
]


@pytest.mark.parametrize("element", [*LOCKING, bf.ANCF(), bf.ANCFCRBF(), bf.BilinearCRBF()], ids=identify)
@pytest.mark.parametrize("slenderness", [1e2, 1e4])
def test_what_locks_says_so_wherever_it_costs_a_thousandth(element, slenderness):
    """Against the same strains where they do not lock, and silent where the tip is as exact as that."""
    if element.field.name == "bilinear":
        free, other = "reduced", bf.CRBF(3, bf.ContinuumMechanics())
    else:
        free, other = "lobatto", bf.Element(element.field, element.coordinates, element.forces, "lobatto")
    (found, beam), (right, same) = (cantilever(kind, 20, slenderness, tip_force) for kind in (element, other))
    lost = np.abs(found.displacement(beam.end)[-1] - right.displacement(same.end)[-1]).max()
    assert right.warnings == ()
    if lost > 1e-3:
        (sentence,) = found.warnings
        assert element.label in sentence
        assert f'integration="{free}"' in sentence
    elif lost < 2e-4:
        assert found.warnings == ()


THIN = bf.ContinuumMechanics()


@pytest.mark.parametrize(
    ("element", "elements", "slenderness"),
    [
        (bf.BilinearCRBF(integration="reduced"), 10, 1e3),
        (bf.BilinearCRBF(integration="reduced"), 20, 1e3),
        (bf.BilinearCRBF(integration="reduced"), 20, 1e2),
        (bf.CRBF(1, bf.SplitContinuum()), 40, 1e3),
        (bf.CRBF(2, bf.ContinuumMechanics(plane_stress=True)), 4, 1e3),
        (bf.CRBF(3, THIN), 2, 1e3),
        (bf.CRBF(4, THIN), 2, 1e4),
    ],
    ids=lambda value: getattr(value, "name", value),
)
def test_a_director_that_shortens_between_its_nodes_locks_and_says_so(element, elements, slenderness):
    """Tip 0.194 and 0.400 instead of 0.654 L, in silence; against the elastica with the body's bending stiffness."""
    law = element.forces
    factor = {"split": 1.0, "continuum": 0.7 / (1.3 * 0.4)}[law.name]
    if getattr(law, "plane_stress", False):
        factor = 1.0 / (1.0 - 0.3**2)
    rod = Member(1.0, 0.0)
    (moment,) = solved(lambda m: rod.run((0.0, 0.0, 0.0, 0.0, 5.0 / factor, m[0]))[5:], [3.0])
    tip = rod.run((0.0, 0.0, 0.0, 0.0, 5.0 / factor, moment))[1]
    with pytest.warns(bf.LockingWarning, match=f"elements lock: {element.name} .* structural forces or a higher order"):
        solution, beam = cantilever(element, elements, slenderness, tip_force)
    lost = tip / solution.displacement(beam.end)[-1, 1] - 1.0
    assert lost > 0.01
    (sentence,) = solution.warnings
    found = re.search(r"about (\S+) %", sentence)
    assert lost > 0.8 if found is None else lost / 2.0 < float(found[1]) / 100.0 < 1.5 * lost


@pytest.mark.parametrize(
    ("element", "elements", "slenderness"),
    [
        (bf.BilinearCRBF(integration="reduced"), 160, 1e3),
        (bf.BilinearCRBF(integration="reduced"), 80, 1e2),
        (bf.BilinearCRBF(integration="reduced"), 40, 10),
        (bf.CRBF(2, THIN), 20, 1e4),
        (bf.CRBF(4, THIN), 4, 1e4),
        (bf.BilinearANCF(THIN, "reduced"), 4, 1e4),
    ],
    ids=lambda value: getattr(value, "name", value),
)
def test_a_director_that_shortens_by_less_than_matters_says_nothing(element, elements, slenderness):
    """Fine meshes and high orders, and gradients, whose nodes make up for it by their length."""
    assert not locks(cantilever(element, elements, slenderness, tip_force)[0])


def test_the_beam_that_locks_most_is_named():
    """A slender arm that bends and one with nothing to carry, of one element."""
    section, element = bf.Rectangle(1e-3, 1e-3), bf.CRBF(1, THIN)
    idle, bent = (bf.Beam(bf.Line((0, y), (1, y)), 10, element, section, STEEL, name=f"at {y}") for y in (0, 1))
    load = bf.PointForce(bent.end, (0.0, 5.0 * 2e11 * section.second_moment))
    with pytest.warns(bf.LockingWarning, match="elements lock, most in beam 'at 1': CRBF-1"):
        bf.solve_static(bf.Model([idle, bent], [bf.Clamp(idle.start), bf.Clamp(bent.start)], [load]))


def test_frequencies_about_a_bent_state_that_a_short_director_stiffens_say_so():
    """A slender cantilever whose end is held at a quarter turn; many elements find a lower frequency."""
    found = []
    for elements in (8, 320):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(1, THIN), bf.Rectangle(1e-3, 1e-3), STEEL)
        model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, rotation=0.5 * np.pi)])
        found.append(bf.solve_modes(model, 3, about=bf.solve_static(model)))
    coarse, fine = found
    assert coarse.frequencies[0] > 1.05 * fine.frequencies[0]
    assert "elements lock: CRBF-1" in coarse.warnings[0]
    assert fine.warnings == ()


@pytest.mark.parametrize("element", DEFAULTS, ids=identify)
def test_a_layered_section_whose_neutral_axis_is_off_bends_right(element):
    """Small end moment: the section's own stiffness, with stretch and curvature coupled; no mode is lost or soft."""
    layers = (bf.Layer(bf.Material(2e11, 0.3, 7800.0), 0.01), bf.Layer(bf.Material(1e10, 0.3, 1000.0), 0.02))
    section = bf.Layered(layers, 0.02)
    rigidity = section.rigidity(None)
    bending = rigidity.bending - rigidity.coupling**2 / rigidity.axial
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, element, section)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 1e-3 * bending)])
    solution = bf.solve_static(model)
    assert rigidity.coupling != 0.0
    assert solution.rotation(beam.end)[-1] == pytest.approx(1e-3, rel=1e-4)
    forces = solution.section_forces(beam)
    np.testing.assert_allclose(forces.moment[-1], 1e-3 * bending, rtol=1e-4)


@pytest.mark.parametrize("order", [1, 4])
def test_what_does_not_lock_says_nothing(order):
    for slenderness in (1e1, 1e5):
        solution, _ = cantilever(bf.CRBF(order), 4, slenderness, tip_force)
        assert not locks(solution)


def test_a_line_that_cannot_bend_within_its_element_says_so():
    """One straight element with Gauss points is 25 % too stiff, though it stores hardly any energy in shear."""
    element = bf.ANCFCRBF(bf.ElasticLine(), "full")
    solution, beam = cantilever(element, 1, 100, lambda b, bending: bf.PointForce(b.end, (0, 3e-3 * bending)))
    assert solution.displacement(beam.end)[-1, 1] == pytest.approx(0.75e-3, rel=1e-3)
    assert len(solution.warnings) == 1


def test_frequencies_of_a_ring_that_locks_say_so():
    """Continuum forces of the paper on 24 elements: 29.9 Hz instead of 7.24 Hz."""
    ring = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 2 * np.pi), 24, bf.ANCFCRBF(), bf.Rectangle(0.01, 0.01), STEEL)
    modes = bf.solve_modes(bf.Model([ring], joints=[bf.Rigid(ring.start, ring.end)]), 5)
    (sentence,) = modes.warnings
    assert "ANCF-CRBF" in sentence


def test_warnings_of_a_solver_come_first_and_are_saved(tmp_path):
    pytest.importorskip("h5py")
    solution, _ = cantilever(bf.CRBF(1), 2, 10, tip_force)
    said = Statistics(3, 1, 0, "ended", warnings=("take care",))
    marked = bf.Solution(solution.model, True, solution.at, solution.p, solution.v, solution.a, said)
    assert marked.warnings == ("take care",)
    marked.save(tmp_path / "marked.h5")
    assert bf.load(tmp_path / "marked.h5").warnings == ("take care",)


def test_the_lobatto_rules_go_by_the_strain_measures_of_forces_not_by_their_class(monkeypatch):
    """Forces with measures of their own were integrated as those of a continuum, without a word."""

    class Own(bf.Structural):
        code = 3

    class Green(bf.Structural):
        code = bf.ContinuumMechanics().code
        shear_measures = bf.ContinuumMechanics().shear_measures

    monkeypatch.setattr(block, "MEASURES", (*block.MEASURES, Own.code))
    with pytest.raises(bf.InputError, match=r'"lobatto" has no rule for the strain measures of Own: .* use "full"'):
        bf.ANCF(Own(), integration="lobatto")
    assert bf.ANCF(Own()).integration == bf.ANCF(Green()).integration == "full"
    body, own = (bf.ANCF(forces, integration="lobatto") for forces in (bf.ContinuumMechanics(), Green()))
    assert own.energy_points()[0] == pytest.approx(body.energy_points()[0])
    stiffness, jacobian = np.eye(6)[None, None] * np.ones((1, 3, 1, 1)), np.ones((1, 3))
    assert own.energy_stiffness(stiffness, jacobian) == pytest.approx(body.energy_stiffness(stiffness, jacobian))


def test_the_lobatto_points_need_nodes_with_r_x():
    with pytest.raises(bf.InputError, match="cubic field"):
        bf.CRBF(2, integration="lobatto")


def test_the_papers_elements_keep_their_integration():
    for element in (bf.ANCF(), bf.ANCFCRBF(), bf.BilinearANCF(), bf.BilinearCRBF(bf.Structural())):
        assert element.integration == "full"
    assert bf.ShearRigid(True, bf.ContinuumMechanics()).integration == "reduced"
    assert bf.ANCF(bf.Structural()).integration == bf.ShearRigid().integration == "lobatto"


def test_locking_does_not_matter_in_a_motion_too_short_for_stiffness():
    """In 1e-7 s inertia alone decides: locked or not, the tip moves by the same, and nothing is reported."""
    tips = []
    for integration in ("full", "lobatto"):
        own = bf.Beam(
            bf.Line((0, 0), (1, 0)), 4, bf.ANCFCRBF(bf.Structural(), integration), bf.Rectangle(0.01, 0.01), STEEL
        )
        model = bf.Model([own], [bf.Clamp(own.start)], [bf.PointForce(own.end, (0.0, 1.0))])
        motion = bf.simulate(model, 1e-7, 1e-8)
        tips.append(motion.displacement(own.end)[-1, 1])
        assert motion.warnings == ()
    assert tips[0] == pytest.approx(tips[1], rel=1e-3)


@pytest.mark.filterwarnings("ignore::beamfem.LockingWarning")
def test_other_loads_lock_as_in_a_model_of_their_own():
    """The equations without locking are kept for all loads on a mesh."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.BilinearCRBF(), bf.Rectangle(0.05, 0.05), STEEL)
    forces = [[bf.PointForce(beam.end, (0.0, size))] for size in (1e3, 3e4)]
    first = bf.Model([beam], [bf.Clamp(beam.start)], forces[0])
    bf.solve_static(first)
    shared = bf.solve_static(first.with_loads(forces[1]))
    own = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], forces[1]))
    assert locks(shared)
    assert shared.warnings == own.warnings
