"""Errors in a model file, with their place."""

from pathlib import Path

from beamfem.cli.modelfile.phrases import in_keys
from beamfem.errors import InputError


class ModelFileError(InputError):
    """An error in a model file; the message begins with `file:line: key:`."""

    def __init__(self, message: str, file: Path, line: int | None, key: str | None) -> None:
        message = in_keys(message)
        where = f"{file}:{line}" if line else str(file)
        super().__init__(f"{where}: {key}: {message}" if key else f"{where}: {message}")
        self.message = message
        self.file = file
        self.line = line
        self.key = key
