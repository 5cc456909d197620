"""Bad supports, loads, joints and models get an error that names them where they are given."""

import numpy as np
import pytest
from bad_inputs import BEAM, CANTILEVER, END, INF, NAN, a_beam, require_named

import beamfem as bf

BAD = bf.InputError
OTHER = a_beam()

SUPPORTS = {
    "clamp of a beam": (lambda: bf.Clamp(BEAM), BAD, "point of Clamp must be a Point, such as beam.end"),
    "clamp of coordinates": (lambda: bf.Clamp((0, 0)), BAD, "point of Clamp"),
    "pin of nothing": (lambda: bf.Pin(None), BAD, "point of Pin"),
    "roller without normal": (lambda: bf.Roller(END, (0, 0)), BAD, "normal of a Roller must not be zero"),
    "roller along text": (lambda: bf.Roller(END, "01"), BAD, "normal of Roller"),
    "roller along 1e300": (lambda: bf.Roller(END, (0, 1e300)), BAD, "normal of Roller is 1e.300"),
    "nothing prescribed": (lambda: bf.Prescribed(END), BAD, "at least one"),
    "prescribed nan": (lambda: bf.Prescribed(END, ux=NAN), BAD, "ux of Prescribed must be finite"),
    "prescribed text": (lambda: bf.Prescribed(END, rotation="pi"), BAD, "rotation of Prescribed must be a number"),
    "prescribed of nothing": (lambda: bf.Prescribed(END, uy=lambda: 0.0), BAD, "uy of Prescribed .* of time alone"),
    "prescribed 1e300": (lambda: bf.Prescribed(END, ux=1e300), BAD, "ux of Prescribed is 1e.300"),
    "negative spring": (lambda: bf.Spring(END, (-1.0, 0.0)), BAD, "stiffness of a Spring must not be negative"),
    "negative turning spring": (lambda: bf.Spring(END, rotational=-1.0), BAD, "must not be negative"),
    "spring of nothing": (lambda: bf.Spring(END), BAD, "somewhere positive"),
    "spring of one number": (lambda: bf.Spring(END, 1.0), BAD, "stiffness of Spring must be two numbers"),
    "spring of infinity": (lambda: bf.Spring(END, (INF, 0.0)), BAD, "two finite numbers"),
    "spring of 1e300": (lambda: bf.Spring(END, rotational=1e300), BAD, "rotational of Spring is 1e.300"),
    "foundation of a point": (lambda: bf.Foundation(END, (1, 1)), BAD, "beam of Foundation must be a Beam"),
    "foundation of nothing": (lambda: bf.Foundation(BEAM, (0, 0)), BAD, "somewhere positive"),
    "negative foundation": (lambda: bf.Foundation(BEAM, (0, -1)), BAD, "must not be negative"),
}

