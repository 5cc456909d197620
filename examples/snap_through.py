"""Lee's frame snaps: its equilibrium path through both limit points, in cm and N.

Lee, Manuel and Rossow (1968); the limit loads of Reissner's beam by collocation are 18544.53 and -9392.49 N.
"""

import beamfem as bf

common = (
    bf.CRBF(order=4),
    bf.Section(area=6.0, second_moment=2.0),
    bf.Material(youngs_modulus=7.2e6, poisson_ratio=0.3, density=2.7e-5),
)
column = bf.Beam(bf.Line((0, 0), (0, 120)), 10, *common)
bar = bf.Beam(bf.Line((0, 120), (120, 120)), 10, *common)
loaded = bar.at(0.2)
model = bf.Model(
    [column, bar],
    supports=[bf.Pin(column.start), bf.Pin(bar.end)],
    joints=[bf.Rigid(column.end, bar.start)],
    loads=[bf.PointForce(loaded, (0, -1.0))],
    units="N, cm",
)
path = bf.trace_equilibrium(model, until=lambda state: state.displacement(loaded)[1] < -90.0)

for point in path.limit_points:
    print(f"limit load {point.load_factor:.2f} N, {-point.displacement(loaded)[1]:.3f} cm down")
path.plot_load_displacement(loaded, path="out/examples/snap_through.png")
