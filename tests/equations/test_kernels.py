"""Tangents against finite differences, rigid motion, the band solver; every combination."""

import numpy as np
import pytest
from conftest import ELEMENTS, beam, identify
from scipy.linalg import solve_banded

import beamfem as bf
from beamfem.equations.equations import linearise, predicted_stresses
from beamfem.equations.model_coordinates import coordinate_columns
from beamfem.equations.system import System
from beamfem.linalg.tangent import BandTangent, _solve_pivoted
from beamfem.mesh.reference import stations
from beamfem.results.axis_points import axis, nodal_vectors

NONE_TURNED = (np.empty(0, dtype=np.int64), np.empty((0, 2)))


@pytest.fixture(params=ELEMENTS, ids=identify)
def element(request):
    """Every integration too."""
    return request.param


def dense(tangent):
    rows = tangent.rows
    n, width = rows.shape
    half = width // 2
    matrix = np.zeros((n, n))
    for i in range(n):
        for j in range(max(0, i - half), min(n, i + half + 1)):
            matrix[i, j] = rows[i, half + j - i]
    return matrix


@pytest.mark.parametrize("moving", [False, True], ids=["at rest", "moving"])
@pytest.mark.parametrize("weights", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.7, 0.3), (0.0, 0.0, 1.0)])
def test_tangent_equals_finite_differences(element, rng, weights, moving):
    """Without a weight of p'' that of p and p' lacked the inertia forces, by 100 % for rates of shear-rigid nodes."""
    one = beam(element)
    loads = [
        bf.PointMoment(one.at(0.4), 3.0),
        bf.PointForce(one.end, (1.0, 2.0)),
        bf.Gravity((1.0, -9.81)),
        bf.DistributedLoad(one, (2.0, 1.0)),
    ]
    system = System(bf.Model([one], loads=loads), static=False)
    n = system.model.size
    p = system.reference + 0.1 * rng.standard_normal(n)
    v, a = rng.standard_normal(n), rng.standard_normal(n)
    ck, cv, ca = weights
    if not moving:  # statics knows no inertia
        v, a = np.zeros(n), np.zeros(n)
    tangent = dense(linearise(system, p, v, a, 0.0, weights, moving=moving)[1])
    h = 1e4 if ck == 0.0 else 1e-6  # the residual is linear in p''; elastic forces of 1e8 round at 1e-8
    numeric = np.empty((n, n))
    for j in range(n):
        d = np.zeros(n)
        d[j] = h
        ahead = linearise(system, p + ck * d, v + cv * d, a + ca * d, 0.0, (1.0, 1.0, 1.0))[0]
        behind = linearise(system, p - ck * d, v - cv * d, a - ca * d, 0.0, (1.0, 1.0, 1.0))[0]
        numeric[:, j] = (ahead - behind) / (2 * h)
    assert np.abs(tangent - numeric).max() <= 1e-8 * np.abs(numeric).max()


def test_predicted_stresses_of_no_step_are_the_true_ones(element, rng):
    system = System(bf.Model([beam(element)]), static=True)
    p = system.reference + 0.1 * rng.standard_normal(system.model.size)
    rest = np.zeros_like(p)
    stresses = predicted_stresses(system, p, rest, 0.0)
    plain = linearise(system, p, rest, rest, 0.0, (1.0, 0.0, 0.0))[1].rows
    mixed = linearise(system, p, rest, rest, 0.0, (1.0, 0.0, 0.0), stresses)[1].rows
    assert np.abs(plain - mixed).max() <= 1e-13 * np.abs(plain).max()


def moved(system, angle, shift):
    """Coordinates of the reference after a rigid motion."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    p = system.reference.copy()
    for mesh in system.model.meshes:
        columns = coordinate_columns(mesh)
        for place, (label, _, dofs) in enumerate(columns):
            if label == "theta":
                p[dofs] += angle
            elif label.endswith("^x"):
                pair = np.stack([dofs, columns[place + 1][2]])
                p[pair] = turn @ p[pair]
                if label == "r^x":
                    p[pair] += shift[:, None]
    return p


@pytest.mark.parametrize("angle", [0.3, 2.0, -3.1, 40.0])
@pytest.mark.parametrize("distance", [0.0, 1000.0])
def test_rigid_motion_gives_no_strain(element, angle, distance):
    system = System(bf.Model([beam(element)]), static=True)
    mesh = system.model.meshes[0]
    reach = distance * mesh.beam.curve.length
    p = moved(system, angle, np.array([reach, -reach]))
    where, xi = stations(mesh)
    now = axis(mesh, nodal_vectors(mesh, p[None]), where, xi)
    strains = mesh.beam.element.forces.strains(now)
    # a position of size |r| carries eps |r|, which the derivatives of the shape functions magnify by sum |N'| / l
    field, length = mesh.beam.element.field, mesh.lengths.min()
    slopes = np.abs(field.centreline(np.linspace(0, 1, 21), 1)).sum(axis=1).max() / length
    if mesh.beam.element.forces.turns_with == "r_x":
        slopes += np.abs(field.centreline(np.linspace(0, 1, 21), 2)).sum(axis=1).max() / length**2
    floor = 4 * np.finfo(float).eps * (mesh.beam.curve.length + reach) * slopes
    assert np.abs(strains).max() <= floor


def test_uniform_stretch_is_a_patch(element):
    system = System(bf.Model([beam(element, end=(1.0, 0.0))]), static=True)
    mesh = system.model.meshes[0]
    p = system.reference.copy()
    for label, _, dofs in coordinate_columns(mesh):
        if label in ("r^x", "r_x^x", "s"):
            p[dofs] *= 1.1
    rest = np.zeros_like(p)
    force, _ = linearise(system, p, rest, rest, 0.0, (1.0, 0.0, 0.0))
    inner = force[mesh.kinematics.dof[1:-1, :2]]
    assert np.abs(inner).max() <= 1e-12 * np.abs(force).max()


def test_band_solver_equals_scipy(rng):
    n, half = 40, 5
    rows = rng.standard_normal((n, 2 * half + 1))
    rows[:, half] += 12.0
    for i in range(n):
        for j in range(2 * half + 1):
            if not 0 <= i + j - half < n:
                rows[i, j] = 0.0
    right = rng.standard_normal(n)
    reach = np.minimum(np.arange(n) + half + 1, n).astype(np.int32)
    matrix = dense(BandTangent(rows, reach))
    expected = np.linalg.solve(matrix, right)
    assert np.abs(BandTangent(rows, reach).solve(right, NONE_TURNED) - expected).max() <= 1e-13
    assert np.abs(_solve_pivoted(rows, right) - expected).max() <= 1e-13


def test_band_solver_pivots_where_it_must():
    rows = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    right = np.array([2.0, 3.0])
    reach = np.array([2, 2], dtype=np.int32)
    assert BandTangent(rows, reach).solve(right, NONE_TURNED) == pytest.approx([3.0, 2.0], abs=1e-15)
    assert solve_banded((1, 1), np.array([[0, 1.0], [0, 0], [1.0, 0]]), right) == pytest.approx([3.0, 2.0], abs=1e-15)
