"""Equilibrium paths against closed forms and references computed without any beam element."""

import numpy as np
import pytest
from scipy.special import ellipk

import beamfem as bf
from beamfem.equations.system import System
from beamfem.solve.continuation.bifurcations import bifurcations
from beamfem.solve.continuation.continuation import begin
from beamfem.solve.continuation.critical_points import Segment
from beamfem.solve.newton.newton import Newton
from beamfem.solve.paths.trace import trace_equilibrium

SOFT = bf.Material(1.0, 0.0, 1.0)


def cantilever(slenderness, force, element=None, elements=8, nu=0.3):
    """A cantilever along x or up along y with E I = 1 and a tip force."""
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    material = bf.Material(1.0 / section.second_moment, nu, 1.0)
    end = (1.0, 0.0) if force[1] > 0.0 else (0.0, 1.0)
    beam = bf.Beam(bf.Line((0, 0), end), elements, element or bf.CRBF(4), section, material)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force)])


def bar(scale=1.0, turn=0.0):
    """Half of a von Mises truss: a pinned bar that is stiff in bending, its upper end guided along the load."""
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s], [s, c]])
    section = bf.Section(area=1.0, second_moment=10.0)
    beam = bf.Beam(bf.Line((0, 0), tuple(rotation @ (1.0, 0.4))), 1, bf.CRBF(1), section, SOFT)
    supports = [bf.Pin(beam.start), bf.Roller(beam.end, tuple(rotation @ (1.0, 0.0)))]
    return beam, bf.Model([beam], supports, [bf.PointForce(beam.end, tuple(scale * rotation @ (0.0, -1.0)))])


def bar_force(w):
    """Force [N] that holds the straight bar of E A = 1 at the deflection w, N = E A (l / l0 - 1)."""
    length = np.hypot(1.0, 0.4 - w)
    return (1.0 - length / np.hypot(1.0, 0.4)) * (0.4 - w) / length


# dP/dw = 0 where the length of the bar is (b^2 l0)^(1/3)
LIMIT_HEIGHT = np.sqrt(np.hypot(1.0, 0.4) ** (2 / 3) - 1.0)


@pytest.mark.parametrize(
    ("slenderness", "tip"), [(10, (-0.38922722797924, 0.72054526137677)), (100, (-0.38764432832607, 0.71385896416489))]
)
def test_the_path_of_a_cantilever_ends_on_the_reissner_reference(slenderness, tip):
    beam, model = cantilever(slenderness, (0.0, 5.0))
    path = trace_equilibrium(model, 1.0)
    assert path.load_factor[-1] == 1.0
    assert np.abs(path.displacement(beam.end)[-1] - tip).max() < 2e-9
    assert path.limit_points == () == path.bifurcations
    assert len(path) <= 12
    assert path.iterations <= 35


@pytest.mark.parametrize("slenderness", [10, 1000, 10000])
def test_the_work_does_not_grow_with_slenderness(slenderness):
    _, model = cantilever(slenderness, (0.0, 5.0))
    assert trace_equilibrium(model, 1.0).iterations <= 35


@pytest.mark.parametrize("make", [bf.ANCF, bf.ANCFCRBF, bf.BilinearANCF, bf.BilinearCRBF])
def test_states_along_a_path_are_those_of_load_steps(make):
    _, model = cantilever(20, (0.0, 2.0), make(), 8)
    path = trace_equilibrium(model, 1.0)
    expected = bf.solve_static(model).p[-1]
    assert np.abs(path.p[-1] - expected).max() < 1e-8


@pytest.mark.parametrize("what", [{"uy": 0.8}, {"rotation": 2 * np.pi}])
@pytest.mark.parametrize("slenderness", [10, 1000])
def test_prescribed_motions_are_followed(what, slenderness):
    beam, _ = cantilever(slenderness, (0.0, 1.0))
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, **what)])
    path = trace_equilibrium(model, 1.0)
    expected = bf.solve_static(model)
    assert path.reaction(beam.end)[-1] == pytest.approx(expected.reaction(beam.end)[-1], rel=1e-6, abs=1e-6)
    assert path.iterations <= 40


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_both_limit_loads_of_a_bar_are_met_whatever_the_unit_of_the_load(scale, turn):
    beam, model = bar(scale, turn)
    path = trace_equilibrium(model, lambda state: np.linalg.norm(state.displacement(beam.end)) > 1.2)
    for found, height in zip(path.limit_points, (LIMIT_HEIGHT, -LIMIT_HEIGHT), strict=True):
        assert found.load_factor * scale == pytest.approx(bar_force(0.4 - height), rel=1e-12)
        assert np.linalg.norm(found.displacement(beam.end)) == pytest.approx(0.4 - height, rel=1e-7)
    assert path.bifurcations == ()
    for state in path:
        w = np.linalg.norm(state.displacement(beam.end))
        assert state.load_factor * scale == pytest.approx(bar_force(w), abs=1e-11)


