"""A pack of four leaves, clamped at one end; each shorter leaf pushes with its tip on the leaf above, in mm and N.

Prints the deflection, the forces between the leaves, and the safety factor of each leaf.
"""

from itertools import pairwise

import beamfem as bf

steel = bf.Material(youngs_modulus=2.06e5, poisson_ratio=0.3, density=7.85e-9, strength=1400.0)
section = bf.Rectangle(width=60.0, height=8.0)
leaves = [
    bf.Beam(bf.Line((0, -8 * below), (600 - 150 * below, -8 * below)), section=section, material=steel)
    for below in range(4)
]
pads = [bf.Link(lower.end, upper.at(lower.curve.length / upper.curve.length)) for upper, lower in pairwise(leaves)]
load = bf.PointForce(leaves[0].end, (0.0, 300.0))
pack = bf.Model(leaves, [bf.Clamp(leaf.start) for leaf in leaves], [load], joints=pads, units="N, mm")
solution = bf.solve_static(pack)

print(f"tip moves by {solution.displacement(leaves[0].end)[-1, 1]:.3f} mm")
print("forces", [round(float(-solution.joint_force(pad)[-1, 1]), 1) for pad in pads], "N")
print("safety factors", [round(solution.safety_factor(leaf), 2) for leaf in leaves])
solution.plot("out/examples/leaf_pack.png", colour="stress")
