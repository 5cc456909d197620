"""A warning of beams whose sections define no stress."""

from collections.abc import Sequence

from beamfem.errors import UnknownStressWarning, warn
from beamfem.model.beam import Beam
from beamfem.model.beam_names import names

_NAMED = 10  # beams that the warning names


def warn_of_unknown_stress(beams: Sequence[Beam], unknown: Sequence[int], what: str) -> None:
    """Warn of beams by their numbers, if there are any; what: what becomes of their stress, such as "left out"."""
    if not unknown:
        return
    called = names(beams)
    shown = ", ".join(called[number] for number in unknown[:_NAMED]) + (", ..." if len(unknown) > _NAMED else "")
    warn(
        f"the stress of {len(unknown)} of {len(beams)} beams ({shown}) is not known and is {what}: their sections are "
        "given by a stiffness, a law of their own, or moments without a height; Section(..., height=) gives it",
        UnknownStressWarning,
    )
