"""Statics against references computed without any beam code, and the ways it refuses."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.results.solution_checks import advice

STEEL = bf.Material(2e11, 0.3, 7800.0)
SQUARE = bf.Rectangle(0.01, 0.01)


def cantilever(element, elements, loads, supports=(bf.Clamp,), material=STEEL):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SQUARE, material)
    held = [make(beam.start) for make in supports]
    return beam, bf.Model([beam], supports=held, loads=[load(beam) for load in loads])


@pytest.mark.parametrize(
    ("plane_stress", "reference"), [(False, 0.01485507106598), (True, 0.01819510330389)], ids=["3D", "plane-stress"]
)
def test_cantilever_converges_to_the_continuum_reference(plane_stress, reference):
    """Case 11.ii: stationary energy of the same continuum, degree 10 on 9 pieces; order 2 in the mesh."""
    errors = []
    for elements in (16, 32, 64, 128):
        element = bf.ANCF(forces=bf.ContinuumMechanics(plane_stress))
        beam, model = cantilever(element, elements, [lambda b: bf.PointForce(b.end, (0, 10.0))])
        errors.append(abs(bf.solve_static(model).displacement(beam.end)[-1, 1] - reference))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] < 3e-7
    assert np.all((orders > 1.8) & (orders < 2.2))


def test_crbf_holds_the_thickness_and_ends_close_to_ancf():
    values = []
    for make in (bf.ANCF, bf.ANCFCRBF):
        beam, model = cantilever(make(), 128, [lambda b: bf.PointForce(b.end, (0, 10.0))])
        values.append(bf.solve_static(model).displacement(beam.end)[-1, 1])
    assert values[0] != values[1]
    assert values[0] == pytest.approx(values[1], rel=1e-6)


def test_reactions_balance_the_loads(element):
    loads = [lambda b: bf.PointForce(b.at(0.3), (2.0, 5.0)), lambda b: bf.DistributedLoad(b, (0.0, 1.0))]
    loads.append(lambda b: bf.PointMoment(b.end, 0.5))
    beam, model = cantilever(element, 6, loads)
    solution = bf.solve_static(model)
    fx, fy, _ = solution.reaction(beam.start)[-1]
    assert fx == pytest.approx(-2.0, abs=1e-6)
    assert fy == pytest.approx(-6.0, abs=1e-6)


def test_moment_reaction_is_force_times_lever(element):
    beam, model = cantilever(element, 8, [lambda b: bf.PointForce(b.end, (0.0, 10.0))])
    solution = bf.solve_static(model)
    lever = solution.position(beam.end)[-1, 0]
    assert solution.reaction(beam.start)[-1, 2] == pytest.approx(-10.0 * lever, rel=1e-8)


def test_prescribed_displacement_gives_the_force_back(element):
    beam, model = cantilever(element, 8, [lambda b: bf.PointForce(b.end, (0.0, 10.0))])
    wanted = bf.solve_static(model).displacement(beam.end)[-1, 1]
    pulled = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, uy=wanted)])
    assert bf.solve_static(pulled).reaction(beam.end)[-1, 1] == pytest.approx(10.0, rel=1e-7)


def test_prescribed_rotation_turns_the_section(element):
    beam, _ = cantilever(element, 8, [])
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, rotation=0.2)])
    assert bf.solve_static(model).rotation(beam.end)[-1] == pytest.approx(0.2, abs=1e-12)


@pytest.mark.parametrize("at", [0.5, 0.505])
def test_moment_at_a_node_and_inside_an_element_does_the_work_of_a_couple(at):
    beam, model = cantilever(bf.ANCFCRBF(), 64, [lambda b: bf.PointMoment(b.at(at), 2.0)])
    solution = bf.solve_static(model)
    moments = solution.section_forces(beam)
    inner = moments.moment[-1][moments.arc_length < 0.4]
    assert inner == pytest.approx(2.0, rel=1e-7)
    assert np.abs(moments.moment[-1][moments.arc_length > 0.6]).max() < 1e-8


def test_loads_that_do_not_scale_act_from_the_start():
    loads = [lambda b: bf.Gravity((0, -9.81), scale=False), lambda b: bf.PointForce(b.end, (0, 10.0))]
    beam, model = cantilever(bf.ANCF(), 8, loads)
    rows = bf.solve_static(model).displacement(beam.end)[[0, -1], 1]
    assert rows[0] < 0.0 < rows[1] - rows[0]


def test_support_between_nodes_puts_one_there(element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, SQUARE, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.at(1 / 3))], [bf.PointForce(beam.end, (0, 1.0))])
    solution = bf.solve_static(model)
    assert np.abs(solution.displacement(beam.at(1 / 3))).max() <= 1e-14
    assert model.meshes[0].elements == 5


def test_energy_equals_the_work_of_the_load(element):
    """dW/dload = displacement: the strain energy is the load's work along the equilibrium path (Clapeyron, small)."""
    beam, model = cantilever(element, 8, [lambda b: bf.PointForce(b.end, (0.0, 0.01))])
    solution = bf.solve_static(model)
    work = 0.5 * 0.01 * solution.displacement(beam.end)[-1, 1]
    assert solution.energy().strain[-1] == pytest.approx(work, rel=1e-6)


