"""What is done for many members at once is what would be done for each; and its cost."""

import tracemalloc
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import splu
from slow_values import mostly_slow
from test_sparse import MATERIAL, SECTION, grid, tangent_at

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import System
from beamfem.mesh.beam_grid import Grid, distances, make_grid, make_grids, nearest
from beamfem.model.beam import reference_positions
from beamfem.results import batched_beams, energies
from beamfem.results import solution_system as last_digits
from beamfem.solve.start.mechanisms import Conditions, mechanisms


def mixed_beams():
    """Straight beams of several divisions and elements among others, with fractions of joints."""
    arc = bf.Arc((0.0, 0.0), 2.0, 0.0, 1.5)
    bent = bf.Polyline([(0.0, 0.0), (1.0, 0.0), (1.0, 2.0)])
    axes = [bf.Line((i, 0.3 * i), (2.0 * i + 1.0, -0.7)) for i in range(4)]
    chosen = [
        (axes[0], 3, bf.CRBF(2), [0.0, 1.0]),
        (arc, 4, bf.CRBF(2), [1.0]),
        (axes[1], 3, bf.CRBF(2), []),
        (axes[2], 3, bf.ANCF(), [0.4]),
        (bent, 3, bf.ANCF(), [0.0, 0.5]),
        (axes[3], (0.0, 0.2, 1.0), bf.CRBF(2), [1.0]),
        (axes[2], 3, bf.ANCF(), [1.0]),
    ]
    beams = [bf.Beam(axis, elements, element, SECTION, MATERIAL) for axis, elements, element, _ in chosen]
    return beams, [fractions for *_, fractions in chosen]


def test_grids_made_at_once_are_those_of_each_beam():
    beams, fractions = mixed_beams()
    for beam, own, found in zip(beams, fractions, make_grids(beams, fractions), strict=True):
        alone = make_grid(beam, own)
        assert found.beam is beam
        for name in Grid.__dataclass_fields__:
            if name != "beam":
                assert np.array_equal(getattr(found, name), getattr(alone, name)), name


def test_points_of_straight_and_other_beams_stand_where_they_are():
    beams, _ = mixed_beams()
    points = [beam.at(share) for share in (0.0, 0.3, 1.0) for beam in beams]
    found, each = reference_positions(points), np.array([point.reference for point in points])
    assert np.abs(found - each).max() < 1e-14
    assert reference_positions([]).shape == (0, 2)


def test_the_order_of_a_lattice_fills_in_no_more_than_that_of_its_coordinates():
    """Nodes are ordered instead of coordinates; both orders are of minimum degree."""
    model, _ = grid(30, 30)
    system, tangent = tangent_at(model, System(model, static=True).reference)
    factors = tangent.factorised(system.rotated)
    options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    assert factors.lu.nnz < 1.1 * splu(tangent.matrix, **options).nnz


@pytest.mark.slow
@pytest.mark.parametrize("columns", [4, 24])
def test_springs_stand_on_the_diagonal(columns):
    model, ends = grid(columns, columns)
    spring = bf.Spring(ends[columns, columns][0], (3.0, 5.0), 7.0)
    sprung = bf.Model(model.beams, [*model.supports, spring], model.loads, model.joints)
    p = System(model, static=True).reference
    system, before = tangent_at(model, p)
    assert (system.unknowns.pattern is None) == (columns == 4)
    after = tangent_at(sprung, p)[1]
    nothing = np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    change = (after.sparse(nothing) - before.sparse(nothing)).toarray()
    places = np.flatnonzero(np.abs(change).max(axis=1) > 1e-6)
    assert np.allclose(np.sort(change[places, places]), [3.0, 5.0, 7.0], rtol=1e-9)
    assert np.count_nonzero(np.abs(change) > 1e-6) == 3


def test_a_foundation_under_many_elements_takes_no_square_of_them():
    """A rail on k: w = P b / (2 k), b^4 = k / (4 EI), pushed up at its middle (Hetenyi), 20 / b long.

    Whether the nodes on a foundation hold the beam took a square matrix of them all: 1.2 GB here, and 74 GB for 50,000.
    """
    k, rigidity = 1e5, 2e11 * 1e-6
    wave = (k / (4 * rigidity)) ** 0.25
    section = bf.Section.from_stiffness(axial=1e9, shear=1e12, bending=rigidity, mass=10.0, rotary_inertia=1e-6)
    rail = bf.Beam(bf.Line((0, 0), (20 / wave, 0)), 6000, bf.CRBF(1), section)
    model = bf.Model([rail], [bf.Foundation(rail, (k, k))], [bf.PointForce(rail.at(0.5), (0.0, 100.0))])
    tracemalloc.start()
    try:
        system = System(model, static=True)
        free = mechanisms(Conditions(system, np.zeros(1, dtype=int), system.reference))
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(free) == 0
    assert most < 1e8
    rise = bf.solve_static(model).displacement(rail.at(0.5))[-1, 1]
    assert rise == pytest.approx(100.0 * wave / (2 * k), rel=1e-4)


