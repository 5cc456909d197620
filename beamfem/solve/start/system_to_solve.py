"""The system of a model that is to be solved."""

from beamfem.assembly.system import System, system_of
from beamfem.model.made_of import require_unchanged
from beamfem.model.model import Model


def system_to_solve(model: Model, static: bool) -> System:
    """Return the system of a model, whose tables are kept. Raises InputError if what it was made of has changed."""
    system = system_of(model, static)
    require_unchanged(model)
    return system
