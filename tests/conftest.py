"""The elements that every test of all combinations runs over, and a small model of each."""

import numpy as np
import pytest

import beamfem as bf

PRESETS = (bf.ANCF, bf.ANCFCRBF, bf.BilinearANCF, bf.BilinearCRBF)
ELEMENTS = [make(forces=bf.ContinuumMechanics(flag)) for make in PRESETS for flag in (False, True)]
ELEMENTS += [make(forces=bf.Structural()) for make in PRESETS] + [bf.CRBF(1), bf.CRBF(3)]


@pytest.fixture(
    params=ELEMENTS,
    ids=lambda e: f"{e.name}-{e.forces.name}{'-plane-stress' if getattr(e.forces, 'plane_stress', False) else ''}",
)
def element(request):
    return request.param


@pytest.fixture
def rng():
    return np.random.default_rng(20160101)


def beam(element, elements=3, start=(0.0, 0.0), end=(1.0, 0.5)):
    section = bf.Section(area=1.6e-3, second_moment=8.533e-6)
    return bf.Beam(bf.Line(start, end), elements, element, section, bf.Material(0.7e6, 0.3, 5540.0))
