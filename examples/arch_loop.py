"""A shallow arch is pushed through by a force and pulled back: it snaps both ways, and its path is a loop.

Prints the work of the force around the loop, which the snaps release.
"""

import numpy as np

import beamfem as bf

plastic = bf.Material(youngs_modulus=2e9, poisson_ratio=0.3, density=1200.0)
curve = bf.Arc(center=(0.0, -0.24), radius=0.26, start_angle=1.97, end_angle=1.17)
arch = bf.Beam(curve, 8, bf.CRBF(order=4), bf.Rectangle(0.02, 0.002), plastic)
there_and_back = bf.Interpolated([(0.0, 0.0), (0.25, 1.0), (0.75, -1.0), (1.0, 0.0)])
push = bf.PointForce(arch.at(0.5), (0.0, -30.0), amplitude=there_and_back)
model = bf.Model([arch], [bf.Pin(arch.start), bf.Pin(arch.end)], [push])
loop = bf.solve_static(model, steps=160, snap="jump")

force = -30.0 * np.array([there_and_back(load_factor) for load_factor in loop.load_factor])
work = np.trapezoid(force, loop.displacement(arch.at(0.5))[:, 1])
print(f"the loop takes {work:.4f} J")
loop.plot_curve(("uy", arch.at(0.5)), ("force [N]", force), "out/examples/arch_loop.png")
loop.animate("out/examples/arch_loop.gif", seconds=5.0)
