"""Static solves to a given accuracy: true errors against much finer meshes, and what the result tells."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.special import ellipk
from slow_values import mostly_slow

import beamfem as bf
from beamfem.solve.accuracy.adapted_mesh import refined
from studies.stability import deep_arches, williams_toggle

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.02, 0.01)
EI = 2e11 * SECTION.second_moment


def model_of(element, elements, loads):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SECTION, STEEL, "arm")
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], loads(beam))


def bent(beam):
    return [bf.PointForce(beam.end, (0.0, 5.0 * EI)), bf.PointForce(beam.at(0.3), (0.0, -9.0 * EI))]


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize(("element", "elements"), [(bf.CRBF(1), 4), (bf.CRBF(3), 1), (bf.CRBF(8), 1)])
def test_displacements_are_as_accurate_as_asked_for(element, elements, accuracy):
    beam, model = model_of(element, elements, bent)
    solution = bf.solve_static(model, accuracy=accuracy)
    fine_beam, fine = model_of(bf.CRBF(8), 20, bent)
    exact = bf.solve_static(fine)
    for at in (0.3, 0.5, 1.0):
        error = exact.displacement(fine_beam.at(at))[-1] - solution.displacement(beam.at(at))[-1]
        assert np.linalg.norm(error) < 1.2 * accuracy
    assert solution.error() <= accuracy
    assert solution.model.size < 130


def test_cubic_elements_are_shortened():
    beam, model = model_of(bf.ANCF(bf.Structural()), 4, bent)
    solution = bf.solve_static(model, accuracy=1e-3)
    fine_beam, fine = model_of(bf.ANCF(bf.Structural()), 256, bent)
    error = bf.solve_static(fine).displacement(fine_beam.end)[-1] - solution.displacement(beam.end)[-1]
    assert np.linalg.norm(error) < 2e-3
    assert solution.model.meshes[0].elements > 8


def test_a_quantity_may_be_what_is_accurate():
    beam, model = model_of(bf.CRBF(2), 2, bent)
    solution = bf.solve_static(model, accuracy=1e-5, quantity=lambda s: s.reaction(beam.start)[-1, 2])
    fine_beam, fine = model_of(bf.CRBF(8), 20, bent)
    exact = bf.solve_static(fine).reaction(fine_beam.start)[-1, 2]
    assert solution.reaction(beam.start)[-1, 2] == pytest.approx(exact, rel=2e-5)


@pytest.mark.parametrize("asked", [1e-3, 1e-8])
def test_quantities_that_are_zero_but_for_round_off_are_exact(asked):
    """Eleven meshes of round-off ended in a ConvergenceError."""
    beam, model = model_of(bf.CRBF(2), 1, bent)

    def moment(place):
        return lambda s: s.section_forces(beam).moment[-1, place]

    free = bf.solve_static(model, accuracy=asked, quantity=moment(-1))
    assert abs(moment(-1)(free)) < 1e-10 * abs(moment(0)(free))
    assert free.model.meshes[0].elements <= 4


def test_small_quantities_are_refined_as_any_other():
    beam, model = model_of(bf.CRBF(1), 1, lambda beam: [bf.PointForce(beam.end, (0.0, 1e-5 * EI))])
    solution = bf.solve_static(model, accuracy=1e-3, quantity=lambda s: s.displacement(beam.end)[-1, 0])
    assert solution.displacement(beam.end)[-1, 0] == pytest.approx(-1e-10 / 15.0, rel=1e-3)


@pytest.mark.parametrize("place", [0.5, 1.0])
def test_small_quantities_are_as_accurate_as_round_off_permits(place):
    """Displacements of second order, of which positions hold 4 to 5 digits; a ConvergenceError after 6 meshes or more.

    From u' = -w'^2 / 2 with w' = f (x - x^2 / 2), and the shear angle, which is 1e-4 of it.
    """
    beam, model = model_of(bf.CRBF(1), 1, lambda beam: [bf.PointForce(beam.end, (0.0, 1e-5 * EI))])
    point = beam.at(place)
    with pytest.warns(bf.RoundOffWarning, match="round-off leaves about [345] digits of the quantity"):
        solution = bf.solve_static(model, accuracy=1e-6, quantity=lambda s: s.displacement(point)[-1, 0])
    exact = -0.5e-10 * (place**3 / 3.0 - place**4 / 4.0 + place**5 / 20.0)
    assert solution.displacement(point)[-1, 0] == pytest.approx(exact, rel=2e-3)


def loaded_span(**mesh):
    """Simply supported under a uniform load: shear forces of both ends are equal, and of opposite sign."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=SECTION, material=STEEL, **mesh)
    return beam, bf.Model(
        [beam], [bf.Pin(beam.start), bf.Roller(beam.end)], [bf.DistributedLoad(beam, (0.0, -20.0 * EI))]
    )


@pytest.mark.parametrize(
    ("accuracy", "of"),
    [
        *((accuracy, lambda s, b: s.section_forces(b).peak("shear").value) for accuracy in (1e-2, 1e-6, 1e-8)),
        (1e-2, lambda s, b: s.section_forces(b).peak("normal").value),
        (1e-2, lambda s, b: s.rotation(b.end)[-1]),
    ],
)
def test_peaks_of_either_sign_and_of_one_coarse_element_are_as_accurate_as_asked_for(accuracy, of):
    fine, model = loaded_span(elements=16, element=bf.CRBF(8))
    exact = of(bf.solve_static(model), fine)
    beam, model = loaded_span()
    solution = bf.solve_static(model, accuracy=accuracy, quantity=lambda s: of(s, beam))
    assert abs(of(solution, beam)) == pytest.approx(abs(exact), rel=accuracy)
    assert abs(solution.error(lambda s: of(s, beam))) <= accuracy * abs(exact)


@pytest.mark.slow
def test_forces_and_moments_are_each_as_accurate_as_asked_for():
    """A strut whose axial reaction is some 3000 times as large as the moment at its clamp."""
    found = []
    for mesh in ({"elements": 6, "element": bf.CRBF(8)}, {}):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=SECTION, material=STEEL, **mesh)
        loads = [bf.PointForce(beam.at(0.3), (1e5, 0.0)), bf.DistributedLoad(beam, lambda s: (0.0, np.exp(-30.0 * s)))]
        model = bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end)], loads)
        asked = {} if mesh else {"accuracy": 1e-2, "quantity": lambda s, beam=beam: s.reaction(beam.start)[-1]}
        found.append(bf.solve_static(model, **asked).reaction(beam.start)[-1])
    assert found[1] == pytest.approx(found[0], rel=1e-2)


def test_entries_of_a_list_are_each_as_accurate_as_asked_for():
    beam, model = loaded_span()

    def both(solution):
        return [1e6 * solution.section_forces(beam).peak("moment").value, solution.rotation(beam.end)[-1]]

    fine, exact = loaded_span(elements=16, element=bf.CRBF(8))
    solution = bf.solve_static(model, accuracy=1e-5, quantity=both)
    assert both(solution)[1] == pytest.approx(bf.solve_static(exact).rotation(fine.end)[-1], rel=1e-5)


