"""Loads and steps of the section inside elements: closed forms of slender beams in small displacements."""

import numpy as np
import pytest

import beamfem as bf

STIFF = bf.Section.from_stiffness(1e9, 1e9, 1.0, 1.0, 1.0)
AT, SMALL = 0.3, 1e-5


def simply_supported(elements, element, load, section=STIFF, curve=None):
    beam = bf.Beam(curve or bf.Line((0, 0), (1, 0)), elements, element, section)
    return beam, bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], [load(beam)])


def turn_under_moment(elements, element):
    """Error of the rotation under a moment M at a: M (3 a^2 - 3 a + 1) / (3 EI)."""
    beam, model = simply_supported(elements, element, lambda b: bf.PointMoment(b.at(AT), SMALL))
    exact = SMALL / 3 * (3 * AT**2 - 3 * AT + 1)
    return abs(bf.solve_static(model).rotation(beam.at(AT))[-1] / exact - 1.0)


def sag_under_force(elements, element):
    """Error of the displacement under a force F at a: F a^2 (1 - a)^2 / (3 EI)."""
    beam, model = simply_supported(elements, element, lambda b: bf.PointForce(b.at(AT), (0.0, -SMALL)))
    exact = -SMALL * AT**2 * (1 - AT) ** 2 / 3
    return abs(bf.solve_static(model).displacement(beam.at(AT))[-1, 1] / exact - 1.0)


@pytest.mark.parametrize("error", [turn_under_moment, sag_under_force])
@pytest.mark.parametrize("make", [lambda: bf.CRBF(1), lambda: bf.CRBF(3), lambda: bf.ANCF(bf.Structural())])
def test_a_load_inside_an_element_is_as_good_as_one_at_a_node(error, make):
    """Without a node there 9 CRBF(1) are off by 17.6 % and 9 CRBF(3) by 3.8 %, where 10 have a node at 0.3."""
    inside, at_node = error(9, make()), error(10, make())
    assert inside < 1.3 * at_node + 1e-8
    assert inside < (2e-8 if make() == bf.CRBF(3) else 0.015)


@pytest.mark.parametrize("error", [turn_under_moment, sag_under_force])
def test_the_order_of_convergence_is_full_wherever_the_load_is(error):
    """Linear elements: order 2; elements of order 2 are nodally exact here as they are with a node at the load."""
    errors = [error(elements, bf.CRBF(1)) for elements in (11, 21, 41, 81)]
    assert np.log2(errors[0] / errors[-1]) / 3 == pytest.approx(2.0, abs=0.15)
    assert error(7, bf.CRBF(2)) < 1e-7


def test_meshes_that_need_no_further_node_keep_their_elements():
    for fractions in ([], [0.3], [0.0, 1.0, 0.7]):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 10, bf.CRBF(2), STIFF)
        loads = [bf.PointForce(beam.at(fraction), (0.0, 1.0)) for fraction in fractions]
        mesh = bf.Model([beam], loads=loads).meshes[0]
        assert mesh.elements == 10
        assert np.array_equal(mesh.vertices, np.linspace(0.0, 1.0, 11))


def test_a_distributed_load_needs_no_node():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 9, bf.CRBF(2), STIFF)
    assert bf.Model([beam], loads=[bf.DistributedLoad(beam, (0.0, 1.0))]).meshes[0].elements == 9


def test_two_loads_at_a_point_share_its_node():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), STIFF)
    loads = [bf.PointForce(beam.at(0.3), (0.0, 1.0)), bf.PointMoment(beam.at(0.3), 1.0)]
    supports = [bf.Spring(beam.at(0.3), (1.0, 1.0))]
    assert bf.Model([beam], supports, loads).meshes[0].vertices == pytest.approx([0.0, 0.25, 0.3, 0.5, 0.75, 1.0])


def test_a_load_beside_a_node_moves_it_there():
    """An element of 1e-7 m would lose seven digits of its strains."""
    near = 0.3 + 1e-7
    beam, model = simply_supported(10, bf.CRBF(3), lambda b: bf.PointMoment(b.at(near), SMALL))
    assert model.meshes[0].elements == 10
    assert near in model.meshes[0].vertices
    solution = bf.solve_static(model)
    exact = SMALL / 3 * (3 * near**2 - 3 * near + 1)
    assert solution.rotation(beam.at(near))[-1] == pytest.approx(exact, rel=1e-8)
    assert solution.statistics.digits > 9


def test_a_node_that_a_support_needs_stays():
    near = 0.3 + 1e-6
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 10, bf.CRBF(2), STIFF)
    model = bf.Model([beam], [bf.Pin(beam.at(0.3))], [bf.PointMoment(beam.at(near), 1.0)])
    vertices = model.meshes[0].vertices
    assert model.meshes[0].elements == 11
    assert np.abs(vertices - 0.3).min() < 1e-15
    assert near in vertices


