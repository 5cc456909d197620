"""Bands with a border: connectors on chains in motions, against the same equations as a sparse matrix."""

from dataclasses import dataclass

import numpy as np
import pytest
from connectors import (
    KINDS,
    Anchor,
    Barrier,
    PointMass,
    Rest,
    RigidLink,
    SpringDamper,
    beam,
    cantilever,
    crossbar,
)
from section_laws import LinearLaw
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations import equation_numbering as layout
from beamfem.equations.equations import linearise
from beamfem.equations.system import System, system_of
from beamfem.linalg.bordered import Border, BorderedTangent
from beamfem.linalg.lapack import LinAlgError
from beamfem.linalg.tangent import UNROTATED, BandTangent


def of_all_kinds():
    for element in KINDS:
        own = beam(element)
        gravity = [bf.Gravity((3.0, -9.81))]
        yield cantilever(own, gravity, [PointMass(own.end, 1.0), SpringDamper(own.at(0.5), own.end, 1e4, 3.0)])
        yield cantilever(own, gravity, [Rest(own.end, -1e-3, 1e5, 0.3), Anchor(own.at(0.25), (1e3, 1e4, 10.0))])
        yield bf.Model([own], [bf.Pin(own.start)], gravity, connectors=[RigidLink(own.at(0.5), own.end)])
    yield crossbar(RigidLink, 0.3)[1]
    yield crossbar(lambda a, b: SpringDamper(a, b, 1e4, 10.0))[1]


@mostly_slow("number", range(3 * len(KINDS) + 2), quick=(0, 4, 8, 10))
def test_a_motion_is_that_of_the_sparse_matrix(number, monkeypatch):
    def run():
        model = list(of_all_kinds())[number]
        motion = bf.simulate(model, 0.1, 2e-3, integrator=bf.GeneralizedAlpha(0.8))
        return motion, system_of(model, static=False).unknowns

    bordered, unknowns = run()
    assert unknowns.pattern is None
    monkeypatch.setattr(layout, "WIDEST_BORDER", -1)
    sparse, unknowns = run()
    assert unknowns.pattern is not None
    coordinates = slice(bordered.model.coordinates)
    assert bordered.p == pytest.approx(sparse.p, rel=1e-5, abs=1e-7)  # multipliers [N] as well
    for name, tolerance in (("p", 1e-9), ("v", 1e-7)):
        one, other = (getattr(motion, name)[:, coordinates] for motion in (bordered, sparse))
        assert np.abs(other - other[0]).max() > 1e-3
        assert one == pytest.approx(other, abs=tolerance * np.abs(other).max())


@pytest.mark.parametrize("number", range(3 * len(KINDS) + 2))
def test_its_tangent_is_that_of_the_sparse_matrix(number, monkeypatch, rng):
    found = []
    for widest in (64, -1):
        monkeypatch.setattr(layout, "WIDEST_BORDER", widest)
        system = System(list(of_all_kinds())[number], static=False)
        moved = system.reference + 1e-2 * np.random.default_rng(0).standard_normal(len(system.reference))
        _, tangent = linearise(system, moved, 0.0 * moved, 0.0 * moved, 0.0, (1.0, 2.0, 3.0))
        whole = np.zeros((len(moved),) * 2)
        whole[np.ix_(system.free_dofs, system.free_dofs)] = tangent.sparse(UNROTATED).toarray()
        right = rng.standard_normal(len(system.free_dofs)) if not found else found[0][1][system.free_dofs]
        full, x = np.zeros(len(moved)), np.zeros(len(moved))
        full[system.free_dofs] = right
        x[system.free_dofs] = tangent.solve(right, UNROTATED)
        assert isinstance(tangent, BorderedTangent | BandTangent) == (widest > 0)
        found.append((whole, full, x, tangent.factorised(UNROTATED).negative_pivots))
    one, other = found
    assert one[0] == pytest.approx(other[0], rel=1e-13, abs=1e-13 * np.abs(other[0]).max())
    assert one[2] == pytest.approx(other[2], rel=1e-6, abs=1e-7 * np.abs(other[2]).max())
    assert one[3] == other[3]


