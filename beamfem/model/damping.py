"""The retardation time of a beam: the stress per strain rate, relative to the stiffness."""

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section.protocol import CrossSection


def retardation_time(section: CrossSection, material: Material | None) -> float:
    """Return the retardation time [s] of a section; material: that of its beam, which layered sections do not need.

    Raises InputError if layers have different ones.
    """
    try:
        times = {part_material.retardation_time for part_material, _ in section.moments(material)}
    except InputError:  # known by its stiffness
        return 0.0 if material is None else material.retardation_time
    if len(times) > 1:
        raise InputError(
            f"the materials of a {type(section).__name__} section have different retardation times {sorted(times)}; "
            "a beam has one: damping is proportional to its stiffness"
        )
    return times.pop()
