"""Compiled force and tangent of a part at points: generated for those of the package, derived for a user's own."""

import linecache
from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np

from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.kernels.compiling import Routine
from beamfem.kernels.connection_passes import GENERATED, MOST
from beamfem.physics.connections import CONNECTIONS, Connection


class Passes(NamedTuple):
    """Compiled force and tangent."""

    force: Routine
    tangent: Routine


@cache
def passes_of(connection: Connection) -> Passes:
    """Return the compiled force and tangent. Raises InputError for energies that cannot be derived."""
    if connection in CONNECTIONS:
        module = GENERATED[connection.name]
        return Passes(module.force, module.tangent)
    if max(connection.points * connection.coordinates, connection.multipliers) > MOST:
        raise InputError(f"{connection.name} has more than {MOST} coordinates or conditions; split it into parts")
    with needed_for("a part defined by its energies"):
        from beamfem.physics.connection_source import connection_source
    try:
        source = connection_source(connection)
    except Exception as error:
        raise InputError(
            f"force and tangent of {connection.name} cannot be derived from its energies: {error}. Write them with "
            "+, -, *, /, whole powers and f.sqrt, and f.cos and f.sin of rotations"
        ) from error
    file = f"<{connection.name} of {id(connection)}>"
    linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
    found: dict[str, Any] = {"__name__": f"connection_{connection.name}"}
    exec(compile(source, file, "exec"), found)
    return Passes(found["force"], found["tangent"])


@cache
def in_python(connection: Connection) -> Callable[..., Any]:
    """Return the force as a function of Python, for complex numbers as well."""
    function = passes_of(connection).force.function
    return FunctionType(function.__code__, {**function.__globals__, "math": np})