@pytest.mark.parametrize(("order", "elements", "within"), [(1, 30_000, 1e-3), (2, 8000, 3e-2)])
@pytest.mark.parametrize("turned", [False, True])
def test_a_long_cantilever_is_eliminated_from_its_free_end(order, elements, within, turned):
    """P L^3 / (3 E I), with a first correction that was off by 66 % and by 22 %, and steps that were refused for it.

    Elimination from the clamp takes the stiffness of the cantilever as a difference of numbers that are 1e20 as large.
    One last digit of the tangent's entries moves the second case by some 1 %.
    """
    section = bf.Rectangle(1e-4, 1e-4)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order), section, bf.Material(2e11, 0.3, 7800.0))
    held, tip = (beam.end, beam.start) if turned else (beam.start, beam.end)
    force = 3.0 * 2e11 * section.second_moment * 1e-3
    model = bf.Model([beam], [bf.Clamp(held)], [bf.PointForce(tip, (0.0, force))])
    system = System(model, static=True)
    rest = np.zeros(model.size)
    residual, tangent = linearise(system, system.reference, rest, rest, 1.0, STATICS)
    mesh = model.mesh_of(tip)
    assert system.unknowns.dofs[0] == min(mesh.coordinates_of(mesh.node_at(tip.fraction)).values())
    factors = tangent.factorised(system.rotated)
    moved = np.zeros(model.size)
    moved[system.free_dofs] = factors.solve(-residual[system.free_dofs])
    assert np.abs(moved * system.positions).max() == pytest.approx(1e-3, rel=within)
    assert factors.negative_pivots == 0


