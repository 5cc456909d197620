"""Beams of a model file, what holds and joins them and what acts on them."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from beamfem.assembly.system import System
from beamfem.cli.modelfile import parts
from beamfem.cli.modelfile.functions import Components
from beamfem.cli.modelfile.parts import Kinds, Named
from beamfem.cli.modelfile.table import Reader, Table, build, build_kind
from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.imposed_strains import Actuation, Temperature
from beamfem.model.joints import Hinge, Rigid
from beamfem.model.loads import DistributedLoad, Gravity, PointForce, PointMoment, Pressure
from beamfem.model.model import Model
from beamfem.model.support import Support
from beamfem.model.supports import Clamp, Foundation, Pin, Prescribed, Roller, Spring
from beamfem.validation import nearest

SUPPORTS: Kinds = {
    "clamp": Clamp,
    "pin": Pin,
    "roller": Roller,
    "prescribed": Prescribed,
    "spring": Spring,
    "foundation": Foundation,
}
LOADS: Kinds = {
    "gravity": Gravity,
    "force": PointForce,
    "moment": PointMoment,
    "distributed": DistributedLoad,
    "pressure": Pressure,
    "actuation": Actuation,
    "temperature": Temperature,
}
JOINTS: Kinds = {"rigid": Rigid, "hinge": Hinge}

_POINT = re.compile(r"(?P<beam>.+?)\.(?:(?P<end>start|end)|at\(\s*(?P<share>[^()]+?)\s*\))")


def beams(root: Table, function: Named) -> dict[str, Beam]:
    """Return the beams of a file by name. Raises ModelFileError."""
    material, element = parts.materials(root), parts.elements(root)
    section = parts.sections(root, material, function)
    readers: dict[str, Reader] = {
        "curve": parts.curve,
        "element": element,
        "section": section,
        "material": material,
    }
    found = {name: build(table, Beam, readers) for name, table in root.named("beams").items()}
    if not found:
        raise root.error("a model needs at least one beam, a table headed [beams.NAME]")
    for named in (material, element, section):
        named.check_all()
    return found


class Places:
    """Reads what means a beam of the file, or a point of one."""

    def __init__(self, beams: Mapping[str, Beam]) -> None:
        self.beams = beams

    def beam(self, table: Table, key: str) -> Beam:
        """Return the beam named at a key. Raises ModelFileError."""
        name = table.text(key)
        if name not in self.beams:
            raise table.error(f"there is no beam {name!r}; {nearest(name, self.beams)}", key)
        return self.beams[name]

    def point(self, table: Table, key: str) -> Point:
        """Return the point at a key: NAME.start, NAME.end or NAME.at(fraction). Raises ModelFileError."""
        text = table.text(key)
        found = _POINT.fullmatch(text.strip())
        if not found:
            raise table.error(f'must be a point such as "NAME.start", "NAME.end" or "NAME.at(0.5)", got "{text}"', key)
        name = found["beam"]
        if name not in self.beams:
            raise table.error(f"there is no beam {name!r}; {nearest(name, self.beams)}", key)
        if found["end"]:
            return self.beams[name].start if found["end"] == "start" else self.beams[name].end
        try:
            fraction = float(found["share"])
        except ValueError:
            raise table.error(f"the fraction along the beam must be a number, got {found['share']!r}", key) from None
        try:
            return self.beams[name].at(fraction)
        except InputError as error:
            raise table.error(str(error), key) from None


def model(root: Table, known: Mapping[str, Beam], function: Named, moving: bool) -> Model:
    """Return the model of a file; moving: for an analysis in time. Raises ModelFileError."""
    places, value = Places(known), parts.value_by(function)
    all_beams = list(known.values())

    def vector(table: Table, key: str) -> Any:
        given = table.values[key]
        if not isinstance(given, list) or not any(isinstance(part, str | dict) for part in given):
            return given
        named = [Table(table.source, table.path, {key: part}) for part in given]
        return Components(tuple(value(part, key) for part in named))

    readers: dict[str, Reader] = {"beam": places.beam, "a": places.point, "b": places.point, "amplitude": function}
    readers |= {"point": places.point, "vector": vector}
    readers |= dict.fromkeys(("ux", "uy", "rotation", "value", *Actuation.along, *Temperature.along), value)

    def items(key: str, kinds: Kinds, trial: Callable[[Any], Model]) -> list[Any]:
        found = []
        for table in root.tables(key):
            found.append(build_kind(table, kinds, readers))
            try:
                trial(found[-1])
            except InputError as error:
                raise table.refused(error) from None
        return found

    supports = items("supports", SUPPORTS, lambda item: Model(all_beams, supports=[item]))
    loads = items("loads", LOADS, lambda item: Model(all_beams, loads=[item]))
    joints = items("joints", JOINTS, lambda item: Model(all_beams, joints=[item]))
    whole = Model(all_beams, supports, loads, joints)
    if "units" in root.values:
        try:
            whole = replace(whole, units=root.text("units"))
        except InputError as error:
            raise root.error(str(error), "units") from None
    _require_compatible(root, whole, not moving)
    return whole


def _require_compatible(root: Table, model: Model, static: bool) -> None:
    """Raise ModelFileError at the first support that holds what another one holds already."""

    def check(supports: Sequence[Support]) -> None:
        system = System(Model(model.beams, supports, joints=model.joints), static)
        _ = system.prescribed, system.inclined

    try:
        check(model.supports)
    except InputError:
        for number, table in enumerate(root.tables("supports"), 1):
            try:
                check(model.supports[:number])
            except InputError as error:
                raise table.error(str(error)) from None
        raise
