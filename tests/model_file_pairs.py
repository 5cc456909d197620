"""Models as a file and as Python: both must give the same numbers to the last digit."""

import numpy as np

import beamfem as bf
from beamfem.cli.modelfile import read_model_file

STEEL = bf.Material(2e11, 0.3, 7800.0)
FLAT = bf.Rectangle(0.01, 0.01)
ARM = """
[materials.steel]
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[beams.arm]
curve = { kind = "line", start = [0, 0], end = [1, 0] }
elements = 4
element = { kind = "CRBF", order = 3 }
section = { kind = "rectangle", width = 0.01, height = 0.01 }
material = "steel"
[[supports]]
kind = "clamp"
point = "arm.start"
"""
LIFT = """
[[loads]]
kind = "force"
point = "arm.end"
vector = [0, 100]
"""


def arm(elements=4, element=None, section=FLAT, material=STEEL, curve=None):
    """Return the beam of ARM, or one with other parts."""
    return bf.Beam(curve or bf.Line((0, 0), (1, 0)), elements, element or bf.CRBF(3), section, material)


def held(beam, loads=None, **others):
    """Return the model of ARM and LIFT."""
    lift = [bf.PointForce(beam.end, (0, 100))] if loads is None else loads
    return bf.Model([beam], [bf.Clamp(beam.start)], lift, **others)


def from_file(path, text):
    """Return what the analysis of a text finds."""
    path.write_text(text)
    return read_model_file(path).imperfect().solve()


def require_same(found, expected):
    """Fail where the states of two solutions differ in any digit."""
    for name in ("at", "p", "v", "a"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), strict=True)
