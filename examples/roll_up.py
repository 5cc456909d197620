"""A strip that a moment at its end rolls up into two full circles.

Prints where the end is; M = 4 pi E I / L brings it back to the clamp exactly.
"""

import numpy as np

import beamfem as bf

strip = bf.Rectangle(width=0.02, height=0.001)  # m
steel = bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
moment = 4 * np.pi * steel.youngs_modulus * strip.second_moment / 1.0  # N m

beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements=16, element=bf.CRBF(order=4), section=strip, material=steel)
model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointMoment(beam.end, moment)])
solution = bf.solve_static(model, at=[0.0, 0.125, 0.25, 0.5, 1.0])

print("end at", solution.position(beam.end)[-1].round(6) + 0.0, "m")
print(f"turned by {solution.rotation(beam.end)[-1] / (2 * np.pi):.6f} turns")
solution.plot("out/examples/roll_up.png", shapes=5)
