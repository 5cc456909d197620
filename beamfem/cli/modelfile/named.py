"""Named parts of a model file, and numbers or functions given by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from beamfem.cli.modelfile.table import Kinds, Reader, Table, in_braces, shown
from beamfem.validation import nearest


@dataclass(frozen=True)
class Named:
    """Named parts of a file, to be referred to by name; each is made once."""

    kind: str
    tables: Mapping[str, Table]
    made: dict[str, Any]
    make: Callable[[Table], Any]
    kinds: Kinds = field(default_factory=dict)
    short: tuple[str, ...] = ()  # kinds that need no further keys, so that their name is enough

    def __call__(self, table: Table, key: str) -> Any:
        """Return the part at a key: a name, a table of its own, or a kind alone. Raises ModelFileError."""
        value = table.values[key]
        if isinstance(value, dict):
            return self.make(table.table(key))
        if not isinstance(value, str):
            article = "an" if self.kind[0] in "aeiou" else "a"
            raise table.error(f"must be the name of {article} {self.kind}, or a table, got {shown(value)}", key)
        if value in self.tables:
            return self.part(value)
        if value in self.short:
            return self.make(Table(table.source, (*table.path, key), {"kind": value}))
        if value in self.kinds:
            raise table.error(f"the kind {value!r} needs further keys: {in_braces(value, self.kinds[value])}", key)
        known = [*self.tables, *self.short]
        right = nearest(value, known) if known else f"the file has none; they are headed [{self.kind}s.NAME]"
        raise table.error(f"there is no {self.kind} {value!r}; {right}", key)

    def part(self, name: str) -> Any:
        if name not in self.made:
            self.made[name] = self.make(self.tables[name])
        return self.made[name]

    def check_all(self) -> None:
        """Make every part, so that errors in unused ones are found too."""
        for name in self.tables:
            self.part(name)


def value_by(function: Named) -> Reader:
    """Return the reader of a number, or of a function by name or as a table."""

    def value(table: Table, key: str) -> Any:
        given = table.values[key]
        if isinstance(given, bool) or not isinstance(given, int | float | str | dict):
            raise table.error(f"must be a number, or a function by name or as a table, got {shown(given)}", key)
        if isinstance(given, str) and given not in function.tables:
            hint = nearest(given, function.tables) if function.tables else "the file has none"
            raise table.error(f"must be a number or the name of a function, got {shown(given)}; {hint}", key)
        return given if isinstance(given, int | float) else function(table, key)

    return value
