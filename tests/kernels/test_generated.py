"""What is written by `beamfem.physics.generate` is what the definitions give, and what they mean."""

import numpy as np
import pytest

from beamfem.assembly.routines import MEASURE_PASSES
from beamfem.element.fields import Axis
from beamfem.element.forces import ContinuumMechanics, ElasticLine, Structural
from beamfem.kernels import point
from beamfem.kernels.block import ELASTIC_LINE, GREEN_LAGRANGE, STRUCTURAL
from beamfem.kernels.record import ROW
from beamfem.physics import generate
from beamfem.physics.measures import MEASURES
from beamfem.precision.roundoff_bounds import depends


def test_the_committed_passes_are_those_of_the_definitions():
    written = {name: (generate.FOLDER / name).read_text() for name in generate.sources()}
    assert written == generate.sources()
    assert {path.name for path in generate.FOLDER.glob("*.py")} == {*written, "__init__.py"}


def test_the_passes_stand_in_the_order_of_the_measures():
    names = [passes.strains.__module__.rpartition(".")[2] for passes in MEASURE_PASSES]
    assert names == [f"{measure.__name__}_pass" for measure in MEASURES]


def test_round_off_reaches_strains_through_the_vectors_of_their_definition():
    """Vectors r0' and d of size one; r0'' or d' is small, so what is quadratic in it, or multiplies it, is left out."""
    green, section, line = (depends(code)[0] for code in (GREEN_LAGRANGE, STRUCTURAL, ELASTIC_LINE))
    r, d, third = 0, 1, 2
    assert green == ((r,), (third,), (), (d,), (r, d), (third,))
    assert section == ((r, d), (r, d), (third,), (d,))
    assert line == ((r,), (third,), (r, d), (d,))
    for code, strains in enumerate((green, section, line)):
        assert depends(code)[1] == tuple(tuple(i for i, of in enumerate(strains) if v in of) for v in (r, d, third))


@pytest.mark.parametrize(("number", "forces"), list(enumerate((ContinuumMechanics(), Structural(), ElasticLine()))))
def test_compiled_strains_are_those_of_post_processing(number, forces, rng):
    """The passes of a measure stand in the place that its number names, and read r', d and the third vector."""
    at = Axis(*rng.uniform(0.5, 1.0, (5, 4, 2)))
    rows = np.zeros((point.POINT_ROWS, ROW))
    rows[:6, :4] = np.concatenate([at.r_s.T, at.d.T, (at.r_ss if number == 2 else at.d_s).T])
    MEASURE_PASSES[forces.code].strains(4, rows)
    expected = forces.strains(at)
    np.testing.assert_allclose(rows[point.STRAIN : point.STRAIN + expected.shape[1], :4].T, expected, rtol=1e-12)
