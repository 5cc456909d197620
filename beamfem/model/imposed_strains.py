"""Imposed strains of a beam: actuation and temperature, as strains of its stress-free state."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from beamfem.element.coordinates import ShearFree
from beamfem.errors import InputError
from beamfem.model.along_beam import AlongBeam, check_along, ends_and_middle, require_names
from beamfem.model.beam import Beam, require_beam
from beamfem.model.load_arrays import values_along
from beamfem.model.load_base import Amplitude, Load
from beamfem.model.load_shapes import LoadShape, Strains
from beamfem.model.state_protocols import Placed
from beamfem.section.thermal import expands_evenly, thermal_strain
from beamfem.validation import called, convert, finite, squared


class ImposedStrain(AlongBeam, Load):
    """Strains of the stress-free state of a beam; each field named in `along` is a number or a function.

    Attributes
    ----------
    along : tuple of str
        Names of the fields that may be functions of the arc length [m] from the start.
    units : tuple of str
        Their units.
    """

    units: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))
        require_names(self)
        convert(self, squared(finite), *(name for name in self.along if not callable(getattr(self, name))))
        check_along(self)
        super().__post_init__()

    @abstractmethod
    def free_strain(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the strains of the unconstrained beam.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths from the start.

        Returns
        -------
        array, (n, 4)
            Stretch [-], shear [-], curvature [1/m] and thickness stretch [-].
        """

    def heat(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the change of temperature, by which layers expand with their own coefficients; zero unless overridden.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths from the start.

        Returns
        -------
        array, (n, 2)
            Change of temperature on the axis [K] and its gradient over the section [K/m].
        """
        return np.zeros((len(arc_length), 2))

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values of a field named in `along`.

        Parameters
        ----------
        name : str
            Name of the field.
        arc_length : array, [m], (n,)
            Arc lengths from the start.

        Returns
        -------
        array, (n,)
            Values, in the unit of the field.

        Raises
        ------
        InputError
            If a function does not return finite numbers.
        """
        value, what = getattr(self, name), f"{name} of {type(self).__name__}"
        if not callable(value):
            return np.full(len(arc_length), value)
        return np.array([finite(f"{what} at arc length {s:g}", called(what, value, s)) for s in arc_length.tolist()])

    @property
    def place(self) -> Beam:
        """The beam that is strained."""
        return self.beam

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as every imposed strain has."""
        return True

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the imposed strains to draw, see `Load.shapes`."""
        values: dict[str, tuple[float | None, str]] = {}
        for name, unit in zip(self.along, self.units, strict=True):
            value = getattr(self, name)
            if callable(value):
                values[name] = None, unit
            elif value:
                values[name] = weight * value, unit
        return (Strains(self.beam, type(self).__name__.lower(), values),)

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined load."""
        super().require_valid()
        kind = type(self).__name__
        require_beam(kind, getattr(self, "beam", None))
        check_along(self)
        if len(self.units) != len(self.along):
            raise InputError(f"units of {kind} must name a unit for each name of along, {self.along}, got {self.units}")
        at = ends_and_middle(self.beam)
        free_strain_of(self, at)
        heat_of(self, at)
        require_followed(self)


def require_followed(load: ImposedStrain) -> None:
    """Raise InputError if the nodal coordinates cannot represent the imposed strains."""
    coordinates, name = load.beam.element.coordinates, load.beam.element.name
    if not isinstance(coordinates, ShearFree):
        return
    stretch, shear, *_ = load.free_strain(ends_and_middle(load.beam)).T
    if shear.any():
        raise InputError(f"{type(load).__name__}: nodes of {name} do not shear; take another element")
    if stretch.any() and not coordinates.stretchable:
        raise InputError(f"{type(load).__name__}: nodes of {name} do not stretch; let them")


Along = float | Callable[[float], float]


@dataclass(frozen=True)
class Actuation(ImposedStrain):
    """Imposed curvature, stretch and shear of the stress-free state, such as by muscles, growth or swelling.

    Section forces follow from the difference, s = C (eps - eps0 - amplitude * actuation).

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

    Raises
    ------
    InputError
        For an invalid value, or a strain that the nodes of the element cannot follow.

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


@dataclass(frozen=True)
class Temperature(ImposedStrain):
    """Change of temperature of a beam, and its gradient over the section.

    An unconstrained section of one material has the stretch alpha * change and the curvature -alpha * gradient, with
    the `thermal_expansion` alpha of the material; different layers are in equilibrium with each other. The thickness
    does not expand at nodes that keep it constant.

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

    Raises
    ------
    InputError
        For an invalid value, or a material without thermal expansion.

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
        if beam.prismatic:
            unit = thermal_strain(beam.section_at(0.0), beam.material)[None]
        else:
            unit = np.array([thermal_strain(beam.section_at(s), beam.material) for s in arc_length.tolist()])
        stretch, curvature, thickness = (unit @ heat[:, :, None])[:, :, 0].T
        return np.column_stack([stretch, np.zeros(len(arc_length)), curvature, thickness])

    def heat(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the change of temperature [K] and its gradient [K/m] (n, 2), see `ImposedStrain.heat`."""
        return np.column_stack([self.values_of(name, arc_length) for name in self.along])


def free_strain_of(load: ImposedStrain, arc_length: np.ndarray) -> np.ndarray:
    """Return the free strains (n, 4) of a load at arc lengths (n,) [m]. Raises InputError for any other result."""
    return values_along(load, "free_strain", load.free_strain, arc_length, 4)


def heat_of(load: ImposedStrain, arc_length: np.ndarray) -> np.ndarray:
    """Return temperature [K] and gradient [K/m] (n, 2) of a load. Raises InputError for any other result."""
    return values_along(load, "heat", load.heat, arc_length, 2)
