"""A model on an enriched space: elements of a higher order, or halved ones, under the same supports and loads."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import chain
from typing import cast

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element.element import Element
from beamfem.element.fields import Lagrange
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Beam
from beamfem.model.model import Model

# halved elements of order k have an error of about 2^-2k of the others, for the same cost as those of order k + 1
_RAISED = 2  # orders up to this one are raised


@dataclass(frozen=True, eq=False, repr=False)
class EnrichedModel(Model):
    """A model with other meshes than its original, which takes points and beams of either of them.

    Parameters
    ----------
    original : tuple of Beam
        The beam that each of `beams` stands for; supports, loads, joints and connectors are on these.
    """

    original: tuple[Beam, ...] = ()

    @cached_property
    def _numbers(self) -> dict[int, int]:
        numbered = chain(enumerate(self.beams), enumerate(self.original))
        return {id(beam): number for number, beam in numbered}


def enriched(model: Model) -> EnrichedModel:
    """Return a model whose elements are of order k + 1 instead of k = 1 or 2, and halves of other ones.

    Those of models that `Model.with_loads` has made share their meshes and tables as these do.
    """
    known: EnrichedModel | None = model.tables.get("enriched")
    if known is None:
        known = model.tables["enriched"] = remeshed(model, [_enriched(mesh) for mesh in model.meshes])
    return known if known.loads == model.loads else cast(EnrichedModel, known.with_loads(model.loads))


def remeshed(model: Model, beams: Sequence[Beam]) -> EnrichedModel:
    """Return a model with other elements on the same curves.

    The parts at points and along beams are those of the model itself, so that results are found by them.
    """
    original = getattr(model, "original", ()) or tuple(model.beams)
    parts = {field.name: getattr(model, field.name) for field in fields(Model) if field.name not in ("beams", "units")}
    result = EnrichedModel(beams, **parts, original=original)
    vars(result)["units"] = model.units  # of which the model has warned
    return result


def _enriched(mesh: BeamMesh) -> Beam:
    beam = mesh.beam
    field = beam.element.field
    if type(field) is Lagrange and field.order <= _RAISED:
        return replace(beam, element=of_order(beam.element, field.order + 1))
    along = mesh.arc_length(np.arange(mesh.elements), np.full(mesh.elements, 0.5))
    ends = np.sort(np.concatenate([mesh.vertices, along])) / mesh.vertices[-1]
    return replace(beam, elements=tuple(ends.tolist()))


def of_order(element: Element, order: int) -> Element:
    """Return an element with a Lagrange field of another order, and the name of a `CRBF` of this order if it is one."""
    named = element.label == f"CRBF-{element.field.degree}"
    return replace(element, field=Lagrange(order), label=f"CRBF-{order}" if named else None)
