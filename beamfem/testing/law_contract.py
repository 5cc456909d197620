"""Check of a section law: analytic, with an energy, and determined by the committed history."""

from collections.abc import Callable

import numpy as np

from beamfem.material import Material
from beamfem.model.beam import require_shapes
from beamfem.section.law import COMPLEX_STEP, ConstitutiveLaw, law_of
from beamfem.section.protocol import CrossSection, Rigidity

_STEP = 1e-4  # of a sample: differences of fourth order are then accurate to about 1e-11
_AGREE = 1e-6  # of the largest entry of a stiffness
# irregular, so that a limit of a law, such as a yield limit, is unlikely to lie within a difference
_SAMPLES = np.array([[1.0, 0.7137, -0.4079], [-0.6173, 0.3119, 0.9161], [0.2143, -0.8171, 0.5087]])
_SIZES = (1e-5, 1e-3, 3e-2)  # strains of the outer fibre at which a law is checked
_TIMES = (0.0, 1e-3, 1.0)  # time steps [s] at which a law with history is checked


def check_law(section: CrossSection, material: Material | None = None) -> None:
    """Check that a user-defined section law is consistent, at arbitrary strains.

    Resultants are zero at zero strain and analytic: derivatives by complex steps are those by differences, and
    symmetric. They are the derivatives of the energy, and the stiffness at zero strain is the rigidity of the section.
    With history, a state determines its section forces, and it is elastic at the history that `remember` has just
    returned, see `RememberingLaw`. A law in C agrees with its `resultants`.

    Parameters
    ----------
    section : CrossSection
        Section with `resultants` and `energy`, see `SectionLaw` and `RememberingLaw`.
    material : Material, optional
        Material of the beam, passed to the section.

    Raises
    ------
    AssertionError
        If the law is inconsistent; the message names what is wrong.
    InputError
        If it returns arrays of another shape or numbers that are not finite.

    Examples
    --------
    >>> from beamfem.testing import check_law
    >>> class Softening(bf.Section):
    ...     def resultants(self, strain, material):
    ...         stiffness = self.rigidity(material)
    ...         return strain * [stiffness.axial, stiffness.shear, stiffness.bending]
    ...     def energy(self, strain, material):
    ...         return np.sum(strain * self.resultants(strain, material), axis=1)
    >>> try:
    ...     check_law(Softening(area=5e-3, second_moment=4e-6, height=0.1), steel)
    ... except AssertionError as error:
    ...     print(str(error).partition(" at strains")[0])
    energy of Softening does not belong to its resultants
    """
    law = law_of(section, material)
    if law is None:
        raise AssertionError(f"{type(section).__name__} has no resultants and energy: it is no section law")
    require_shapes(law)
    zero, start = np.zeros((1, 3)), law.at_start(1)
    if np.any(law.resultants(zero, start) != 0.0) or np.any(law.energy(zero, start) != 0.0):
        raise AssertionError(
            f"resultants and energy of {law.name} must be zero at zero strain: a beam is free of stress along its curve"
        )
    low, high = section.bounds
    lengths = np.array([1.0, 1.0, 2.0 / (high - low)])
    for size in _SIZES:
        for dt in _TIMES if law.remembers else _TIMES[:1]:
            _check_consistent(law, size * lengths * _SAMPLES, size * lengths, dt)
    _check_rigidity(law, section.rigidity(law.material), lengths)


