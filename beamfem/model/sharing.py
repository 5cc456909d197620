"""Data that a model made by `with_loads` or `with_` shares with its original."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from beamfem.model.load_base import Load
    from beamfem.model.model import Model


def share(old: "Model", new: "Model") -> None:
    """Give a new model the meshes of an old one if their nodes are the same, and its tables if sizes of loads differ.

    Both have the same beams and joints.
    """
    same = all(map(_same, (old.supports, old.at_points, _layouts(old)), (new.supports, new.at_points, _layouts(new))))
    if same or old.nodes_needed == new.nodes_needed:
        vars(new)["numbered"] = old.numbered
    # the stiffness of a connector may depend on gravity
    if same and (not new.at_points or _same(old.gravity, new.gravity)):
        vars(new)["tables"] = old.tables


def _layouts(model: "Model") -> list[Any]:
    """Return the loads of a model without their sizes, see `Load.layout`."""
    return [layout for layout in map(_layout, model.loads) if layout is not None]


def _layout(load: "Load") -> Any:
    return load.layout


def _same(one: Any, other: Any) -> bool:
    """Return whether two sequences hold the same objects, or equal points and flags of loads."""
    return len(one) == len(other) and all(
        a is b or (type(a) is tuple and a == b) for a, b in zip(one, other, strict=True)
    )
