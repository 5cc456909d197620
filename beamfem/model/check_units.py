"""Whether materials, sections and gravity can be in the units that a model names, and in which others they may be."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.model.beam import Beam
from beamfem.model.load_base import BodyLoad
from beamfem.units import Units, units_of

UNNAMED = "N, m, s"


class _Kind(NamedTuple):
    """A kind of quantity: SI unit, powers of force, length and time, range in SI, and units that people use (in SI)."""

    unit: str
    powers: tuple[int, int, int]
    least: float
    most: float
    common: dict[str, float]


_MODULUS = _Kind("Pa", (1, -2, 0), 1e2, 2e12, {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "kPa": 1e3})
_DENSITY = _Kind("kg/m^3", (1, -4, 2), 0.1, 3e4, {"kg/m^3": 1.0, "t/m^3": 1e3, "kg/mm^3": 1e9, "t/mm^3": 1e12})
_GRAVITY = _Kind("m/s^2", (0, 1, -2), 1e-3, 1e3, {"m/s^2": 1.0, "mm/s^2": 1e-3})


def doubts_of_units(beams: Sequence[Beam], loads: Iterable[Any], named: str) -> tuple[str, ...]:
    """Return a sentence on values that no material, section or planet has in units that are named, if there are any."""
    found = () if named == UNNAMED else tuple(dict.fromkeys(_implausible(beams, loads, units_of(named))))
    return (f'units="{named}" are named, but {"; ".join(found)}',) if found else ()


def _implausible(beams: Sequence[Beam], loads: Iterable[Any], units: Units) -> Iterator[str]:
    materials = dict[int, Material]()
    for beam in beams:
        section = beam.section_at(0.0)
        try:
            materials |= {id(material): material for material, _ in section.moments(beam.material)}
        except InputError:  # the section is defined by its stiffness and has neither materials nor faces
            continue
        height, length, unit = float(np.ptp(section.bounds)), beam.curve.length, units.of("m")
        if height > length:
            yield f"a section {height:g} {unit} high is larger than its beam is long, {length:g} {unit}"
    for material in materials.values():
        yield from _of_value("youngs_modulus", material.youngs_modulus, _MODULUS, units)
        yield from _of_value("density", material.density, _DENSITY, units)
    for load in loads:
        if isinstance(load, BodyLoad):
            yield from _of_value("gravity", float(np.hypot(*load.vector)), _GRAVITY, units)


def _of_value(name: str, value: float, kind: _Kind, units: Units) -> Iterator[str]:
    """Yield a sentence on a value out of its range, with the unit that it was probably given in."""
    size = units.in_si(*kind.powers)
    if value == 0.0 or kind.least <= value * size <= kind.most:
        return
    unit = units.of(kind.unit)
    meant = next((other for other, si in kind.common.items() if kind.least <= value * si <= kind.most), None)
    slip = "" if meant is None else f" ({value:g} {meant} is {value * kind.common[meant] / size:.4g} {unit})"
    span = f"{kind.least:g} to {kind.most:g}"
    yield f"{name} {value:g} {unit} is {value * size:.3g} {kind.unit}, which is not within {span}{slip}"