def border_of(size, multipliers, coupled, matrices):
    """The border of a band (size, size) by matrices (m, m) of coupled equations (m,), -1 for what is no unknown."""
    everything = np.concatenate([*coupled, np.arange(size, size + multipliers)])
    numbers = np.unique(everything[everything >= 0])
    entries = np.zeros((len(numbers), len(numbers)))
    for own, matrix in zip(coupled, matrices, strict=True):
        mask = own >= 0
        place = np.searchsorted(numbers, own[mask])
        entries[np.ix_(place, place)] += matrix[np.ix_(mask, mask)]
    return Border(numbers[numbers < size], multipliers, entries)


@pytest.mark.parametrize("multipliers", [0, 2])
def test_factors_with_a_border_solve_the_whole_matrix(multipliers, rng):
    size, half = 12, 2
    whole = np.zeros((size + multipliers, size + multipliers))
    rows = rng.standard_normal((size, 2 * half + 1))
    rows[:, half] += 8.0
    whole[:size, :size] = BandTangent(rows, np.empty((2, 0))).sparse(UNROTATED).toarray()
    coupled = [np.array([0, 7, -1, 11]), np.array([3, 7, *range(size, size + multipliers)])]
    matrices = [rng.standard_normal((len(own), len(own))) for own in coupled]
    matrices[1][2:, 2:] = 0.0
    for own, matrix in zip(coupled, matrices, strict=True):
        mask = own >= 0
        whole[np.ix_(own[mask], own[mask])] += matrix[np.ix_(mask, mask)]

    reach = np.tile(np.minimum(np.arange(size) + half + 1, size).astype(np.int32), (2, 1))
    tangent = BorderedTangent(BandTangent(rows, reach), border_of(size, multipliers, coupled, matrices))
    right = rng.standard_normal(size + multipliers)
    assert whole @ tangent.solve(right, UNROTATED) == pytest.approx(right, abs=1e-12)


def test_conditions_that_repeat_each_other_are_singular():
    twice, reach = [np.array([0, 2]), np.array([0, 3])], np.array([[1, 2], [1, 2]], dtype=np.int32)
    row = [np.array([[0.0, 1.0], [1.0, 0.0]])] * 2
    with pytest.raises(LinAlgError):
        BorderedTangent(BandTangent(np.ones((2, 1)), reach), border_of(2, 2, twice, row)).factorised(UNROTATED)


def test_an_error_in_a_force_ends_the_motion_with_the_states_before():
    class Failing(PointMass):
        def force(self, at):
            if 0.0101 < np.real(at.time) < 0.0119:
                raise ZeroDivisionError("no force there")
            return super().force(at)

    own = beam(KINDS[1])
    model = cantilever(own, [bf.Gravity((0.0, -9.81))], [Failing(own.end, 1.0)])
    with pytest.raises(
        bf.InputError, match=r"force of Failing.*cannot be computed: ZeroDivisionError: no force"
    ) as caught:
        bf.simulate(model, 0.05, 1e-3)
    known = bf.simulate(cantilever(own, [bf.Gravity((0.0, -9.81))], [PointMass(own.end, 1.0)]), 0.01, 1e-3)
    assert len(caught.value.solution) == 11
    assert caught.value.solution.p == pytest.approx(known.p[: len(caught.value.solution)], abs=1e-14)
    assert bf.simulate(model, 0.01, 1e-3).p == pytest.approx(known.p, abs=1e-14)


def test_many_connectors_make_the_matrix_sparse():
    own = beam(bf.CRBF(2), elements=40)
    springs = [SpringDamper(own.at(k / 40), own.end, 10.0) for k in range(1, 40)]
    model = cantilever(own, [bf.Gravity((0.0, -9.81))], springs)
    bf.simulate(model, 0.01, 1e-3)
    assert system_of(model, static=False).unknowns.pattern is not None


def test_connectors_of_one_point_are_entries_of_the_band_however_many_there_are(monkeypatch):
    """So are those between neighbours. What iterations leave in the steps is 1e-8 of the motion."""
    tips = []
    for widest in (64, -1):
        monkeypatch.setattr(layout, "_WIDEST_BAND", widest)
        own = beam(bf.CRBF(2), elements=30)
        parts = [PointMass(own.at(k / 30), 0.1) for k in range(1, 31)]
        parts.append(SpringDamper(own.at(14 / 30), own.at(29 / 60), 1e3, 2.0))
        model = cantilever(own, [bf.Gravity((0.0, -9.81))], parts)
        unknowns = system_of(model, static=False).unknowns
        assert (unknowns.pattern is None) == (widest > 0)
        assert unknowns.border_size == 0
        tips.append(bf.simulate(model, 0.05, 1e-3).displacement(own.end))
    assert np.abs(tips[1]).max() > 1e-2
    assert tips[0] == pytest.approx(tips[1], abs=1e-8 * np.abs(tips[1]).max())