def test_elements_are_short_only_where_it_is_needed():
    """On a stiff foundation only the loaded end bends."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), SECTION, STEEL)
    bed = bf.Foundation(beam, (0.0, 4e6 * EI))
    held = [bf.Roller(beam.start, (1, 0)), bed]
    solution = bf.solve_static(bf.Model([beam], held, [bf.PointForce(beam.end, (0.0, 1e3 * EI))]), accuracy=1e-7)
    lengths = solution.model.meshes[0].lengths
    assert lengths[0] > 3.0 * lengths[-1]


def test_the_result_tells_its_mesh_and_is_saved_with_it(tmp_path):
    beam, model = model_of(bf.CRBF(1), 4, bent)
    solution = bf.solve_static(model, accuracy=1e-4)
    assert "the estimated error is" in solution.statistics.ended
    assert solution.model.beams[0].element.name == "CRBF-4"
    solution.save(tmp_path / "arm.h5")
    loaded = bf.load(tmp_path / "arm.h5")
    again = loaded.model.beams[0]
    assert np.array_equal(loaded.displacement(again.end), solution.displacement(beam.end))
    assert loaded.reaction(again.start) == pytest.approx(solution.reaction(beam.start))


def test_the_finer_model_can_be_used_on():
    beam, model = model_of(bf.CRBF(1), 4, bent)
    finer = bf.solve_static(model, accuracy=1e-4).model
    more = finer.with_loads([bf.PointForce(beam.end, (0.0, EI))])
    assert bf.solve_static(more).displacement(beam.end)[-1, 1] > 0.2
    crooked = finer.with_imperfection(bf.solve_modes(finer, 1), size=1e-3)
    assert bf.solve_static(crooked).displacement(crooked.beams[0].end)[-1, 1] > 0.0


def test_elements_of_ones_own_stay_and_fewer_are_found_if_asked_for():
    beam, model = model_of(bf.CRBF(1), 200, bent)
    own = bf.solve_static(model, accuracy=1e-3)
    assert own.model.size == model.size
    few = bf.solve_static(model.meshed("auto"), accuracy=1e-3)
    assert few.model.size < model.size / 10
    assert few.displacement(beam.end)[-1] == pytest.approx(own.displacement(beam.end)[-1], abs=2e-3)
    with pytest.raises(bf.InputError, match='meshed takes a state or a solution of the model, or "auto"'):
        model.meshed("fine")


def test_elements_that_lock_and_bad_accuracies_are_refused():
    _, model = model_of(bf.ANCF(), 4, bent)
    with pytest.raises(bf.InputError, match="an accuracy cannot be had with these elements: elements lock"):
        bf.solve_static(model, accuracy=1e-3)
    with pytest.raises(bf.InputError, match="accuracy must be"):
        bf.solve_static(model, accuracy=0.0)


def auto(**parts):
    return bf.Beam(bf.Line((0, 0), (1, 0)), section=SECTION, material=STEEL, **parts)


def test_beams_without_elements_are_meshed_to_four_digits(tmp_path):
    beam = auto()
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], bent(beam)))
    fine_beam, fine = model_of(bf.CRBF(8), 20, bent)
    exact = bf.solve_static(fine).displacement(fine_beam.end)[-1]
    assert np.linalg.norm(solution.displacement(beam.end)[-1] - exact) < 1e-4
    assert solution.error() < 1e-4
    solution.save(tmp_path / "arm.h5")
    loaded = bf.load(tmp_path / "arm.h5")
    assert loaded.displacement(loaded.model.beams[0].end)[-1] == pytest.approx(solution.displacement(beam.end)[-1])


@pytest.mark.parametrize("accuracy", [1e-4, 1e-8])
def test_frequencies_are_as_accurate_as_asked_for(accuracy):
    beam = auto()
    found = bf.solve_modes(bf.Model([beam], [bf.Clamp(beam.start)]), 4, accuracy=accuracy)
    _, fine = model_of(bf.CRBF(8), 8, lambda beam: [])
    exact = bf.solve_modes(fine, 4).frequencies
    assert found.frequencies == pytest.approx(exact, rel=1.2 * accuracy)


@pytest.mark.parametrize("accuracy", [None, 1e-7])
def test_critical_loads_are_as_accurate_as_asked_for(accuracy):
    beam = auto()
    column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1.0, 0.0))])
    found = bf.solve_buckling(column, 2, accuracy=accuracy)
    _, fine = model_of(bf.CRBF(8), 8, lambda beam: [bf.PointForce(beam.end, (-1.0, 0.0))])
    assert found.load_factors == pytest.approx(bf.solve_buckling(fine, 2).load_factors, rel=1.2 * (accuracy or 1e-4))


@mostly_slow("accuracy", [1e-3, 1e-4, 1e-6], quick=(1,))
def test_limit_points_are_as_accurate_as_asked_for(accuracy):
    """Lee's frame; near its limit points displacements at a given load have errors without bound."""
    section, material = bf.Section(area=6.0, second_moment=2.0), bf.Material(7.2e6, 0.3, 2.7e-5)

    def limits(elements, accuracy=None):
        column = bf.Beam(bf.Line((0, 0), (0, 120)), elements, bf.CRBF(4), section, material)
        bar = bf.Beam(bf.Line((0, 120), (120, 120)), elements, bf.CRBF(4), section, material)
        held, joined = [bf.Pin(column.start), bf.Pin(bar.end)], [bf.Rigid(column.end, bar.start)]
        frame = bf.Model([column, bar], held, [bf.PointForce(bar.at(0.2), (0, -1.0))], joined, units="N, cm")

        def far(state):
            return state.displacement(bar.at(0.2))[1] < -95.0

        path = bf.trace_equilibrium(frame, until=far, accuracy=accuracy)
        return path, frame, [point.load_factor for point in path.limit_points]

    _, _, exact = limits(12)
    path, frame, found = limits("auto", accuracy)
    assert found == pytest.approx(exact, abs=2.0 * accuracy * exact[0])
    again = bf.trace_equilibrium(frame.meshed(path), until=exact[0] / 2.0)
    assert again.model.beams[0].elements == path.model.beams[0].elements


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", [1e-4, 1e-6])
def test_limits_of_a_toggle_are_as_accurate_as_asked_for(accuracy):
    """Williams' toggle, by collocation of the Reissner beam."""
    toggle = williams_toggle.toggle(None, 1, 1)
    path = bf.trace_equilibrium(toggle.meshed("auto"), until=90.0, accuracy=accuracy)
    for found, (load, deflection, _) in zip(path.limit_points, williams_toggle.LIMITS, strict=True):
        assert found.load_factor == pytest.approx(load, abs=accuracy * 90.0)
        assert -found.displacement(toggle.beams[0].end)[1] == pytest.approx(deflection, abs=accuracy * 25.886)


@pytest.mark.slow
@mostly_slow("accuracy", [1e-4, 1e-6])
def test_limits_of_a_deep_arch_are_as_accurate_as_asked_for(accuracy):
    """The clamped-hinged arch of 215 degrees, the elastica by collocation; L / h = 1e4, so that it hardly stretches."""
    arch = deep_arches.arch("clamped-hinged", 1, 1, 1e4).meshed("auto")
    path = bf.trace_equilibrium(arch, until=lambda state: deep_arches.crown(state)[1] > 1.3, accuracy=accuracy)
    limit = path.limit_points[0]
    assert limit.load_factor == pytest.approx(deep_arches.LIMITS["clamped-hinged"], rel=2.0 * accuracy)
    size = 2.0 * deep_arches.HALF
    assert deep_arches.crown(limit) == pytest.approx((0.61141465795, 1.13732063125), abs=2.0 * accuracy * size)


