"""The sparse matrix of entangled models against the band, dense linear algebra and closed forms."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from conftest import beam as small_beam
from scipy.sparse import csc_array

import beamfem as bf
from beamfem.element.fields import cross
from beamfem.equations.equation_numbering import Unknowns
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import System
from beamfem.linalg.lapack import LinAlgError, superlu
from beamfem.mesh.reference import energy_points
from beamfem.results.axis_points import axis, nodal_vectors

SECTION = bf.Rectangle(0.05, 0.05)
MATERIAL = bf.Material(1e7, 0.3, 1000.0)


@pytest.fixture
def force_sparse(monkeypatch):
    """Return a function that makes every model from now on sparse."""
    return lambda: monkeypatch.setattr("beamfem.equations.equation_numbering._WIDEST_BAND", -1)


def portal(loads=True):
    """A portal of three kinds of element with every kind of support and load, one member hinged."""
    left = bf.Beam(bf.Line((0, 0), (0, 1)), 3, bf.CRBF(2), SECTION, MATERIAL)
    top = bf.Beam(bf.Line((0, 1), (1.5, 1)), (0.0, 0.2, 0.6, 1.0), bf.ShearRigid(), SECTION, MATERIAL)
    right = bf.Beam(bf.Line((1.5, 1), (1.5, 0)), 2, bf.ANCF(bf.SplitContinuum()), SECTION, MATERIAL)
    brace = bf.Beam(bf.Line((0, 1), (0.75, 1.5)), 2, bf.CRBF(1), SECTION, MATERIAL)
    supports = [
        bf.Clamp(left.start),
        bf.Roller(right.end, (-0.6, 0.8)),
        bf.Spring(top.at(0.5), (2.0, 5.0)),
        bf.Spring(right.end, rotational=3.0),
        bf.Foundation(left, (4.0, 7.0)),
        bf.Roller(brace.end, (1.0, 1.0)),
        bf.Prescribed(brace.end, rotation=0.1),
    ]
    acting = [
        bf.PointForce(top.at(0.3), (0.0, -6.0), follower=True),
        bf.DistributedLoad(left, (2.0, 0.0), follower=True),
        bf.PointMoment(right.at(0.4), 0.5),
        bf.Gravity((0.0, -0.4), scale=False),
    ]
    joints = [bf.Rigid(left.end, top.start), bf.Rigid(top.end, right.start), bf.Hinge(left.end, brace.start)]
    return bf.Model([left, top, right, brace], supports, acting if loads else [], joints)


def grid(columns, rows, diagonals=True, element=None, force=(0.0, -1.0), supports=bf.Clamp):
    """A lattice of squares of 1 m, held at the bottom, with a force on each node of its top."""
    number = {(i, j): (float(i), float(j)) for j in range(rows + 1) for i in range(columns + 1)}
    pairs = [((i, j), (i + 1, j)) for i, j in number if i < columns]
    pairs += [((i, j), (i, j + 1)) for i, j in number if j < rows]
    if diagonals:
        pairs += [((i, j), (i + 1, j + 1)) for i, j in number if i < columns and j < rows]
    beams, ends = [], {place: [] for place in number}
    for a, b in pairs:
        beam = bf.Beam(bf.Line(number[a], number[b]), 2, element or bf.CRBF(1), SECTION, MATERIAL)
        beams.append(beam)
        ends[a].append(beam.start)
        ends[b].append(beam.end)
    joints = [bf.Rigid(here[0], other) for here in ends.values() for other in here[1:]]
    held = [supports(ends[i, 0][0]) for i in range(columns + 1)]
    loads = [bf.PointForce(ends[i, rows][0], force) for i in range(columns + 1)]
    return bf.Model(beams, held, loads, joints), ends


def tangent_at(model, p, factor=0.7):
    system = System(model, static=True)
    rest = np.zeros_like(p)
    return system, linearise(system, p, rest, rest, factor, STATICS)[1]


def disturbed(model, size, seed=1):
    p = System(model, static=True).reference
    return p + size * np.random.default_rng(seed).standard_normal(len(p))


def allowed(system):
    """Basis (unknown, m) of the changes that inclined rollers let through."""
    basis = np.eye(len(system.free_dofs))
    for first, (c, s) in zip(*system.rotated, strict=True):
        basis[[first, first + 1], first + 1] = -s, c
    return np.delete(basis, system.rotated[0], axis=1)


def test_the_sparse_tangent_has_the_entries_of_the_band(force_sparse):
    model = portal()
    p = disturbed(model, 0.02)
    nothing = np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    narrow, band = tangent_at(model, p)
    force_sparse()
    system, sparse = tangent_at(replace(model), p)
    assert isinstance(system.unknowns, Unknowns)
    assert system.unknowns.pattern is not None
    order = narrow.unknowns.free[system.free_dofs]
    a, b = band.sparse(nothing).toarray()[np.ix_(order, order)], sparse.sparse(nothing).toarray()
    assert np.abs(a - b).max() < 1e-13 * np.abs(a).max()
    assert np.abs(a - a.T).max() > 1e-6 * np.abs(a).max()  # followers are in it


@pytest.mark.parametrize("factor", [0.0, 0.7])
def test_a_sparse_solve_is_that_of_dense_matrices(force_sparse, factor, rng):
    force_sparse()
    model = portal()
    system, tangent = tangent_at(model, disturbed(model, 0.01), factor)
    assert len(system.rotated[0]) == 2
    nothing = np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    dense, basis = tangent.sparse(nothing).toarray(), allowed(system)
    right = rng.standard_normal(len(dense))
    expected = basis @ np.linalg.solve(basis.T @ dense @ basis, basis.T @ right)
    for x in (tangent.solve(right, system.rotated), tangent.factorised(system.rotated).solve(right)):
        assert np.abs(x - expected).max() < 1e-9 * np.abs(expected).max()


def test_static_solutions_agree(force_sparse):
    model = portal()
    band = bf.solve_static(model)
    force_sparse()
    sparse = bf.solve_static(model)
    assert sparse.statistics.iterations == band.statistics.iterations
    assert np.abs(sparse.p[-1] - band.p[-1]).max() < 1e-10
    for point in (model.beams[0].start, model.beams[2].end, model.beams[3].end):
        scale = np.abs(band.reaction(point)).max()
        assert np.abs(sparse.reaction(point) - band.reaction(point)).max() < 1e-8 * scale


def test_modes_buckling_and_paths_agree(force_sparse):
    model, ends = grid(2, 2, diagonals=False)
    tip = ends[0, 2][0]

    def run():
        frequencies = bf.solve_modes(model, 5).frequencies
        factors = bf.solve_buckling(model, 2).load_factors
        path = bf.trace_equilibrium(model, 0.95 * factors[0])
        return frequencies, factors, path.displacement(tip)[-1]

    band = run()
    force_sparse()
    sparse = run()
    for one, other in zip(band, sparse, strict=True):
        assert np.allclose(one, other, rtol=1e-7, atol=1e-10)


@pytest.mark.parametrize("size", [0.0, 0.01, 0.03, 0.1, 0.3])
@pytest.mark.parametrize("seed", range(4))
def test_negative_pivots_are_the_negative_eigenvalues(force_sparse, size, seed):
    force_sparse()
    model, ends = grid(4, 3, element=bf.CRBF(2))
    model = bf.Model(model.beams, [*model.supports, bf.Roller(ends[4, 2][0], (0.6, -0.8))], model.loads, model.joints)
    system, tangent = tangent_at(model, disturbed(model, size, seed))
    nothing = np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    dense, basis = tangent.sparse(nothing).toarray(), allowed(system)
    assert np.abs(dense - dense.T).max() < 1e-12 * np.abs(dense).max()
    expected = int((np.linalg.eigvalsh(basis.T @ dense @ basis) < 0.0).sum())
    assert tangent.factorised(system.rotated).negative_pivots == expected
    assert (expected > 0) == (size > 0.0)


@pytest.mark.slow
def test_a_wide_lattice_stretches_like_bars():
    """Without diagonals each column carries its own force and moves by P H / (E A); the rest is not strained."""
    model, ends = grid(24, 24, diagonals=False, force=(0.0, 50.0), supports=bf.Clamp)
    system = System(model, static=True)
    assert system.unknowns.pattern is not None
    solution = bf.solve_static(model)
    stretch = 50.0 * 24 / (MATERIAL.youngs_modulus * SECTION.area)
    moved = np.array([solution.displacement(ends[i, 24][0])[-1] for i in range(25)])
    assert np.abs(moved[:, 1] / stretch - 1.0).max() < 1e-9
    assert np.abs(moved[:, 0]).max() < 1e-9 * stretch


def test_like_beams_share_their_classes():
    model, _ = grid(5, 4)
    (block,) = System(model, static=True).blocks
    assert len(block.scale) == 2  # sides and diagonals
    assert block.kind.shape == (2 * len(model.beams),)
    lengths = np.array([beam.curve.length / 2 for beam in model.beams])
    assert np.allclose(block.jacobian[block.kind, 0], np.repeat(lengths, 2), rtol=1e-15)


def test_beams_that_differ_do_not_share_classes():
    lines = [((0, 0), (1, 0)), ((1, 0), (2, 0)), ((2, 0), (3 + 1e-9, 0)), ((3 + 1e-9, 0), (4 + 1e-9, 0))]
    sections = [SECTION, bf.Rectangle(0.05, 0.05), SECTION, bf.Rectangle(0.05, 0.06)]
    beams = [bf.Beam(bf.Line(*ends), 2, bf.CRBF(1), own, MATERIAL) for ends, own in zip(lines, sections, strict=True)]
    joints = [bf.Rigid(one.end, other.start) for one, other in pairwise(beams)]
    (block,) = System(bf.Model(beams, [bf.Clamp(beams[0].start)], joints=joints), static=True).blocks
    assert block.kind.tolist() == [0, 0, 0, 0, 1, 1, 2, 2]


def test_a_state_turned_inside_out_is_seen(element):
    beams = [small_beam(element), small_beam(element, 2, (1.0, 0.5), (1.5, 1.5))]
    system = System(bf.Model(beams, joints=[bf.Rigid(beams[0].end, beams[1].start)]), static=True)
    p = system.reference
    assert system.assembler().smallest_jacobian(p) > 0.0
    generator = np.random.default_rng(3)
    seen = set()
    for size in (0.01, 0.1, 0.5, 1.0, 3.0):
        state = p + size * generator.standard_normal(len(p))
        turned = False
        for mesh in system.model.meshes:
            now = axis(mesh, nodal_vectors(mesh, state[None]), *energy_points(mesh)[:2])
            turned = turned or bool(np.any(cross(now.r_s, now.d) <= 0.0))
        assert (system.assembler().smallest_jacobian(state) <= 0.0) == turned
        seen.add(turned)
    assert seen == {False, True}


def without_pivots(seed):
    """A symmetric matrix (30, 30) with so few entries that it is singular whatever their values are."""
    random = np.random.default_rng(seed)
    values = random.standard_normal((30, 30))
    above = np.triu(np.where(random.random((30, 30)) < 0.08, values, 0.0), 1)
    matrix = csc_array(above + above.T + np.diag(random.standard_normal(30)))
    matrix.data[random.integers(matrix.nnz, size=matrix.nnz // 3)] = 0.0
    matrix.eliminate_zeros()
    return matrix


@pytest.mark.parametrize("seed", [58, 310, 586, 1090])
def test_a_matrix_whose_zeros_make_it_singular_is_not_given_to_superlu(capfd, seed):
    """It printed "On entry to DTRSV parameter number 6 had an illegal value", for other seeds the process died."""
    with pytest.raises(LinAlgError):
        superlu(without_pivots(seed))
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_matrix_that_is_not_finite_is_not_given_to_superlu(value):
    matrix = csc_array(np.diag(np.full(5, 2.0)))
    matrix.data[3] = value
    with pytest.raises(LinAlgError, match="not finite"):
        superlu(matrix, full_diagonal=True, options={"SymmetricMode": True})


def test_a_zero_on_the_diagonal_is_no_singular_matrix():
    regular = csc_array(np.array([[0.0, 2.0], [4.0, 0.0]]))
    np.testing.assert_allclose(superlu(regular).solve(np.array([2.0, 4.0])), [1.0, 1.0])