def test_a_load_behind_a_limit_point_is_landed_on():
    beam, model = bar()
    path = trace_equilibrium(model, -0.01, direction=1)
    assert path.load_factor[-1] == -0.01
    assert len(path.limit_points) == 1
    back = trace_equilibrium(model, 0.0)
    assert back.load_factor[-1] == 0.0
    assert back.displacement(beam.end)[-1, 1] == pytest.approx(-0.4, abs=1e-9)


WILLIAMS = [(33.8491411685, 0.231963322934), (31.2444502955, 0.39174738873)]


def toggle():
    """Half of Williams' toggle with a guided crown; it carries half the load (references, family 7)."""
    section, material = bf.Section(0.1885, 9.274e-4), bf.Material(1e7, 0.3, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (12.943, 0.386)), 8, bf.CRBF(4), section, material)
    supports = [bf.Clamp(beam.start), bf.Prescribed(beam.end, rotation=0.0), bf.Roller(beam.end, (1.0, 0.0))]
    return beam, bf.Model([beam], supports, [bf.PointForce(beam.end, (0.0, -0.5))])


def test_williams_toggle_has_the_limit_loads_of_the_collocation_reference():
    beam, model = toggle()
    path = trace_equilibrium(model, 80.0)
    for found, (load, deflection) in zip(path.limit_points, WILLIAMS, strict=True):
        assert found.load_factor == pytest.approx(load, rel=2e-9)
        assert -found.displacement(beam.end)[1] == pytest.approx(deflection, rel=1e-7)
    thrust = path.limit_points[0].reaction(beam.start)[0]
    assert thrust == pytest.approx(631.491699114, rel=1e-7)


def test_two_limit_points_in_one_step_are_told_apart():
    beam, model = toggle()
    path = trace_equilibrium(model, 80.0)
    deflection = -path.displacement(beam.end)[:, 1]
    rows = [np.flatnonzero(deflection < WILLIAMS[0][1])[-1], np.flatnonzero(deflection > WILLIAMS[1][1])[0]]
    system = System(model, static=True)
    line, first = begin(system, system.reference, 0.0, Newton())
    ends = [np.append(path.p[row], path.at[row]) for row in rows]
    segment = Segment(line, *(line.linearised(y, first.tangent) for y in ends))
    loads = [segment.at(x).load_factor for x in segment.limit_points()]
    assert loads == pytest.approx([load for load, _ in WILLIAMS], rel=2e-9)
    assert bifurcations(segment, segment.limit_points()) == []


def test_the_buckling_load_of_a_column_and_its_mode():
    """References, family 8: cantilever, L/h = 10, Reissner beam, linearised about the compressed state."""
    beam, model = cantilever(10, (0.0, -1.0))
    path = trace_equilibrium(model, 3.0)
    (found,) = path.bifurcations
    assert found.load_factor == pytest.approx(2.4567382724132, rel=1e-8)
    assert path.limit_points == ()
    assert np.abs(path.displacement(beam.end)[:, 0]).max() < 1e-12
    table = found.mode.reshape(-1, 3)
    axial, lateral = np.abs(table[:, 1]).max(), np.abs(table[:, 0]).max()
    assert axial < 1e-8 * lateral


@pytest.mark.parametrize("imperfection", [1e-2, 1e-5, 1e-8])
def test_an_imperfect_column_is_followed_round_the_corner_and_not_across_it(imperfection):
    """A straight continuation would pass the buckling load on a path that is not connected with load factor 0."""
    beam, _ = cantilever(100, (0.0, -1.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (imperfection, -1.0))])
    path = trace_equilibrium(model, 4.0)
    assert path.bifurcations == () == path.limit_points
    assert path.displacement(beam.end)[-1, 0] > 0.5
    angle = path.rotation(beam.end)[-1]
    assert ellipk(np.sin(angle / 2) ** 2) ** 2 == pytest.approx(4.0, rel=0.1 * imperfection + 1e-4)


