"""A change of temperature of a beam."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.errors import InputError
from beamfem.model.along_beam import ends_and_middle
from beamfem.model.beam import Beam, sections_along
from beamfem.model.imposed_strains import Along, ImposedStrain, require_followed
from beamfem.model.load_base import Amplitude
from beamfem.section.moments import expands_evenly, thermal_strain


@dataclass(frozen=True)
class Temperature(ImposedStrain):
    """Change of temperature of a beam, and its gradient over the section.

    An unconstrained section of one material has the stretch alpha * change and the curvature -alpha * gradient, with
    the `thermal_expansion` alpha of the material; different layers are in equilibrium with each other. The thickness
    does not expand at nodes that keep it constant. Raises InputError for an invalid value, or a material without
    thermal expansion.

    Parameters
    ----------
    beam : Beam
        The heated beam.
    change : float or callable, [K]
        Change of temperature on the axis.
    gradient : float or callable, [K/m], default 0
        Gradient over the section, towards +y.
    amplitude : callable, optional
        Factor as a function of time [s], or of the load factor in statics.
    scale : bool, default True
        Whether the change grows with the load factor in statics, if it has no amplitude.

    Notes
    -----
    Change and gradient are numbers or functions of the arc length [m] from the start, as in `Actuation`.

    Examples
    --------
    >>> warm = bf.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0, thermal_expansion=1.2e-5)
    >>> rod = bf.Beam(bf.Line((0, 0), (2, 0)), 4, bf.CRBF(order=3), bf.Rectangle(0.05, 0.1), warm)
    >>> heated = bf.solve_static(bf.Model([rod], [bf.Clamp(rod.start)], [bf.Temperature(rod, change=50.0)]))
    >>> round(float(heated.displacement(rod.end)[-1, 0]), 6)
    0.0012
    """

    along: ClassVar[tuple[str, ...]] = ("change", "gradient")
    units: ClassVar[tuple[str, ...]] = ("K", "K/m")

    beam: Beam
    change: Along
    gradient: Along = 0.0
    amplitude: Amplitude = None
    scale: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
        beam = self.beam
        sections = [beam.section_at(s) for s in ends_and_middle(beam).tolist()]
        if not any(thermal_strain(section, beam.material).any() for section in sections):
            raise InputError(
                "Temperature changes nothing: no material of its beam expands with heat",
                remedy="give one a coefficient of thermal expansion, thermal_expansion=1.2e-5",
            )
        evenly = all(expands_evenly(section, beam.material) for section in sections)
        if not evenly and (beam.element.forces.fills_body or beam.law is not None):
            raise InputError(
                "Temperature of layers that expand differently needs Structural() or ElasticLine() forces and a linear "
                f"section, got {beam.element.forces.name} forces"
            )
        require_followed(self)

    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the thermal strains (n, 4) at arc lengths (n,) [m], see `ImposedStrain.free_strain`."""
        beam, heat = self.beam, self.heat(arc_length)
        unit = np.array([thermal_strain(section, beam.material) for section in sections_along(beam, arc_length)])
        stretch, curvature, thickness = (unit @ heat[:, :, None])[:, :, 0].T
        return np.column_stack([stretch, np.zeros(len(arc_length)), curvature, thickness])

    def heat(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the change of temperature [K] and its gradient [K/m] (n, 2), see `ImposedStrain.heat`."""
        return np.column_stack([self.values_of(name, arc_length) for name in self.along])
