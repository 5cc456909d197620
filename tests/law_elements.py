"""The elements with structural forces: those that take a section law, and those that do not."""

import beamfem as bf

FIELDS = {"cubic": bf.Cubic(), "order1": bf.Lagrange(1), "order2": bf.Lagrange(2), "order3": bf.Lagrange(3)}
FULL, REDUCED, LOBATTO = "full", "reduced", "lobatto"
RULES = {"cubic": (FULL, REDUCED, LOBATTO), "order1": (FULL, REDUCED), "order2": (FULL, REDUCED), "order3": (REDUCED,)}
SHEAR_FREE = [
    bf.ShearRigid(stretchable=True, integration=FULL),
    bf.ShearRigid(stretchable=False, integration=FULL),
    bf.ShearRigid(stretchable=False, integration=REDUCED),
]
REFUSED = [
    bf.ShearRigid(stretchable=True, integration=LOBATTO),
    bf.ShearRigid(stretchable=True, integration=REDUCED),
    bf.ShearRigid(stretchable=False, integration=LOBATTO),
]
SHEARING = [
    bf.Element(FIELDS[name], coordinates, bf.Structural(), rule)
    for name, rules in RULES.items()
    for coordinates in (bf.Gradients(), bf.Rotation())
    for rule in rules
]
TAKEN = SHEARING + SHEAR_FREE
# one of each kind of rule that is not that of CRBF
NEW = [
    bf.ANCF(bf.Structural()),
    bf.ANCF(bf.Structural(), integration=REDUCED),
    bf.ANCFCRBF(bf.Structural()),
    bf.Element(bf.Lagrange(2), bf.Gradients(), bf.Structural(), REDUCED),
]
ids = {"ids": lambda element: f"{element.name}-{element.integration}"}


LINE = bf.Line((0, 0), (1, 0))


def arm(section, element, loads=lambda beam: [], elements=4, curve=LINE):
    """A beam that is clamped at its start."""
    beam = bf.Beam(curve, elements, element, section)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], loads(beam))


def at_tip(x, y, moment=0.0):
    return lambda beam: [bf.PointForce(beam.end, (x, y)), bf.PointMoment(beam.end, moment)]
