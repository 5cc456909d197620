"""A model of many beams of every kind: elements, sections, curves and loads, in mixed order."""

import numpy as np

import beamfem as bf

PLASTIC = bf.Material(2e9, 0.3, 1200.0, strength=5e6)
BELOW = bf.Material(7e9, 0.3, 2700.0, thermal_expansion=2e-5)
ABOVE = bf.Material(3e9, 0.3, 2700.0, thermal_expansion=1e-5)
SECTION = bf.Rectangle(0.05, 0.06)
LAYERS = bf.Layered([bf.Layer(BELOW, 0.02), bf.Layer(ABOVE, 0.03)], width=0.05)
STIFFNESS = bf.Section(area=3e-3, second_moment=9e-7)
ELEMENTS = (
    bf.ANCF(),
    bf.ANCFCRBF(),
    bf.ShearRigid(),
    bf.BilinearANCF(),
    bf.BilinearCRBF(),
    bf.CRBF(1),
    bf.CRBF(2),
    bf.CRBF(4),
    bf.Element(bf.Cubic(), bf.Gradients(), bf.ElasticLine()),
)


def taper(s):
    return bf.Rectangle(0.05, 0.06 - 0.01 * s)


def mixed_model() -> bf.Model:
    """Return two beams of each kind of section and curve, with each kind of element, clamped and loaded."""
    beams, supports, loads, joints = [], [], [], []
    for row, element in enumerate(ELEMENTS):
        own = _beams(element, 3.0 * row)
        for number, beam in enumerate(own):
            supports.append(bf.Clamp(beam.start))
            loads.append(bf.PointForce(beam.at(0.5) if number % 2 else beam.end, (1.0, -2.0)))
        joined = bf.Beam(bf.Line(own[0].curve.end, (2.0, 3.0 * row + 1.0)), 2, element, SECTION, PLASTIC)
        joints.append(bf.Rigid(own[0].end, joined.start))
        supports.append(bf.Foundation(own[1], (10.0, 100.0)))
        loads += [bf.DistributedLoad(own[2], (0.0, -3.0)), bf.DistributedLoad(own[3], lambda s: (0.0, -3.0 * s))]
        loads += [bf.Pressure(own[1], 2.0), bf.Pressure(own[7], 2.0)]
        if isinstance(element.forces, bf.Structural | bf.ElasticLine):
            loads.append(bf.Temperature(own[5], change=5.0))
        beams += [*own, joined]
    loads.append(bf.Gravity((0.0, -9.81)))
    order = np.random.default_rng(1).permutation(len(beams))
    return bf.Model([beams[number] for number in order], supports, loads, joints)


def _beams(element: bf.Element, y: float) -> list[bf.Beam]:
    rng, beams = np.random.default_rng(4), []
    for number in range(4):
        angle, length = rng.uniform(-1.0, 1.0), rng.uniform(0.6, 1.3)
        start = 3.0 * number, y
        end = start[0] + length * np.cos(angle), y + length * np.sin(angle)
        beams.append(bf.Beam(bf.Line(start, end), 2 + number % 2, element, SECTION, PLASTIC))
    for number in range(2):
        x = 12.0 + 3.0 * number
        corner = bf.Polyline([(x, y + 2.0), (x + 0.6, y + 2.0 + 0.1 * number), (x + 0.9, y + 2.6)])
        beams += [
            bf.Beam(bf.Line((x, y), (x + 1.0, y + 0.3 * number)), 3, element, taper, PLASTIC),
            bf.Beam(bf.Line((x + 6.0, y), (x + 7.0, y + 0.1 * number)), 3, element, LAYERS),
            bf.Beam(bf.Line((x + 12.0, y), (x + 13.0, y + 0.1 * number)), 2, element, STIFFNESS, PLASTIC),
            bf.Beam(bf.Arc((x + 18.0, y), 1.0, 0.0, 1.0 + 0.2 * number), 3, element, SECTION, PLASTIC),
            bf.Beam(corner, 3, element, SECTION, PLASTIC),
        ]
    return beams