def _check_consistent(law: ConstitutiveLaw, strain: np.ndarray, unit: np.ndarray, dt: float) -> None:
    """Compare complex steps, differences and energy of a law, before and after history is committed."""
    history = law.at_start(len(strain))
    forces, tangent = law.linearised(strain, history, dt)
    moved = law.resultants(strain.astype(complex), history, dt).imag
    whole, work = tangent * unit[:, None] * unit, forces * unit
    largest = np.abs(whole).max(initial=0.0)
    where = f"at strains such as {strain[0].tolist()}" + (f" after {dt:g} s" if law.remembers else "")
    if not np.isfinite(whole).all() or not np.isfinite(work).all() or np.any(moved != 0.0):
        raise AssertionError(f"resultants of {law.name} must be finite and real {where}")
    slopes = _slopes(lambda at: law.resultants(at, history, dt).real, strain, unit) * unit
    if not np.abs(np.moveaxis(slopes, 0, -1) - whole).max() <= _AGREE * largest:
        raise AssertionError(
            f"resultants of {law.name} are not analytic, or not symmetric, {where}: their derivatives by complex steps "
            f"and by differences disagree (abs, hypot, linalg.norm or conj lose complex steps)"
        )
    least = _AGREE * max(np.abs(work).max(), largest)
    if law.compiled is not None:
        in_c, tangent_in_c = law.linearised_in_c(strain, history, dt)
        close = np.abs(in_c * unit - work).max() <= least
        if not (close and np.abs(tangent_in_c * unit[:, None] * unit - whole).max() <= _AGREE * largest):
            raise AssertionError(f"the C function of {law.name} is not that of its resultants {where}")
    if law.remembers:
        history = law.remember(strain, history, dt)
        again, elastic = law.linearised(strain, history)
        if not np.abs((again - forces) * unit).max() <= least:
            raise AssertionError(
                f"resultants of {law.name} change {where} when history is committed: with the history that remember "
                f"returns and dt = 0 they must be those of the step"
            )
    if dt > 0.0:
        return
    if not np.abs(_force(law, strain, history, unit) - work).max() <= least:
        raise AssertionError(
            f"energy of {law.name} does not belong to its resultants {where}: they must be its derivatives by stretch, "
            f"shear and curvature"
        )
    if law.remembers:
        second = np.moveaxis(_slopes(lambda at: _force(law, at, history, unit), strain, unit), 0, -1)
        if not np.abs(second - elastic * unit[:, None] * unit).max() <= _AGREE * largest:
            raise AssertionError(
                f"{law.name} is not elastic {where} at the history that remember has just returned: the tangent there "
                f"must be the second derivative of the stored energy. Let a step yield beyond a limit with a tolerance "
                f"only, such as 1e-9 of it, so that round-off decides nothing"
            )


def _force(law: ConstitutiveLaw, strain: np.ndarray, history: np.ndarray, unit: np.ndarray) -> np.ndarray:
    """Return the derivatives (n, 3) of the stored energy for a history, times the unit of each strain."""
    steps = 1j * COMPLEX_STEP * np.diag(unit)
    columns = [law.energy(strain + step, history)[:, 0].imag / COMPLEX_STEP for step in steps]
    return np.stack(columns, axis=-1)


def _slopes(function: Callable[[np.ndarray], np.ndarray], at: np.ndarray, unit: np.ndarray) -> np.ndarray:
    """Return the derivatives (3, n, ...) by each strain, times its unit, by differences of fourth order."""
    slopes = []
    for step in _STEP * np.diag(unit):
        near = function(at + step) - function(at - step)
        far = function(at + 2.0 * step) - function(at - 2.0 * step)
        slopes.append((8.0 * near - far) / (12.0 * _STEP))
    return np.array(slopes)


def _check_rigidity(law: ConstitutiveLaw, rigidity: Rigidity, lengths: np.ndarray) -> None:
    """Raise AssertionError if the stiffness of a law at zero strain is not the rigidity of its section."""
    stiffness = np.diag([rigidity.axial, rigidity.shear, rigidity.bending])
    stiffness[0, 2] = stiffness[2, 0] = rigidity.coupling
    units = lengths[:, None] * lengths
    if np.abs((law.stiffness - stiffness) * units).max() > _AGREE * np.abs(stiffness * units).max():
        raise AssertionError(
            f"the law of {law.name} begins with the stiffness {law.stiffness.tolist()}, but its rigidity is "
            f"{stiffness.tolist()}: rigidity(material) must be the stiffness at zero strain"
        )