@pytest.mark.parametrize("direction", [1, -1])
def test_the_branch_of_a_buckled_column_is_the_elastica(direction):
    """Tip angle a under P L^2 / E I = K(sin(a / 2))^2; strains of the load make 4e-9 at L/h = 10000."""
    beam, model = cantilever(10000, (0.0, -1.0), elements=16)
    path = trace_equilibrium(model, 3.0)
    branch = trace_equilibrium(
        model, lambda state: abs(state.rotation(beam.end)) > 2.0, start=path.bifurcations[0], direction=direction
    )
    angle = branch.rotation(beam.end)[1:]
    assert np.all(np.sign(angle) == np.sign(angle[0]))
    assert abs(angle[-1]) > 2.0
    assert branch.load_factor[1:] == pytest.approx(ellipk(np.sin(angle / 2) ** 2) ** 2, rel=1e-8)
    assert branch.bifurcations == () == branch.limit_points


def test_the_two_sides_of_a_bifurcation_mirror_each_other():
    beam, model = cantilever(10, (0.0, -1.0))
    crossing = trace_equilibrium(model, 3.0).bifurcations[0]
    ends = [
        trace_equilibrium(model, 4.0, start=crossing, direction=side).displacement(beam.end)[-1] for side in (1, -1)
    ]
    assert ends[0] * (-1.0, 1.0) == pytest.approx(ends[1], abs=1e-8)
    assert abs(ends[0][0]) > 0.5


def test_several_bifurcations_in_one_step_are_told_apart():
    """Buckling loads (pi / 2)^2 (1, 9, 25) of a thin column between two points far apart on the straight path."""
    _, model = cantilever(1000, (0.0, -1.0))
    system = System(model, static=True)
    line, start = begin(system, system.reference, 0.0, Newton())
    far = start.y + 70.0 * start.tangent / start.tangent[-1]
    far = line.correct(far, line.stresses(start.y, far - start.y), start.tangent).y
    segment = Segment(line, start, line.linearised(far, start.tangent))
    loads = [found.y[-1] for found in bifurcations(segment, [])]
    assert loads == pytest.approx(np.pi**2 / 4 * np.array([1.0, 9.0, 25.0]), rel=3e-5)


