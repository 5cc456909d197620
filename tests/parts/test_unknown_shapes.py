"""Shapes of a user's own class are refused by name where they would be drawn, never left out in silence."""

from dataclasses import dataclass

import pytest

import beamfem as bf
from tests.own_parts import Bracket, Guide, Weld

STEEL = bf.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000.0)


@dataclass(frozen=True)
class Ribbon:
    """A shape that no drawing knows."""

    at: bf.Point


class Shown:
    """A part that is drawn as a ribbon."""

    def shapes(self, *_):
        return (Ribbon(getattr(self, "point", None)),)


@dataclass(frozen=True)
class ShownBracket(Shown, Bracket):
    pass


@dataclass(frozen=True)
class ShownGuide(Shown, Guide):
    pass


@dataclass(frozen=True)
class ShownWeld(Shown, Weld):
    pass


def solved(load=Bracket, support=Guide, joint=Weld):
    one, two = (
        bf.Beam(bf.Line((at, 0.0), (at + 1.0, 0.0)), 2, bf.CRBF(order=2), bf.Rectangle(0.05, 0.1), STEEL)
        for at in (0.0, 1.0)
    )
    supports = [bf.Clamp(one.start), support(two.end, 50.0)]
    return bf.solve_static(bf.Model([one, two], supports, [load(one.end, 1.0, 0.1)], [joint(one.end, two.start)]))


OUTPUTS = {
    "model": lambda solution, folder: solution.model.plot(folder / "a.svg"),
    "states": lambda solution, folder: solution.plot(folder / "a.svg"),
    "page": lambda solution, folder: solution.to_html(folder / "a.html"),
}
PARTS = {
    "load": (ShownBracket, "shapes of ShownBracket must return shapes .Force, Moment, ForcesAlong, .*got Ribbon"),
    "support": (ShownGuide, "shapes of ShownGuide must return shapes .Constraint, Springs, SpringsAlong.*got Ribbon"),
    "joint": (ShownWeld, "shapes of ShownWeld must return shapes .Ring.*got Ribbon"),
}


@pytest.mark.parametrize("output", OUTPUTS)
def test_known_shapes_are_drawn(output, tmp_path):
    OUTPUTS[output](solved(), tmp_path)


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("output", OUTPUTS)
def test_unknown_shapes_are_refused(output, part, tmp_path):
    kind, message = PARTS[part]
    solution = solved(**{part: kind})
    with pytest.raises(bf.InputError, match=message):
        OUTPUTS[output](solution, tmp_path)


@dataclass(frozen=True)
class Torque(Bracket):
    """A load that tells of a quantity which no file has."""

    def acting(self, arc_length):
        return {"torque": arc_length[:, None]}


def test_unknown_quantities_are_refused(tmp_path):
    with pytest.raises(bf.InputError, match="acting of Torque has the unknown quantity 'torque'"):
        solved(load=Torque).to_vtk(tmp_path / "a.pvd")