@pytest.mark.parametrize("part", [lambda at: PointMass(at, 2.0), lambda at: Anchor(at, (1e3, 1e3, 1.0))])
def test_a_connector_at_a_clamp_changes_nothing(part):
    own = beam(KINDS[1])
    model = cantilever(own, [bf.Gravity((0.0, -9.81))], [part(own.start)])
    alone = cantilever(own, [bf.Gravity((0.0, -9.81))])
    tips = [bf.simulate(each, 0.02, 1e-3).position(own.end) for each in (model, alone)]
    assert tips[0] == pytest.approx(tips[1], abs=1e-8 * np.ptp(tips[1][:, 1]))


@pytest.mark.filterwarnings("ignore::beamfem.EnergyWarning")  # long steps damp nearly all of the vibration
@mostly_slow("step", [1e-3, 0.1, 1.0], quick=(0, 2))
@mostly_slow("density", [1.0, 1e-6, 1e-9], quick=(2,))
def test_connectors_may_hold_and_load_a_beam_of_hardly_any_mass(density, step):
    """A rotor: a light shaft with a disc between springs; without them the band would have no digits."""
    shaft = beam(bf.CRBF(2), elements=6, density=density)
    springs = [Anchor(point, (1e6, 1e6, 0.0)) for point in (shaft.start, shaft.end)]
    middle = shaft.at(0.5)
    disc, tie = PointMass(middle, 10.0), SpringDamper(shaft.start, shaft.end, 1e4)
    model = bf.Model([shaft], [], [bf.Gravity((0.0, -9.81))], connectors=[*springs, disc, tie])
    motion = bf.simulate(model, 400 * step, step, integrator=bf.GeneralizedAlpha(0.0), save_every=400)
    still = bf.solve_static(model)
    if step == 1.0:
        assert motion.displacement(middle)[-1, 1] == pytest.approx(still.displacement(middle)[-1, 1], rel=1e-4)
    assert motion.displacement(middle)[-1, 1] < 0.0


@pytest.mark.slow
def test_a_force_that_is_undefined_at_an_iterate_is_tried_from_elsewhere(request):
    """A wall that is defined up to some depth: iterates are rejected; if all are, the step fails in a sentence."""

    class Shallow(Barrier):
        def force(self, at):
            outside = np.real(at.q[0, 1]) - self.level < -3.0 * self.width
            return super().force(at) * (np.nan if outside else 1.0)

    own, motions = beam(bf.CRBF(2)), []
    for kind in (Shallow, Barrier):
        model = cantilever(own, [bf.Gravity((0.0, -100.0))], [kind(own.end, -0.05, 1e4, 0.01)])
        motions.append(bf.simulate(model, 1.2, 2e-2))
    assert motions[0].p == pytest.approx(motions[1].p, abs=1e-8)
    deep = cantilever(own, [bf.Gravity((0.0, -100.0))], [Shallow(own.end, -0.02, 1e5, 0.003)])
    bounced = bf.simulate(deep, 1.2, 2e-2)  # with shorter steps
    assert bounced.statistics.cuts > 0
    assert np.isfinite(bounced.p).all()
    request.getfixturevalue("uncut_steps")
    with pytest.raises(bf.ConvergenceError, match="did not converge") as caught:
        bf.simulate(deep, 1.2, 2e-2)
    assert len(caught.value.solution) == 5
    assert np.isfinite(caught.value.solution.p).all()


