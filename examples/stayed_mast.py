"""A mast between two guys with a mass on its top: how it sways, and what the guys carry in the wind.

Prints the sway frequency, and the tensions of the guys under a force of the wind. Writes a picture.
"""

import numpy as np

import beamfem as bf

aluminium = bf.Material(youngs_modulus=7e10, poisson_ratio=0.33, density=2700.0)
section = bf.Tube(diameter=0.06, thickness=0.003)  # m
mast = bf.Beam(bf.Line((0, 0), (0, 6)), elements=6, element=bf.CRBF(order=3), section=section, material=aluminium)
guys = [bf.Cable(mast.end, (x, 0.0), stiffness=1.5e4, pretension=400.0) for x in (-4.5, 4.5)]
head = bf.PointMass(mast.end, mass=300.0)  # kg
wind = bf.PointForce(mast.end, (150.0, 0.0))  # N
model = bf.Model([mast], supports=[bf.Clamp(mast.start)], loads=[wind], connectors=guys, masses=[head])

calm = model.with_loads([])
frequency = bf.solve_modes(calm, count=1, about=bf.solve_static(calm)[-1]).frequencies[0]
print(f"sways at {frequency:.4f} Hz")
solution = bf.solve_static(model)
tensions = [np.hypot(*solution.connector_force(guy)[-1, 0, :2]) for guy in guys]
print(f"tensions in the wind {tensions[0]:.2f} and {tensions[1]:.2f} N")
solution.plot("out/examples/stayed_mast.png")