LOADS = {
    "force of nan": (lambda: bf.PointForce(END, (0, NAN)), BAD, "vector of PointForce"),
    "force as text": (lambda: bf.PointForce(END, (0, "1")), BAD, "vector of PointForce"),
    "force of three": (lambda: bf.PointForce(END, (0, 1, 2)), BAD, "two finite numbers"),
    "force of 1e300": (lambda: bf.PointForce(END, (0, 1e300)), BAD, "cannot square"),
    "force of 1e-300": (lambda: bf.PointForce(END, (0, 1e-300)), BAD, "take zero, or units"),
    "force on a beam": (lambda: bf.PointForce(BEAM, (0, 1)), BAD, "point of PointForce"),
    "amplitude as a number": (lambda: bf.PointForce(END, (0, 1), amplitude=2.0), BAD, "amplitude of PointForce"),
    "amplitude of nothing": (lambda: bf.PointForce(END, (0, 1), amplitude=lambda: 1.0), BAD, "of time alone"),
    "follower by words": (lambda: bf.PointForce(END, (0, 1), follower="no"), BAD, "follower of PointForce"),
    "scale by words": (lambda: bf.PointForce(END, (0, 1), scale="no"), BAD, "scale of PointForce must be True or"),
    "scale as a number": (lambda: bf.Gravity((0, -9.81), scale=1), BAD, "scale of Gravity must be True or False"),
    "moment of words": (lambda: bf.PointMoment(END, "much"), BAD, "moment of PointMoment must be a number"),
    "moment as text": (lambda: bf.PointMoment(END, "3"), BAD, "moment of PointMoment must be a number"),
    "moment of two": (lambda: bf.PointMoment(END, (0, 1)), BAD, "moment of PointMoment must be a number"),
    "moment as True": (lambda: bf.PointMoment(END, True), BAD, "moment of PointMoment must be a number"),
    "gravity without direction": (lambda: bf.Gravity(9.81), BAD, "vector of Gravity must be two numbers"),
    "gravity of two arguments": (lambda: bf.Gravity((0, 1), amplitude=lambda t, x: t), BAD, "missing .* 'x'"),
    "a line load on a point": (lambda: bf.DistributedLoad(END, (0, 1)), BAD, "must be a Beam"),
    "a line load of one number": (lambda: bf.DistributedLoad(BEAM, 1.0), BAD, "vector of DistributedLoad"),
    "a line load of text": (
        lambda: bf.DistributedLoad(BEAM, lambda s: "ab"),
        BAD,
        "vector of DistributedLoad at arc length 0",
    ),
    "a line load that raises": (lambda: bf.DistributedLoad(BEAM, lambda s: 1 / 0), BAD, "ZeroDivisionError"),
    "pressure of a vector": (lambda: bf.Pressure(BEAM, (0, 1)), BAD, "value of Pressure must be a number"),
    "pressure of nan along": (
        lambda: bf.Pressure(BEAM, lambda s: NAN),
        BAD,
        "value of Pressure at arc length 0 must be finite",
    ),
    "pressure on a class": (lambda: bf.Pressure(bf.Beam, 1.0), BAD, "beam of Pressure must be a Beam"),
    "a table of one point": (lambda: bf.Interpolated([(0, 0)]), BAD, "at least two pairs"),
    "a table of equal times": (lambda: bf.Interpolated([(0, 0), (0, 1)]), BAD, "increasing times"),
    "a table of text": (lambda: bf.Interpolated("ab"), BAD, "points must be a list"),
    "a table of one row": (lambda: bf.Interpolated([0, 1]), BAD, r"points\[0\] must be two numbers"),
    "kinks of a number": (lambda: bf.Piecewise(lambda t: t, 1.0), BAD, "kinks must be a list"),
    "kinks of text": (lambda: bf.Piecewise(lambda t: t, "12"), BAD, "kinks must be a list"),
    "kinks that fall": (lambda: bf.Piecewise(lambda t: t, [1.0, 0.5]), BAD, "increasing"),
    "kinks of a set": (lambda: bf.Piecewise(lambda t: t, {0.5}), BAD, "kinks must be a list"),
    "pieces of no function": (lambda: bf.Piecewise(1.0, [0.5]), BAD, "must be a function"),
}

MODELS = {
    "rigid joint of beams": (lambda: bf.Rigid(BEAM, OTHER), BAD, "a of Rigid must be a Point"),
    "hinge of one point": (lambda: bf.Hinge(END, None), BAD, "b of Hinge must be a Point"),
    "joint with itself": (lambda: bf.Model([BEAM], joints=[bf.Rigid(END, BEAM.at(1.0))]), BAD, "with itself"),
    "joint of distant points": (lambda: bf.Model([BEAM], joints=[bf.Hinge(END, BEAM.start)]), BAD, "1 m apart"),
    "joint of a foreign beam": (lambda: bf.Model([BEAM], joints=[bf.Rigid(END, OTHER.end)]), BAD, "not in this model"),
    "model without beams": (lambda: bf.Model([]), BAD, "at least one beam"),
    "model of None": (lambda: bf.Model(None), BAD, "beams of Model must be a list"),
    "model of a set": (lambda: bf.Model({BEAM}), BAD, "beams of Model must be a list"),
    "model of text": (lambda: bf.Model([BEAM], ""), BAD, "supports of Model must be a list"),
    "model of one load": (lambda: bf.Model([BEAM], loads=bf.Gravity((0, -9.81))), BAD, "loads of Model must be a"),
    "a beam for a list": (lambda: bf.Model(BEAM), BAD, "beams of Model must be a list"),
    "the same beam twice": (lambda: bf.Model([BEAM, BEAM]), BAD, "twice"),
    "a beam as a class": (lambda: bf.Model([bf.Beam]), BAD, "cannot hold .*Beam.*, but Beam"),
    "a load as a support": (lambda: bf.Model([BEAM], [bf.Gravity((0, -9.81))]), BAD, "; it belongs in loads"),
    "a support as a load": (lambda: bf.Model([BEAM], loads=[bf.Clamp(END)]), BAD, "loads of a Model cannot hold"),
    "a support as a joint": (lambda: bf.Model([BEAM], joints=[bf.Clamp(END)]), BAD, "; it belongs in supports"),
    "a number as a joint": (
        lambda: bf.Model([BEAM], joints=[1]),
        BAD,
        "cannot hold 1, but Hinge, Rigid or another",
    ),
    "a foreign support": (lambda: bf.Model([BEAM], [bf.Clamp(OTHER.end)]), bf.UnknownPointError, "add it to beams"),
    "a foreign load": (lambda: bf.Model([BEAM], loads=[bf.Pressure(OTHER, 1.0)]), bf.UnknownPointError, "not in this"),
    "two supports of one coordinate": (
        lambda: bf.solve_static(bf.Model([BEAM], [bf.Clamp(END), bf.Pin(END)])),
        BAD,
        "already prescribes",
    ),
    "a beam in its own curvature": (
        lambda: bf.Model([a_beam(curve=bf.Arc((0, 0), 0.004, 0.0, 1.0))]).meshes,
        BAD,
        "overlap itself",
    ),
    "more elements than memory": (lambda: bf.Model([a_beam(elements=10**15)]).meshes, BAD, "this computer has"),
}

