"""Pretension of a beam."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.model.beam import Beam, sections_along
from beamfem.model.imposed_strains import Along, ImposedStrain, require_followed
from beamfem.model.load_base import Amplitude


@dataclass(frozen=True)
class Pretension(ImposedStrain):
    """Pretension of a beam by a force, as by a turnbuckle: its stress-free length becomes shorter.

    It imposes the stretch -F / (E A), so that the normal force is F if the ends do not move; ends that give way relax
    it, and every other load changes it. Continuum forces without plane stress are stiffer than E A, and F is larger.
    Raises InputError for an invalid value, or elements whose nodes cannot stretch.

    Parameters
    ----------
    beam : Beam
        The beam.
    force : float or callable, [N]
        Force F, > 0 in tension; or a function of the arc length [m] from the start.
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default False
        Whether it grows with the load factor in statics; by default it acts fully at load factor 0, so that what it is
        balanced with should do so, too: `Gravity(scale=False)`.

    Examples
    --------
    >>> supports = [bf.Clamp(beam.start), bf.Clamp(beam.end)]
    >>> tight = bf.solve_static(bf.Model([beam], supports, [bf.Pretension(beam, 5e4)]))
    >>> round(float(tight.section_forces(beam).normal[-1, 0]))
    50000
    """

    along: ClassVar[tuple[str, ...]] = ("force",)
    units: ClassVar[tuple[str, ...]] = ("N",)

    beam: Beam
    force: Along
    amplitude: Amplitude = None
    scale: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        require_followed(self)

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the imposed strains (n, 4) at arc lengths (n,) [m], see `ImposedStrain.free_strain`."""
        sections = sections_along(self.beam, arc_length)
        axial = np.array([section.rigidity(self.beam.material).axial for section in sections])
        strain = np.zeros((len(arc_length), 4))
        strain[:, 0] = -self.values_of("force", arc_length) / axial
        return strain
