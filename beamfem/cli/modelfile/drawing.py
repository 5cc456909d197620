"""The axis of a beam from a drawing that a model file names."""

from pathlib import Path

from beamfem.curves import Curve
from beamfem.errors import FileError, InputError
from beamfem.io.cad import read_dxf
from beamfem.validation import count


def from_drawing(file: Path, layer: str | None = None, number: int | None = None) -> Curve:
    """Return a curve of a DXF file, of one layer or of all; number: which one, from 1, if there are several.

    Raises InputError.
    """
    try:
        curves = read_dxf(file, layer)
    except FileError as error:
        raise InputError(f"file: {error}") from error
    if number is None and len(curves) > 1:
        raise InputError(f"{file.name} has {len(curves)} curves there; number, from 1 to {len(curves)}, chooses one")
    chosen = 1 if number is None else count("number", number)
    if chosen > len(curves):
        raise InputError(f"number is {number}, but {file.name} has {len(curves)} curves there")
    return curves[chosen - 1]
