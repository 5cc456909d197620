"""Compiled force and tangent of a part at points: derived from its definition."""

from collections.abc import Callable
from contextlib import suppress
from ctypes import CFUNCTYPE, c_double, c_void_p
from functools import cache, partial
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np

from beamfem.errors import InputError
from beamfem.kernels.compiler.value_types import Signature
from beamfem.kernels.compiling import Derived, Routine
from beamfem.kernels.connection_passes import MOST, MOST_DATA
from beamfem.kernels.model_record import POINT_FORCE, POINT_TANGENT
from beamfem.kernels.records import address_of
from beamfem.physics.connection_source import connection_source
from beamfem.physics.connections import Connection
from beamfem.physics.floating_frame import floating_frame
from beamfem.physics.stations import GENERATED


class Foreign:
    """A C function by its address, which is called as a `Routine` is: with arrays, and with numbers between them."""

    def __init__(self, address: int, weights: int, arrays: int = 7) -> None:
        self.address = address
        kinds = [c_void_p] * arrays + [c_double] * weights + [c_void_p]
        self._function = CFUNCTYPE(None, *kinds)(address)

    def __call__(self, *arguments: Any) -> None:
        """Call it."""
        self._function(*(address_of(each) if isinstance(each, np.ndarray) else each for each in arguments))


class Passes(NamedTuple):
    """Compiled force and tangent, and the equation of a place if there is one."""

    force: Routine | Foreign
    tangent: Routine | Foreign
    root: Foreign | None = None


@cache
def passes_of(connection: Connection) -> Passes:
    """Return the compiled force and tangent. Raises InputError for energies that cannot be derived."""
    if not connection.name.isidentifier():
        raise InputError(f"the name of a Connection must be one word of letters, digits and _, got {connection.name!r}")
    if max(connection.size, connection.multipliers + connection.prescribed) > MOST:
        raise InputError(f"{connection.name} has more than {MOST} coordinates or conditions; split it into parts")
    if len(connection.data) + len(connection.memory) > MOST_DATA and connection.memory:
        raise InputError(
            f"{connection.name} has more than {MOST_DATA} numbers and history variables; split it into parts"
        )
    if connection.compiled is not None:
        found = connection.compiled
        if len(found) not in (2, 3) or not all(isinstance(each, int) and each > 0 for each in found):
            raise InputError(
                f"compiled of {connection.name} must be the addresses of two C functions, for force and tangent, got "
                f"{found}"
            )
        force, tangent, *root = found
        return Passes(Foreign(force, 0), Foreign(tangent, 3), *(Foreign(each, 1, arrays=2) for each in root))
    signatures = {"force": POINT_FORCE, "tangent": POINT_TANGENT}
    derived = [_derived(connection, what, signature) for what, signature in signatures.items()]
    try:
        if connection not in GENERATED:
            _ = [each.function for each in derived]
    except Exception as error:
        raise InputError(
            f"force and tangent of {connection.name} cannot be derived from its energies: {error}. Write them with "
            "+, -, *, /, whole powers, f.sqrt and f.positive, and f.cos and f.sin of rotations"
        ) from error
    return Passes(derived[0], derived[1])


def _derived(connection: Connection, what: str, signature: Signature) -> Derived:
    known = *GENERATED, floating_frame(connection.points, connection.amplitudes, connection.dissipation is not None)
    package = connection in known
    name = connection.name if package else f"{connection.name} of {id(connection)}"
    return Derived(f"{name}_{what}", signature, partial(connection_source, connection, what), on_disk=package)


@cache
def remembering(connection: Connection) -> Routine | None:
    """Return the compiled `remember`, None if there is none or it cannot be derived, and is called in Python."""
    if connection.remember is None:
        return None
    derived = _derived(connection, "remember", POINT_FORCE)
    with suppress(Exception):
        _ = derived.function
        return derived
    return None


@cache
def in_python(connection: Connection) -> Callable[..., Any]:
    """Return the force as a function of Python, for complex numbers as well unless it is a C function."""
    force = passes_of(connection).force
    if isinstance(force, Foreign):
        return lambda *arguments: force(
            *(np.ascontiguousarray(each, dtype=float) for each in arguments[:-1]), arguments[-1]
        )
    function = force.function
    return FunctionType(function.__code__, {**function.__globals__, "math": np})