def critical_loads(path):
    return [point.load_factor for point in (*path.limit_points, *path.bifurcations)]


def columns(**mesh):
    """Straight columns between a clamp and a free or a guided end: until they buckle, any mesh is exact."""
    for guided, force in ((False, 1e4), (True, 4e4)):
        beam = bf.Beam(bf.Line((0, 0), (0, 1)), section=bf.Rectangle(0.01, 0.01), material=STEEL, **mesh)
        guide = [bf.Prescribed(beam.end, ux=0.0, rotation=0.0)] if guided else []
        yield bf.Model([beam], [bf.Clamp(beam.start), *guide], [bf.PointForce(beam.end, (0.0, -force))])


@pytest.mark.slow
@mostly_slow("accuracy", [1e-2, 1e-3, 1e-4, 1e-6], quick=(0, 2))
def test_critical_points_of_straight_columns_are_found_on_any_mesh(accuracy):
    for fine, model in zip(columns(elements=12, element=bf.CRBF(8)), columns(), strict=True):
        exact = critical_loads(bf.trace_equilibrium(fine, 1.0))
        found = critical_loads(bf.trace_equilibrium(model, 1.0, accuracy=accuracy))
        assert found == pytest.approx(exact, abs=accuracy * max(exact))


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4])
@mostly_slow(("stiffness", "end"), [(1.0, 2.5), (100.0, 20.4)])
def test_bifurcations_into_waves_shorter_than_the_first_elements_are_found(stiffness, end, accuracy):
    """N_m = EI (m pi / L)^2 + k (L / m pi)^2, inextensible: paths on both meshes were straight, and stable, beyond."""
    length, height = 10.0, 1e-3
    material = bf.Material(12.0 / height**3, 0.3, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (length, 0)), section=bf.Rectangle(1.0, height), material=material)
    parts = [bf.Pin(beam.start), bf.Roller(beam.end), bf.Foundation(beam, (0.0, stiffness))]
    column = bf.Model([beam], parts, [bf.PointForce(beam.end, (-1.0, 0.0))])
    waves = (np.arange(1, 20) * np.pi / length) ** 2
    exact = sorted(load for load in waves + stiffness / waves if load < end)
    found = critical_loads(bf.trace_equilibrium(column, end, accuracy=accuracy))
    assert found == pytest.approx(exact, abs=accuracy * exact[-1])


def test_a_branch_starts_at_a_bifurcation_of_a_model_without_elements():
    """Tip of the elastica: 2 sin(a / 2) sqrt(EI / P), P = K(sin^2(a / 2))^2 EI / L^2; strains of 4e-5 are left out."""
    column = next(columns())
    path = bf.trace_equilibrium(column, 1.0, accuracy=1e-4)
    start, turn, stiffness = path.bifurcations[0], 1.5, 2e11 * 0.01**4 / 12.0
    squared = np.sin(0.5 * turn) ** 2
    end = ellipk(squared) ** 2 * stiffness / 1e4
    branch = bf.trace_equilibrium(column, end, start=start)
    tip = branch.displacement(column.beams[0].end)[-1, 0]
    assert abs(tip) == pytest.approx(2.0 * np.sqrt(squared * stiffness / (1e4 * end)), rel=2e-4)
    with pytest.raises(bf.InputError, match="a branch has the mesh of the path that it leaves"):
        bf.trace_equilibrium(column, end, start=start, accuracy=1e-4)
    pressed = column.with_loads([bf.PointForce(column.beams[0].end, (0.0, -2e4))])
    with pytest.raises(bf.InputError, match="start is a bifurcation of another model"):
        bf.trace_equilibrium(pressed, end, start=start)


@pytest.mark.slow
@pytest.mark.parametrize("ends", [pytest.param(True, marks=pytest.mark.slow), False])
@pytest.mark.parametrize("accuracy", [1e-4])
def test_critical_points_of_shallow_arches_are_as_accurate_as_asked_for(accuracy, ends):
    """A clamped bistable beam whose middle is moved down, or a pinned arch, against 12 elements of order 8."""
    height = 0.01 if ends else 0.03

    def rise(x):
        return x, height * (1.0 - np.cos(2.0 * np.pi * x)) if ends else height * np.sin(np.pi * x)

    found = []
    for mesh in ({"elements": 12, "element": bf.CRBF(8)}, {}):
        beam = bf.Beam(bf.Parametric(rise, 0, 1), section=bf.Rectangle(0.1, 0.002), material=STEEL, **mesh)
        if ends:
            moved = bf.Prescribed(beam.at(0.5), uy=-0.04, rotation=0)
            model = bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end), moved])
        else:
            load = bf.PointForce(beam.at(0.5), (0.0, -100.0))
            model = bf.Model([beam], [bf.Pin(beam.start), bf.Pin(beam.end)], [load])
        found.append(critical_loads(bf.trace_equilibrium(model, 1.0, accuracy=None if mesh else accuracy)))
    assert found[1] == pytest.approx(found[0], abs=accuracy * np.abs(found[0]).max())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("element", "elements", "expected"),
    [(bf.CRBF(2), 16, 1.0), (bf.CRBF(3), 4, 0.97), (bf.ANCF(bf.Structural()), 16, 0.75)],
)
def test_the_effectivity_of_critical_load_factors_is_that_of_the_order(element, elements, expected):
    """Limit points and bifurcations of a pinned sine arch that snaps through and back."""

    def path(element, elements):
        arch = bf.Parametric(lambda x: (x, 0.1 * np.sin(np.pi * x)), 0, 1)
        beam = bf.Beam(arch, elements, element, bf.Rectangle(0.01, 0.005), STEEL)
        load = bf.PointForce(beam.at(0.5), (0.0, -1e3))
        return bf.trace_equilibrium(bf.Model([beam], [bf.Pin(beam.start), bf.Pin(beam.end)], [load]), 0.55)

    coarse, fine = path(element, elements), path(bf.CRBF(8), 12)
    points = (*coarse.limit_points, *coarse.bifurcations)
    true = np.subtract(critical_loads(fine), critical_loads(coarse))
    assert [coarse.error(point) for point in points] / true == pytest.approx(np.full(4, expected), abs=0.03)
    with pytest.raises(bf.InputError, match="one of the limit points or bifurcations of the path"):
        coarse.error(fine.limit_points[0])


@pytest.mark.parametrize("accuracy", [1e-4, 1e-6])
def test_tips_of_cantilevers_are_as_accurate_as_asked_for(accuracy):
    """P L^2 = 5 E I and L / h = 100, by collocation of the Reissner beam."""
    section = bf.Rectangle(0.01, 0.01)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=section, material=STEEL)
    force = bf.PointForce(beam.end, (0.0, 5.0 * 2e11 * section.second_moment))
    found = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [force]), accuracy=accuracy)
    assert found.displacement(beam.end)[-1] == pytest.approx((-0.38764432832607, 0.71385896416489), abs=accuracy)