def test_an_error_of_a_connector_leaves_none_of_a_law_behind():
    """The corrections that end the motion reach the law, which objects to them."""

    @dataclass(frozen=True)
    class Strict(LinearLaw):
        def resultants(self, strain, material):
            if not np.isfinite(strain).all():
                raise ValueError("no strain")
            return super().resultants(strain, material)

    class Failing(PointMass):
        def force(self, at):
            if 0.0051 < np.real(at.time) < 0.0069:
                raise ZeroDivisionError("no force there")
            return super().force(at)

    own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), Strict(2e7, 7e6, 166.0, 0.78, 1e-5))
    model = cantilever(own, [bf.Gravity((0.0, -9.81))], [Failing(own.end, 1.0)])
    with pytest.raises(bf.InputError, match="no force there"):
        bf.simulate(model, 0.01, 1e-3)
    assert len(bf.simulate(model, 0.005, 1e-3)) == 6


@pytest.mark.parametrize("element", KINDS, ids=lambda element: element.name)
def test_equilibria_with_connectors_of_one_point_are_those_of_the_sparse_matrix(element, monkeypatch):
    """Friction makes the tangent unsymmetric; the wall is met on the way."""
    found = []
    for band in (True, False):
        if not band:
            monkeypatch.setattr(layout, "_WIDEST_BAND", -1)
        own = beam(element)
        parts = [Rest(own.at(0.75), -1e-3, 1e4, 0.3), Barrier(own.end, -1e-2, 1e3, 1e-3), PointMass(own.end, 3.0)]
        loads = [bf.Gravity((1.0, -9.81)), bf.PointForce(own.end, (3.0, -10.0))]
        model = cantilever(own, loads, parts)
        solution = bf.solve_static(model, steps=4)
        assert (system_of(model, static=True).unknowns.pattern is None) == band
        found.append(solution)
    one, other = found
    assert one.p == pytest.approx(other.p, abs=1e-10)
    assert one.statistics.iterations == other.statistics.iterations
    assert np.array_equal(one.stable, other.stable)
    assert np.abs(one.displacement(one.model.beams[0].end)[-1]).max() > 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("own", [bf.SpringDamper, SpringDamper], ids=("compiled", "Python"))
@mostly_slow("element", KINDS, quick=(0, 2), ids=lambda element: element.name)
def test_equilibria_with_springs_across_beams_are_those_of_the_sparse_matrix(element, own, monkeypatch):
    """The upper beam is held by springs alone."""
    found = []
    for widest in (layout.WIDEST_BORDER, -1):
        monkeypatch.setattr(layout, "WIDEST_BORDER", widest)
        lower, upper = beam(element), beam(element, (0, 0.3), (1, 0.3))
        pairs = (0.5, 0.0), (1.0, 0.5), (0.25, 1.0), (1.0, 1.0)
        springs = [own(lower.at(a), upper.at(b), 200.0) for a, b in pairs]
        loads = [bf.Gravity((1.0, -9.81)), bf.PointForce(upper.end, (0.1, -0.3))]
        model = bf.Model([lower, upper], [bf.Clamp(lower.start)], loads, connectors=springs)
        solution, path = bf.solve_static(model, steps=4), bf.trace_equilibrium(model, until=1.0)
        modes = bf.solve_modes(model, 4, about=solution[-1])
        assert (system_of(model, static=True).unknowns.pattern is None) == (widest > 0)
        assert np.abs(solution.displacement(upper.end)[-1]).max() > 1e-3
        found.append((solution, path, modes))
    (one, path, modes), (other, sparse_path, sparse_modes) = found
    assert one.p == pytest.approx(other.p, abs=1e-10)
    assert one.statistics.iterations == other.statistics.iterations
    assert np.array_equal(one.stability, other.stability)
    assert path.p == pytest.approx(sparse_path.p, abs=1e-8)
    assert modes.frequencies == pytest.approx(sparse_modes.frequencies, rel=1e-8)


def test_an_error_of_a_connector_in_statics_is_raised_and_leaves_none_behind():
    class Failing(Anchor):
        def force(self, at):
            if 0.6 < np.real(at.time) < 0.8:
                raise ZeroDivisionError("no force there")
            return super().force(at)

    own = beam(KINDS[1])
    model = cantilever(own, [bf.Gravity((0.0, -9.81))], [Failing(own.end, (1e3, 1e3, 0.0))])
    with pytest.raises(bf.InputError, match="no force there") as caught:
        bf.solve_static(model, steps=4)
    assert caught.value.solution.load_factor.tolist()[:2] == [0.0, 0.25]
    assert bf.solve_static(model, steps=2).load_factor[-1] == 1.0
