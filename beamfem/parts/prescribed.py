"""Prescribed displacement and rotation of a point."""

from dataclasses import dataclass, field

from beamfem.errors import InputError
from beamfem.model.beam import Point
from beamfem.model.supports import PointSupport, Value
from beamfem.validation import convert, finite, function_of_one, squared


@dataclass(frozen=True)
class Prescribed(PointSupport):
    """Prescribe displacement and rotation at a point, from the reference.

    A number is multiplied by the load factor in statics and constant in dynamics; a function depends on time [s], or on
    the load factor in statics. None leaves a direction free.

    Parameters
    ----------
    point : Point
        The moved point.
    ux, uy : float or callable, [m], optional
        Displacement.
    rotation : float or callable, [rad], optional
        Rotation of the section.

    Raises
    ------
    InputError
        If nothing is prescribed, or a value is invalid.

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

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.prescribed():
            raise InputError("Prescribed needs at least one of ux, uy and rotation")
        for name, value in self.prescribed().items():
            if callable(value):
                function_of_one(f"{name} of Prescribed", value, "time")
            else:
                convert(self, squared(finite), name)

    def prescribed(self) -> dict[str, Value]:
        """Return the prescribed displacements [m] and rotation [rad] by direction."""
        values = {"ux": self.ux, "uy": self.uy, "rotation": self.rotation}
        return {name: value for name, value in values.items() if value is not None}
