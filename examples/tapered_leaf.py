"""A tapered leaf spring whose end is pressed down by 120 mm, in mm and N.

Prints the force and the safety factor; writes the stress, and the force over the displacement.
"""

import beamfem as bf

steel = bf.Material(youngs_modulus=2.06e5, poisson_ratio=0.3, density=7.85e-9, strength=1400.0)
leaf = bf.Beam(
    bf.Line((0, 0), (400, 0)),
    section=lambda s: bf.Rectangle(width=60.0 - 0.135 * s, height=6.0),  # s: arc length
    material=steel,
)
model = bf.Model([leaf], [bf.Clamp(leaf.start), bf.Prescribed(leaf.end, uy=-120.0)], units="N, mm")
solution = bf.solve_static(model, steps=6)

print(f"force {-solution.reaction(leaf.end)[-1, 1]:.2f} N")
print(f"safety factor {solution.safety_factor():.3f}")
solution.plot("out/examples/tapered_leaf.png", colour="stress")
solution.plot_curve(("uy", leaf.end), ("fy", leaf.end), "out/examples/tapered_leaf_force.png")
