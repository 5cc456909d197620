"""Parts of one's own at all nodes of a beam; those at quadrature points are in `tests/trials`."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf

STRIP, STEEL = bf.Rectangle(0.02, 0.001), bf.Material(2e11, 0.3, 7800.0)


def _pressed(q, data, gravity, f):
    """Return k max(R - |r - c|, 0)^2 / 2."""
    stiffness, radius, cx, cy = data
    x, y = q[0][0] - cx, q[0][1] - cy
    depth = f.positive(radius - f.sqrt(x * x + y * y))
    return stiffness * depth * depth / 2


def _torque(q, data, gravity, f):
    """Return the energy of a dipole m in a field B along y, - m B sin(t)."""
    return -data[0] * f.sin(q[0][2])


PRESSED = bf.Connection("pressed", 1, 2, ("stiffness", "radius", "cx", "cy"), potential=_pressed)
TORQUE = bf.Connection("magnetic_torque", 1, 3, ("strength",), potential=_torque)


@dataclass(frozen=True)
class AtNode(bf.PartAtPoints):
    points: tuple[bf.Point, ...]
    connection: bf.Connection
    numbers: tuple[float, ...]

    def data(self, reference):
        return self.numbers


@dataclass(frozen=True)
class Along(bf.PartAlongBeam):
    """A part at all nodes, whose first number is a density per length."""

    beam: bf.Beam
    connection: bf.Connection
    numbers: tuple[float, ...]

    @property
    def rotations(self):
        return self.connection.coordinates == 3

    def at_nodes(self, points, lengths):
        first, *others = self.numbers
        return tuple(
            AtNode((p,), self.connection, (first * w, *others)) for p, w in zip(points, lengths.tolist(), strict=True)
        )


def test_a_strip_is_laid_over_a_disc():
    """Its weight is carried by the clamp and the disc, and it goes into the disc by what the penalty lets it."""
    strip = bf.Beam(bf.Line((0, 0), (1, 0)), 40, bf.CRBF(2), STRIP, STEEL)
    disc = Along(strip, PRESSED, (1e6, 0.1, 0.6, -0.12))
    model = bf.Model([strip], [bf.Clamp(strip.start)], [bf.Gravity((0.0, -9.81))], connectors=[disc])
    laid = bf.solve_static(model, at=np.linspace(0, 1, 11))
    pushes = laid.connector_force(disc)[-1]
    weight = 7800.0 * 2e-5 * 9.81
    assert laid.reaction(strip.start)[-1, 1] + pushes[:, 1].sum() == pytest.approx(weight, rel=1e-9)
    assert pushes[:, 1].sum() > 0.2 * weight
    nodes = [k / 80 for k in range(81)]
    gaps = [np.hypot(*(laid.position(strip.at(at))[-1] - (0.6, -0.12))) - 0.1 for at in nodes]
    assert -1e-3 < min(gaps) < 0.0
    touching = np.abs(pushes[:, :2]).max(axis=1) > 0.0
    assert (np.array(gaps)[touching] < 0.0).all()
    alone = bf.solve_static(model.with_(connectors=[]))
    assert alone.position(strip.at(0.6))[-1, 1] < laid.position(strip.at(0.6))[-1, 1] - 1e-3


def test_a_magnetic_strip_bends_as_its_closed_form_says():
    """A uniform torque m B per length, for small turns: EI t'' + m B = 0, so the tip turns by m B L^2 / (2 EI)."""
    strip = bf.Beam(bf.Line((0, 0), (0.2, 0)), 8, bf.CRBF(3), STRIP, STEEL)
    bending = 2e11 * 0.02 * 1e-9 / 12
    magnet = Along(strip, TORQUE, (0.01,))
    solution = bf.solve_static(bf.Model([strip], [bf.Clamp(strip.start)], connectors=[magnet]))
    assert solution.rotation(strip.end)[-1] == pytest.approx(0.01 * 0.2**2 / (2 * bending), rel=1e-5)


def test_a_part_at_the_angles_of_all_nodes_asks_for_elements_that_have_them():
    strip = bf.Beam(bf.Line((0, 0), (0.2, 0)), 4, bf.ANCF(bf.Structural()), STRIP, STEEL)
    model = bf.Model([strip], [bf.Clamp(strip.start)], connectors=[Along(strip, TORQUE, (0.1,))])
    with pytest.raises(bf.InputError, match="Along acts on rotations along a beam, and the nodes of ANCF have none"):
        bf.solve_static(model)


@dataclass(frozen=True)
class BetweenNodes(Along):
    def at_nodes(self, points, lengths):
        return ()

    def at_stations(self, stations):
        return ()


def test_stations_need_elements_of_an_order_and_a_part_each():
    for element, said in ((bf.ANCFCRBF(), "stations along a beam, which the cubic field"), (bf.CRBF(2), "got 0")):
        strip = bf.Beam(bf.Line((0, 0), (0.2, 0)), 4, element, STRIP, STEEL)
        part = BetweenNodes(strip, TORQUE, (0.1,))
        with pytest.raises(bf.InputError, match=said):
            bf.solve_static(bf.Model([strip], [bf.Clamp(strip.start)], connectors=[part]))
