"""A model file as text: parsed by tomllib, with the line of every key for messages."""

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from beamfem.errors import InputError

_HDF5 = b"\x89HDF"
_LARGEST = 5_000_000  # bytes
# start of a message of tomllib, and the usual cause
_CAUSES = {
    "Cannot overwrite": "the key is there twice, or the header of its table has another number of brackets above",
    "Cannot declare": "the table is there twice; only those in double brackets, such as [[loads]], may be repeated",
    "Invalid value": 'texts are written in quotation marks: "arm.start", numbers like 0.5, arrays like [0, 1], truth '
    "values true or false",
    "Expected newline": "only a comment may follow a value on its line, and numbers are written like 5.0 or 2e-3",
    "Invalid initial character": "a table in braces must be on one line, without a comma at its end",
    "Illegal character '\\n'": "a quotation mark is missing at the end of a text",
    "Expected ']' at the end of a table": "names other than A-Z, a-z, 0-9, - and _ are written in quotation marks",
    "Expected '='": "keys and their values are written: key = value",
    "Unescaped": "paths may be written with /",
}


class ModelFileError(InputError):
    """An error in a model file; the message begins with `file:line: key:`."""

    def __init__(self, message: str, file: Path, line: int | None = None, key: str | None = None) -> None:
        place = f"{file}:{line}" if line else str(file)
        super().__init__(f"{place}: {key}: {message}" if key else f"{place}: {message}")
        self.message, self.file, self.line, self.key = message, file, line, key


@dataclass(frozen=True)
class Source:
    """The text of a model file and its values."""

    file: Path
    text: str
    values: dict[str, Any]

    def error(self, message: str, *path: str | int) -> ModelFileError:
        """Return the error of a key; items of arrays are counted from 1."""
        key = "".join(f"[{part + 1}]" if isinstance(part, int) else f".{part}" for part in path)
        return ModelFileError(message, self.file, _line(self.text, path), key.removeprefix(".") or None)


def read_source(path: Path) -> Source:
    """Return the text and values of a model file. Raises ModelFileError."""
    line, content = None, b""
    if path.exists() and not path.is_file():
        raise ModelFileError(f"this is a {'folder' if path.is_dir() else 'device'}, not a model file", path)
    try:
        if path.stat().st_size <= _LARGEST:
            content = path.read_bytes()
            text = content.decode("utf-8-sig").replace("\r\n", "\n")
            return Source(path, text, tomllib.loads(text))
        message = f"this file has more than {_LARGEST // 10**6} MB, too many for a model file"
    except FileNotFoundError:
        message = "there is no such file"
    except UnicodeDecodeError:
        results = "a results file, which beamfem info, plot and export read"
        message = f"this is {results if content.startswith(_HDF5) else 'not a text in UTF-8'}; model files are TOML"
    except tomllib.TOMLDecodeError as error:
        cause = next((f"; {cause}" for start, cause in _CAUSES.items() if str(error).startswith(start)), "")
        place = re.search(r"\(at line (\d+)", str(error))
        line = int(place[1]) if place else max(len(text.rstrip().splitlines()), 1)
        message = f"not valid TOML: {error}{cause}"
    except ValueError as error:  # whole numbers of thousands of digits
        message = f"a number cannot be read: {error}"
    except RecursionError:
        message = "arrays or tables are nested too deeply"
    raise ModelFileError(message, path, line)


def _line(text: str, path: tuple[str | int, ...]) -> int | None:
    """Return the line, from 1, where the statement of a key begins, or else the table that should contain it."""
    while path and not _known(text, path):
        path = path[:-1]
    lines = text.splitlines(keepends=True)
    without, having = 0, len(lines)
    while path and having - without > 1:
        middle = (without + having) // 2
        # the first lines are TOML if they end with a statement, which lines of a long array, with a comma, do not
        ends = (end for end in range(middle, having) if end == middle or lines[end - 1].rstrip()[-1:] != ",")
        known = next((known for end in ends if (known := _known("".join(lines[:end]), path)) is not None), True)
        without, having = (without, middle) if known else (middle, having)
    return having if path else None


def _known(text: str, path: tuple[str | int, ...]) -> bool | None:
    """Return whether a text has a key, None if it is no TOML."""
    try:
        value: Any = tomllib.loads(text)
        for key in path:
            value = value[key]
        return True
    except (KeyError, IndexError, TypeError):
        return False
    except tomllib.TOMLDecodeError:
        return None
