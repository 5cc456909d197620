"""A Kelvin-Voigt bushing: spring and damper in parallel in both axes and the angle, as energies."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf


def relative(x, y, angle, f):
    c, s = f.cos(angle), f.sin(angle)
    return c * x + s * y, c * y - s * x


def stored(q, data, gravity, f):
    kx, kt, _, x0, y0 = data
    u, v = relative(q[1][0] - q[0][0], q[1][1] - q[0][1], q[0][2], f)
    return (kx * ((u - x0) ** 2 + (v - y0) ** 2) + kt * (q[1][2] - q[0][2]) ** 2) / 2


def lost(q, v, data, f):
    """Return half the power of dampers with the same retardation time in all directions."""
    kx, kt, time, _, _ = data
    (xa, ya, _), (xb, yb, _) = q
    (va, wa, ra), (vb, wb, rb) = v
    x, y = vb - va + ra * (yb - ya), wb - wa - ra * (xb - xa)
    return time * (kx * (x * x + y * y) + kt * (rb - ra) ** 2) / 2


NAMES = ("translational", "rotational", "time", "x0", "y0")
BUSHING = bf.Connection("own_bushing", 2, 3, NAMES, potential=stored, dissipation=lost)


@dataclass(frozen=True)
class OwnBushing(bf.PartAtPoints):
    a: bf.Point
    b: bf.Point
    stiffness: tuple[float, float]
    time: float  # [s]
    connection = BUSHING

    @property
    def points(self):
        return self.a, self.b

    def data(self, reference):
        return (*self.stiffness, self.time, *(reference[1] - reference[0])[:2].tolist())


def test_a_stiff_bar_on_it_creeps_to_where_it_hangs():
    """k t v' + k v = F for a light bar: v = F / k (1 - exp(-time / t))."""
    shape, stiff = bf.Rectangle(0.02, 0.02), bf.Material(2e11, 0.3, 1.0)
    wall, bar = (bf.Beam(bf.Line((x, 0), (x + 0.1, 0)), 1, bf.CRBF(2), shape, stiff) for x in (0.0, 0.1))
    bushing = OwnBushing(wall.end, bar.start, (1e3, 1e3), 0.1)
    model = bf.Model([wall, bar], [bf.Clamp(wall.start)], [bf.PointForce(bar.start, (1.0, -2.0))], connectors=[bushing])
    moved = bf.simulate(model, 0.2, step=1e-3, start=None)
    np.testing.assert_allclose(moved.displacement(bar.start)[-1, 1], -2e-3 * (1 - np.exp(-2.0)), rtol=2e-3)
    assert moved.displacement(bar.start)[-1, 0] == pytest.approx(1e-3 * (1 - np.exp(-2.0)), rel=2e-3)
