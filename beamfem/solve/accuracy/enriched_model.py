"""A model on an enriched space: elements of a higher order, or halved ones, under the same supports and loads."""

from dataclasses import dataclass, fields, replace
from itertools import chain

import numpy as np

from beamfem.cached_properties import cached_property
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

    The parts at points and along beams are those of the model itself, so that results are found by them.
    """
    beams = tuple(_enriched(mesh) for mesh in model.meshes)
    original = getattr(model, "original", ()) or tuple(model.beams)
    parts = {field.name: getattr(model, field.name) for field in fields(Model) if field.name not in ("beams", "units")}
    return EnrichedModel(beams, **parts, original=original)


def _enriched(mesh: BeamMesh) -> Beam:
    beam = mesh.beam
    field = beam.element.field
    if type(field) is Lagrange and field.order <= _RAISED:
        finer = replace(beam.element, field=Lagrange(field.order + 1), label=None)
        return replace(beam, element=finer)
    along = mesh.arc_length(np.arange(mesh.elements), np.full(mesh.elements, 0.5))
    ends = np.sort(np.concatenate([mesh.vertices, along])) / mesh.vertices[-1]
    return replace(beam, elements=tuple(ends.tolist()))
