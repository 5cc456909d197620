"""A column between two hinges: where it buckles, and how it goes on.

Prints the critical load over Euler's, and what the column bears once its ends have turned by an angle a, where the
elastica bears (2 K(sin a/2) / pi)^2 of Euler's load.
"""

import numpy as np

import beamfem as bf

section = bf.Rectangle(width=0.02, height=0.002)  # m
steel = bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
euler = np.pi**2 * steel.youngs_modulus * section.second_moment / 1.0**2  # N

beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements=8, element=bf.CRBF(order=4), section=section, material=steel)
supports = [bf.Pin(beam.start), bf.Roller(beam.end)]
model = bf.Model([beam], supports=supports, loads=[bf.PointForce(beam.end, (-euler, 0))])
print(f"buckles at {bf.solve_buckling(model, count=1).load_factors[0]:.6f} of Euler's load")

straight = bf.trace_equilibrium(model, until=1.1)
bent = bf.trace_equilibrium(
    model, until=lambda state: abs(state.rotation(beam.end)) > 1.0, start=straight.bifurcations[0]
)
angle = np.degrees(abs(bent.rotation(beam.end)[-1]))
print(f"turned by {angle:.4f} degrees it bears {bent.load_factor[-1]:.6f} of it")
bent.plot("out/examples/buckling.png")
