"""What rounded coordinates leave of a balance, and the digits that are sure, against sums by hand."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.analysis.equations import STATICS, linearise
from beamfem.analysis.round_off import _digits
from beamfem.model.system import System, coordinate_columns

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
    tangent = linearise(system, p, rest, rest, 0.0, STATICS)[1].sparse(system.turned).toarray()
    assert len(tangent) == len(p)
    positions = [dofs for label, _, dofs in coordinate_columns(mesh) if label.startswith("r^")]
    worst = np.abs(tangent[:, np.concatenate(positions)]).sum(axis=1)
    foreseen = system.residual_errors[0]
    assert np.all(foreseen >= (1.0 - 1e-12) * worst)
    assert foreseen.max() < 10.0 * worst.max()


def test_digits_are_those_of_the_moment_where_what_is_left_turns_the_model():
    """Forces f up before the middle and down behind it: a couple of f (0.75 + 0.5 + 0.25) 2 under a load P at 2 m."""
    beam = bf.Beam(bf.Line((-1, 0), (1, 0)), 8, bf.CRBF(1), SECTION, SOFT)
    load, left = 40.0, 1e-3
    system = System(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, load))]), static=True)
    assert system.extent == pytest.approx(2.0)
    unbalanced = np.zeros(system.model.size)
    (mesh,) = system.model.meshes
    for node, force in ((1, left), (2, left), (3, left), (5, -left), (6, -left), (7, -left)):
        unbalanced[mesh.coordinates_of(node)["r^y"]] = force
    found = _digits(system, system.reference, unbalanced, 1.0)
    assert found == pytest.approx(np.log10(2.0 * load / (3.0 * left)), abs=1e-9)
