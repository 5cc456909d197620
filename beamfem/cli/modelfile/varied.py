"""Keys of a model file that a sweep varies."""

import copy
import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

from beamfem.cli.modelfile.lines import Path
from beamfem.cli.modelfile.table import Table, shown, written

_PART = re.compile(r"(?:^|\.)(?P<key>[^.\[\]]+)|\[(?P<item>[1-9]\d*)\]")


@dataclass(frozen=True)
class Varied:
    """A key as written in messages, such as loads[1].vector[2], its path in the file, and its values."""

    name: str
    path: Path
    values: list[Any]


def varied(root: Table) -> tuple[Varied, ...]:
    """Return what the tables [[sweep]] of a file vary. Raises ModelFileError."""
    result: list[Varied] = []
    for table in root.tables("sweep"):
        table.require_known(("key", "values"))
        for key in ("key", "values"):
            if key not in table.values:
                raise table.error(f"the key {key} is missing; needed are key, values")
        name, values = table.text("key"), table.values["values"]
        if not isinstance(values, list) or not values:
            raise table.error(f"must be an array of the values that {name} takes, got {shown(values)}", "values")
        path = _path(table, root)
        for other in result:
            shared = min(len(path), len(other.path))
            if path[:shared] == other.path[:shared]:
                raise table.error(f"{name} and {other.name} vary the same key", "key")
        result.append(Varied(name, path, values))
    return tuple(result)


def with_values(root: Table, values: Mapping[Path, Any]) -> Table:
    """Return the file with other values at some of its keys."""
    changed = copy.deepcopy(dict(root.values))
    for path, value in values.items():
        within: Any = changed
        for part in path[:-1]:
            within = within[part]
        within[path[-1]] = copy.deepcopy(value)
    return Table(root.source, (), changed)


def _path(table: Table, root: Table) -> Path:
    """Return the path of the key of a sweep in the file. Raises ModelFileError if it is not there."""
    name, path, end = table.text("key"), [], 0
    for match in _PART.finditer(name):
        if match.start() != end:
            break
        end = match.end()
        path.append(match["key"] if match["key"] else int(match["item"]) - 1)
    if not path or end != len(name):
        such = 'such as "sections.NAME.height" or "loads[1].vector[2]", with items counted from 1'
        raise table.error(f'must be a key {such}, got "{name}"', "key")
    if path[0] in ("sweep", "title", "units", "code", "outputs", "curves", "files"):
        raise table.error(f"{path[0]} cannot be varied", "key")
    if tuple(path) not in root.source.lines:
        near = get_close_matches(name, [written(known) for known in root.source.lines], 1)
        right = f"did you mean {near[0]}? Otherwise write" if near else "write"
        raise table.error(f"{name} is not in the file; {right} it there with one of its values", "key")
    return tuple(path)
