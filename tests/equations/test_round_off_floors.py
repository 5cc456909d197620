"""What rounded coordinates leave of a balance, and the reliable digits, against sums by hand."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.model_coordinates import coordinate_columns
from beamfem.equations.system import System
from beamfem.precision.roundoff import _digits, remainder

SECTION, SOFT = bf.Rectangle(0.1, 0.1), bf.Material(1e6, 0.3, 1.0)


@pytest.mark.parametrize("forces", [bf.ContinuumMechanics(), bf.ContinuumMechanics(True), bf.Structural()])
@pytest.mark.parametrize("kind", [bf.CRBF, bf.ANCF])
def test_no_row_feels_more_of_errors_of_positions_than_is_foreseen(kind, forces):
    """Errors of any sign of one metre leave at most the sum of the sizes in a row of the tangent."""
    element = kind(2, forces) if kind is bf.CRBF else kind(forces)
    beam = bf.Beam(bf.Line((0, 0), (2, 0)), 3, element, SECTION, SOFT)
    system = System(bf.Model([beam]), static=True)
    (mesh,), p = system.model.meshes, system.reference
    rest = np.zeros(len(p))
    tangent = linearise(system, p, rest, rest, 0.0, STATICS)[1].sparse(system.rotated).toarray()
    assert len(tangent) == len(p)
    positions = [dofs for label, _, dofs in coordinate_columns(mesh) if label.startswith("r^")]
    worst = np.abs(tangent[:, np.concatenate(positions)]).sum(axis=1)
    foreseen = system.residual_errors[0]
    assert np.all(foreseen >= (1.0 - 1e-12) * worst)
    assert foreseen.max() < 10.0 * worst.max()


@pytest.mark.parametrize(
    ("label", "shares", "worst"),
    [
        ("r^x", (1, 1, 1, 1, 1, 1, 1), 7.0 * 2.0),
        ("r^y", (1, 1, 1, 1, 1, 1, 1), 7.0 * 2.0),
        ("r^y", (1, 1, 1, 0, -1, -1, -1), 2.0 * (0.75 + 0.5 + 0.25)),
    ],
    ids=["along", "across", "turning"],
)
def test_digits_are_those_of_the_balance_of_the_whole(label, shares, worst):
    """A load P on a model of 2 m, forces f left at inner nodes: their sum times 2 m, or their moment, beside P 2 m."""
    beam = bf.Beam(bf.Line((-1, 0), (1, 0)), 8, bf.CRBF(1), SECTION, SOFT)
    load, left = 40.0, 1e-3
    system = System(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, load))]), static=True)
    assert system.extent == pytest.approx(2.0)
    (mesh,), unbalanced = system.model.meshes, np.zeros(system.model.size)
    for node, share in enumerate(shares, start=1):
        unbalanced[mesh.coordinates_of(node)[label]] = share * left
    found = _digits(system, system.reference, unbalanced, 1.0)
    assert found == pytest.approx(np.log10(2.0 * load / (worst * left)), abs=1e-9)


@pytest.mark.parametrize(("size", "mended"), [(1e-9, True), (0.9e-7, True), (1.1e-7, False), (1e-5, False)])
def test_only_the_last_digits_of_a_state_are_mended(size, mended):
    """A clamped beam whose end is off by a part of the model's size: beyond 1e-7 it is another state, not round-off."""
    beam = bf.Beam(bf.Line((0, 0), (2, 0)), 4, bf.CRBF(2), SECTION, SOFT)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])
    system, p = System(model, static=True), bf.solve_static(model).p[-1]
    shift = np.zeros(len(p))
    shift[system.free_dofs] = size * system.scale[system.free_dofs]
    found = remainder(system, p + shift, 1.0)
    np.testing.assert_allclose(found.step, -shift if mended else 0.0, atol=0.02 * size * system.scale.max())
    assert (found.digits > 9.0) == mended