@pytest.mark.parametrize("accuracy", [1e-4, 1e-6])
def test_slender_strips_with_thin_hinges_are_as_accurate_as_asked_for(accuracy):
    """L / h = 1e5, half as thick on a hundredth of it, which bends most; the reference has 36 elements of order 6."""
    found = []
    for mesh in ({}, {"elements": 12, "element": bf.CRBF(6)}):
        thick, thin = bf.Rectangle(1e-5, 1.0), bf.Rectangle(5e-6, 1.0)
        parts = [(0.0, 0.495, thick), (0.495, 0.505, thin), (0.505, 1.0, thick)]
        beams = [bf.Beam(bf.Line((a, 0), (b, 0)), section=each, material=STEEL, **mesh) for a, b, each in parts]
        joints = [bf.Rigid(a.end, b.start) for a, b in pairwise(beams)]
        force = bf.PointForce(beams[-1].end, (0.0, 3.0 * 2e11 * thick.second_moment))
        model = bf.Model(beams, [bf.Clamp(beams[0].start)], [force], joints)
        solution = bf.solve_static(model, accuracy=None if mesh else accuracy)
        found.append(solution.displacement(beams[-1].end)[-1])
    assert np.linalg.norm(found[0] - found[1]) < accuracy


def test_motions_are_as_accurate_as_asked_for():
    material, section = bf.Material(0.7e6, 0.3, 5540.0), bf.Section(1.6e-3, 8.533e-6)

    def tip(elements, accuracy=None):
        arm = bf.Beam(bf.Line((0, 0), (1.2, 0)), elements, section=section, material=material)
        model = bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity((0, -9.81))])
        return bf.simulate(model, 0.2, 1e-3, save_every=20, accuracy=accuracy).position(arm.end)

    errors = np.linalg.norm(tip("auto", 1e-5) - tip(16), axis=1)
    assert errors.max() < 1.2 * 2e-5  # of the diameter of the circle of its reach


def falling(**mesh):
    """A printed pendulum that is let go."""
    material, section = bf.Material(0.7e6, 0.3, 5540.0), bf.Section(1.6e-3, 8.533e-6)
    arm = bf.Beam(bf.Line((0, 0), (1.2, 0)), section=section, material=material, **mesh)
    return arm, bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity((0, -9.81))])


@pytest.mark.parametrize(
    ("element", "accuracy"),
    [
        (bf.ANCF(bf.Structural()), 1e-4),
        (bf.ANCFCRBF(bf.Structural()), 1e-4),
        (bf.ShearRigid(), 1e-2),
        (bf.CRBF(1), 1e-2),
    ],
)
def test_elements_between_nodes_that_do_not_turn_are_refined(element, accuracy):
    """Neither one element nor its halves bend where both ends and, by symmetry, the middle keep their direction."""

    def deflection(elements, element):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SECTION, STEEL)
        load = bf.DistributedLoad(beam, (0.0, -300.0 * EI))
        model = bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end)], [load])
        found = bf.solve_static(model, accuracy=accuracy) if elements == 1 else bf.solve_static(model)
        return found.displacement(beam.at(0.5))[-1, 1]

    assert deflection(1, element) == pytest.approx(deflection(32, bf.CRBF(8)), abs=accuracy)


@pytest.mark.parametrize("size", [4.0, 8.0])
def test_two_cubic_elements_whose_halves_do_not_bend_either_are_refined(size):
    """A clamped half circle, which four of them keep from bending as two do."""

    def crown(elements, element, **asked):
        arch = bf.Beam(bf.Arc((0, 0), 1.0, np.pi, 0.0), elements, element, SECTION, STEEL)
        load = bf.DistributedLoad(arch, (0.0, -size * EI))
        model = bf.Model([arch], [bf.Clamp(arch.start), bf.Clamp(arch.end)], [load])
        return bf.solve_static(model, **asked).displacement(arch.at(0.5))[-1, 1]

    found = crown(2, bf.ANCF(bf.Structural()), accuracy=1e-2)
    assert found == pytest.approx(crown(8, bf.CRBF(8)), abs=1e-2 * np.pi)


