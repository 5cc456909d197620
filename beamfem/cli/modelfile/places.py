"""References to beams of a model file and to points of them."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from beamfem.cli.modelfile.table import Table
from beamfem.errors import InputError
from beamfem.io.frame import Frame
from beamfem.model.beam import Beam, Point
from beamfem.model.model import Model
from beamfem.validation import nearest

_POINT = re.compile(r"(?P<beam>.+?)\.(?:(?P<end>start|end)|at\(\s*(?P<fraction>[^()]+?)\s*\))")
_SET = re.compile(r"(?P<frame>[^.]+)\.(?P<set>.+)")


@dataclass(frozen=True)
class Moved:
    """Beams and points of an imperfect model that replace those of the perfect one, by identity."""

    beams: Mapping[int, Beam] = field(default_factory=dict)
    points: Mapping[tuple[int, float], Point] = field(default_factory=dict)

    def beam(self, beam: Beam) -> Beam:
        """Return the beam that replaces another."""
        return self.beams.get(id(beam), beam)

    def point(self, point: Point) -> Point:
        """Return the point that replaces another; if nothing acts there, the one at the same fraction."""
        moved = self.points.get((id(point.beam), point.fraction))
        return Point(self.beam(point.beam), point.fraction) if moved is None else moved


def moved(old: Model, new: Model) -> Moved:
    """Return the replacements of the beams of a model by those of another with the same parts."""
    beams = {id(before): after for before, after in zip(old.beams, new.beams, strict=True)}
    pairs = zip(_points(old), _points(new), strict=True)
    return Moved(beams, {(id(before.beam), before.fraction): after for before, after in pairs})


def _points(model: Model) -> list[Point]:
    """Return all points with supports, loads, joints or connectors."""
    points = [support.point for support in model.point_supports] + [load.point for load in model.point_loads]
    points += [point for joint in model.joints for point in (joint.a, joint.b)]
    return points + [point for connector in model.connectors for point in connector.points]


@dataclass(frozen=True)
class Places:
    """Reads references to beams of the file and to points; frames: those from mesh files, by name."""

    beams: Mapping[str, Beam]
    frames: Mapping[str, Frame] = field(default_factory=dict)
    moved: Moved = field(default_factory=Moved)

    def beam(self, table: Table, key: str) -> Beam:
        """Return the beam named at a key. Raises ModelFileError."""
        given = table.values[key]
        return given if isinstance(given, Beam) else self.moved.beam(self._beam(table, key, table.text(key)))

    def _beam(self, table: Table, key: str, name: str) -> Beam:
        if name not in self.beams:
            raise table.error(f"there is no beam {name!r}; {nearest(name, self.beams)}", key)
        return self.beams[name]

    def point(self, table: Table, key: str) -> Point:
        """Return the point at a key: NAME.start, NAME.end, NAME.at(fraction), or FRAME.at(x, y). Raises ModelFileError.

        x, y [m]: of a node of the mesh.
        """
        given = table.values[key]
        return given if isinstance(given, Point) else self.moved.point(self._point(table, key))

    def _point(self, table: Table, key: str) -> Point:
        text = table.text(key)
        match = _POINT.fullmatch(text.strip())
        if not match:
            prefix = text.partition(".")[0]
            name = prefix if prefix in self.beams else next(iter(self.beams), "NAME")
            such = f'"{name}.start", "{name}.end" or "{name}.at(0.5)"'
            raise table.error(f'must be a point such as {such}, got "{text}"', key)
        try:
            if match["beam"] in self.frames and match["fraction"]:
                return self.frames[match["beam"]].at(*_numbers(table, key, match["fraction"], 2))
            beam = self._beam(table, key, match["beam"])
            if match["end"]:
                return beam.start if match["end"] == "start" else beam.end
            return beam.at(*_numbers(table, key, match["fraction"], 1))
        except InputError as error:
            raise table.error(getattr(error, "message", str(error)), key) from None

    def points(self, table: Table, key: str) -> Sequence[Point]:
        """Return the points of a list, or of a point set, FRAME.SET. Raises ModelFileError."""
        if isinstance(table.values[key], list):
            return [self.point(item, place) for item, place in table.items(key)]
        frame, name = self._set(table, key, "NAME.start")
        try:
            return [self.moved.point(point) for point in frame.points(name)]
        except InputError as error:
            raise table.error(str(error), key) from None

    def members(self, table: Table, key: str) -> Sequence[Beam]:
        """Return the beams of a list, or of a member set, FRAME.SET. Raises ModelFileError."""
        if isinstance(table.values[key], list):
            return [self.beam(item, place) for item, place in table.items(key)]
        frame, name = self._set(table, key, "NAME")
        try:
            return [self.moved.beam(beam) for beam in frame.members(name)]
        except InputError as error:
            raise table.error(str(error), key) from None

    def _set(self, table: Table, key: str, one: str) -> tuple[Frame, str]:
        text = table.text(key)
        match = _SET.fullmatch(text)
        if not match or match["frame"] not in self.frames:
            near = f"; {nearest(match['frame'] if match else text, self.frames)}" if self.frames else ""
            right = f'must be a list such as ["{one}"], or a set of a frame, "FRAME.SET", got "{text}"'
            raise table.error(right + near, key)
        return self.frames[match["frame"]], match["set"]


def _numbers(table: Table, key: str, text: str, count: int) -> list[float]:
    """Return the numbers between brackets. Raises ModelFileError."""
    parts = text.split(",")
    try:
        if len(parts) != count:
            raise ValueError
        return [float(part) for part in parts]
    except ValueError:
        right = "the fraction along the beam must be a number" if count == 1 else "a node of a frame is at two numbers"
        raise table.error(f"{right}, got {text!r}", key) from None
