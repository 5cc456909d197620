"""A flexible pendulum falls for a second; an animation, a file for ParaView and a file to go on with.

Prints the tip at half a second and what the total energy, 0 at first, has changed by. The pendulum is a classic of the
literature, with a linear law up to strains of 0.26, beyond which rubber is not linear.
"""

import warnings

import beamfem as bf

warnings.simplefilter("ignore", bf.LargeStrainWarning)

rubber = bf.Material(youngs_modulus=0.7e6, poisson_ratio=0.3, density=5540.0)
section = bf.Section(area=1.6e-3, second_moment=8.533e-6, height=0.253)  # m^2, m^4, m
arm = bf.Beam(bf.Line((0, 0), (1.2, 0)), elements=6, element=bf.CRBF(order=4), section=section, material=rubber)
model = bf.Model([arm], supports=[bf.Pin(arm.start)], loads=[bf.Gravity((0, -9.81))])
motion = bf.simulate(model, duration=1.0, step=5e-4, save_every=40)  # 51 states, one every 20 ms

print("tip at 0.5 s", motion.position(arm.end)[25].round(4), "m")
energy = motion.energy()
print(f"of {energy.kinetic.max():.2f} J at most the total changes by {abs(energy.total).max():.0e} J")
motion.animate("out/examples/pendulum.gif", seconds=2.0, fps=12)
motion.to_vtk("out/examples/pendulum.vtkhdf")  # one file; ParaView before 5.12 reads pendulum.pvd
motion.save("out/examples/pendulum.h5")  # bf.load("out/examples/pendulum.h5") gives it back