MESHES = {
    "nodes of text": (lambda: bf.LineMesh("ab", np.zeros((0, 3), int), {}, {}), BAD, "nodes of LineMesh must be"),
    "nodes in space": (lambda: bf.LineMesh(np.zeros((2, 3)), [[0, 1, -1]], {}, {}), BAD, r"array \(n, 2\)"),
    "nodes of nan": (lambda: bf.LineMesh([[0, 0], [NAN, 0]], [[0, 1, -1]], {}, {}), BAD, "finite numbers"),
    "ragged nodes": (lambda: bf.LineMesh([[0, 0], [1]], [[0, 1, -1]], {}, {}), BAD, "nodes of LineMesh"),
    "cells of two": (lambda: bf.LineMesh([[0, 0], [1, 0]], [[0, 1]], {}, {}), BAD, "cells of LineMesh must be"),
    "cells of no node": (lambda: bf.LineMesh([[0, 0], [1, 0]], [[0, 2, -1]], {}, {}), BAD, "between 0 and 1, got 2"),
    "cells of node -1": (lambda: bf.LineMesh([[0, 0], [1, 0]], [[-1, 0, -1]], {}, {}), BAD, "0 and 1, got -1"),
    "set of a number": (
        lambda: bf.LineMesh([[0, 0], [1, 0]], [[0, 1, -1]], {3: [0]}, {}),
        BAD,
        "a text, got 3",
    ),
    "set of rows": (lambda: bf.LineMesh([[0, 0], [1, 0]], [[0, 1, -1]], {"a": [[0]]}, {}), BAD, "a list of whole"),
    "cells of halves": (lambda: bf.LineMesh([[0, 0], [1, 0]], [[0, 0.5, -1]], {}, {}), BAD, "whole numbers"),
    "sets as a list": (lambda: bf.LineMesh([[0, 0], [1, 0]], [[0, 1, -1]], [], {}), BAD, "member_sets .* mapping"),
    "set of no cell": (lambda: bf.LineMesh([[0, 0], [1, 0]], [[0, 1, -1]], {"a": [3]}, {}), BAD, "between 0 and 0"),
    "unknown members": (lambda: mesh().frame(1, *PARTS, members="chain"), BAD, 'did you mean "chains"'),
    "members as an array": (lambda: mesh().frame(1, *PARTS, members=np.ones(2)), BAD, "members must be"),
    "unknown hinges": (lambda: mesh().frame(1, *PARTS, hinges="tp"), BAD, "did you mean top"),
    "hinges as a number": (lambda: mesh().frame(1, *PARTS, hinges=3), BAD, "hinges must be a list"),
    "hinges of lists": (lambda: mesh().frame(1, *PARTS, hinges=[[1]]), BAD, "no point set"),
    "no elements a cell": (lambda: mesh().frame(0, *PARTS), BAD, "elements must be at least 1"),
    "section of an unknown set": (lambda: mesh().frame(1, PARTS[0], {"al": PARTS[1]}), BAD, "did you mean all"),
    "section of no set": (lambda: mesh().frame(1, PARTS[0], {}), BAD, "in none of"),
    "a frame's unknown point": (lambda: mesh().frame(1, *PARTS).points("tob"), BAD, "did you mean top"),
    "a frame's unknown member": (lambda: mesh().frame(1, *PARTS).members(["all"]), BAD, "no member set"),
    "a frame's point elsewhere": (lambda: mesh().frame(1, *PARTS).at(3, 3), BAD, "nearest end"),
    "a frame's point at text": (lambda: mesh().frame(1, *PARTS).at("3", 3), BAD, "point must be two numbers"),
}

PARTS = (bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
TABLE = SUPPORTS | LOADS | MODELS | MESHES


def mesh():
    return bf.LineMesh([[0, 0], [1, 0]], [[0, 1, -1]], {"all": [0]}, {"top": [1]})


@pytest.mark.parametrize("case", TABLE)
def test_bad_models_are_named(case):
    require_named(*TABLE[case])


def test_a_model_takes_any_list_of_its_parts():
    for beams in ([BEAM], (BEAM,), np.array([BEAM], dtype=object), iter([BEAM])):
        assert bf.Model(beams, CANTILEVER.supports).beams == (BEAM,)


def test_the_sets_of_a_mesh_may_be_lists():
    (point,) = mesh().frame(1, *PARTS).points("top")
    assert point.reference.tolist() == [1.0, 0.0]
