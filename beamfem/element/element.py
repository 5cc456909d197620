"""An element as a user chooses it, and the named combinations of the paper."""

from collections.abc import Hashable
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from beamfem.alike import whole
from beamfem.element import lobatto
from beamfem.element.coordinates import Coordinates, Gradients, Rotation, ShearFree, labels
from beamfem.element.fields import Cubic, Field, Lagrange
from beamfem.element.forces import ContinuumMechanics, ElasticLine, Forces, SplitContinuum, Structural
from beamfem.errors import InputError
from beamfem.keywords import keywords_checked
from beamfem.quadrature import gauss
from beamfem.validation import flag, fulfils, one_of, optional, shown, text

Integration = Literal["full", "reduced", "lobatto"]


@dataclass(frozen=True)
class Element:
    """A field, the nodal coordinates that carry it and the elastic forces that resist it.

    Parameters
    ----------
    field : Cubic or Lagrange
        Field basis.
    coordinates : Gradients, Rotation or ShearFree
        Nodal coordinates.
    forces : ContinuumMechanics, SplitContinuum, ElasticLine or Structural
        Elastic forces.
    integration : {"full", "reduced", "lobatto"}, optional
        "full" integrates the energy of a straight element exactly. "reduced" takes as many Gauss points as the order of
        the field, and 2 if its nodes have no shear (3 for all strains but shear, with a stretch coordinate). "lobatto"
        takes strains of the cubic field at its nodes and its middle, where it does not lock however slender the beam
        is. The default is "lobatto" for the cubic field with structural forces or the elastic line, and "full"
        otherwise.
    label : str, optional
        Name for legends and files.

    Raises
    ------
    InputError
        For a combination that makes no sense.

    Examples
    --------
    >>> element = bf.Element(bf.Cubic(), bf.Rotation(), bf.Structural())
    >>> element.coordinates_per_node, element.integration
    (5, 'lobatto')
    """

    field: Field
    coordinates: Coordinates
    forces: Forces
    integration: Integration | None = None
    label: str | None = None

    def __post_init__(self) -> None:
        one_of("integration", self.integration, ("full", "reduced", "lobatto", None))
        optional(text)("label of an element", self.label)
        for name, kind in (("coordinates", Coordinates), ("forces", Forces)):
            if not isinstance(getattr(self, name), kind):
                raise InputError(f"{name} of an element must be one of {kind}, got {shown(getattr(self, name))}")
        if not fulfils(self.field, Field):
            raise InputError(f"field of an element must be one of {Field}, got {shown(self.field)}")
        has_slope = "r_x" in self.field.vectors
        if self.integration is None:
            free_of_locking = has_slope and isinstance(self.forces, Structural | ElasticLine)
            object.__setattr__(self, "integration", "lobatto" if free_of_locking else "full")
        if self.integration == "lobatto" and not has_slope:
            raise InputError(
                f'integration="lobatto" is for the cubic field, whose nodes have r_x; on the {self.field.name} field '
                '"reduced" does not lock'
            )
        if isinstance(self.coordinates, ShearFree) and not has_slope:
            raise InputError(
                f"coordinates without shear tie r_x to the angle of a node, but the {self.field.name} field has no r_x "
                "there; the cubic field has"
            )
        if isinstance(self.forces, ElasticLine) and not has_slope:
            raise InputError(
                f"the elastic line takes its curvature from r_xx, which the {self.field.name} field does not have "
                "across elements; use the cubic field, or Structural forces"
            )

    def __eq__(self, other: object) -> bool:
        return self._compared == other._compared if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._compared)

    @property
    def _compared(self) -> tuple[Hashable, ...]:
        # what a user derives from a field or from forces may be more than these are compared by
        return whole(self.field), whole(self.coordinates), whole(self.forces), self.integration, self.label

    @property
    def name(self) -> str:
        """Fit for a file name and a legend."""
        return self.label or f"{self.field.name}-{self.coordinates.name}"

    @property
    def coordinates_per_node(self) -> int:
        """Number of coordinates of a node."""
        return len(labels(self.coordinates.code, self.field.vectors))

    def quadrature(self) -> tuple[np.ndarray, np.ndarray]:
        """Gauss points (nq,) and weights (nq,) on [0, 1] where section forces are evaluated."""
        if self.integration == "lobatto":
            return gauss(len(lobatto.STATIONS))
        reduced = 2 if isinstance(self.coordinates, ShearFree) else self.field.degree
        full = self.forces.points(self.field.degree, self.field.director_degree)
        return gauss(reduced if self.integration == "reduced" else full)

    def energy_points(self) -> tuple[np.ndarray, np.ndarray]:
        """Points (nq,) and weights (nq,) on [0, 1] of the strain energy."""
        return _energy_points(self)

    def energy_stiffness(self, stiffness: np.ndarray, jacobian: np.ndarray) -> np.ndarray:
        """Return what of the section stiffness (ne, nq, ns, ns) counts at these points; jacobian (ne, nq) [m]."""
        if self.integration == "lobatto":
            return lobatto.energy_stiffness(self.forces, self.coordinates, stiffness, jacobian)
        counted = _counted(self)
        return stiffness if counted is None else stiffness * counted

    def energy_rules(self) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]:
        """Gauss points, weights on [0, 1] and which strain measures (ns,) each rule integrates; one where all agree.

        With 2 points alone a stretch coordinate could change without resistance: r_x + c at every node leaves r0' as it
        is at both of them. So all but shear takes 3 there. What resists a change of |d| alone is taken at the nodes of
        d: between them |d| is below 1 wherever the beam bends, which would lock a thin one.
        """
        forces = self.forces
        shear, thickness = np.array(forces.shear_measures), np.array(forces.thickness_measures)
        if self.integration == "reduced" and self.coordinates == ShearFree(stretchable=True):
            return (*gauss(2), shear), (*gauss(3), ~shear)
        if isinstance(self.coordinates, Gradients) and thickness.any():
            return (*self.quadrature(), ~thickness), (*self.field.director_rule(), thickness)
        return ((*self.quadrature(), np.ones_like(shear)),)


