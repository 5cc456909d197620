"""A magnetic torque along a beam: dipoles that turn with the sections, at the quadrature points of any order."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf


def dipole(nodes):
    """Return the energy of a dipole m across the section in a field B along x, m B sum N_i sin(t_i)."""

    def energy(q, data, gravity, f):
        return data[0] * sum(shape * f.sin(t) for shape, (_, _, t) in zip(data[1:], q, strict=True))

    names = ("strength", *(f"shape{i}" for i in range(nodes)))
    return bf.Connection(f"dipole_{nodes}", nodes, 3, names, potential=energy)


DIPOLES = {nodes: dipole(nodes) for nodes in (2, 3, 4)}


@dataclass(frozen=True)
class Dipole(bf.PartAtPoints):
    points: tuple[bf.Point, ...]
    strength: float
    shape: tuple[float, ...]

    @property
    def connection(self):
        return DIPOLES[len(self.points)]

    def data(self, reference):
        return self.strength, *self.shape


@dataclass(frozen=True)
class Magnet(bf.PartAlongBeam):
    beam: bf.Beam
    strength: float  # m B per length [N]
    rotations = True

    def at_stations(self, stations):
        return tuple(Dipole(at.points, self.strength * at.length, tuple(at.shape)) for at in stations)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_magnetic_strip_bends_as_its_closed_form_says(order):
    """A uniform torque m B per length, for small turns: EI t'' = m B, so the tip turns by - m B L^2 / (2 EI)."""
    steel = bf.Material(2e11, 0.3, 7800.0)
    strip = bf.Beam(bf.Line((0, 0), (0.2, 0)), 24 // order, bf.CRBF(order), bf.Rectangle(0.02, 0.001), steel)
    bending = 2e11 * 0.02 * 1e-9 / 12
    solution = bf.solve_static(bf.Model([strip], [bf.Clamp(strip.start)], connectors=[Magnet(strip, 0.01)]))
    assert solution.rotation(strip.end)[-1] == pytest.approx(-0.01 * 0.2**2 / (2 * bending), rel=2e-4)
    assert np.abs(solution.reaction(strip.start)[-1, :2]).max() < 1e-9