def test_the_largest_compression_of_a_material_is_a_limit_point_and_the_path_ends_where_nothing_is_left():
    """St. Venant-Kirchhoff: P = E A l (1 - l^2) / 2 has its maximum at the stretch 1 / sqrt(3), case 11.iii."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.BilinearANCF(), bf.Rectangle(0.5, 0.5), SOFT)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1.0, 0.0))])
    with pytest.raises(bf.ConvergenceError, match="inside out") as caught:
        trace_equilibrium(model)
    path = caught.value.solution
    stretch = 1.0 / np.sqrt(3.0)
    assert path.limit_points[0].load_factor == pytest.approx(0.125 * stretch * (1.0 - stretch**2), rel=1e-12)
    assert 0.0 < path.position(beam.end)[-1, 0] < 1e-2
    assert "inside out" in path.statistics.ended
    assert path.status is bf.Status.STOPPED
    assert trace_equilibrium(model, points=3).status is bf.Status.COMPLETED


def test_a_state_answers_as_its_row_of_the_path():
    beam, model = cantilever(10, (0.0, 1.0))
    path = trace_equilibrium(model, 1.0)
    state = path[-1]
    assert state.load_factor == path.load_factor[-1]
    for name in ("position", "displacement", "rotation"):
        assert np.array_equal(getattr(state, name)(beam.at(0.3)), getattr(path, name)(beam.at(0.3))[-1])
    # products of one row and of many round in their own ways
    assert state.reaction(beam.start) == pytest.approx(path.reaction(beam.start)[-1], rel=1e-14, abs=1e-12)
    assert state.section_forces(beam).moment == pytest.approx(
        path.section_forces(beam).moment[-1], rel=1e-14, abs=1e-14
    )
    strains = [of.fields(beam.end).green_strain.xx for of in (state, path)]
    assert strains[0] == pytest.approx(strains[1][-1], abs=1e-14)  # the change of lengths of 1
    assert [s.at for s in path] == list(path.load_factor)


def test_a_path_is_saved_and_drawn_as_a_solution_and_a_motion_starts_from_its_states(tmp_path):
    _, model = bar()
    path = trace_equilibrium(model, points=12)
    assert len(path) == 12
    assert "used up" in path.statistics.ended
    path.save(tmp_path / "path.h5")
    assert np.array_equal(bf.load(tmp_path / "path.h5").p, path.p)
    path.plot(tmp_path / "path.png")
    with pytest.warns(bf.UnknownStressWarning):
        path.to_vtk(tmp_path / "path.pvd")
    motion = bf.simulate(model, 0.01, 0.01, start=path.limit_points[0])
    assert np.array_equal(motion.p[0], path.limit_points[0].p)


def test_an_until_for_a_whole_solution_is_told_that_it_gets_one_state():
    beam, model = cantilever(10, (0.0, 5.0))
    with pytest.raises(IndexError) as caught:
        trace_equilibrium(model, lambda state: state.displacement(beam.end)[-1, 1] > 0.1)
    assert any("state.displacement(point)[1], have no axis of rows" in note for note in caught.value.__notes__)


@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt])
def test_what_stops_the_work_keeps_the_path(error):
    _, model = cantilever(10, (0.0, 5.0))

    def until(state):
        if state.load_factor > 0.3:
            raise error
        return False

    with pytest.raises(error) as caught:
        trace_equilibrium(model, until)
    found = caught.value.solution
    assert found.load_factor[-1] > 0.3
    assert np.all(np.diff(found.load_factor) > 0.0)


def test_the_first_step_is_the_users():
    _, model = cantilever(10, (0.0, 5.0))
    assert trace_equilibrium(model, 1.0, step=0.05).load_factor[1] == pytest.approx(0.05, rel=1e-2)


def test_paths_that_cannot_be_followed_are_refused():
    beam, model = cantilever(10, (0.0, 1.0))
    other = cantilever(10, (0.0, -1.0))[1]
    crossing = trace_equilibrium(other, 3.0).bifurcations[0]
    with pytest.raises(bf.FreeMotionError, match="turns about"):
        trace_equilibrium(bf.Model([beam], [bf.Pin(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))]))
    constant = bf.PointForce(beam.end, (0.0, 1.0), scale=False)
    with pytest.raises(bf.InputError, match="changes with the load factor"):
        trace_equilibrium(bf.Model([beam], [bf.Clamp(beam.start)], [constant]))
    for wrong in (
        {"until": "1"},
        {"until": np.nan},
        {"points": 0},
        {"step": -1.0},
        {"direction": 0},
        {"start": 1.0},
        {"start": crossing},
        {"start": crossing, "step": 0.1},
    ):
        with pytest.raises(bf.InputError):
            trace_equilibrium(model, **wrong)


def test_columns_that_buckle_together_have_a_mode_each():
    """Three equal columns in one model: the stiffness of three modes vanishes at one load; each branch is one's own."""
    columns = [cantilever(10, (0.0, -1.0))[0] for _ in range(3)]
    supports, loads = zip(*((bf.Clamp(c.start), bf.PointForce(c.end, (0.0, -1.0))) for c in columns), strict=True)
    model = bf.Model(columns, supports, loads)
    path = trace_equilibrium(model, 3.0)
    assert [found.load_factor for found in path.bifurcations] == pytest.approx([2.4567382724132] * 3, rel=1e-8)
    modes = np.array([found.mode for found in path.bifurcations])
    assert modes @ modes.T == pytest.approx(np.diag(np.diag(modes @ modes.T)), abs=1e-6 * (modes @ modes.T).max())
    branch = trace_equilibrium(model, points=4, start=path.bifurcations[1])
    assert np.abs([branch.displacement(c.end)[-1, 0] for c in columns]).max() > 0.01


@pytest.mark.parametrize(
    "amplitude", [lambda at: at**2, lambda at: 1.0 + at**2, lambda at: at**3, lambda at: np.sin(at)]
)
def test_a_path_may_begin_where_its_loads_do_not_grow_yet(amplitude):
    """The load factor was measured by what a millionth of it does, a million times too large."""
    own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([own], [bf.Clamp(own.start)], [bf.PointMoment(own.end, 150.0, amplitude=amplitude)])
    path = bf.trace_equilibrium(model, until=1.0)
    assert path.rotation(own.end)[-1] == pytest.approx(bf.solve_static(model).rotation(own.end)[-1], rel=1e-9)
    assert np.all(np.diff(path.load_factor) > 0.0)
