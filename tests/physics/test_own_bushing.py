"""A bushing written by hand gives the same as that of the package."""

import numpy as np
import pytest
from own_bushing import Mount

import beamfem as bf
from beamfem.testing import check_connector


def test_a_bushing_by_hand_gives_the_same_motion():
    square, steel = bf.Rectangle(0.02, 0.02), bf.Material(2.1e11, 0.3, 7850.0)
    one, two = (bf.Beam(bf.Line((x, 0), (x + 0.5, 0.1)), 2, bf.CRBF(3), square, steel) for x in (0.0, 0.55))
    tips = []
    for kind in (bf.Bushing, Mount):
        part = kind(one.end, two.start, (3e3, 2e3, 40.0), (5.0, 3.0, 0.2))
        check_connector(part)
        model = bf.Model([one, two], [bf.Clamp(one.start)], [bf.Gravity((0, -9.81))], connectors=[part])
        tips.append(bf.simulate(model, 0.1, 1e-3).position(two.end))
    assert np.abs(tips[0] - tips[0][0]).max() > 1e-2
    assert tips[1] == pytest.approx(tips[0], rel=0, abs=1e-10)
