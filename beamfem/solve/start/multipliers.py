"""Analyses that cannot take unknowns without stiffness or mass, or forces against velocities."""

from beamfem.assembly.connector_checks import resists_rates
from beamfem.assembly.system import System
from beamfem.errors import InputError


def refuse_multipliers(system: System, analysis: str) -> None:
    """Raise InputError where a connector brings along unknowns of its own."""
    for item in system.connectors.items:
        if len(item.own):
            raise InputError(
                f"{analysis} takes no connectors with unknowns of their own, which {item.name} has; solve_static "
                "and simulate do. A stiff spring in its place has none"
            )


def refuse_dampers(system: System) -> None:
    """Raise InputError where the force of a connector depends on velocities, which free vibrations leave out."""
    for item in system.connectors.items:
        if resists_rates(item):
            raise InputError(
                f"solve_modes finds undamped vibrations, but the force of {item.name} depends on velocities; leave it "
                "out, or let simulate show how the motion decays"
            )
