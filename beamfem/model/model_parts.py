"""Parts of a model by the base classes that tell how they enter the equations."""

from collections.abc import Sequence

from beamfem.model.body_load import BodyLoad
from beamfem.model.line_load import LineLoad
from beamfem.model.load import Load
from beamfem.model.point_load import PointLoad
from beamfem.model.support import LineSupport, PointSupport, Support
from beamfem.model.supports_along import SupportsAlong
from beamfem.once import cached_property


class ModelParts:
    """Base class of `Model` with its supports and loads by base class."""

    supports: Sequence[Support]
    loads: Sequence[Load]

    @cached_property
    def gravity(self) -> tuple[BodyLoad, ...]:
        """The loads that are accelerations of all mass."""
        return tuple(load for load in self.loads if isinstance(load, BodyLoad))

    @cached_property
    def line_loads(self) -> tuple[LineLoad, ...]:
        """The loads that are forces along beams."""
        return tuple(load for load in self.loads if isinstance(load, LineLoad))

    @cached_property
    def point_loads(self) -> tuple[PointLoad, ...]:
        """The loads that are forces and moments at points."""
        return tuple(load for load in self.loads if isinstance(load, PointLoad))

    @cached_property
    def point_supports(self) -> tuple[PointSupport, ...]:
        """The supports at points."""
        return tuple(support for support in self.supports if isinstance(support, PointSupport))

    @cached_property
    def supports_along(self) -> SupportsAlong:
        """The supports at points in the order of their beams' fractions."""
        return SupportsAlong(self.point_supports)

    @cached_property
    def line_supports(self) -> tuple[LineSupport, ...]:
        """The supports along beams."""
        return tuple(support for support in self.supports if isinstance(support, LineSupport))
