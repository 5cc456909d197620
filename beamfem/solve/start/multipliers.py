"""Analyses that cannot take unknowns without stiffness or mass."""

from beamfem.assembly.system import System
from beamfem.errors import InputError


def refuse_multipliers(system: System, analysis: str) -> None:
    """Raise InputError where a connector brings along unknowns of its own."""
    for item in system.connectors.items:
        if len(item.own):
            raise InputError(
                f"{analysis} takes no connectors with unknowns of their own, which {item.name} has; solve_static does. "
                "A stiff spring in its place has none"
            )