def test_ends_of_elements_that_a_user_gives_stay_if_a_load_is_apart():
    ends = (0.0, 0.1, 0.5, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), ends, bf.CRBF(2), STIFF)
    mesh = bf.Model([beam], loads=[bf.PointForce(beam.at(0.4), (0.0, 1.0))]).meshes[0]
    assert mesh.vertices == pytest.approx((0.0, 0.1, 0.4, 0.5, 1.0))


STEP, THICK = 0.37, 8.0


def stepped(arc_length):
    """EI = 8 up to the step, 1 behind it."""
    bending = THICK if arc_length < STEP else 1.0
    return bf.Section.from_stiffness(1e9, 1e9, bending, 1.0, 1.0)


def stepped_tip(section, elements, element):
    """Sag of a cantilever under a force at its tip over F / 3 ((1 - (1 - a)^3) / EI_1 + (1 - a)^3 / EI_2), less 1."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, SMALL))])
    rest = (1.0 - STEP) ** 3
    exact = SMALL / 3 * ((1.0 - rest) / THICK + rest)
    return abs(bf.solve_static(model).displacement(beam.end)[-1, 1] / exact - 1.0), model.meshes[0]


@pytest.mark.parametrize("elements", [5, 9, 15])
def test_elements_end_where_the_section_jumps(elements):
    """Without that the tip was off by up to 31 %; one point an element gives F sum h^3 / (12 EI) too little."""
    error, mesh = stepped_tip(stepped, elements, bf.CRBF(1))
    assert mesh.elements == elements + 1
    assert np.abs(mesh.vertices - STEP).min() < 1e-11
    size = np.diff(mesh.vertices)
    bending = np.where(mesh.vertices[:-1] < STEP - 1e-9, THICK, 1.0)
    rest = (1.0 - STEP) ** 3
    assert error == pytest.approx((size**3 / bending).sum() / 4 / ((1.0 - rest) / THICK + rest), abs=1e-7)
    assert stepped_tip(stepped, elements, bf.CRBF(2))[0] < 1e-7


@pytest.mark.parametrize("forces", [bf.Structural(), bf.ElasticLine()])
def test_cubic_elements_take_the_section_of_their_own_side(forces):
    """They have points at their ends, where the function gives one side only."""
    error, _ = stepped_tip(stepped, 40, bf.ANCFCRBF(forces))
    assert error < (1e-7 if isinstance(forces, bf.ElasticLine) else 2e-3)


def test_a_declared_kink_is_taken_at_its_word():
    beside = bf.Piecewise(stepped, [STEP, 0.6])
    error, mesh = stepped_tip(beside, 5, bf.CRBF(2))
    assert mesh.vertices == pytest.approx([0.0, 0.2, STEP, 0.4, 0.6, 0.8, 1.0])
    assert error < 1e-7


def test_every_step_of_a_staircase_is_found():
    steps = (0.11, 0.1234, 0.5, 0.9171)
    sizes = (5.0, 4.0, 3.0, 2.0, 1.0)
    section = lambda s: bf.Section.from_stiffness(1e9, 1e9, sizes[np.searchsorted(steps, s)], 1.0, 1.0)  # noqa: E731
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), section)
    assert beam.jumps == pytest.approx(steps, abs=1e-11)


def test_a_step_in_a_taper_is_found_and_smooth_sections_have_none():
    def taper(s, step=0.0):
        return bf.Rectangle(0.1, 0.1 + 0.05 * s + (step if s > 0.4321 else 0.0))

    steel = bf.Material(2e11, 0.3, 7800.0)
    for section, expected in (
        (taper, ()),
        (lambda s: taper(s, 0.01), (0.4321,)),
        (lambda s: bf.Rectangle(0.1, 0.1 * np.exp(-30.0 * s) + 0.01), ()),
        (lambda s: bf.Rectangle(0.1, 0.1 + 0.03 * np.sin(40.0 * s)), ()),
        (lambda s: bf.Rectangle(0.1, 0.1 + 0.04 * np.tanh(2000.0 * (s - 0.5))), ()),
        (lambda s: bf.Rectangle(0.1, max(0.05, 0.1 - 0.2 * s)), ()),
    ):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(2), section, steel)
        assert beam.jumps == pytest.approx(expected, abs=1e-11)


def test_a_jump_of_the_mass_alone_is_found():
    section = lambda s: bf.Section.from_stiffness(1.0, 1.0, 1.0, 1.0 if s < 0.7 else 2.0, 1.0)  # noqa: E731
    assert bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(2), section).jumps == pytest.approx((0.7,), abs=1e-11)


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCFCRBF(bf.Structural())])
def test_a_saved_stepped_beam_is_the_same_when_it_is_loaded(element, tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 5, element, stepped)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 0.1))])
    solution = bf.solve_static(model)
    solution.save(tmp_path / "stepped.h5")
    loaded = bf.load(tmp_path / "stepped.h5")
    again = bf.solve_static(loaded.model)
    assert np.array_equal(loaded.model.meshes[0].vertices, model.meshes[0].vertices)
    assert again.p[-1] == pytest.approx(solution.p[-1], abs=1e-12)