@lru_cache(maxsize=64)  # asked for by every beam of a model
def _energy_points(element: Element) -> tuple[np.ndarray, np.ndarray]:
    """Return the points and weights (nq,) of the strain energy, which cannot be written to."""
    if element.integration == "lobatto":
        found = lobatto.energy_points(element.forces)
    else:
        rules = element.energy_rules()
        found = np.concatenate([rule[0] for rule in rules]), np.concatenate([rule[1] for rule in rules])
    for values in found:
        values.setflags(write=False)
    return found


@lru_cache(maxsize=64)
def _counted(element: Element) -> np.ndarray | None:
    """Return which parts of the stiffness count at the points of the energy (nq, ns, ns); None if all of them do."""
    counted = np.concatenate([np.tile(rule[2], (len(rule[0]), 1)) for rule in element.energy_rules()])
    return None if counted.all() else counted[:, :, None] & counted[:, None, :]


@keywords_checked
def ANCF(forces: Forces | None = None, integration: Integration | None = None) -> Element:
    """Return the ANCF element: cubic field with gradients as coordinates, 6 coordinates per node.

    Parameters
    ----------
    forces : ContinuumMechanics, SplitContinuum, ElasticLine or Structural, optional
        Elastic forces, by default `ContinuumMechanics()`.
    integration : {"full", "reduced", "lobatto"}, optional
        Integration of the strain energy, see `Element`.

    Returns
    -------
    Element
        Element for `Beam`.

    References
    ----------
    Omar and Shabana 2001.

    Examples
    --------
    >>> element = bf.ANCF(bf.Structural())
    >>> element.coordinates_per_node, element.integration
    (6, 'lobatto')
    """
    return Element(Cubic(), Gradients(), _chosen(forces, ContinuumMechanics()), integration, "ANCF")


@keywords_checked
def ANCFCRBF(forces: Forces | None = None, integration: Integration | None = None) -> Element:
    """Return the ANCF-CRBF element: cubic field with rotations as coordinates, 5 coordinates per node.

    Parameters
    ----------
    forces : ContinuumMechanics, SplitContinuum, ElasticLine or Structural, optional
        Elastic forces, by default `ContinuumMechanics()`.
    integration : {"full", "reduced", "lobatto"}, optional
        Integration of the strain energy, see `Element`.

    Returns
    -------
    Element
        Element for `Beam`.

    References
    ----------
    Paper, section 3.

    Examples
    --------
    >>> element = bf.ANCFCRBF()
    >>> element.coordinates_per_node, element.integration
    (5, 'full')
    """
    return Element(Cubic(), Rotation(), _chosen(forces, ContinuumMechanics()), integration, "ANCF-CRBF")


