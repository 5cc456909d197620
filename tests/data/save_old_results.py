"""Saves small solutions in an earlier version of beamfem, and the displacements of their tips as it prints them.

    git worktree add --detach /tmp/old_version f90d608
    cd /tmp/old_version && PYTHONPATH=. python .../tests/data/save_old_results.py before_rooms OUT

The files beside this script, compressed with gzip, are from two commits: `before_rooms` from f90d608, shortly before
the package was divided into rooms; `first` from 610b2c2, the first that could save. A cantilever and a motion of
9373791 loaded as well. These versions need numba; it was 0.68.1, with NumPy 2.4.6, SciPy 1.17.1 and h5py 3.16.0.
"""

import json
import sys
from pathlib import Path

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
RUBBER = bf.Material(0.7e6, 0.3, 5540.0)


def section():
    """Return a section by its moments."""
    return bf.Section(area=1.6e-3, second_moment=8.533e-6)


def cantilever():
    """A clamped cantilever under a tip force, two load steps."""
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.5)), 3, bf.ANCF(), section(), RUBBER)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -2.0))])
    return bf.solve_static(model, steps=2), beam.end


def motion():
    """A hinged beam that swings down, five steps, with a load that varies with time."""
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 2, bf.BilinearCRBF(), section(), RUBBER)
    push = bf.PointForce(beam.end, (0.0, -1.0), amplitude=lambda t: 1.0 - t)
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81)), push])
    return bf.simulate(model, 0.05, 0.01), beam.end


def frame():
    """A portal of three kinds of elements, rigid at one corner and hinged at the other, on a roller and a spring."""
    shape = bf.Rectangle(0.02, 0.03)
    left = bf.Beam(bf.Line((0.0, 0.0), (0.0, 1.0)), 1, bf.ANCFCRBF(), shape, STEEL)
    top = bf.Beam(bf.Line((0.0, 1.0), (1.0, 1.0)), 2, bf.CRBF(3), shape, STEEL)
    right = bf.Beam(bf.Line((1.0, 1.0), (1.0, 0.0)), 1, bf.ShearRigid(), shape, STEEL)
    supports = [bf.Clamp(left.start), bf.Pin(right.end), bf.Spring(top.at(0.5), (0.0, 1e4), 10.0)]
    joints = [bf.Rigid(left.end, top.start), bf.Hinge(top.end, right.start)]
    loads = [bf.PointForce(left.end, (500.0, 0.0), follower=True), bf.DistributedLoad(top, (0.0, -300.0))]
    return bf.solve_static(bf.Model([left, top, right], supports, loads, joints)), top.end


def corner():
    """A beam with a corner, under a moment and a pressure, the thickness of its section varying."""
    axis = bf.Polyline(((0.0, 0.0), (0.5, 0.0), (0.5, 0.5)))
    beam = bf.Beam(axis, 4, bf.CRBF(2), lambda s: bf.Rectangle(0.02, 0.03 - 0.01 * s), STEEL)
    loads = [bf.PointMoment(beam.end, 50.0), bf.Pressure(beam, 200.0)]
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads)), beam.end


def layered():
    """A strip of two metals along an arc, whose end is moved."""
    layers = (bf.Layer(STEEL, 0.004), bf.Layer(bf.Material(7.0e10, 0.33, 2700.0), 0.006))
    arc = bf.Arc((0.0, 0.0), 1.0, 0.0, 1.0)
    beam = bf.Beam(arc, 2, bf.ANCF(bf.Structural()), bf.Layered(layers, 0.02))
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, ux=0.01)], [])
    return bf.solve_static(model), beam.end


def path():
    """A shallow arch of two straight members over its limit point."""
    shape = bf.Rectangle(0.05, 0.01)
    members = [
        bf.Beam(bf.Line((0.0, 0.0), (0.5, 0.05)), 2, bf.BilinearANCF(), shape, STEEL),
        bf.Beam(bf.Line((0.5, 0.05), (1.0, 0.0)), 2, bf.BilinearANCF(), shape, STEEL),
    ]
    supports = [bf.Clamp(members[0].start), bf.Clamp(members[1].end)]
    crown = members[0].end
    model = bf.Model(members, supports, [bf.PointForce(crown, (0.0, -1e6))], [bf.Rigid(crown, members[1].start)])
    return bf.trace_equilibrium(model, points=6), crown


if __name__ == "__main__":
    prefix, folder = sys.argv[1], Path(sys.argv[2])
    made = (cantilever, motion, frame, corner, layered, path) if hasattr(bf, "Polyline") else (cantilever, motion)
    tips = {}
    for make in made:
        solution, tip = make()
        solution.save(folder / f"{prefix}_{make.__name__}.h5")
        tips[make.__name__] = solution.displacement(tip).tolist()
    (folder / f"{prefix}.json").write_text(json.dumps(tips, indent=1) + "\n")
