"""A cantilever under a tip force that bends it by most of its length.

Prints the tip's displacement, the clamp's reaction and the largest moment; Reissner's beam moves its tip by
(-0.387644, 0.713859) m.
"""

import beamfem as bf

section = bf.Rectangle(width=0.01, height=0.01)  # m
steel = bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
force = 5.0 * steel.youngs_modulus * section.second_moment / 1.0**2  # N: P L^2 / (E I) = 5

beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements=4, element=bf.CRBF(order=4), section=section, material=steel)
model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0, force))])
solution = bf.solve_static(model)

print("tip moves by", solution.displacement(beam.end)[-1].round(6), "m")
print("reaction fx, fy, m:", solution.reaction(beam.start)[-1].round(2), "N, N, N m")
print(f"largest moment {solution.section_forces(beam).moment[-1].max():.2f} N m")
solution.plot("out/examples/cantilever.png", colour="moment")
