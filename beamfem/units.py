"""Units that a model is written in, for labels of pictures and tables; results are never converted."""

import re
from dataclasses import dataclass
from typing import Any

from beamfem.errors import InputError
from beamfem.validation import nearest, text

FORCES = {"N": 1.0, "mN": 1e-3, "uN": 1e-6, "nN": 1e-9, "daN": 10.0, "kN": 1e3, "MN": 1e6}
FORCES |= {"lbf": 4.4482216152605, "kip": 4448.2216152605, "kgf": 9.80665}
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "cm": 1e-2, "dm": 0.1, "km": 1e3, "in": 0.0254, "ft": 0.3048}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0}
_STRESS = {("N", "m"): "Pa", ("N", "mm"): "MPa", ("kN", "m"): "kPa", ("MN", "m"): "MPa", ("kN", "mm"): "GPa"}
_MASS = {("N", "m"): "kg", ("N", "mm"): "t", ("kN", "m"): "t", ("mN", "mm"): "kg", ("uN", "um"): "kg"}
_LARGE = 1e5  # [Pa]
_STRESS |= {("lbf", "in"): "psi", ("kip", "in"): "ksi", ("uN", "um"): "MPa", ("mN", "mm"): "kPa"}


@dataclass(frozen=True)
class Units:
    """Names of the units of force, length and time."""

    force: str = "N"
    length: str = "m"
    time: str = "s"

    def of(self, unit: str) -> str:
        """Return what takes the place of an SI unit such as "N m", "Pa", "kg" or "J"; others stay as they are."""
        mass = _MASS.get((self.force, self.length)) if self.time == "s" else None
        if mass is None and unit == "kg/m^3":
            return f"{self.force} {self.time}^2/{self.length}^4"
        parts = {
            "N": self.force,
            "m": self.length,
            "s": self.time,
            "J": "J" if (self.force, self.length) == ("N", "m") else f"{self.force} {self.length}",
            "Pa": _STRESS.get((self.force, self.length), f"{self.force}/{self.length}^2"),
            "kg": mass or f"{self.force} {self.time}^2/{self.length}",
            "Hz": "Hz" if self.time == "s" else f"1/{self.time}",
        }
        return re.sub(r"[A-Za-z]+", lambda match: parts.get(match[0], match[0]), unit)

    def readable(self, size: float, unit: str) -> tuple[float, str]:
        """Return a factor and a unit with which a number of some size is written in texts: large stresses in MPa."""
        name = self.of(unit)
        return (1e-6, "MPa") if name == "Pa" and abs(size) >= _LARGE else (1.0, name)

    def in_si(self, force: int = 0, length: int = 0, time: int = 0) -> float:
        """Return the size in SI of the unit that is a product of powers of those of force, length and time."""
        return FORCES[self.force] ** force * LENGTHS[self.length] ** length * TIMES[self.time] ** time


def units_of(given: Any) -> Units:
    """Return the units of a text such as "N, mm" or "kN, m, s", in any order. Raises InputError."""
    given = text("units", given)
    units: dict[str, str] = {}
    kinds = {"force": FORCES, "length": LENGTHS, "time": TIMES}
    for name in (part.strip() for part in given.split(",")):
        kind = next((kind for kind, names in kinds.items() if name in names), None)
        if kind is None:
            known = [*FORCES, *LENGTHS, *TIMES]
            raise InputError(
                f'units are a force, a length and a time, such as "N, mm, s": {name!r} is none; {nearest(name, known)}'
            )
        if kind in units:
            raise InputError(f'units are one force, one length and one time, such as "N, mm, s", got {given!r}')
        units[kind] = name
    return Units(**units)
