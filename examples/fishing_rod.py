"""A fishing rod, bent by a weight that is let go.

Prints how far the weight bends it, the energy it stores, and what the total energy has changed by after a second.
"""

import beamfem as bf

carbon = bf.Material(youngs_modulus=9e10, poisson_ratio=0.3, density=1600.0)
rod = bf.Beam(
    bf.Line((0, 0), (2.5, 0)), elements=8, element=bf.CRBF(order=4), section=bf.Circle(0.008), material=carbon
)
loaded = bf.Model([rod], [bf.Clamp(rod.start)], [bf.PointForce(rod.end, (0.0, -8.0))])
bent, free = bf.solve_static(loaded), loaded.with_loads([])
motion = bf.simulate(free, duration=1.0, step=1e-3, start=bent[-1], save_every=5)

energy = motion.energy()
print("tip moves by", bent.displacement(rod.end)[-1].round(5), "m")
print(f"stored {energy.strain[0]:.5f} J")
print(f"the total changes by {abs(energy.total - energy.total[0]).max() / energy.total[0]:.0e} of it")
motion[:60].plot("out/examples/fishing_rod.png", shapes=13)
