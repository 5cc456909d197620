"""What holds for every model, asked of models that hypothesis draws."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from recipes import View
from strategies import CONSERVATIVE, SHARING, between, recipes, views

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import system_of
from beamfem.solve.statics.statics import solve_through

pytestmark = pytest.mark.filterwarnings("ignore:.*unstable equilibria:beamfem.errors.UnstableWarning")
SAME = 1e-7  # of the model: corrections end below 1e-10 of it, and its softest way is far softer than its stiffest
SUDDEN = 0.05  # E I / L^2: loads that begin at once
RESOLVED = 4000  # steps of half a period of the lowest mode that resolve the highest one
LINES = ("line", "arc", "line")
conservative = recipes(load_kinds=CONSERVATIVE, followers=False)


def solved(built, steps=1):
    """The end of a static solve, or nothing where a limit point is in the way: other tests are about these."""
    try:
        return bf.solve_static(built.model, steps)
    except bf.ConvergenceError as error:
        assume("reach a limit point" not in str(error) and not isinstance(error, bf.LimitPointError))
        raise


def apart(recipe, one, other):
    """How far the last states of two (built, solution) are from one another, as a share of the model."""
    first, second = (built.positions(solution.p[-1]) for built, solution in (one, other))
    return np.abs(first - second).max() / recipe.reach


@given(recipes(), views())
def test_statics_do_not_know_where_and_how_a_model_is_drawn(recipe, view):
    plain, moved = recipe.build(), recipe.build(view)
    one, other = solved(plain), solved(moved)
    assert apart(recipe, (plain, one), (moved, other)) < SAME
    assert other.energy().strain[-1] == pytest.approx(one.energy().strain[-1], rel=1e-6)
    # loads that cancel leave reactions of their round-off
    acting = sum(np.abs(load.values).max() for load in recipe.loads)
    for support in recipe.supports:
        if support.kind == "foundation":
            continue
        here, there = (s.reaction(b.point(support.place))[-1] for b, s in ((plain, one), (moved, other)))
        size = acting + np.abs(here).max() + np.abs(one.support_forces[-1]).max()
        assert there[:2] @ view.matrix == pytest.approx(here[:2], abs=1e-6 * size)
        assert view.sense * there[2] == pytest.approx(here[2], abs=1e-6 * size)


@given(recipes(followers=False, led=False, load_kinds=CONSERVATIVE), views())
def test_modes_do_not_know_where_and_how_a_model_is_drawn(recipe, view):
    states = [solved(recipe.build(how)) for how in (View(), view)]
    assume(states[0].stable[-1])
    one, other = (bf.solve_modes(state.model, 4, about=state) for state in states)
    assert len(one.rigid) == len(other.rigid) == 0
    np.testing.assert_allclose(other.frequencies, one.frequencies, rtol=1e-7)


@pytest.mark.slow
@given(recipes(load_kinds=("force", "line"), followers=False, led=False, axis_kinds=("line",), most=2), views())
def test_buckling_does_not_know_where_and_how_a_model_is_drawn(recipe, view):
    found = []
    for how in (View(), view):
        try:
            found.append(bf.solve_buckling(recipe.build(how).model))
        except bf.BeamfemError as error:
            found.append(type(error))
    if isinstance(found[0], type) or isinstance(found[1], type):
        assert found[0] is found[1]
    else:
        np.testing.assert_allclose(found[1].load_factors, found[0].load_factors, rtol=1e-6)
        assert found[0].kinds == found[1].kinds


# coarse steps of random models may rightly gain energy; in every view alike
@pytest.mark.filterwarnings("ignore::beamfem.EnergyWarning")
@given(recipes(led=False, largest=SUDDEN, alike=True), views())
def test_motion_does_not_know_where_and_how_a_model_is_drawn(recipe, view):
    ends = []
    for how in (View(), view):
        built = recipe.build(how)
        try:
            ends.append((built, bf.simulate(built.model, 0.02, 1e-3)))
        except bf.ConvergenceError as error:
            ends.append(len(error.solution))
    if isinstance(ends[0], int) or isinstance(ends[1], int):
        assert ends[0] == ends[1]
    else:
        assert apart(recipe, *ends) < SAME


def asymmetry(solution):
    system = system_of(solution.model, True)
    rest = np.zeros(solution.model.size)
    _, tangent = linearise(system, solution.p[-1], rest, rest, 1.0, STATICS)
    matrix = tangent.sparse(system.rotated)
    return abs(matrix - matrix.T).max() / abs(matrix).max(), system.symmetric


@given(conservative)
def test_tangents_of_conservative_models_are_symmetric(recipe):
    found, said = asymmetry(solved(recipe.build()))
    assert said
    assert found < 1e-13


@given(recipes(load_kinds=("force", "line", "pressure")))
def test_a_tangent_that_is_said_to_be_symmetric_is(recipe):
    """Forces that follow and pressures on free ends have no potential; where the model says so, it is right."""
    found, said = asymmetry(solved(recipe.build()))
    if said:
        assert found < 1e-13
    else:
        assert any(load.follower or load.kind == "pressure" for load in recipe.loads)


@given(recipes(load_kinds=("force", "moment"), followers=False, most=2))
def test_the_work_of_slow_loads_is_stored_in_beams_and_springs(recipe):
    """Gauss' rule over the load factor integrates the work, of forces, moments and what leads the supports.

    Where the tangent is soft on the way the work bends sharply there, and takes more panels, up to 64.
    """
    assume(all(load.scale for load in recipe.loads))
    assume(all(support.kind != "foundation" for support in recipe.supports))
    stored, work = stored_and_done(recipe, panels=1)
    if stored != pytest.approx(work, rel=1e-6, abs=1e-12 * recipe.reach):
        stored, work = stored_and_done(recipe, panels=64)
    assert stored == pytest.approx(work, rel=1e-6, abs=1e-12 * recipe.reach)


def stored_and_done(recipe, panels):
    """Energy of beams and springs, and the work done, by Gauss' rule with 10 points a panel of the load factor."""
    built, (nodes, weights) = recipe.build(), np.polynomial.legendre.leggauss(10)
    nodes = ((0.5 + 0.5 * nodes + np.arange(panels)[:, None]) / panels).ravel()
    weights = np.tile(0.5 * weights / panels, panels)
    try:
        path = solve_through(built.model, nodes.tolist(), 3)
    except bf.LimitPointError:
        assume(False)
    rows = [int(np.argmin(np.abs(path.at - at))) for at in (*nodes, 1.0)]
    assert path.at[rows[:-1]] == pytest.approx(nodes, abs=1e-12)
    work = 0.0
    for load in built.model.loads:
        # the integral of lambda du is u(1) less that of u
        if isinstance(load, bf.PointForce):
            moved = path.displacement(load.point)[rows] @ np.array(load.vector)
        else:
            moved = path.rotation(load.point)[rows] * load.moment
        work += moved[-1] - weights @ moved[:-1]
    stored = path.energy().strain[-1]
    for support in built.model.supports:
        if isinstance(support, bf.Prescribed):
            reaction = path.reaction(support.point)[rows[:-1]]
            values = [float(value or 0.0) for value in (support.ux, support.uy, support.rotation)]
            work += float(weights @ (reaction @ values))
        if isinstance(support, bf.Spring):
            stored += 0.5 * path.displacement(support.point)[-1] ** 2 @ np.array(support.stiffness)
            stored += 0.5 * path.rotation(support.point)[-1] ** 2 * support.rotational
    return stored, work


