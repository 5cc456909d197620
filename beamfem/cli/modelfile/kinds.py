"""Kinds of the package's parts in model files, and readers of their keys, from the classes themselves."""

import re
from inspect import signature
from typing import Any, get_type_hints

from beamfem.cli.modelfile.own_parts import Types, typed_reader
from beamfem.cli.modelfile.table import Kinds, Reader
from beamfem.model.listed_parts import parts_in


def kinds_of(name: str) -> Kinds:
    """Return the parts of the package that a list of a `Model` takes, by their kinds in model files."""
    return {_kind(part.__name__): part for part in parts_in(name)}


def readers_of(kinds: Kinds, kind: Any, types: Types) -> dict[str, Reader]:
    """Return the readers of the keys of a kind by the types of its parameters; none for an unknown kind."""
    if not isinstance(kind, str) or kind not in kinds:
        return {}
    hints = get_type_hints(kinds[kind])
    found = {name: typed_reader(hints.get(name), types) for name in signature(kinds[kind]).parameters}
    return {name: reader for name, reader in found.items() if reader is not None}


def _kind(name: str) -> str:
    """Return the kind of a class: its name in lower case with hyphens, without Point before it and Load after it."""
    words = re.findall(r"[A-Z][a-z0-9]*", name.removeprefix("Point").removesuffix("Load"))
    return "-".join(words).lower()