def test_a_band_is_ordered_towards_the_support_and_rollers_stay_in_order():
    """The nodes are reversed, the coordinates of each are not; motions keep the order of the nodes."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 5, bf.CRBF(2), SECTION, MATERIAL)
    for supports, turned in (
        ([bf.Clamp(beam.start)], True),
        ([bf.Clamp(beam.end)], False),
        ([bf.Pin(beam.start), bf.Roller(beam.end, (0.1, 1.0))], False),
        ([bf.Pin(beam.start), bf.Roller(beam.at(0.4), (0.1, 1.0))], True),
    ):
        model = bf.Model([beam], supports, [bf.PointForce(beam.at(0.6), (0.0, 1.0))])
        still, moving = System(model, static=True).unknowns, System(model, static=False).unknowns
        assert np.array_equal(moving.dofs, np.sort(moving.dofs))
        assert np.array_equal(np.sort(still.dofs), moving.dofs)
        assert (still.dofs[0] > still.dofs[-1]) == turned
        x, y = list(model.mesh_of(beam.start).coordinates_of(2).values())[:2]
        assert still.free[y] == still.free[x] + 1


def test_many_supports_and_corners_take_no_table_of_places_by_elements():
    """6000 supports between 6000 elements, on a polyline with 6000 corners: such tables were 288 MB each."""
    places = np.linspace(0.0, 1.0, 6001)[1:-1].tolist()
    corners = [(0.1 * i, 0.01 * (i % 2)) for i in range(6001)]
    for curve in (bf.Line((0.0, 0.0), (600.0, 0.0)), bf.Polyline(corners)):
        beam = bf.Beam(curve, 7001, bf.CRBF(1), SECTION, MATERIAL)
        tracemalloc.start()
        try:
            grid = make_grid(beam, places)
            _, most = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert np.abs(grid.arc[[grid.node_at(place) for place in places]] / curve.length - places).max() < 1e-9
        assert most < 2e7


def test_the_nearest_numbers_and_distances_are_those_of_the_whole_table():
    rng = np.random.default_rng(3)
    ascending = np.sort(np.append(rng.random(50), [0.0, 0.25, 0.25, 0.5, 1.0]))
    values = np.concatenate([rng.random(200), ascending, ascending + 1e-16, [-1.0, 2.0, 0.375]])
    table = np.abs(values[:, None] - ascending)
    assert np.array_equal(nearest(ascending, values), table.argmin(axis=1))
    assert np.array_equal(distances(values, rng.permutation(ascending)), table.min(axis=1))
    assert np.isinf(distances(values, np.empty(0))).all()


def test_reactions_are_of_all_supports_at_a_point():
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 20, bf.CRBF(1), SECTION, MATERIAL)
    other = bf.Beam(bf.Line((0.0, 1.0), (1.0, 1.0)), 4, bf.CRBF(1), SECTION, MATERIAL)
    springs = [bf.Spring(beam.at(place), (0.0, 5.0)) for place in (0.75, 0.25, 0.25 + 1e-12, 0.25 + 2e-9, 0.75)]
    supports = [*springs, bf.Clamp(beam.start), bf.Clamp(other.start)]
    model = bf.Model([beam, other], supports, [bf.PointForce(beam.end, (0.0, -1.0))])
    for point in (*(own.point for own in supports), beam.end, other.end, other.at(0.25)):
        near = {id(own) for own in supports if own.point.beam is point.beam}
        near &= {id(own) for own in supports if abs(own.point.fraction - point.fraction) < 1e-9}
        assert {id(own) for own in model.supports_along.near(point, 1e-9)} == near
    assert model.supports_along.near(beam.at(0.75), 1e-9) == [springs[0], springs[4]]


def heated_lattice(cells):
    """A lattice on foundations, each of its members heated."""
    model, _ = grid(cells, cells, element=bf.CRBF(1))
    material = bf.Material(1e7, 0.3, 1000.0, thermal_expansion=1e-5)
    warm = {id(beam): replace(beam, material=material) for beam in model.beams}
    beams = list(warm.values())

    def moved(point):
        return warm[id(point.beam)].at(point.fraction)

    return bf.Model(
        beams,
        [bf.Clamp(moved(own.point)) for own in model.supports] + [bf.Foundation(beam, (1.0, 2.0)) for beam in beams],
        [bf.Temperature(beam, 1.0 + number % 3) for number, beam in enumerate(beams)],
        [bf.Rigid(moved(joint.a), moved(joint.b)) for joint in model.joints],
    )


def taken_by_results(solution):
    """Return the largest memory [bytes] that some results of one beam take, after those of another."""
    first, *_, last = solution.model.beams
    calls = (
        solution.section_forces,
        solution.stresses,
        lambda beam: solution.fields(beam.end),
        lambda beam: solution.rotation(beam.at(0.3)),
    )
    most = []
    for call in calls:
        call(first)
        tracemalloc.start()
        try:
            call(last)
            most.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    return most


@pytest.mark.slow
def test_results_of_a_beam_take_no_memory_of_the_size_of_a_large_solution(monkeypatch):
    """Each of n members took n coordinates, loads and foundations: 8 times as much in a model of 8 times the size."""
    monkeypatch.setattr(batched_beams, "_KEPT", 0)  # as if rows had a million coordinates
    small, large = (taken_by_results(bf.solve_static(heated_lattice(cells))) for cells in (6, 18))
    assert all(after < 1.5 * before for before, after in zip(small, large, strict=True))


def test_forces_of_all_beams_of_a_lattice_balance_at_its_joints():
    """Foundations, temperatures and several beams of one block: each beam finds its own loads among those of all."""
    solution = bf.solve_static(heated_lattice(4))
    for beam in solution.model.beams:
        forces, foundation = solution.section_forces(beam), np.array([1.0, 2.0])
        mesh = solution.model.mesh_of(beam.start)
        moved = np.array([solution.displacement(beam.at(s))[-1] for s in (0.0, 0.5, 1.0)])
        pulled = foundation * np.trapezoid(moved, dx=0.5 * beam.curve.length, axis=0)
        normal = [solution.fields(point).r_y[-1][[1, 0]] * [1.0, -1.0] for point in (beam.start, beam.end)]
        ends = [
            forces.normal[-1, i] * n + forces.shear[-1, i] * np.array([-n[1], n[0]])
            for i, n in zip((0, -1), normal, strict=True)
        ]
        assert mesh.elements == 2
        assert ends[1] - ends[0] == pytest.approx(pulled, abs=1e-6 * np.abs(ends).max())


@pytest.mark.slow
@mostly_slow("element", [bf.CRBF(2), bf.ANCF(), bf.ShearRigid()], ids=lambda own: own.name)
def test_the_energy_of_many_moments_is_the_work_of_each(element):
    beam = bf.Beam(bf.Arc((0.0, 0.0), 1.0, 0.0, 2.0), 5, element, SECTION, MATERIAL)
    places = (0.2, 0.37, 0.8, 1.0)
    loads = [bf.PointMoment(beam.at(place), 0.1 * (1 + i)) for i, place in enumerate(places)]
    loads += [bf.PointForce(beam.at(0.5), (0.3, 0.2)), *(bf.DistributedLoad(beam, (0.1 * i, -0.2)) for i in range(3))]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    work = sum(load.value[2] * solution.rotation(load.point) for load in loads if isinstance(load, bf.PointMoment))
    arc = np.linspace(0.0, 1.0, 4001)
    moved = np.array([solution.displacement(beam.at(s))[-1] for s in arc])
    total = np.trapezoid(moved @ np.array([0.3, -0.6]), dx=beam.curve.length / 4000)
    known = work[-1] + solution.displacement(beam.at(0.5))[-1] @ [0.3, 0.2] + total
    assert solution.energy().potential[-1] == pytest.approx(-known, rel=1e-4)


def test_stresses_of_many_layers_ask_for_the_moments_of_the_section_once(monkeypatch):
    """It was once for each layer, of all layers."""
    asked, moments = [], bf.Layered.moments

    def counted(self, material=None):
        asked.append(len(self.layers))
        return moments(self, material)

    counts = []
    for layers in (4, 16):
        strong = [replace(MATERIAL, strength=1e5 * (1 + i)) for i in range(layers)]
        section = bf.Layered([bf.Layer(own, 0.05 / layers) for own in strong], width=0.05)
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(1), section)
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (1.0, 0.0))]))
        with monkeypatch.context() as patched:
            patched.setattr(bf.Layered, "moments", counted)
            stresses = solution.stresses(beam)
        # a pull by 1 N stresses all layers alike, so that the weakest one counts
        assert stresses.utilisation[-1] == pytest.approx(1.0 / 0.0025 / 1e5, rel=1e-5)
        counts.append(len(asked))
        asked.clear()
    assert counts[0] == counts[1]


@pytest.mark.parametrize("element", [bf.BilinearANCF(), bf.ANCF(), bf.CRBF(2)], ids=lambda own: own.name)
def test_joined_nodes_stay_in_the_band_when_it_is_turned_towards_the_support(element):
    """Nodes that share some of their coordinates are further apart in the reverse order: entries were lost."""
    post = bf.Beam(bf.Line((0.0, 0.0), (0.0, 1.0)), 2, element, SECTION, MATERIAL)
    arm = bf.Beam(bf.Arc((1.0, 1.0), 1.0, np.pi, 1.5), 2, element, SECTION, MATERIAL)
    brace = bf.Beam(bf.Line((0.0, 1.0), (-1.0, 1.5)), 2, element, SECTION, MATERIAL)
    joints = [bf.Hinge(post.end, arm.start), bf.Rigid(post.end, brace.start)]
    for held in (post.start, arm.end, brace.end):
        system = System(bf.Model([post, arm, brace], [bf.Clamp(held)], joints=joints), static=True)
        free, half_width = system.unknowns.free, system.layouts[0].half_width
        for block in system.blocks:
            numbers = np.where(block.dof >= 0, free[block.dof], -1)[block.node].reshape(len(block.node), -1)
            known = [own[own >= 0] for own in numbers]
            assert max(np.ptp(own) for own in known if len(own)) <= half_width


def test_tables_and_pictures_of_many_beams_compute_what_belongs_to_the_model_once(monkeypatch):
    """Tables took the energy of all beams for each of them, pictures the last digits of the state for each load."""
    calls = Counter()

    def counted(module, name):
        own = getattr(module, name)

        def call(*given):
            calls[name] += 1
            return own(*given)

        monkeypatch.setattr(module, name, call)

    counted(energies, "energies_of_beams")
    counted(last_digits, "digits_of")
    counts = []
    for number in (3, 9):
        posts = [bf.Beam(bf.Line((i, 0), (i, 1)), 2, bf.CRBF(1), SECTION, MATERIAL) for i in range(number)]
        loads = [bf.PointForce(post.end, (0.01, 0.0)) for post in posts]
        solution = bf.solve_static(bf.Model(posts, [bf.Clamp(post.start) for post in posts], loads))
        calls.clear()
        solution.to_pandas()
        solution.plot()
        counts.append((calls["energies_of_beams"], calls["digits_of"]))
    assert counts[0] == counts[1]
    assert counts[0][0] == 2  # of its states, and of its reference