@keywords_checked
def BilinearANCF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Return the bilinear ANCF element: bilinear field with gradients as coordinates, 4 coordinates per node.

    Parameters
    ----------
    forces : ContinuumMechanics, SplitContinuum or Structural, optional
        Elastic forces, by default `ContinuumMechanics()`.
    integration : {"full", "reduced"}, default "full"
        Integration of the strain energy, see `Element`.

    Returns
    -------
    Element
        Element for `Beam`.

    References
    ----------
    Paper, eqs. (8) to (10).

    Examples
    --------
    >>> element = bf.BilinearANCF()
    >>> element.coordinates_per_node, element.integration
    (4, 'full')
    """
    return Element(Lagrange(1), Gradients(), _chosen(forces, ContinuumMechanics()), integration, "bilinear-ANCF")


@keywords_checked
def BilinearCRBF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Return the bilinear CRBF element: bilinear field with rotations as coordinates, 3 coordinates per node.

    Parameters
    ----------
    forces : ContinuumMechanics, SplitContinuum or Structural, optional
        Elastic forces, by default `ContinuumMechanics()`.
    integration : {"full", "reduced"}, default "full"
        Integration of the strain energy, see `Element`.

    Returns
    -------
    Element
        Element for `Beam`.

    References
    ----------
    Paper, section 4.

    Examples
    --------
    >>> element = bf.BilinearCRBF()
    >>> element.coordinates_per_node, element.integration
    (3, 'full')
    """
    return Element(Lagrange(1), Rotation(), _chosen(forces, ContinuumMechanics()), integration, "bilinear-CRBF")


@keywords_checked
def CRBF(order: int, forces: Forces | None = None, integration: Integration = "reduced") -> Element:
    """Return the CRBF element: field of any order in r and r_y with rotations as coordinates, 3 coordinates per node.

    Parameters
    ----------
    order : int
        Polynomial order of the field, 1 to 8.
    forces : ContinuumMechanics, SplitContinuum or Structural, optional
        Elastic forces, by default `Structural()`.
    integration : {"full", "reduced"}, default "reduced"
        Integration of the strain energy, see `Element`.

    Returns
    -------
    Element
        Element for `Beam`.

    Raises
    ------
    InputError
        For an order outside 1 to 8, or a combination that makes no sense.

    References
    ----------
    Suggested in the paper, section 4.

    Examples
    --------
    >>> element = bf.CRBF(order=3)
    >>> element.name, element.coordinates_per_node
    ('CRBF-3', 3)
    """
    return Element(Lagrange(order), Rotation(), _chosen(forces, Structural()), integration, f"CRBF-{order}")


@keywords_checked
def ShearRigid(
    stretchable: bool = True, forces: Forces | None = None, integration: Integration | None = None
) -> Element:
    """Return the shear-rigid element: cubic field without shear at its nodes, 4 or 3 coordinates per node.

    Full integration makes it 1.2 times too stiff in shear, and in stretch if the length of r_x is no coordinate;
    without that coordinate, as any cubic field with full integration.

    Parameters
    ----------
    stretchable : bool, default True
        Whether the length of r_x is a coordinate (4 coordinates per node) or not (3).
    forces : ContinuumMechanics, SplitContinuum, ElasticLine or Structural, optional
        Elastic forces, by default `Structural()`.
    integration : {"full", "reduced", "lobatto"}, optional
        Integration of the strain energy, see `Element`; by default "reduced" with continuum forces.

    Returns
    -------
    Element
        Element for `Beam`.

    References
    ----------
    Paper, sections 1.5 and 3.5.

    Examples
    --------
    >>> element = bf.ShearRigid(stretchable=False)
    >>> element.coordinates_per_node, element.integration
    (3, 'lobatto')
    """
    label = "shear-rigid-stretchable" if flag("stretchable", stretchable) else "shear-rigid"
    chosen = _chosen(forces, Structural())
    if integration is None and isinstance(chosen, ContinuumMechanics | SplitContinuum):
        integration = "reduced"
    return Element(Cubic(), ShearFree(stretchable), chosen, integration, label)


def _chosen(forces: Forces | None, usual: Forces) -> Forces:
    return usual if forces is None else forces