@pytest.mark.parametrize(("element", "elements"), [(bf.CRBF(5), "auto"), (bf.ANCF(bf.Structural()), 8)])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4])
def test_all_rows_are_as_accurate_as_asked_for(element, elements, accuracy):
    """A cantilever that is rolled up to a circle and back ends without a load; its middle row was off by 0.17 m."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SECTION, STEEL)
    moment = bf.PointMoment(beam.end, 2.0 * np.pi * EI, amplitude=bf.Interpolated([(0, 0), (0.5, 1), (1, 0)]))
    solution = bf.solve_static(
        bf.Model([beam], [bf.Clamp(beam.start)], [moment]), at=[0.0, 0.5, 1.0], accuracy=accuracy
    )
    position = solution.position(beam.end)[solution.load_factor == 0.5]
    np.testing.assert_allclose(position, [[0.0, 0.0]], atol=accuracy)


def test_rows_without_the_largest_strain_energy_are_as_accurate_as_asked_for():
    """A curved cantilever of cubic elements under four load histories; a row between was off six times as much."""

    def moved(elements, element, **asked):
        arm = bf.Beam(bf.Arc((0, 0), 0.5, np.pi, np.pi - 2.0), elements, element, SECTION, STEEL)
        histories = [(2.3, -0.4, 0.7, 0.8, -0.4), (7.5, 0.8, 0.4, -0.1, 0.0), (5.8, -0.2, -0.5, 1.0, 0.0)]
        loads = []
        for number, (size, *values) in enumerate(histories):
            history = bf.Interpolated(tuple(zip(np.linspace(0.0, 1.0, 5).tolist(), (0.0, *values), strict=True)))
            if number < 2:
                loads.append(bf.PointMoment(arm.at(0.6 - 0.4 * number), size * EI / 1.5, amplitude=history))
            else:
                wave = bf.DistributedLoad(
                    arm, lambda s, size=size: (0.0, size * EI * np.sin(5.0 * s)), amplitude=history
                )
                loads.append(wave)
        found = bf.solve_static(bf.Model([arm], [bf.Clamp(arm.start)], loads), at=np.linspace(0.0, 1.0, 10), **asked)
        return np.array([found.displacement(arm.at(place)) for place in np.linspace(0.0, 1.0, 9)])

    found = moved(4, bf.ANCF(bf.Structural()), accuracy=1e-4)
    np.testing.assert_allclose(found, moved(8, bf.CRBF(8)), atol=1e-4)


@pytest.mark.parametrize(("layers", "accuracy"), [(20.0, 1e-2), (40.0, 1e-2), (40.0, 1e-3)])
def test_bars_turn_about_short_strips_that_bend_in_a_layer_as_accurately_as_asked_for(layers, accuracy):
    """A strip under a tension N bends within sqrt(EI / N) by a moment 2 sqrt(EI N) sin(angle / 2), and turns a bar.

    Its axis is short, so that even a poor one is off by little: the end of the bar was off by 1.6 times the accuracy.
    """
    strip, bar = (
        bf.Beam(bf.Line((a, 0), (b, 0)), section=bf.Rectangle(0.02, height), material=STEEL)
        for a, b, height in ((0.0, 0.01, 1e-5), (0.01, 1.0, 0.02))
    )
    bending, layer = STEEL.youngs_modulus * strip.section.second_moment, 0.01 / layers
    loads = [bf.PointForce(strip.end, (bending / layer**2, 0.0)), bf.PointMoment(bar.end, 0.5 * bending / layer)]
    model = bf.Model([strip, bar], [bf.Clamp(strip.start)], loads, [bf.Rigid(strip.end, bar.start)])
    solution = bf.solve_static(model, accuracy=accuracy)
    assert solution.rotation(bar.end)[-1] == pytest.approx(2.0 * np.arcsin(0.25), abs=accuracy)


@pytest.mark.parametrize(("length", "stiffness", "force"), [(10.0, 1e9, 3e5), (100.0, 1e5, 3e3), (100.0, 1e7, 1e5)])
def test_layers_much_thinner_than_elements_are_found(length, stiffness, force):
    """Halved elements show but a quarter of the error there: deflections of 5e-4 of the length were off by 4e-4."""

    def deflection(**mesh):
        beam = bf.Beam(bf.Line((0, 0), (length, 0)), section=bf.Rectangle(0.01, 0.01), material=STEEL, **mesh)
        load = bf.PointForce(beam.at(0.5), (0.0, -force))
        solution = bf.solve_static(bf.Model([beam], [bf.Foundation(beam, (stiffness, stiffness))], [load]))
        return solution.displacement(beam.at(0.5))[-1, 1] / length

    assert deflection() == pytest.approx(deflection(elements=256, element=bf.CRBF(8)), abs=1e-4)


def test_references_of_fine_meshes_are_in_equilibrium():
    """Modes of a frame were refused on its last mesh, where round-off of three rows is above the others."""

    def frequencies(elements, element, accuracy):
        lines = ((0, 0), (0, 1)), ((0, 1), (1, 1)), ((1, 0), (1, 1))
        left, top, right = (bf.Beam(bf.Line(*ends), elements, element, SECTION, STEEL) for ends in lines)
        load = bf.DistributedLoad(top, (0.0, -8.0 * EI))
        joints = [bf.Rigid(left.end, top.start), bf.Rigid(top.end, right.end)]
        frame = bf.Model([left, top, right], [bf.Clamp(left.start), bf.Clamp(right.start)], [load], joints)
        return bf.solve_modes(frame, 3, accuracy=accuracy).frequencies

    found, exact = frequencies("auto", bf.ANCF(bf.Structural()), 1e-4), frequencies(4, bf.CRBF(8), None)
    np.testing.assert_allclose(found, exact, rtol=1e-4)


def test_motions_have_short_elements_where_they_bend():
    """On a foundation only the loaded end moves; meshes that were refined evenly had twelve elements."""

    def swing(accuracy=None, **mesh):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=SECTION, material=STEEL, **mesh)
        force = bf.PointForce(beam.end, (0.0, 300.0 * EI), amplitude=lambda t: np.sin(500.0 * t) ** 2)
        model = bf.Model([beam], [bf.Roller(beam.start, (1, 0)), bf.Foundation(beam, (0.0, 4e5 * EI))], [force])
        motion = bf.simulate(model, 0.01, 5e-5, save_every=5, accuracy=accuracy)
        return motion, np.array([motion.position(beam.at(x)) for x in np.linspace(0.0, 1.0, 17)])

    (motion, found), (_, exact) = swing(1e-7), swing(elements=16, element=bf.CRBF(8))
    assert np.linalg.norm(found - exact, axis=2).max() < 1e-7
    lengths = motion.model.meshes[0].lengths
    assert len(lengths) <= 8
    assert lengths[0] > 1.5 * lengths[-1]


def test_motions_whose_steps_follow_a_tolerance_are_accurate_at_all_rows():
    """They were compared at their last rows only, with the steps of the tolerance on every mesh."""
    arm, model = falling()
    motion = bf.simulate(model, 0.3, tolerance=1e-5, accuracy=1e-3)
    assert "steps; the estimated error is" in motion.statistics.ended
    fine_arm, fine = falling(elements=6, element=bf.CRBF(8))
    exact = bf.simulate(fine, 0.3, tolerance=1e-6, save_at=motion.time)
    error = motion.position(arm.end) - exact.position(fine_arm.end)
    assert np.linalg.norm(error, axis=1).max() < 2.4 * 1e-3
    again = bf.simulate(model.meshed(motion), 0.3, tolerance=1e-5)
    assert np.array_equal(again.p, motion.p)


def test_a_quantity_of_a_motion_may_be_what_is_accurate():
    (arm, model), (fine_arm, fine) = falling(), falling(elements=8, element=bf.CRBF(8))

    def largest_tension(beam):
        return lambda motion: motion.section_forces(beam).normal.max()

    exact = bf.simulate(fine, 0.3, 1e-3)
    force = bf.simulate(model, 0.3, 1e-3, accuracy=1e-3, quantity=largest_tension(arm))
    assert largest_tension(arm)(force) == pytest.approx(largest_tension(fine_arm)(exact), rel=1e-3)
    tip = bf.simulate(model, 0.3, 1e-3, accuracy=1e-3, quantity=arm.end)
    error = np.linalg.norm(tip.displacement(arm.end) - exact.displacement(fine_arm.end), axis=1)
    assert error.max() < 1e-3 * np.linalg.norm(exact.displacement(fine_arm.end), axis=1).max()


def test_motions_that_an_event_ends_are_compared_up_to_there():
    arm, model = falling()
    passes = bf.Event("passes", lambda state: state.position(arm.end)[1] + 0.3, stop=True)
    asked = {"events": [passes], "accuracy": 1e-4}
    motion = bf.simulate(model, 5.0, 2e-3, **asked)
    assert motion.time[-1] == motion.events[0].time < 0.5
    timed = bf.simulate(model, 0.5, 2e-3, **asked, quantity=lambda motion: motion.events[0].time)
    assert timed.events[0].time == pytest.approx(motion.events[0].time, rel=2e-4)


@pytest.mark.slow
def test_a_quantity_of_a_path_may_be_what_is_accurate():
    toggle = williams_toggle.toggle(None, 1, 1)

    def limits(path):
        return [point.load_factor for point in path.limit_points]

    path = bf.trace_equilibrium(toggle.meshed("auto"), until=40.0, accuracy=1e-5, quantity=limits)
    assert limits(path) == pytest.approx([load for load, _, _ in williams_toggle.LIMITS], rel=1e-5)
    crown = toggle.beams[0].end
    at_crown = bf.trace_equilibrium(toggle.meshed("auto"), until=40.0, accuracy=1e-4, quantity=crown)
    for point, (_, deflection, _) in zip(at_crown.limit_points, williams_toggle.LIMITS, strict=True):
        assert -point.displacement(crown)[1] == pytest.approx(deflection, abs=1e-4)
    with pytest.raises(IndexError):
        bf.trace_equilibrium(toggle.meshed("auto"), until=40.0, accuracy=1e-2, quantity=lambda path: limits(path)[2])


@pytest.mark.parametrize(
    "solve",
    [
        bf.trace_equilibrium,
        lambda *given, **asked: bf.simulate(*given, 0.01, **asked),
        lambda model, _, **asked: bf.solve_static(model, **asked),
    ],
)
def test_a_quantity_needs_an_accuracy(solve):
    beam, model = model_of(bf.CRBF(2), 2, bent)
    with pytest.raises(bf.InputError, match="a quantity is what is to be accurate, so it needs an accuracy"):
        solve(model, 1.0, quantity=beam.end)
    for wrong in ("tip", 3, beam):
        with pytest.raises(bf.InputError, match="quantity is a function of a solution, such as"):
            solve(model, 1.0, quantity=wrong, accuracy=1e-3)


def test_motions_from_a_static_state_begin_in_it_on_a_finer_mesh():
    beam = auto()
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, EI))])
    state = bf.solve_static(model)
    let_go = bf.simulate(model.with_loads([]), 0.01, 1e-3, start=state)
    distance = let_go.displacement(beam.end)[0] - state.displacement(beam.end)[-1]
    assert np.hypot(*distance) < 1e-4  # the accuracy of the state


def cantilever_frequencies(count):
    """Return frequencies [Hz] of a slender cantilever: cos(a) cosh(a) = -1."""
    roots = np.array([1.875104, 4.694091, 7.854757, 10.995541, *(np.pi * (k + 0.5) for k in range(4, count))])
    mass = STEEL.density * SECTION.area
    return roots**2 * np.sqrt(EI / mass) / (2.0 * np.pi)


@pytest.mark.parametrize("given", [lambda solution: solution, lambda solution: solution[-1]])
def test_modes_about_a_state_are_not_left_on_its_coarse_mesh(given):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=SECTION, material=STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1e-3 * EI))])
    state = bf.solve_static(model)
    modes = bf.solve_modes(model, 6, about=given(state))
    assert modes.frequencies == pytest.approx(cantilever_frequencies(6), rel=0.01)  # shear and rotary inertia
    precise = bf.solve_modes(model, 6, about=given(state), accuracy=1e-7)
    fine = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.CRBF(6), SECTION, STEEL)
    finer = bf.Model([fine], [bf.Clamp(fine.start)], [bf.PointForce(fine.end, (0.0, -1e-3 * EI))])
    exact = bf.solve_modes(finer, 6, about=bf.solve_static(finer)).frequencies
    assert modes.frequencies == pytest.approx(exact, rel=1e-4)
    assert precise.frequencies == pytest.approx(exact, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("loaded", [True, False])
def test_linear_models_of_default_elements_are_not_those_of_one_element(loaded):
    beam = auto()
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1e-3 * EI))])
    about = bf.solve_static(model) if loaded else None
    exact = cantilever_frequencies(6)  # but for shear and rotary inertia
    linear = bf.linearise(model, about)
    assert linear.modes(6).frequencies == pytest.approx(exact, rel=0.01)
    assert linear.modes(6).frequencies == pytest.approx(bf.solve_modes(model, 6, about).frequencies, rel=2e-4)
    damper = bf.SpringDamper(beam.end, (1.0, 1.0), stiffness=1e-6, damping=1e-6)
    damped = bf.linearise(model.with_(connectors=[damper]), about)
    assert damped.modes(6).frequencies == pytest.approx(exact, rel=0.01)
    tip = bf.reduce(model, [beam.end], 4, about)
    assert tip.modes(3).frequencies == pytest.approx(exact[:3], rel=0.01)
    push, sides = bf.PointForce(beam.end, (0.0, 1.0)), exact[2] * np.array([0.95, 1.0, 1.05])
    response = bf.frequency_response(model, push, ("uy", beam.end), sides, about)
    assert response.amplitude.argmax() == 1


def test_buckling_from_a_state_is_not_left_on_its_coarse_mesh():
    beam = auto()
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-EI, 0.0))])
    whole = bf.solve_buckling(model)
    about = bf.solve_buckling(model, about=bf.solve_static(model, at=[0.5]))
    assert about.load_factors == pytest.approx(whole.load_factors, rel=1e-4)


def driven(beam, frequency):
    return bf.PointForce(beam.end, (0.0, -0.05 * EI), amplitude=lambda t: np.sin(2.0 * np.pi * frequency * t))


def test_motions_from_a_state_are_not_left_on_its_coarse_mesh():
    frequency = float(cantilever_frequencies(3)[2])

    def swing(*elements):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), *elements, section=SECTION, material=STEEL)
        weight = bf.PointForce(beam.end, (0.0, -1e-3 * EI), scale=False)
        state = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [weight]))
        model = bf.Model([beam], [bf.Clamp(beam.start)], [weight, driven(beam, frequency)])
        motion = bf.simulate(model, 10.0 / frequency, 0.05 / frequency, start=state)
        return np.ptp(motion.displacement(beam.end)[:, 1])

    assert swing() == pytest.approx(swing(12, bf.CRBF(4)), rel=0.02)


def test_motions_that_keep_the_coarse_mesh_of_a_moving_state_warn_of_it():
    beam = auto()
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -0.01 * EI))])
    moving = bf.simulate(model, 0.02, 1e-3)
    frequency = float(cantilever_frequencies(5)[4])
    with pytest.warns(bf.CoarseMeshWarning, match="the mesh is too coarse: displacements are off by about .* start"):
        fast = bf.simulate(model.with_loads([driven(beam, frequency)]), 0.02, 1e-4, start=moving)
    assert fast.model.beams[0].elements == moving.model.beams[0].elements
    assert len(fast.warnings) == 1
    slow = bf.simulate(model, 0.05, 5e-4, start=moving)
    assert slow.warnings == ()
    with pytest.raises(bf.InputError, match=r"the state to start from moves.*Ask for an accuracy where this state"):
        bf.simulate(model, 0.05, 5e-4, start=moving, accuracy=1e-4)


def test_modes_about_a_state_that_does_not_tell_its_history_warn_of_its_coarse_mesh():
    mild = bf.ElasticPlastic(youngs_modulus=2.1e11, yield_stress=2.5e8, poisson_ratio=0.3, density=7850.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=bf.Fibres(bf.Rectangle(0.01, 0.01), mild))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -50.0))])  # yields above 41.7 N
    state = bf.solve_static(model, steps=2)
    whole = bf.solve_modes(model, 3, about=state)
    assert whole.frequencies[2] == pytest.approx(146.4, rel=0.01)  # of the elastic cantilever
    with pytest.warns(bf.CoarseMeshWarning, match="a frequency is off by about .*; give the whole solution"):
        bf.solve_modes(model, 3, about=state[-1])


def test_only_results_of_the_same_beams_have_its_mesh():
    _, model = model_of(bf.CRBF(3), 4, bent)
    other, _ = model_of(bf.CRBF(3), 4, bent)
    solution = bf.solve_static(model)
    with pytest.raises(bf.InputError, match="meshed takes a result of this model"):
        bf.Model([other]).meshed(solution)
    with pytest.raises(bf.InputError, match="meshed takes a state or a solution"):
        model.meshed(model)


@pytest.mark.parametrize("seed", range(12))
def test_true_errors_of_random_beams_are_below_the_accuracy(seed):
    """Of 174 results 4 % were off by up to 1.4 times the accuracy, as was their estimate the other way."""
    random = np.random.default_rng(seed)
    length = random.uniform(0.5, 3.0)
    curve = (bf.Line((0, 0), (1, 0.3)), bf.Arc((0, 0), 1.0, 0, length))[random.integers(2)]
    height, taper = 10 ** random.uniform(-3, -1.2), random.uniform(-0.4, 0.4)
    bending = STEEL.youngs_modulus * 0.02 * height**3 / 12
    force, kind = random.uniform(-4, 4) * bending, random.integers(3)

    def section(s):
        return bf.Rectangle(0.02, height * (1 + taper * s / curve.length))

    def positions(*elements, accuracy=None):
        beam = bf.Beam(curve, *elements, section=section, material=STEEL)
        loads = ([bf.PointForce(beam.end, (0, force))], [bf.Pressure(beam, force)], [bf.PointMoment(beam.end, force)])
        model = bf.Model([beam], [bf.Clamp(beam.start)], loads[kind])
        solution = bf.solve_static(model, accuracy=accuracy)
        return np.array([solution.position(beam.at(x))[-1] for x in np.linspace(0.1, 1.0, 10)])

    exact = positions(24, bf.CRBF(8))
    for accuracy in (1e-2, 1e-4, 1e-6):
        error = np.linalg.norm(positions("auto", accuracy=accuracy) - exact, axis=1).max()
        assert error < accuracy * curve.length


def wave(**mesh):
    """Clamped at one end: the moments of a moment in the middle are exact on every mesh, the axis is not."""
    axis = bf.Parametric(lambda u: (u, 0.22 * np.sin(3.0 * np.pi * u)), 0.0, 1.0)
    beam = bf.Beam(axis, section=SECTION, material=STEEL, **mesh)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.at(0.5), -1.5 * EI)])


def test_curved_beams_whose_moments_are_exact_are_refined_evenly():
    accuracy = 1e-4
    beam, model = wave()
    solution = bf.solve_static(model, accuracy=accuracy)
    fine_beam, fine = wave(elements=96, element=bf.CRBF(8))
    error = solution.displacement(beam.end)[-1] - bf.solve_static(fine).displacement(fine_beam.end)[-1]
    assert np.linalg.norm(error) < accuracy
    assert solution.model.meshes[0].elements < 50


def test_an_accuracy_below_round_off_ends_soon():
    _, model = model_of(bf.CRBF(4), 2, bent)
    with pytest.raises(bf.ConvergenceError, match="and falls no further; for an accuracy of 1e-17 it must be at most"):
        bf.solve_static(model, accuracy=1e-17)


@pytest.mark.parametrize("turns", [8, 16])
def test_limit_points_of_coarse_meshes_alone_are_refined_away(turns):
    """A strip rolls up into full circles without end; two elements stop at a quarter of it."""
    beam = auto()
    rolled = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 2.0 * np.pi * turns * EI)])
    assert np.hypot(*bf.solve_static(rolled).position(beam.end)[-1]) < 1e-4


def test_limit_points_that_meshes_agree_on_are_told():
    beam = bf.Beam(bf.Arc((0, 0), 1.0, np.radians(120), np.radians(60)), section=SECTION, material=STEEL)
    arch = bf.Model([beam], [bf.Pin(beam.start), bf.Pin(beam.end)], [bf.PointForce(beam.at(0.5), (0.0, -200.0 * EI))])
    with pytest.raises(bf.LimitPointError) as told:
        bf.solve_static(arch)
    finer = bf.Beam(beam.curve, 12, bf.CRBF(4), SECTION, STEEL)
    loads = [bf.PointForce(finer.at(0.5), (0.0, -200.0 * EI))]
    path = bf.trace_equilibrium(bf.Model([finer], [bf.Pin(finer.start), bf.Pin(finer.end)], loads), points=60)
    assert told.value.load_factor == pytest.approx(path.limit_points[0].load_factor, rel=1e-2)


@pytest.mark.parametrize("turns", [3, 6])
def test_beams_without_elements_follow_curves_of_several_turns(turns):
    axis = bf.Parametric(lambda u: ((1 + 0.1 * u) * np.cos(u), (1 + 0.1 * u) * np.sin(u)), 0.0, 2.0 * np.pi * turns)
    found = []
    for mesh in ({}, {"elements": 24 * turns, "element": bf.CRBF(8)}):
        spiral = bf.Beam(axis, section=SECTION, material=STEEL, **mesh)
        force = bf.PointForce(spiral.end, (0.0, 0.1 * EI / axis.length**2))
        model = bf.Model([spiral], [bf.Clamp(spiral.start)], [force])
        found.append(bf.solve_static(model).displacement(spiral.end)[-1])
    assert np.linalg.norm(found[0] - found[1]) < 1e-4


@pytest.mark.slow
def test_the_best_mesh_is_reported_where_no_accuracy_is_met():
    """Finer meshes than those with errors of round-off end with larger ones, which were reported."""
    beam = auto()
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 3.0 * EI))])
    with pytest.raises(
        bf.ConvergenceError, match=r"the estimated error is at best \d\.?\d*e-1[2-6] on \d+ meshes"
    ) as caught:
        bf.simulate(model, 0.01, 1e-3, accuracy=1e-17)
    fine = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.CRBF(8), SECTION, STEEL)
    exact = bf.simulate(
        bf.Model([fine], [bf.Clamp(fine.start)], [bf.PointForce(fine.end, (0.0, 3.0 * EI))]), 0.01, 1e-3
    )
    assert caught.value.solution.position(beam.end) == pytest.approx(exact.position(fine.end), abs=1e-11)


@pytest.mark.parametrize(
    ("element", "elements", "expected"),
    [(bf.ANCF(bf.Structural()), 8, 0.75), (bf.ShearRigid(), 8, 0.75), (bf.CRBF(1), 8, 1.0), (bf.CRBF(2), 8, 1.0)],
)
def test_the_effectivity_is_that_of_the_order(element, elements, expected):
    """Halves of elements of order 2 leave a quarter of a small displacement's error, and a higher order leaves none."""

    def small(beam):
        return [
            bf.PointForce(beam.end, (0.0, 1e-3 * EI)),
            bf.DistributedLoad(beam, lambda s: (0, 1e-3 * EI * np.sin(9 * s))),
        ]

    beam, model = model_of(element, elements, small)
    fine_beam, fine = model_of(bf.CRBF(8), 24, small) if expected == 1.0 else model_of(element, 256, small)
    solution, exact = bf.solve_static(model), bf.solve_static(fine).displacement(fine_beam.end)[-1, 1]
    true = exact - solution.displacement(beam.end)[-1, 1]
    assert solution.error(beam.end)[1] / true == pytest.approx(expected, rel=0.01)


