"""The named elements: combinations of the paper, and fields of any order with rotations."""

from beamfem.element.coordinates import Gradients, Rotation, ShearFree
from beamfem.element.element import Element, Integration
from beamfem.element.fields import Cubic, Lagrange
from beamfem.element.forces import ContinuumMechanics, Forces, SplitContinuum, Structural
from beamfem.validation import flag


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
