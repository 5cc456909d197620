"""A bimetal strip, steel on brass, is heated by 100 K.

Prints its radius of curvature; Timoshenko (1925) has one for strips of two layers.
"""

import beamfem as bf

brass = bf.Material(youngs_modulus=1.05e11, poisson_ratio=0.34, density=8500.0, thermal_expansion=19e-6)
steel = bf.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0, thermal_expansion=12e-6)
section = bf.Layered([bf.Layer(brass, 0.5e-3), bf.Layer(steel, 0.5e-3)], width=0.01)  # from the bottom up

strip = bf.Beam(bf.Line((0, 0), (0.1, 0)), elements=4, element=bf.CRBF(order=4), section=section)
model = bf.Model([strip], supports=[bf.Clamp(strip.start)], loads=[bf.Temperature(strip, change=100.0)])
solution = bf.solve_static(model)

print(f"radius {0.1 / solution.rotation(strip.end)[-1]:.5f} m")
print(f"end moves by {1e3 * solution.displacement(strip.end)[-1, 1]:.4f} mm")
solution.plot("out/examples/thermostat.png")
