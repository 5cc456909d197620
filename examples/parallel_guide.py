"""A compliant guide: a stage on two leaf springs that moves sideways without turning, in mm and N.

Prints the force for one millimetre, 2 x 12 E I / L^3, how far the stage comes down, 3/5 u^2 / L, and the safety factor.
"""

import beamfem as bf

spring_steel = bf.Material(youngs_modulus=2.0e5, poisson_ratio=0.3, density=7.85e-9, strength=1200.0)
section = bf.Rectangle(width=10.0, height=0.2)
leaf = (4, bf.CRBF(order=4), section, spring_steel)
left = bf.Beam(bf.Line((0, 0), (0, 50)), *leaf)
right = bf.Beam(bf.Line((30, 0), (30, 50)), *leaf)
stage = bf.Beam(bf.Line((0, 50), (30, 50)), 1, bf.CRBF(order=2), bf.Rectangle(width=10.0, height=10.0), spring_steel)
guide = bf.Model(
    [left, right, stage],
    joints=[bf.Rigid(left.end, stage.start), bf.Rigid(right.end, stage.end)],
    supports=[bf.Clamp(left.start), bf.Clamp(right.start), bf.Prescribed(stage.start, ux=1.0)],
    units="N, mm",
)
solution = bf.solve_static(guide)

print(f"force {solution.reaction(stage.start)[-1, 0]:.4f} N")
print(f"down by {-solution.displacement(stage.at(0.5))[-1, 1]:.5f} mm")
print(f"turned by {solution.rotation(stage.at(0.5))[-1]:.1e} rad")
print(f"safety factor {solution.safety_factor():.3f}")
solution.plot("out/examples/parallel_guide.png", colour="stress")