@given(recipes(load_kinds=CONSERVATIVE, followers=False, led=False, most=2, largest=SUDDEN, alike=True))
def test_the_energy_of_a_free_motion_drifts_with_the_square_of_the_step(recipe):
    """rho_inf = 1 dissipates nothing, and its error is of second order: half the step leaves about a quarter.

    That is so where steps resolve what loads that are suddenly there excite, up to the thickness of a section.
    """
    model = recipe.build().model
    system, bent = system_of(model, static=False), bf.solve_static(model)
    frequencies = bf.solve_modes(model, len(system.free_dofs) - len(system.inclined), bent).frequencies
    period, highest = 1.0 / frequencies[0], frequencies[-1]
    steps = max(200, int(np.ceil(10 * 0.5 * period * highest)))
    assume(steps <= RESOLVED)
    drifts = []
    for count in (steps, 2 * steps):
        motion = bf.simulate(model, 0.5 * period, 0.5 * period / count, bf.GeneralizedAlpha(1.0))
        assume(np.ptp(motion.p, axis=0).max() > 1e-9 * recipe.reach)  # else supports take up all loads
        energy = motion.energy()
        size = max(energy.kinetic.max(), np.ptp(energy.potential), np.ptp(energy.strain))
        drifts.append(np.abs(energy.total - energy.total[0]).max() / size)
    moved = np.abs(motion.p - motion.p[0]).max() / recipe.reach
    # each step is iterated to 1e-9 of the model, and does that much wrong work of what it moves
    iterated = 2.0 * steps * 1e-9 / moved
    assert drifts[0] < 0.05
    assert drifts[1] < 0.5 * drifts[0] + iterated


@given(recipes(kinds=SHARING, axis_kinds=LINES))
def test_one_beam_is_two_joined_beams(recipe):
    """Of kinds whose nodes share all they have across a rigid joint: position and angle, or position and r_y.

    Other cubic kinds have r_x, or its length, at a node: on both sides of a joint it is free to be another, as it must
    where beams of different sections or directions meet. They are equal in the limit only, see the next test.
    """
    plain, parted = recipe.build(), recipe.build(View(split=True))
    assert apart(recipe, (plain, solved(plain)), (parted, solved(parted))) < SAME


