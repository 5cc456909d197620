"""Compiled passes that are derived are what the definitions mean."""

import numpy as np
import pytest

from beamfem.element.fields import Axis
from beamfem.element.forces import ContinuumMechanics, ElasticLine, Structural
from beamfem.kernels import point
from beamfem.kernels.block import ELASTIC_LINE, GREEN_LAGRANGE, STRUCTURAL
from beamfem.kernels.model_record import ROW
from beamfem.parts.at_points import ANALYTIC
from beamfem.physics.compiled_connections import in_python, passes_of
from beamfem.physics.compiled_elements import MEASURE_PASSES
from beamfem.physics.connections import CABLE, Connection
from beamfem.physics.stations import DEAD, FOLLOWING, GROUNDED, STATIONS, STRETCHING
from beamfem.precision.roundoff_bounds import depends


def test_round_off_reaches_strains_through_the_vectors_of_their_definition():
    """Vectors r0' and d of size one; r0'' or d' is small, so what is quadratic in it, or multiplies it, is left out."""
    r, d, third = 0, 1, 2
    expected = {
        GREEN_LAGRANGE: ((r,), (third,), (), (d,), (r, d), (third,)),
        STRUCTURAL: ((r, d), (r, d), (third,), (d,)),
        ELASTIC_LINE: ((r,), (third,), (r, d), (d,)),
    }
    for code, strains in expected.items():
        assert depends(code).tolist() == [[float(vector in of) for of in strains] for vector in (r, d, third)]


@pytest.mark.parametrize(("number", "forces"), list(enumerate((ContinuumMechanics(), Structural(), ElasticLine()))))
def test_compiled_strains_are_those_of_post_processing(number, forces, rng):
    """The passes of a measure stand in the place that its number names, and read r', d and the third vector."""
    at = Axis(*rng.uniform(0.5, 1.0, (5, 4, 2)))
    rows = np.zeros((point.POINT_ROWS, ROW))
    rows[:6, :4] = np.concatenate([at.r_s.T, at.d.T, (at.r_ss if number == 2 else at.d_s).T])
    MEASURE_PASSES[forces.code]["strains"](4, rows)
    expected = forces.strains(at)
    np.testing.assert_allclose(rows[point.STRAIN : point.STRAIN + expected.shape[1], :4].T, expected, rtol=1e-12)


@pytest.mark.parametrize("kind", [DEAD, FOLLOWING, STRETCHING, GROUNDED])
def test_forces_at_a_station_are_those_of_a_rotated_vector_and_their_tangent_is_the_derivative(kind, rng):
    """The force turns with g, from its direction u in the reference; the moment turns g, whatever the length of g."""
    q, data = rng.uniform(0.5, 1.5, 4), rng.uniform(0.5, 1.5, 7)
    x, y, gx, gy = q
    data[3:5] /= 1.0 if kind == GROUNDED else np.hypot(*data[3:5])
    passes, out, rows, none = passes_of(STATIONS[kind]), np.empty(4), np.empty((4, 4)), np.zeros(4)

    def forces(at):
        in_python(STATIONS[kind])(at, none, none, none, none, data, none, result := np.empty(4, dtype=complex))
        return result

    passes.force(q, none, none, none, none, data, none, out)
    np.testing.assert_allclose(out, forces(q).real, rtol=1e-14)
    passes.tangent(q, none, none, none, none, data, none, 2.0, 0.0, 0.0, rows)
    columns = [2.0 * forces(q + 1e-30j * unit).imag / 1e-30 for unit in np.eye(4)]
    np.testing.assert_allclose(rows, np.transpose(columns), rtol=1e-13, atol=1e-14)
    force, g, u = complex(*data[:2]), complex(gx, gy), complex(*data[3:5])
    turned = {DEAD: 1.0, FOLLOWING: g / u / abs(g), STRETCHING: g / u, GROUNDED: 0.0}[kind] * force
    turned -= complex(data[3] * (x - data[5]), data[4] * (y - data[6])) if kind == GROUNDED else 0.0
    assert complex(*out[:2]) == pytest.approx(-turned, rel=1e-13)
    turning, length = gx * out[3] - gy * out[2], gx * out[2] + gy * out[3]
    assert turning == pytest.approx(0.0 if kind == GROUNDED else -data[2], rel=1e-13)
    assert length == pytest.approx(0.0, abs=1e-13)


def test_forces_and_tangents_are_derivatives_of_an_energy_of_all_operations(rng):
    """Forces by complex steps, tangents by differences; a slack cable may end where it begins."""

    def stored(q, data, gravity, f):
        (xa, ya, ta), (xb, yb, tb) = q
        bent = f.cos(2 * ta - tb + 0.3) * (xb - xa) ** 3 + f.sin(-3 * tb) / (2 + ya * ya) ** 1.5
        return data[0] * bent + (1 + f.positive(xa)) ** -2 * f.sqrt(3 + yb * yb) - np.float64(2.0) * xa / 7

    passes, q, none, step = (
        passes_of(Connection("all", 2, 3, ("k",), None, stored)),
        rng.normal(size=6),
        np.zeros(6),
        1e-30,
    )
    data, out, matrix, each = rng.uniform(0.5, 1.5, 1), np.empty(6), np.empty((6, 6)), np.eye(6)
    q[0] = abs(q[0])
    turned = np.column_stack([np.cos(q[2::3]), np.sin(q[2::3])])
    passes.force(q, none, none, none, turned, data, none, out)
    passes.tangent(q, none, none, none, turned, data, none, 2.0, 0.5, 0.5, matrix)
    moved = [list((q + 1j * step * unit).reshape(2, 3)) for unit in each]
    np.testing.assert_allclose(
        out, [stored(at, data, none, ANALYTIC).imag / step for at in moved], rtol=1e-13, atol=1e-14
    )
    after, before = np.empty(6), np.empty(6)
    for column, unit in enumerate(each):
        for to, at in ((after, q + 1e-6 * unit), (before, q - 1e-6 * unit)):
            turned = np.column_stack([np.cos(at[2::3]), np.sin(at[2::3])])
            passes.force(at, none, none, none, turned, data, none, to)
        np.testing.assert_allclose(matrix[:, column], (after - before) / 1e-6, rtol=1e-7, atol=1e-8)
    passes, rows = passes_of(CABLE), np.empty((4, 4))
    passes.tangent(np.zeros(4), none, none, none, none, np.ones(2), none, 1.0, 0.0, 0.0, rows)
    assert not rows.any()
