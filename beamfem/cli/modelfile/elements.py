"""Elements of a model file: presets, and combinations of a field, coordinates and forces."""

from typing import Any

from beamfem.cli.modelfile.named import Named
from beamfem.cli.modelfile.own_parts import build_own_or_kind
from beamfem.cli.modelfile.table import Kinds, Reader, Table, build_kind
from beamfem.element.coordinates import Gradients, Rotation, ShearFree
from beamfem.element.element import Element
from beamfem.element.fields import Cubic, Lagrange
from beamfem.element.forces import ContinuumMechanics, ElasticLine, Forces, SplitContinuum, Structural
from beamfem.element.presets import ANCF, ANCFCRBF, CRBF, BilinearANCF, BilinearCRBF, ShearRigid


def _continuum(plane_stress: bool = False) -> Forces:
    return ContinuumMechanics(plane_stress)


def _split() -> Forces:
    return SplitContinuum()


def _elastic_line() -> Forces:
    return ElasticLine()


def _structural() -> Forces:
    return Structural()


def _cubic() -> Cubic:
    return Cubic()


FORCES: Kinds = {
    "continuum": _continuum,
    "split-continuum": _split,
    "elastic-line": _elastic_line,
    "structural": _structural,
}
FIELDS: Kinds = {"cubic": _cubic, "lagrange": Lagrange}
COORDINATES: Kinds = {"gradients": Gradients, "rotation": Rotation, "shear-free": ShearFree}
PRESETS: Kinds = {kind.__name__: kind for kind in (ANCF, ANCFCRBF, BilinearANCF, BilinearCRBF, CRBF, ShearRigid)}
ELEMENTS: Kinds = {**PRESETS, "Element": Element}
_NEED_MORE = ("CRBF", "Element")


def elements(root: Table) -> Named:
    """Return the elements of a file; presets need no entry of their own."""

    def named(what: str, kinds: Kinds) -> Named:
        return Named(what, {}, {}, lambda table: build_own_or_kind(table, kinds, {}, {}), kinds, tuple(kinds))

    readers: dict[str, Reader] = {
        "forces": named("kind of forces", FORCES),
        "field": named("kind of field", FIELDS),
        "coordinates": named("kind of coordinates", COORDINATES),
    }

    def make(table: Table) -> Any:
        return build_kind(table, ELEMENTS, readers)

    short = tuple(name for name in ELEMENTS if name not in _NEED_MORE)
    return Named("element", root.named("elements"), {}, make, ELEMENTS, short)