@given(recipes(kinds=("ANCF-CRBF structural", "ANCF structural", "shear-rigid"), axis_kinds=LINES, most=1))
def test_cubic_kinds_are_two_joined_beams_in_the_limit(recipe):
    found = []
    for finer in (2, 8):
        plain, parted = recipe.build(View(finer=finer)), recipe.build(View(finer=finer, split=True))
        found.append(apart(recipe, (plain, solved(plain)), (parted, solved(parted))))
    assert found[1] < 0.3 * found[0] + SAME


@given(recipes(), st.integers(-6, 6), st.integers(-12, 12))
def test_units_that_are_powers_of_two_change_no_bit(recipe, length, force):
    view = View(length=2.0**length, force=2.0**force)
    plain, other = recipe.build(), recipe.build(view)
    assert apart(recipe, (plain, solved(plain)), (other, solved(other))) < 1e-12


@given(recipes(), st.floats(1e-3, 1e3), st.floats(1e-4, 1e4))
def test_units_change_nothing(recipe, length, force):
    plain, other = recipe.build(), recipe.build(View(length=length, force=force))
    assert apart(recipe, (plain, solved(plain)), (other, solved(other))) < 1e-9


@given(recipes())
def test_saved_and_loaded_is_the_same_and_solves_to_the_same(tmp_path_factory, recipe):
    path = tmp_path_factory.mktemp("saved") / "solution.h5"
    solution = solved(recipe.build())
    solution.save(path)
    loaded = bf.load(path)
    for name in ("at", "p", "v", "a"):
        np.testing.assert_array_equal(getattr(loaded, name), getattr(solution, name))
    again = bf.solve_static(loaded.model)
    assert np.abs(again.p[-1] - solution.p[-1]).max() < SAME


@given(recipes())
def test_a_static_solve_ends_on_the_traced_path(recipe):
    built = recipe.build()
    solution = solved(built)
    path = bf.trace_equilibrium(built.model, 1.0)
    assume(not path.limit_points and not path.bifurcations)
    assert path.at[-1] == pytest.approx(1.0, abs=1e-9)
    assert apart(recipe, (built, solution), (built, path)) < 1e-6


@given(recipes(), st.integers(2, 9))
def test_load_steps_do_not_change_the_end(recipe, steps):
    built = recipe.build()
    assert apart(recipe, (built, solved(built)), (built, solved(built, steps))) < SAME


@given(recipes(axis_kinds=LINES, most=1), st.floats(0.05, 0.95))
def test_a_load_between_nodes_is_one_on_a_node_there(recipe, fraction):
    beam = recipe.build().model.beams[0]
    ends = np.unique(np.append(np.linspace(0.0, 1.0, beam.elements + 1), fraction))
    assume(np.diff(ends).min() > 0.02)  # nearer ends of elements move there
    found = []
    for elements in (beam.elements, tuple(ends.tolist())):
        own = bf.Beam(beam.curve, elements, beam.element, beam.section, beam.material)
        force = 0.5 * own.section.rigidity(own.material).bending
        loads = [
            bf.PointForce(own.at(fraction), (force, -force), follower=True),
            bf.PointMoment(own.at(fraction), force),
        ]
        found.append(bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], loads)).position(own.end)[-1])
    assert found[0] == pytest.approx(found[1], abs=1e-12)


@given(recipes(axis_kinds=LINES, most=1, led=False), st.lists(between(-1.0, 1.0), min_size=3, max_size=3))
def test_a_table_is_the_function_that_it_samples(recipe, values):
    """Exactly where it is linear between its points, over the length and over time."""
    built = recipe.build()
    beam = built.model.beams[0]
    length, unit = beam.curve.length, beam.section.rigidity(beam.material).bending
    at = np.array([0.0, 0.4, 1.0])
    table = bf.Interpolated(list(zip((at * length).tolist(), values, strict=True)))
    course = bf.Interpolated([(0.0, 0.0), (0.01, values[0]), (0.03, values[1])])
    ends = []
    for along, amplitude in (
        (table, course),
        (
            bf.Piecewise(lambda s: float(np.interp(s, at * length, values)), (0.4 * length,)),
            bf.Piecewise(lambda t: float(np.interp(t, [0.0, 0.01, 0.03], [0.0, values[0], values[1]])), (0.01,)),
        ),
    ):
        value = bf.Piecewise(lambda s, own=along: (0.0, unit * own(s)), along.kinks)
        load = bf.DistributedLoad(beam, value, amplitude)
        model = bf.Model([beam], built.model.supports, [load])
        ends.append(bf.simulate(model, 0.02, 2e-3).p[-1][: model.size])
    assert ends[0] == pytest.approx(ends[1], abs=1e-11)


@given(recipes(led=False, largest=SUDDEN, alike=True), st.integers(2, 5))
def test_rows_that_are_kept_are_the_same_however_many(recipe, every):
    model = recipe.build().model
    whole, some = (bf.simulate(model, 0.012, 1e-3, save_every=keep) for keep in (1, every))
    rows = [*range(0, len(whole) - 1, every), len(whole) - 1]
    for name in ("at", "p", "v", "a"):
        np.testing.assert_array_equal(getattr(some, name), getattr(whole, name)[rows])
