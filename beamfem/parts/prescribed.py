"""Prescribed displacement, rotation and velocity of a point."""

from dataclasses import dataclass, field

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport, Value
from beamfem.model.time_functions import Integral
from beamfem.validation import convert, finite, function_of_one, squared


@dataclass(frozen=True)
class Prescribed(PointSupport):
    """Prescribe displacement and rotation at a point, from the reference, or their rates.

    A number is multiplied by the load factor in statics and constant in dynamics; a function depends on time [s], or on
    the load factor in statics. None leaves a direction free. With a velocity, the displacement is its integral from
    time 0, and a motion starts with it. Raises InputError if nothing is prescribed, or both a displacement and its
    rate, or a value is invalid.

    Parameters
    ----------
    point : Point
        The moved point.
    ux, uy : float or callable, [m], optional
        Displacement.
    rotation : float or callable, [rad], optional
        Rotation of the section.
    vx, vy : float or callable, [m/s], optional
        Velocity, in place of a displacement.
    angular : float or callable, [rad/s], optional
        Angular velocity of the section, in place of its rotation.

    Examples
    --------
    >>> pushed = bf.Model([beam], [bf.Clamp(beam.start), bf.Prescribed(beam.end, uy=-0.1)])
    >>> round(float(bf.solve_static(pushed).reaction(beam.end)[-1, 1]), -2)
    -32800.0
    """

    point: Point
    ux: Value | None = field(default=None, metadata={"unit": "m"})
    uy: Value | None = field(default=None, metadata={"unit": "m"})
    rotation: Value | None = field(default=None, metadata={"unit": "rad"})
    vx: Value | None = field(default=None, metadata={"unit": "m/s"})
    vy: Value | None = field(default=None, metadata={"unit": "m/s"})
    angular: Value | None = field(default=None, metadata={"unit": "rad/s"})

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.prescribed():
            raise InputError("Prescribed needs at least one of ux, uy, rotation, vx, vy and angular")
        for name, rate in _RATES.items():
            if getattr(self, name) is not None and getattr(self, rate) is not None:
                raise InputError(f"Prescribed takes {name} or {rate}, not both")
        for name in (*_RATES, *_RATES.values()):
            if (value := getattr(self, name)) is None:
                continue
            if callable(value):
                function_of_one(f"{name} of Prescribed", value, "time")
            else:
                convert(self, squared(finite), name)

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        values = {name: getattr(self, name) for name in _RATES}
        rates = {name: getattr(self, rate) for name, rate in _RATES.items()}
        values |= {name: Integral(rate) for name, rate in rates.items() if rate is not None}
        return {name: value for name, value in values.items() if value is not None}


_RATES = {"ux": "vx", "uy": "vy", "rotation": "angular"}
