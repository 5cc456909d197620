"""Rolled and hollow sections by their standard names."""

import csv
import re
from dataclasses import replace
from importlib.resources import files

from beamfem.errors import InputError
from beamfem.section.polygon import Corner, of_loops
from beamfem.section.section_shapes import ShapedSection, Tube
from beamfem.validation import flag, positive, text

_SIZES = ("h", "b", "tw", "tf", "r1", "r2")  # of the table [mm]
_HOLLOW = re.compile(r"(SHS|RHS|CHS) ([\d.]+)(?:X([\d.]+))??X([\d.]+)( COLD)?")


def Profile(name: str, weak: bool = False, millimetre: float = 1e-3) -> ShapedSection:
    """Return a rolled or hollow section by its name, with its nominal dimensions, root fillets and rounded edges.

    There are "IPE 80" to "IPE 600", "HEA 100" and "HEB 100" to 1000, "UPN 80" to "UPN 400" and angles such as
    "L 100x100x10" or "L 100x50x8"; square, rectangular and circular hollow sections have any size, "SHS 100x5",
    "RHS 120x80x5" (sides and wall) and "CHS 114.3x5", hot-finished or, as in "SHS 100x5 cold", cold-formed.
    Its shear factor is that of `Polygon`. A channel or an angle bends in the plane as if held against lateral motion
    and twist. Raises InputError for a name that the standards do not have. Source: EN 10365 (IPE, HE, UPN),
    EN 10056-1 (L), EN 10210-2 (hot-finished), EN 10219-2 (cold-formed).

    Parameters
    ----------
    name : str
        Family and size.
    weak : bool, default False
        Whether to bend about the weak axis, with the web across the plane, that of a channel at the lower face.
        Otherwise the web is along y. For angles, the longer leg counts as the web, and the leg across the plane is at
        the lower face.
    millimetre : float, [m], default 1e-3
        A millimetre, the unit of the names, in the unit of length of the model.

    Examples
    --------
    >>> section = bf.Profile("IPE 200")
    >>> round(1e4 * section.area, 1), round(1e8 * section.second_moment)  # cm^2, cm^4
    (28.5, 1943)
    """
    weak, spelt = flag("weak of Profile", weak), text("name of Profile", name).upper().replace("×", "X")
    spelt = re.sub(r"^([A-Z]+) *(?=\d)", r"\1 ", " ".join(spelt.split()))
    unit = positive("millimetre of Profile", millimetre)
    if match := _HOLLOW.fullmatch(spelt):
        family, *sizes = match.groups()[:4]
        if family != "CHS" or sizes[1] is None:
            own = " ".join([family, *spelt.lower().split()[1:]])
            return _hollow(own, [float(size or sizes[0]) for size in sizes], match[5] is not None, weak, unit)
    with (files("beamfem.section") / "profiles.csv").open(encoding="utf-8") as file:
        table = {row["name"].upper(): row for row in csv.DictReader(file)}
    if spelt not in table:
        family = [row["name"] for row in table.values() if row["name"].split()[0] == spelt.partition(" ")[0]]
        others = "there are IPE, HEA, HEB, UPN, L, SHS, RHS and CHS"
        wanted = _numbers(spelt)
        apart = {own: sum(abs(a - b) for a, b in zip(_numbers(own), wanted, strict=False)) for own in family}
        near = f"did you mean {min(apart, key=apart.__getitem__)}? " if family and wanted else ""
        known = f"{near}Known are {', '.join(family)}" if family else others
        raise InputError(f"there is no profile {name!r}; {known}")
    row = table[spelt]
    outline = {"UPN": _channel, "L": _angle}.get(spelt.split()[0], _two_flanges)
    return _placed([outline(*(float(row[key]) for key in _SIZES))], row["name"], weak, unit)


def _numbers(name: str) -> list[float]:
    return [float(size) for size in re.findall(r"\d+(?:\.\d+)?", name)]


def _placed(loops: list[list[Corner]], name: str, weak: bool, unit: float) -> ShapedSection:
    """Return the section with these corners [mm], turned if it is to bend about the weak axis."""
    scaled: list[list[Corner]] = [[tuple(unit * value for value in corner) for corner in loop] for loop in loops]
    if not weak:
        return of_loops(scaled, name)
    return of_loops([[(y, x, *radius) for x, y, *radius in loop] for loop in scaled], f"{name}, weak axis")


def _hollow(name: str, sizes: list[float], cold: bool, weak: bool, unit: float) -> ShapedSection:
    """Return a hollow section of sizes [mm], for which the standards assume these radii of corners."""
    h, b, t = sizes
    if name.startswith("CHS"):
        return replace(Tube(unit * h, unit * t), name=name)
    outer, inner = (1.5, 1.0) if not cold else (2.0, 1.0) if t <= 6.0 else (2.5, 1.5) if t <= 10.0 else (3.0, 2.0)
    if not 0.0 < 2.0 * outer * t <= min(h, b):
        raise InputError(f"{name}: the wall must be greater than 0, and twice the radius {outer:g} t at most the width")
    return _placed(
        [_rectangle(h, b, outer * t), _rectangle(h - 2 * t, b - 2 * t, inner * t)], name, weak != (b > h), unit
    )


def _rectangle(h: float, b: float, radius: float) -> list[Corner]:
    return [(x * b / 2, y * h / 2, radius) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def _two_flanges(h: float, b: float, tw: float, tf: float, r: float, _: float) -> list[Corner]:
    quarter = [(b / 2, h / 2), (b / 2, h / 2 - tf), (tw / 2, h / 2 - tf, r)]
    right = [*((x, -y, *radius) for x, y, *radius in quarter), *reversed(quarter)]
    return [*right, *((-x, y, *radius) for x, y, *radius in reversed(right))]


def _channel(h: float, b: float, tw: float, tf: float, r1: float, r2: float) -> list[Corner]:
    """Return the corners of a channel with flanges 8 % inclined up to 300 mm of height, above 5 %."""
    slope, at = (0.08, b / 2) if h <= 300.0 else (0.05, (b + tw) / 2)
    tip, root = tf - slope * (b - at), tf + slope * (at - tw)
    lower = [(0.0, 0.0), (b, 0.0), (b, tip, r2), (tw, root, r1)]
    return [*lower, *((x, h - y, *radius) for x, y, *radius in reversed(lower))]


def _angle(h: float, b: float, t: float, _: float, r1: float, r2: float) -> list[Corner]:
    return [(0.0, 0.0), (b, 0.0), (b, t, r2), (t, t, r1), (t, h, r2), (0.0, h)]
