"""Curvature, stretch and shear imposed on a beam."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.model.beam import Beam
from beamfem.model.imposed_strains import Along, ImposedStrain, require_followed
from beamfem.model.load_base import Amplitude


@dataclass(frozen=True)
class Actuation(ImposedStrain):
    """Imposed curvature, stretch and shear of the stress-free state, such as by muscles, growth or swelling.

    Section forces follow from the difference, s = C (eps - eps0 - amplitude * actuation). Raises InputError for an
    invalid value, or a strain that the nodes of the element cannot follow.

    Parameters
    ----------
    beam : Beam
        The actuated beam.
    curvature : float or callable, [1/m], default 0
        Imposed curvature; if positive, the beam turns to the left from start to end.
    stretch : float or callable, [-], default 0
        Imposed stretch.
    shear : float or callable, [-], default 0
        Imposed shear.
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the actuation grows with the load factor in statics, if it has no amplitude.

    Notes
    -----
    Each strain is a number or a function of the arc length [m] from the start. Elements end at the `kinks` of a
    function (declared, or jumps that are found).

    Examples
    --------
    >>> curled = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.Actuation(beam, curvature=np.pi / 2)]))
    >>> round(float(curled.rotation(beam.end)[-1]), 4)  # half a turn
    3.1416
    """

    along: ClassVar[tuple[str, ...]] = ("curvature", "stretch", "shear")
    units: ClassVar[tuple[str, ...]] = ("1/m", "", "")

    beam: Beam
    curvature: Along = 0.0
    stretch: Along = 0.0
    shear: Along = 0.0
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
        require_followed(self)

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the imposed strains (n, 4) at arc lengths (n,) [m], see `ImposedStrain.free_strain`."""
        columns = [self.values_of(name, arc_length) for name in ("stretch", "shear", "curvature")]
        return np.column_stack([*columns, np.zeros(len(arc_length))])
