"""The first natural frequencies of a simply supported beam, and its modes as a picture.

Timoshenko's beam on two hinges has sine modes, so that its frequencies are known in closed form; here
0.4 to 4 % below Euler and Bernoulli's n^2 pi / (2 L^2) sqrt(E I / (rho A)).
"""

import numpy as np

import beamfem as bf

section = bf.Rectangle(width=0.05, height=0.05)  # m
steel = bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements=8, element=bf.CRBF(order=4), section=section, material=steel)
model = bf.Model([beam], supports=[bf.Pin(beam.start), bf.Roller(beam.end)])
modes = bf.solve_modes(model, count=3)

n = np.arange(1, 4)
bending, mass = steel.youngs_modulus * section.second_moment, steel.density * section.area
print("Hz                 ", modes.frequencies.round(3))
print("Euler and Bernoulli", (0.5 * np.pi * n**2 * np.sqrt(bending / mass)).round(3))
modes.plot("out/examples/modes.png")
