"""User-defined classes in files: saved by module and name, found again if the module is imported."""

import sys
from dataclasses import fields, is_dataclass
from typing import Any

from beamfem.errors import InputError
from beamfem.model.check_replaceable import require_remade


class NotImportedError(InputError):
    """A file holds a part of a class that no loaded module has."""

    def __init__(self, kind: str, module: str) -> None:
        if module == "__main__":
            message = f"the file holds a {kind} of the script that saved it: define it in this one as it was"
        else:
            message = f"the file holds a {kind} of the module {module}: import that module before loading the file"
        super().__init__(message)
        self.kind, self.module = kind, module


def name_of(part: Any) -> str:
    """Return "module:Class" for a user-defined part of a model. Raises InputError if it cannot be found again."""
    kind = type(part)
    what = f"a {kind.__name__} cannot be saved"
    if not is_dataclass(part):
        raise InputError(f"{what}: only dataclasses can, whose fields tell what they hold")
    if find(f"{kind.__module__}:{kind.__qualname__}") is not kind:
        raise InputError(f"{what}: define its class at the top level of a module, so that it is found again")
    hidden = [field.name for field in fields(part) if not field.init]
    if hidden:
        raise InputError(f"{what}: its field {hidden[0]} is not an argument of the class")
    require_remade(what, part)
    return f"{kind.__module__}:{kind.__qualname__}"


def class_of(name: str) -> Any:
    """Return the class of "module:Class" without importing anything. Raises NotImportedError if there is none."""
    found = find(name)
    if not (isinstance(found, type) and is_dataclass(found)):
        module, _, kind = name.partition(":")
        raise NotImportedError(kind, module)
    return found


def made(name: str, members: dict[str, Any]) -> Any:
    """Return a part of the class "module:Class". Raises InputError if the class is missing or has changed."""
    kind = class_of(name)
    try:
        return kind(**members)
    except TypeError as error:
        raise InputError(f"the class {name} is no longer that which the file was saved with: {error}") from error


def find(name: str) -> Any:
    """Return the attribute "module:name" of a loaded module, None if there is none."""
    module, _, attribute = name.partition(":")
    result: Any = sys.modules.get(module)
    for part in attribute.split("."):
        result = getattr(result, part, None)
    return result