def test_shares_of_the_error_are_drawn_and_written(tmp_path):
    """Of two equal beams, like to the writers, only the bent one has an error; most of it is near its clamp."""
    pyvista = pytest.importorskip("pyvista")
    beams = [bf.Beam(bf.Line((0, y), (1, y)), 4, bf.CRBF(2), SECTION, STEEL) for y in (0, 1)]
    clamps, load = [bf.Clamp(beam.start) for beam in beams], bf.PointForce(beams[1].end, (0.0, 5.0 * EI))
    solution = bf.solve_static(bf.Model(beams, clamps, [load]))
    still, own = (solution.error_shares(beam) for beam in beams)
    assert still.max() < 1e-12
    assert own.sum() == pytest.approx(1.0)
    assert own.argmax() == 0
    expected = np.concatenate([still, own])
    table = solution.to_pandas(errors=True).loc[1.0]["error_share"].to_numpy()
    assert table.reshape(8, -1) == pytest.approx(np.tile(expected[:, None], 5))
    assert np.isnan(table).sum() == 0
    solution.to_vtk(tmp_path / "arms.pvd", fields=["error_share"])
    body = pyvista.get_reader(tmp_path / "arms.pvd")
    body.set_active_time_point(len(solution) - 1)
    shown = body.read()[0].point_data_to_cell_data()["error_share"]
    assert shown == pytest.approx(expected)
    figure = solution.plot(colour="error_share")
    assert any("share of an element in the error" in axes.get_ylabel() for axes in figure.axes)
    motion = bf.simulate(solution.model, 1e-3, 1e-4)
    with pytest.raises(bf.InputError, match="errors are estimated for static solutions only"):
        motion.error_shares(beams[1])
    with pytest.raises(bf.InputError, match="fields has 'error_share', which is not there"):
        motion.to_vtk(tmp_path / "moving.pvd", fields=["error_share"])


