"""A bracket: a column and a bar, rigidly joined, with a weight at the end of the bar.

Prints how far the weight sinks, about P L^2 h / (E I) + P L^3 / (3 E I), and what the foot carries.
"""

import beamfem as bf

height, reach = 3.0, 1.5  # m
common = (
    bf.CRBF(order=3),
    bf.Tube(diameter=0.1, thickness=0.005),
    bf.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0),
)
column = bf.Beam(bf.Line((0, 0), (0, height)), 4, *common)
bar = bf.Beam(bf.Line((0, height), (reach, height)), 2, *common)
model = bf.Model(
    [column, bar],
    supports=[bf.Clamp(column.start)],
    joints=[bf.Rigid(column.end, bar.start)],
    loads=[bf.PointForce(bar.end, (0, -50.0))],
)
solution = bf.solve_static(model)

print(f"the weight sinks by {-1e3 * solution.displacement(bar.end)[-1, 1]:.4f} mm")
print("the foot carries fx, fy, m:", solution.reaction(column.start)[-1].round(3), "N, N, N m")
solution.plot("out/examples/frame.png", colour="moment")
