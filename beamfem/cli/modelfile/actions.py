"""Beams of a model file, with their supports, joints, connectors and loads."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from inspect import signature
from typing import Any

from beamfem.assembly.system import System
from beamfem.cli.modelfile import axes, parts
from beamfem.cli.modelfile.beams import called
from beamfem.cli.modelfile.elements import elements
from beamfem.cli.modelfile.frames import frame
from beamfem.cli.modelfile.functions import Components
from beamfem.cli.modelfile.kinds import kinds_of, readers_of
from beamfem.cli.modelfile.named import Named, value_by
from beamfem.cli.modelfile.own_parts import build_own, build_own_or_kind
from beamfem.cli.modelfile.places import Moved, Places
from beamfem.cli.modelfile.table import Kinds, Reader, Table, build
from beamfem.errors import InputError
from beamfem.io.frame import Frame
from beamfem.material import Material
from beamfem.model.beam import Beam, Point
from beamfem.model.joints import Joint
from beamfem.model.load import Amplitude
from beamfem.model.loads import Varying
from beamfem.model.model import Model
from beamfem.model.support import Support

SUPPORTS, LOADS, JOINTS = map(kinds_of, ("supports", "loads", "joints"))
CONNECTORS = kinds_of("connectors")


@dataclass(frozen=True)
class Structure:
    """Beams and frames of a file by name, the parts they are made of, and their places in an imperfect model."""

    beams: Mapping[str, Beam]
    frames: Mapping[str, Frame]
    material: Named
    moved: Moved = field(default_factory=Moved)

    @property
    def places(self) -> Places:
        """The reader of points and beams."""
        return Places(self.beams, self.frames, self.moved)

    @property
    def joints(self) -> list[Joint]:
        """The joints inside frames."""
        return [joint for frame in self.frames.values() for joint in frame.joints]


def structure(root: Table, function: Named) -> Structure:
    """Return the beams of a file and the frames that it reads. Raises ModelFileError."""
    material, element = parts.materials(root), elements(root)
    section = parts.sections(root, material, function)
    readers: dict[str, Reader] = {
        "curve": axes.curve,
        "elements": axes.elements_along,
        "element": element,
        "section": section,
        "material": material,
    }
    beams = {name: build(table, called(name), readers) for name, table in root.named("beams").items()}
    frames = {name: frame(table, readers, name) for name, table in root.named("frames").items()}
    for name, item in frames.items():
        beams |= {f"{name}[{number}]": beam for number, beam in enumerate(item.beams, 1)}
    if not beams:
        raise root.error("a model needs at least one beam, a table headed [beams.NAME]")
    for named in (material, element, section):
        named.check_all()
    return Structure(beams, frames, material)


def model(root: Table, known: Structure, function: Named, moving: bool) -> Model:
    """Return the model of a file; moving: for an analysis in time. Raises ModelFileError."""
    places, value = known.places, value_by(function)
    all_beams, inner = list(known.beams.values()), known.joints

    def vector(table: Table, key: str) -> Any:
        given = table.values[key]
        if isinstance(given, str | dict):
            return function(table, key)
        if not isinstance(given, list) or not any(isinstance(part, str | dict) for part in given):
            return given
        return Components(tuple(value(part, place) for part, place in table.items(key)))

    types: dict[Any, Reader] = {Point: places.point, Beam: places.beam, Material: known.material, Callable: value}
    of_package = types | {Amplitude: function, tuple[float, float] | Varying: vector}

    def part(table: Table, kinds: Kinds) -> Any:
        readers = readers_of(kinds, table.values.get("kind"), of_package)
        return build_own_or_kind(table, kinds, readers, types)

    def tried(table: Table, item: Any, trial: Callable[[Any], Model]) -> Any:
        try:
            trial(item)
        except InputError as error:
            raise table.refused(error) from None
        return item

    def items(key: str, kinds: Kinds, trial: Callable[[Any], Model]) -> list[Any]:
        tables = [one for table in root.tables(key) for one in _each_place(table, kinds, places)]
        return [tried(table, part(table, kinds), trial) for table in tables]

    supports = items("supports", SUPPORTS, lambda item: Model(all_beams, supports=[item]))
    loads = items("loads", LOADS, lambda item: Model(all_beams, loads=[item]))
    joints = items("joints", JOINTS, lambda item: Model(all_beams, joints=[item]))

    def connector(table: Table) -> Any:
        of_kind = "kind" in table.values and CONNECTORS
        item = part(table, CONNECTORS) if of_kind else build_own(table, types)
        return tried(table, item, lambda item: Model(all_beams, connectors=[item]))

    connectors = [connector(table) for table in root.named("connectors").values()]
    whole = Model(all_beams, supports, loads, [*inner, *joints], connectors)
    if "units" in root.values:
        units = root.text("units")
        try:
            whole = replace(whole, units=units)
        except InputError as error:
            raise root.error(str(error), "units") from None
    _require_compatible(root, whole, places, not moving)
    return whole


def _each_place(table: Table, kinds: Kinds, places: Places) -> list[Table]:
    """Return a table for each of its `points` or `beams`, if it has several. Raises ModelFileError."""
    kind = table.values.get("kind")
    parameters = signature(kinds[kind]).parameters if isinstance(kind, str) and kind in kinds else {}
    several: Sequence[tuple[str, str, Callable[[Table, str], Sequence[Any]]]] = (
        ("points", "point", places.points),
        ("beams", "beam", places.members),
    )
    for plural, single, read in several:
        if plural in table.values and single in parameters:
            if single in table.values:
                raise table.error(f"{single} and {plural} are given; one of them is enough", plural)
            rest = {key: value for key, value in table.values.items() if key != plural}
            return [Table(table.source, table.path, {**rest, single: place}) for place in read(table, plural)]
    return [table]


def _require_compatible(root: Table, model: Model, places: Places, static: bool) -> None:
    """Raise ModelFileError at the first support that constrains what another one constrains already."""

    def check(supports: Sequence[Support]) -> None:
        system = System(Model(model.beams, supports, joints=model.joints), static)
        _ = system.prescribed, system.inclined

    try:
        check(model.supports)
    except InputError:
        tables = [one for table in root.tables("supports") for one in _each_place(table, SUPPORTS, places)]
        for number, table in enumerate(tables, 1):
            try:
                check(model.supports[:number])
            except InputError as error:
                raise table.error(str(error)) from None
        raise
