"""Corners of a beam: the sections on both sides turn alike, and the reference stays free of stress."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.equations import residual
from beamfem.equations.system import System
from beamfem.precision.roundoff import row_floors


@pytest.mark.parametrize(
    "points", [[(0, 0), (1, 0), (2, 0.3)], [(0, 0), (1, 0), (1, 1), (2, 1)]], ids=["slight", "two"]
)
def test_a_beam_with_corners_is_stress_free_in_its_reference(element, points):
    """Found by the study of curved beams: gradients took the section direction of the wrong side of a corner."""
    beam = bf.Beam(bf.Polyline(points), 6, element, bf.Rectangle(0.02, 0.02), bf.Material(2e11, 0.3, 7800.0))
    system = System(bf.Model([beam], [bf.Clamp(beam.start)]), static=True)
    rest = np.zeros(system.model.size)
    left = residual(system, system.reference, rest, rest, 0.0)
    assert np.abs(left).max() <= row_floors(system, system.reference).max()
