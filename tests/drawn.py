"""Small solutions that the tests of pictures, pages and files draw."""

import numpy as np

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.01, 0.01)
EI = STEEL.youngs_modulus * SECTION.second_moment


def cantilever(load=2.0, elements=4, element=None, moment=0.0):
    """A cantilever of length 1 under a tip force load * E I and a tip moment * E I."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element or bf.CRBF(3), SECTION, STEEL)
    loads = [bf.PointForce(beam.end, (0, load * EI))] if load else []
    loads += [bf.PointMoment(beam.end, moment * EI)] if moment else []
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))


def pendulum(element=None, duration=0.3, step=0.005):
    """A bar that falls from the horizontal about its pinned start."""
    beam = bf.Beam(
        bf.Line((0, 0), (1, 0)), 3, element or bf.CRBF(2), bf.Rectangle(0.02, 0.02), bf.Material(1e8, 0.3, 1e3)
    )
    return bf.simulate(bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))]), duration, step)


def frame():
    """Two beams on every kind of support, joined by a hinge, under every kind of load."""
    common = {"elements": 2, "element": bf.CRBF(2), "section": SECTION, "material": STEEL}
    left, right = bf.Beam(bf.Line((0, 0), (1, 0)), **common), bf.Beam(bf.Line((1, 0), (2, 0)), **common)
    column = bf.Beam(bf.Line((2, 0), (2, -1)), **common)
    supports = [
        bf.Clamp(left.start),
        bf.Roller(right.at(0.5)),
        bf.Spring(left.at(0.5), (0.0, EI), 0.1 * EI),
        bf.Pin(column.end),
        bf.Prescribed(right.end, ux=0.02),
        bf.Foundation(right, (0.0, EI)),
    ]
    loads = [
        bf.Gravity((0.0, -9.81)),
        bf.DistributedLoad(left, (0.0, -0.2 * EI)),
        bf.DistributedLoad(right, (0.0, -0.2 * EI), follower=True),
        bf.PointForce(column.at(0.5), (0.3 * EI, 0.0)),
        bf.PointForce(left.at(0.75), (0.0, -0.1 * EI), follower=True),
        bf.PointMoment(left.end, -0.1 * EI),
    ]
    joints = [bf.Hinge(left.end, right.start), bf.Rigid(right.end, column.start)]
    return bf.solve_static(bf.Model([left, right, column], supports, loads, joints))


def arch():
    """A shallow two-bar frame that snaps through: a path with limit points, in few steps."""
    section, material = bf.Section(area=6.0, second_moment=2.0, height=2.0), bf.Material(7.2e6, 0.3, 1.0)
    common = {"element": bf.CRBF(3), "section": section, "material": material}
    column = bf.Beam(bf.Line((0, 0), (0, 120)), 3, **common)
    beam = bf.Beam(bf.Line((0, 120), (120, 120)), 5, **common)
    model = bf.Model(
        [column, beam],
        [bf.Pin(column.start), bf.Pin(beam.end)],
        [bf.PointForce(beam.at(0.2), (0.0, -1.0))],
        [bf.Rigid(column.end, beam.start)],
    )
    return bf.trace_equilibrium(model, until=lambda state: state.displacement(beam.at(0.2))[1] < -60.0)


def share_of_ink(picture):
    """Share of pixels (height, width, 3 or 4) that are not white."""
    return float(np.mean(np.any(np.asarray(picture)[..., :3] < 250, axis=-1)))
