"""Meshes that are given, and graded ones."""

import numpy as np
import pytest

import beamfem as bf


@pytest.mark.parametrize("ratio", [0.1, 1.0, 8.0])
def test_lengths_grow_geometrically(ratio):
    lengths = np.diff(bf.graded(7, ratio))
    assert lengths[-1] / lengths[0] == pytest.approx(ratio, rel=1e-12)
    assert lengths[1:] / lengths[:-1] == pytest.approx(np.full(6, ratio ** (1 / 6)), rel=1e-12)
    assert lengths.sum() == pytest.approx(1.0, abs=1e-15)


def test_a_beam_takes_them():
    beam = bf.Beam(bf.Line((0, 0), (2, 0)), bf.graded(3, 4.0), bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(1, 0, 1))
    assert bf.Model([beam]).meshes[0].vertices == pytest.approx([0.0, 2 / 7, 6 / 7, 2.0], rel=1e-14)


@pytest.mark.parametrize(("elements", "ratio"), [(0, 1.0), (3, -1.0), (2.5, 1.0)])
def test_nonsense_is_refused(elements, ratio):
    with pytest.raises(bf.InputError):
        bf.graded(elements, ratio)