@pytest.mark.slow
def test_frequencies_and_critical_loads_refine_only_where_shapes_bend():
    """A slender mast on a thick post, which hardly moves."""

    def column(**mesh):
        post = bf.Beam(bf.Line((0, 0), (0, 1)), section=bf.Rectangle(0.02, 0.1), material=STEEL, **mesh)
        mast = bf.Beam(bf.Line((0, 1), (0, 2)), section=bf.Rectangle(0.02, 0.002), material=STEEL, **mesh)
        load = bf.PointForce(mast.end, (0.0, -1.0))
        return bf.Model([post, mast], [bf.Clamp(post.start)], [load], [bf.Rigid(post.end, mast.start)])

    fine = column(elements=12, element=bf.CRBF(8))
    modes, buckling = bf.solve_modes(column(), 3, accuracy=1e-8), bf.solve_buckling(column(), 2, accuracy=1e-8)
    assert modes.frequencies == pytest.approx(bf.solve_modes(fine, 3).frequencies, rel=1e-8)
    assert buckling.load_factors == pytest.approx(bf.solve_buckling(fine, 2).load_factors, rel=1e-8)
    for result in (modes, buckling):
        post, mast = (mesh.nodes for mesh in result.model.meshes)
        assert post < 0.8 * mast


@pytest.mark.slow
def test_critical_loads_refine_the_beams_whose_stress_resultants_are_off():
    """A column between hinges buckles, whose force depends on how the rest of a portal bends; it had 22 elements."""

    def portal(**mesh):
        places, section = [(0, 0), (0, 3), (4, 3), (4, 0)], bf.Rectangle(0.05, 0.05)
        beams = [bf.Beam(bf.Line(a, b), section=section, material=STEEL, **mesh) for a, b in pairwise(places)]
        left, top, right = beams
        loads = [bf.PointForce(top.start, (2e3, 0.0)), bf.DistributedLoad(top, (0.0, -1.5e3))]
        joints = [bf.Rigid(left.end, top.start), bf.Hinge(top.end, right.start)]
        return bf.Model(beams, [bf.Clamp(left.start), bf.Pin(right.end)], loads, joints)

    exact = bf.solve_buckling(portal(elements=4, element=bf.CRBF(8)), 2).load_factors
    found = bf.solve_buckling(portal(), 2, accuracy=1e-6)
    assert found.load_factors == pytest.approx(exact, rel=1e-6)
    assert sum(mesh.elements for mesh in found.model.meshes) <= 12


