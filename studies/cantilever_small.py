"""The cantilever of the paper, section 3.4, with continuum forces: P = 10 N, L = 1 m, square of 0.01 m, E = 2e11 Pa.

The beam converges to its own limit (stationary energy of the same continuum, to 12 digits, independent of elements),
not to P L^3 / (3 E I), because the transverse strain cannot vary over the height.
"""

import beamfem as bf

LIMITS = {False: 0.01485507106598, True: 0.01819510330389}  # tip deflection [m]; 3D lambda, plane-stress lambda
PRINTED = 1.9908e-2  # the paper's "analytical" deflection [m]


def deflection(element: bf.Element, elements: int) -> float:
    """Return the tip deflection [m]."""
    beam = bf.Beam(
        bf.Line((0.0, 0.0), (1.0, 0.0)),
        elements,
        element,
        bf.Rectangle(width=0.01, height=0.01),
        bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0),
    )
    model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0.0, 10.0))])
    return float(bf.solve_static(model).displacement(beam.end)[-1, 1])


def linear() -> float:
    """Return P L^3 / (3 E I) [m] with the printed data."""
    return 10.0 / (3.0 * 2e11 * 0.01**4 / 12.0)


def main(meshes: tuple[int, ...] = (3, 6, 12, 24, 48, 96)) -> dict[tuple[str, bool], list[float]]:
    """Return the deflections [m] over the meshes for each element name and plane-stress flag."""
    return {
        (make().name, flag): [deflection(make(forces=bf.ContinuumMechanics(flag)), count) for count in meshes]
        for make in (bf.ANCF, bf.ANCFCRBF, bf.BilinearCRBF)
        for flag in LIMITS
    }


if __name__ == "__main__":
    print(f"P L^3 / (3 E I) = {linear():.4e} m; the paper prints {PRINTED:.4e} m")
    for (name, flag), values in main().items():
        kind = "plane stress" if flag else "3D"
        print(f"{name:14s} {kind:12s}", *(f"{value:.6e}" for value in values), f" limit {LIMITS[flag]:.6e} m")
