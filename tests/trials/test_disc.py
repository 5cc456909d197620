"""Contact of a beam with a disc along its length, by penalty, at the quadrature points of quadratic elements."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf


def pressed(q, data, gravity, f):
    """Return k max(R - |r - c|, 0)^2 / 2 at r = sum N_i r_i."""
    stiffness, radius, cx, cy, *shape = data
    x, y = (sum(n * r[i] for n, r in zip(shape, q, strict=True)) - c for i, c in enumerate((cx, cy)))
    return stiffness * f.positive(radius - f.sqrt(x * x + y * y)) ** 2 / 2


NAMES = ("stiffness", "radius", "cx", "cy", "n0", "n1", "n2")
PRESSED = bf.Connection("pressed", 3, 2, NAMES, potential=pressed)


@dataclass(frozen=True)
class Pressed(bf.PartAtPoints):
    points: tuple[bf.Point, ...]
    numbers: tuple[float, ...]
    connection = PRESSED

    def data(self, reference):
        return self.numbers


@dataclass(frozen=True)
class Disc(bf.PartAlongBeam):
    beam: bf.Beam
    center: tuple[float, float]
    radius: float
    stiffness: float  # [N/m^2]

    def at_stations(self, stations):
        own = self.radius, *self.center
        return tuple(Pressed(at.points, (self.stiffness * at.length, *own, *at.shape.tolist())) for at in stations)


def test_a_strip_is_laid_over_a_disc():
    """Its weight is carried by the clamp and the disc, and it goes into the disc by what the penalty lets it."""
    steel = bf.Material(2e11, 0.3, 7800.0)
    strip = bf.Beam(bf.Line((0, 0), (1, 0)), 40, bf.CRBF(2), bf.Rectangle(0.02, 0.001), steel)
    disc = Disc(strip, (0.6, -0.12), 0.1, 1e6)
    model = bf.Model([strip], [bf.Clamp(strip.start)], [bf.Gravity((0.0, -9.81))], connectors=[disc])
    laid = bf.solve_static(model, at=np.linspace(0, 1, 11))
    carried = 7800.0 * 2e-5 * 9.81 - laid.reaction(strip.start)[-1, 1]
    assert carried > 0.2 * 7800.0 * 2e-5 * 9.81
    assert laid.connector_force(disc)[-1, :, 1].sum() == pytest.approx(carried, rel=1e-9)
    gaps = [np.hypot(*(laid.position(strip.at(k / 400))[-1] - disc.center)) - 0.1 for k in range(401)]
    assert -1e-3 < min(gaps) < 0.0
