"""A frame of reference that rotates."""

from dataclasses import dataclass

from beamfem.validation import convert, finite, squared, vector


@dataclass(frozen=True)
class RotatingFrame:
    """A frame of reference that turns at a constant speed, in which a model is described.

    Centrifugal forces w^2 (r - c) and Coriolis forces -2 w e_z x v act on all mass. Supports, loads and places on the
    ground turn with the frame. In statics the square of the speed is multiplied by the load factor. Raises InputError
    for an invalid value.

    Parameters
    ----------
    speed : float, [rad/s]
        Angular velocity w, counter-clockwise.
    about : (float, float), [m], default (0, 0)
        Center c of the rotation.

    Examples
    --------
    >>> blade = bf.Model([beam], [bf.Clamp(beam.start)], frame=bf.RotatingFrame(speed=100.0))
    >>> spinning = bf.solve_static(blade)
    >>> bf.solve_modes(blade, 1, about=spinning).frequencies.round(2)
    array([21.92])
    """

    speed: float
    about: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        convert(self, squared(finite), "speed")
        convert(self, squared(vector), "about")