def test_there_are_no_more_elements_than_shares_ask_for():
    """Two and five elements, beside a force, of which 1.2 times as many are enough, become three and six."""
    _, model = model_of(bf.CRBF(8), 6, bent)
    even, errors = [np.full(7, 1.0 / 7.0)], (1e-7, 3e-8)
    assert model.meshes[0].elements == 7
    ends = refined(model, even, *errors, [np.array([0.3])]).meshes[0].vertices
    assert len(ends) - 1 == 9
    assert np.abs(ends - 0.3).min() < 1e-12
    assert refined(model, None, *errors, [np.array([0.3])]).meshes[0].elements == 14


def test_elements_of_ones_own_end_where_they_did():
    _, model = model_of(bf.CRBF(8), (0.0, 0.13, 1.0), bent)
    solution = bf.solve_static(model, accuracy=1e-9)
    assert solution.model.meshes[0].elements > 3
    assert np.abs(solution.model.meshes[0].vertices - 0.13).min() < 1e-12


def test_an_axis_that_is_only_interpolated_is_refined_where_it_is():
    """Beyond its force a clamped wave has no stress, but its axis is carried along; it had 14 elements."""
    accuracy = 1e-4

    def found(accuracy=None, **mesh):
        axis = bf.Parametric(lambda u: (u, 0.22 * np.sin(2.0 * np.pi * u)), 0.0, 1.0)
        beam = bf.Beam(axis, section=SECTION, material=STEEL, **mesh)
        force = bf.PointForce(beam.at(0.3), (2.0 * EI, -9.0 * EI))
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [force]), accuracy=accuracy)
        return solution, np.array([solution.position(beam.at(x))[-1] for x in np.linspace(0.05, 1.0, 20)])

    (solution, here), (_, exact) = found(accuracy), found(elements=48, element=bf.CRBF(8))
    assert np.linalg.norm(here - exact, axis=1).max() < accuracy
    assert solution.model.meshes[0].elements < 10


@pytest.mark.parametrize("load", [1e-3, 1.0, 100.0, 300.0])
def test_default_elements_resolve_displacements_that_are_small_beside_the_model(load):
    """Off by less than 1e-4 of the length, deflections, end moments and reactions at service loads once were zero."""
    steel, span = bf.Material(2.1e11, 0.3, 7850.0), 5.0
    beam = bf.Beam(bf.Line((0, 0), (span, 0)), section=bf.Profile("IPE 200"), material=steel)
    stiffness = beam.section_at(0.0).rigidity(steel)
    press = [bf.DistributedLoad(beam, (0.0, -load))]
    held = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], press))
    sag = load * span**2 * (5.0 * span**2 / (384.0 * stiffness.bending) + 1.0 / (8.0 * stiffness.shear))
    assert held.displacement(beam.at(0.5))[-1, 1] == pytest.approx(-sag, rel=1e-3)
    clamped = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end)], press))
    assert clamped.reaction(beam.start)[-1, 2] == pytest.approx(load * span**2 / 12.0, rel=1e-3)


@pytest.mark.parametrize("force", [1e-9, 1e-5, 1.0])
def test_default_elements_of_a_cantilever_under_any_load(force):
    """It was off by 25 % under small ones, with the advice to use more elements."""
    steel, section = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.01, 0.01)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=section, material=steel)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))]))
    stiffness = section.rigidity(steel)
    expected = force * (1.0 / (3.0 * stiffness.bending) + 1.0 / stiffness.shear)
    assert solution.displacement(beam.end)[-1, 1] == pytest.approx(expected, rel=1e-3)
    assert not solution.warnings


def test_a_branch_on_the_mesh_of_a_straight_path_is_warned_of_if_that_is_too_coarse():
    steel, section = bf.Material(2e11, 0.3, 7850.0, strength=1e12), bf.Rectangle(0.01, 0.002)
    column = bf.Beam(bf.Line((0, 0), (1, 0)), section=section, material=steel)
    push = bf.PointForce(column.end, (-section.rigidity(steel).bending, 0.0))
    model = bf.Model([column], [bf.Pin(column.start), bf.Roller(column.end)], [push])
    path = bf.trace_equilibrium(model, until=1.6 * np.pi**2)
    with pytest.warns(bf.CoarseMeshWarning, match="displacements are off by about"):
        branch = bf.trace_equilibrium(model, until=1.6 * np.pi**2, start=path.bifurcations[0])
    assert "too coarse" in branch.warnings[-1]
