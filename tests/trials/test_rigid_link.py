"""A rigid link: the distance of two points as a condition, in statics and motions."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf


def apart(q, data, f):
    x, y = q[1][0] - q[0][0], q[1][1] - q[0][1]
    return (f.sqrt(x * x + y * y) - data[0],)


LINK = bf.Connection("own_link", 2, 2, ("length",), conditions=apart, multipliers=1)


@dataclass(frozen=True)
class OwnLink(bf.PartAtPoints):
    a: bf.Point
    b: bf.Point
    connection = LINK

    @property
    def points(self):
        return self.a, self.b

    def data(self, reference):
        return (float(np.hypot(*(reference[1] - reference[0])[:2])),)


def pair(link):
    beams = [
        bf.Beam(bf.Line((0, y), (1, y)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.01), bf.Material(2e11, 0.3, 7800.0))
        for y in (0.0, 0.3)
    ]
    load = bf.PointForce(beams[0].end, (20.0, -200.0))
    supports = [bf.Clamp(beams[0].start), bf.Pin(beams[1].start)]
    return bf.Model(beams, supports, [load, bf.Gravity((0, -9.81))], connectors=[link(beams[0].end, beams[1].end)])


def test_it_is_the_link_of_the_package():
    own, other = pair(OwnLink), pair(bf.Link)
    for solve in (bf.solve_static, lambda model: bf.simulate(model, 0.05, step=1e-3)):
        found, wanted = solve(own), solve(other)
        places = [[s.position(beam.end)[-1] for beam in s.model.beams] for s in (found, wanted)]
        np.testing.assert_allclose(*places, atol=1e-8)
        tensions = [s.multipliers(s.model.connectors[0])[-1, 0] for s in (found, wanted)]
        np.testing.assert_allclose(*tensions, rtol=1e-5)
