"""An element: a field, nodal coordinates and elastic forces; the named ones of the paper, and those of any order."""

from collections.abc import Hashable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element import lobatto
from beamfem.element.coordinates import Coordinates, Gradients, Rotation, ShearFree, labels
from beamfem.element.fields import Cubic, Field, Lagrange, Tables, require_field, tables_of
from beamfem.element.forces import ContinuumMechanics, ElasticLine, Forces, SplitContinuum, Structural
from beamfem.errors import InputError
from beamfem.kernels import block
from beamfem.quadrature import gauss
from beamfem.validation import flag, of_package, one_of, optional, shown, text
from beamfem.value_keys import by_value

Integration = Literal["full", "reduced", "lobatto"]
STRAINS = 3  # of a nonlinear section law: stretch, shear and curvature, which precede other measures


@dataclass(frozen=True)
class Element:
    """A beam element: a field, its nodal coordinates and the elastic forces.

    Raises InputError for an invalid combination, or a field of your own whose shape functions do not interpolate its
    nodal values, or do not represent rigid motions and a constant stretch.

    Parameters
    ----------
    field : Cubic, Lagrange or Field
        Field basis; one of your own has the members of `beamfem.element.fields.Field`.
    coordinates : Gradients, Rotation or ShearFree
        Nodal coordinates.
    forces : ContinuumMechanics, SplitContinuum, ElasticLine or Structural
        Elastic forces.
    integration : {"full", "reduced", "lobatto"}, optional
        "full" integrates the energy of a straight element exactly. "reduced" uses as many Gauss points as the order of
        the field, and 2 if its nodes have no shear (3 for all strains but shear, with a stretch coordinate). "lobatto"
        evaluates strains of the cubic field at its nodes and midpoint, which avoids locking at any slenderness. The
        default is "lobatto" for the cubic field with structural forces or the elastic line, and "full" otherwise.
    label : str, optional
        Name for legends and files.

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
        for name, kind, codes in (
            ("coordinates", Coordinates, block.COORDINATES),
            ("forces", Forces, block.MEASURES),
        ):
            part = getattr(self, name)
            if not isinstance(part, kind):
                raise InputError(f"{name} of an element must be one of {kind}, got {shown(part)}")
            if part.code not in codes:
                raise InputError(
                    f"{name} of an element: code of {type(part).__name__} is {shown(part.code)}, but compiled code "
                    f"supports only {', '.join(map(str, codes))}"
                )
        require_field(self.field)
        has_slope = "r_x" in self.field.vectors
        if self.integration is None:
            free_of_locking = has_stations(self.field) and lobatto.is_default(self.forces)
            object.__setattr__(self, "integration", "lobatto" if free_of_locking else "full")
        if self.integration == "lobatto" and not has_stations(self.field):
            raise InputError(
                f'integration="lobatto" is for the cubic field, whose two nodes have r_x; on the {self.field.name} '
                'field "reduced" with structural forces does not lock'
            )
        if self.integration == "lobatto" and not lobatto.knows(self.forces):
            raise InputError(
                f'integration="lobatto" has no rule for the strain measures of {type(self.forces).__name__}: it is for '
                'those of Structural, ElasticLine and the continuum forces; use "full" or "reduced"'
            )
        if isinstance(self.coordinates, ShearFree) and not has_slope:
            raise InputError(
                f"coordinates without shear tie r_x to the angle of a node, but the {self.field.name} field has no r_x "
                "there; the cubic field has"
            )
        if isinstance(self.forces, ElasticLine) and not has_slope:
            raise InputError(
                f"the elastic line takes its curvature from r_xx, which the {self.field.name} field does not have "
                "across elements",
                remedy="use the cubic field, or Structural forces",
            )

    def __eq__(self, other: object) -> bool:
        return self._compared == other._compared if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._compared)

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields only: copies make their own tables."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    @cached_property
    def _compared(self) -> tuple[Hashable, ...]:
        # classes derived by users may have data that the base classes do not compare
        parts: tuple[Any, ...] = self.field, self.coordinates, self.forces
        keys = (part if of_package(type(part)) else by_value(part) for part in parts)
        return *keys, self.integration, self.label

    @property
    def name(self) -> str:
        """Name for legends and files: the given label, or those of field and coordinates."""
        return self.label or f"{self.field.name}-{self.coordinates.name}"

    @property
    def coordinates_per_node(self) -> int:
        """Number of coordinates of a node."""
        return len(labels(self.coordinates.code, self.field.vectors))

    def quadrature(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the Gauss points (nq,) and weights (nq,) on [0, 1] where section forces are evaluated."""
        if self.integration == "lobatto":
            return gauss(len(lobatto.STATIONS))
        reduced = 2 if isinstance(self.coordinates, ShearFree) else self.field.degree
        full = self.forces.points(self.field.degree, self.field.director_degree)
        return gauss(reduced if self.integration == "reduced" else full)

    def energy_points(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the points (nq,) and weights (nq,) on [0, 1] at which the strain energy is integrated."""
        return self._energy_points

    @cached_property
    def _energy_points(self) -> tuple[np.ndarray, np.ndarray]:
        if self.integration == "lobatto":
            return lobatto.energy_points(self.forces)
        rules = self.energy_rules()
        return np.concatenate([rule[0] for rule in rules]), np.concatenate([rule[1] for rule in rules])

    @cached_property
    def without_locking(self) -> "Element":
        """The element with an integration rule that avoids locking."""
        return replace(self, integration="lobatto" if has_stations(self.field) else "reduced")

    @cached_property
    def tables(self) -> Tables:
        """Shape functions at the points that integrate energy and mass."""
        return tables_of(self.field, self._energy_points[0])

    def energy_stiffness(self, stiffness: np.ndarray, jacobian: np.ndarray) -> np.ndarray:
        """Return the part (ne, nq, ns, ns) of the section stiffness that counts at the points of the strain energy.

        It is zero for strain measures that are not integrated at a point; the rules of "lobatto" also change the
        weights of others. jacobian (ne, nq) [m]: length of the reference axis per unit of xi.
        """
        if self.integration == "lobatto":
            return lobatto.energy_stiffness(self.forces, self.coordinates, stiffness, jacobian)
        return stiffness if self._counted is None else stiffness * self._counted

    @cached_property
    def _counted(self) -> np.ndarray | None:
        """Mask (nq, ns, ns) of the stiffness entries that enter the energy at its points, None if all do."""
        counted = np.concatenate([np.tile(rule[2], (len(rule[0]), 1)) for rule in self.energy_rules()])
        return None if counted.all() else counted[:, :, None] & counted[:, None, :]

    @cached_property
    def coupled_fractions(self) -> np.ndarray:
        """Fractions (nq, ns, ns) of a stiffness that couples all strains in the energy at its points."""
        points, measures = len(self._energy_points[0]), len(self.forces.shear_measures)
        return self.energy_stiffness(np.ones((1, points, measures, measures)), np.ones((1, points)))[0]

    @cached_property
    def law_points(self) -> int:
        """Number of points (the first ones) where a law is evaluated; 0 if strains are integrated at different ones."""
        block = self.coupled_fractions[:, :STRAINS, :STRAINS]
        count = int(block.any(axis=(1, 2)).sum())
        full = np.zeros_like(block)
        full[:count] = 1.0
        return count if np.array_equal(block, full) else 0

    def energy_rules(self) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]:
        """Return the points and weights on [0, 1] and the mask of strain measures (ns,) of each quadrature rule.

        There is one rule if all measures share it. With 2 points for all measures, a stretch coordinate has a
        zero-energy mode: r_x + c at every node does not change r0' at these points. All measures but shear therefore
        use 3. A pure thickness strain is evaluated at the nodes of d: between them |d| is below 1 wherever the beam
        bends, which would cause locking of thin beams.
        """
        forces = self.forces
        shear, thickness = np.array(forces.shear_measures), np.array(forces.thickness_measures)
        if self.integration == "reduced" and self.coordinates == ShearFree(stretchable=True):
            return (*gauss(2), shear), (*gauss(3), ~shear)
        if isinstance(self.coordinates, Gradients) and thickness.any():
            return (*self.quadrature(), ~thickness), (*self.field.director_rule(), thickness)
        return ((*self.quadrature(), np.ones_like(shear)),)


def has_stations(field: Field) -> bool:
    """Return whether the strains at the Lobatto points of the cubic field determine a field, and do not lock."""
    return type(field) is Cubic or ("r_x" in field.vectors and len(field.nodes) == 2 and field.degree == 3)


def ANCF(forces: Forces | None = None, integration: Integration | None = None) -> Element:
    """Return the ANCF element: cubic field with gradients as coordinates, 6 coordinates per node.

    Source: Omar and Shabana 2001.

    Parameters
    ----------
    forces, integration : optional
        Elastic forces, by default `ContinuumMechanics()`, and integration of the strain energy, see `Element`.

    Examples
    --------
    >>> element = bf.ANCF(bf.Structural())
    >>> element.coordinates_per_node, element.integration
    (6, 'lobatto')
    """
    return Element(Cubic(), Gradients(), _chosen(forces, ContinuumMechanics()), integration, "ANCF")


def ANCFCRBF(forces: Forces | None = None, integration: Integration | None = None) -> Element:
    """Return the ANCF-CRBF element: cubic field with rotations as coordinates, 5 coordinates per node.

    Source: paper, section 3.

    Parameters
    ----------
    forces, integration : optional
        Elastic forces, by default `ContinuumMechanics()`, and integration of the strain energy, see `Element`.

    Examples
    --------
    >>> element = bf.ANCFCRBF()
    >>> element.coordinates_per_node, element.integration
    (5, 'full')
    """
    return Element(Cubic(), Rotation(), _chosen(forces, ContinuumMechanics()), integration, "ANCF-CRBF")


def BilinearANCF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Return the bilinear ANCF element: bilinear field with gradients as coordinates, 4 coordinates per node.

    Source: paper, eqs. (8) to (10).

    Parameters
    ----------
    forces, integration : optional
        Elastic forces, by default `ContinuumMechanics()`, and integration of the strain energy, see `Element`.

    Examples
    --------
    >>> element = bf.BilinearANCF()
    >>> element.coordinates_per_node, element.integration
    (4, 'full')
    """
    return Element(Lagrange(1), Gradients(), _chosen(forces, ContinuumMechanics()), integration, "bilinear-ANCF")


def BilinearCRBF(forces: Forces | None = None, integration: Integration = "full") -> Element:
    """Return the bilinear CRBF element: bilinear field with rotations as coordinates, 3 coordinates per node.

    Source: paper, section 4.

    Parameters
    ----------
    forces, integration : optional
        Elastic forces, by default `ContinuumMechanics()`, and integration of the strain energy, see `Element`.

    Examples
    --------
    >>> element = bf.BilinearCRBF()
    >>> element.coordinates_per_node, element.integration
    (3, 'full')
    """
    return Element(Lagrange(1), Rotation(), _chosen(forces, ContinuumMechanics()), integration, "bilinear-CRBF")


def CRBF(order: int, forces: Forces | None = None, integration: Integration = "reduced") -> Element:
    """Return the CRBF element: field of any order in r and r_y with rotations as coordinates, 3 coordinates per node.

    Raises InputError for an order outside 1 to 8, or an invalid combination. Suggested in the paper, section 4.

    Parameters
    ----------
    order : int
        Polynomial order of the field, 1 to 8.
    forces, integration : optional
        Elastic forces, by default `Structural()`, and integration of the strain energy, see `Element`.

    Examples
    --------
    >>> element = bf.CRBF(order=3)
    >>> element.name, element.coordinates_per_node
    ('CRBF-3', 3)
    """
    return Element(Lagrange(order), Rotation(), _chosen(forces, Structural()), integration, f"CRBF-{order}")


def ShearRigid(
    stretchable: bool = True, forces: Forces | None = None, integration: Integration | None = None
) -> Element:
    """Return the shear-rigid element: cubic field without shear at its nodes, 4 or 3 coordinates per node.

    Full integration makes it 1.2 times too stiff in shear, and also in stretch if the length of r_x is not a
    coordinate. Source: paper, sections 1.5 and 3.5.

    Parameters
    ----------
    stretchable : bool, default True
        Whether the length of r_x is a coordinate (4 coordinates per node) or not (3).
    forces, integration : optional
        Elastic forces, by default `Structural()`, and integration of the strain energy, see `Element`; by default
        "reduced" with continuum forces.

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