@pytest.mark.parametrize(
    ("stiffness", "words"), [((0.0, 1e3), "translates along x"), ((1e3, 0.0), "translates along y")]
)
def test_a_foundation_that_resists_one_way_holds_nothing_of_the_other(stiffness, words):
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([one], [bf.Foundation(one, stiffness)], [bf.PointForce(one.end, (0.0, 1.0))])
    with pytest.raises(bf.FreeMotionError, match=words):
        bf.solve_static(model)


@pytest.mark.parametrize(
    ("supports", "words"),
    [
        ((), "translates along"),
        ((bf.Pin,), r"turns about \(0, 0\)"),
        ((bf.Roller,), "can move freely"),
    ],
)
def test_a_model_that_can_move_is_refused(element, supports, words):
    _, model = cantilever(element, 3, [lambda b: bf.PointForce(b.end, (0, 1.0))], supports)
    with pytest.raises(bf.FreeMotionError, match=words):
        bf.solve_static(model)


def test_a_load_that_cannot_be_carried_gives_back_what_was_found():
    """St. Venant-Kirchhoff material in compression has its largest force at the stretch 1/sqrt(3); case 11.iii."""
    _, model = cantilever(bf.ANCF(), 1, [lambda b: bf.PointForce(b.end, (-1e8, 0.0))])
    with pytest.raises(bf.ConvergenceError, match="load factor") as caught:
        bf.solve_static(model)
    found = caught.value.solution
    assert 0.0 <= found.load_factor[-1] < 1.0
    assert np.isfinite(found.p).all()


@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 2, 2.5])
def test_a_turned_model_has_the_turned_solution(element, angle):
    """A beam on a pin and a roller, all turned by an angle; only inclined rollers make the difference."""

    def solve(turn):
        c, s = np.cos(turn), np.sin(turn)
        rotation = np.array([[c, -s], [s, c]])
        beam = bf.Beam(bf.Line((0, 0), tuple(rotation @ (1.0, 0.0))), 6, element, SQUARE, STEEL)
        supports = [bf.Pin(beam.start), bf.Roller(beam.end, tuple(rotation @ (0.0, 1.0)))]
        model = bf.Model([beam], supports, [bf.PointForce(beam.at(0.4), tuple(rotation @ (3.0, -30.0)))])
        solution = bf.solve_static(model)
        reaction = solution.reaction(beam.end)[-1]
        return solution.displacement(beam.end)[-1] @ rotation, solution.rotation(beam.end)[-1], reaction[:2] @ rotation

    for found, expected in zip(solve(angle), solve(0.0), strict=True):
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-12 if np.ndim(found) == 0 else 1e-6)


def test_an_inclined_roller_moves_along_its_plane_in_time(element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, element, bf.Rectangle(0.1, 0.1), bf.Material(1e7, 0.3, 1000.0))
    model = bf.Model([beam], [bf.Roller(beam.start, (1.0, 2.0))], [bf.Gravity((0, -9.81))])
    moved = bf.simulate(model, 0.2, 1e-3).displacement(beam.start)
    assert np.abs(moved @ [1.0, 2.0]).max() < 1e-12
    assert np.abs(moved).max() > 1e-3


def test_twenty_thousand_elements_end_at_the_round_off_floor_and_are_right():
    """Strains lose digits to cancellation in 20,000 elements of one beam; the solve says so and stays right."""
    tips = []
    for elements in (1000, 20_000):
        load = 5 * 2e11 * SQUARE.second_moment * 1.346153846
        beam, model = cantilever(bf.ANCF(), elements, [lambda b, load=load: bf.PointForce(b.end, (0, load))])
        solution = bf.solve_static(model)
        tips.append(solution.displacement(beam.end)[-1])
    assert "round-off" in solution.statistics.ended
    assert np.abs(tips[0] - tips[1]).max() < 1e-6


@pytest.mark.parametrize("make", [bf.ANCF, bf.ANCFCRBF])
def test_a_prescribed_full_turn_is_not_taken_for_none(make):
    """Found in review: gradients hold a cosine and a sine, and one load step of 2 pi changed neither."""
    rubber = bf.Material(1e7, 0.0, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 24, make(), SQUARE, rubber)
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, rotation=2 * np.pi)])
    solution = bf.solve_static(model)
    assert solution.rotation(beam.end)[-1] == pytest.approx(2 * np.pi, abs=1e-9)
    assert solution.reaction(beam.end)[-1, 2] > 0.0
    start = bf.simulate(model, 1e-3, 1e-3, start=solution[-1])
    assert start.rotation(beam.end)[0] == pytest.approx(2 * np.pi, abs=1e-9)


@pytest.mark.parametrize("steps", [1, 4, 5])
def test_the_first_load_step_is_the_share_that_is_asked(steps):
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([one], [bf.Clamp(one.start)], [bf.PointForce(one.end, (0.0, 1.0))])
    assert bf.solve_static(model, steps).load_factor[1] == pytest.approx(1.0 / steps)  # later ones may be longer


@pytest.mark.parametrize(("turn", "advised"), [(1.45, False), (1.55, True)])
def test_more_elements_are_advised_where_one_is_bent_by_more_than_85_degrees(turn, advised):
    """A chord of an arc of 1.5 rad is 9 % shorter than the arc: the mesh, not the method, fails there."""
    _, model = cantilever(bf.CRBF(2), 2, [])
    p = system_of(model, True).reference.copy()
    mesh = model.meshes[0]
    p[mesh.coordinates_of(mesh.nodes - 1)["theta"]] = turn
    assert ("use more elements" in advice(model, p)) == advised
