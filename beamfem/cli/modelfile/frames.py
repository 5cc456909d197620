"""Frames of a model file: beams along the lines of a mesh file, with the joints between them."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from beamfem.cli.modelfile.table import Reader, Table, build
from beamfem.errors import FileError, InputError
from beamfem.io.frame import Frame, build_frame
from beamfem.io.mesh import LineMesh, read_mesh
from beamfem.validation import items, require_known

_OF_PART = ("kind", "class", "youngs_modulus")  # keys of a part of its own, not names of member sets


def frame(table: Table, readers: dict[str, Reader], name: str) -> Frame:
    """Return the frame of a table [frames.NAME], its beams called NAME[1], NAME[2] and so on.

    readers: of element, section and material. Raises ModelFileError.
    """

    def by_set(read: Reader) -> Reader:
        def value(own: Table, key: str) -> Any:
            given = own.values[key]
            if not isinstance(given, dict) or any(part in given for part in _OF_PART):
                return read(own, key)
            sets = own.table(key)
            return {name: read(sets, name) for name in sets.values}

        return value

    def plain(own: Table, key: str) -> Any:
        return own.values[key]

    def file(own: Table, key: str) -> Path:
        return own.source.file.parent / own.text(key)

    frame_readers: dict[str, Reader] = {key: by_set(readers[key]) for key in ("element", "section", "material")}
    frame_readers |= {"elements": by_set(plain), "file": file}
    make_frame: Callable[[str], Frame] = build(table, _of_file, frame_readers)
    try:
        return make_frame(name)
    except InputError as error:
        raise table.refused(error) from None


def _of_file(
    file: Path,
    elements: Any,
    element: Any,
    section: Any,
    material: Any = None,
    members: str = "cells",
    hinges: Any = (),
    merge: bool = False,
) -> Callable[[str], Frame]:
    try:
        mesh: LineMesh = read_mesh(file, merge=merge)
    except FileError as error:
        raise InputError(f"file: {error}") from error
    properties = {"elements": elements, "element": element, "section": section, "material": material}
    for key, value in properties.items():
        for name in value if isinstance(value, dict) else ():
            require_known(f"{key} has no member set {name!r}", name, mesh.member_sets)
    for name in [hinges] if isinstance(hinges, str) else items("hinges", hinges):
        require_known(f"hinges has no point set {name!r}", name, mesh.point_sets)
    return partial(build_frame, mesh, elements, element, section, material, members, hinges)  # type: ignore[arg-type]
