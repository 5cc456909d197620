"""What is written by `beamfem.physics.generate` is what the definitions give, and what they mean."""

import numpy as np
import pytest

from beamfem.assembly.routines import MEASURE_PASSES
from beamfem.element.axis import Axis
from beamfem.element.forces import ContinuumMechanics, ElasticLine, Structural
from beamfem.kernels import point
from beamfem.kernels.record import ROW
from beamfem.physics import generate


def test_the_committed_passes_are_those_of_the_definitions():
    written = {name: (generate.FOLDER / name).read_text() for name in generate.sources()}
    assert written == generate.sources()
    assert {path.name for path in generate.FOLDER.glob("*.py")} == {*written, "__init__.py"}


@pytest.mark.parametrize(("number", "forces"), list(enumerate((ContinuumMechanics(), Structural(), ElasticLine()))))
def test_compiled_strains_are_those_of_post_processing(number, forces, rng):
    """The passes of a measure stand in the place that its number names, and read r', d and the third vector."""
    at = Axis(*rng.uniform(0.5, 1.0, (5, 4, 2)))
    rows = np.zeros((point.POINT_ROWS, ROW))
    rows[:6, :4] = np.concatenate([at.r_s.T, at.d.T, (at.r_ss if number == 2 else at.d_s).T])
    MEASURE_PASSES[forces.code].strains(4, rows)
    expected = forces.strains(at)
    np.testing.assert_allclose(rows[point.STRAIN : point.STRAIN + expected.shape[1], :4].T, expected, rtol=1e-12)
