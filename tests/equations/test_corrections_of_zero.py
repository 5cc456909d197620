"""Corrections of Newton's method that are zero."""

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.solve.newton.newton import Correction, _settled


def test_a_correction_after_one_of_zero_is_judged_by_its_own_size():
    """A fine mesh at rest began with a correction of zero, by which the next one was divided."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(2e11, 0.3, 7800.0))
    system = system_of(bf.Model([beam], [bf.Clamp(beam.start)]), static=True)
    assert _settled(system, system.reference, Correction(2, 1e-20, 0.0, 0))
    assert not _settled(system, system.reference, Correction(2, 1e-3, 0.0, 0))
