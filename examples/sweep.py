"""Every combination of two parameters: how far a cantilever bends under a tip force, by load and slenderness.

Prints v / L for each. Run again, it finds its results in the store.
"""

import beamfem as bf


def deflection(load: float, slenderness: float) -> float:
    """Return the tip deflection over the length; load: P L^2 / (E I)."""
    section = bf.Rectangle(width=1.0 / slenderness, height=1.0 / slenderness)
    steel = bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements=4, element=bf.CRBF(order=4), section=section, material=steel)
    force = bf.PointForce(beam.end, (0, load * steel.youngs_modulus * section.second_moment))
    return float(bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [force])).displacement(beam.end)[-1, 1])


if __name__ == "__main__":  # needed where executor=concurrent.futures.ProcessPoolExecutor is added
    table = bf.sweep(deflection, load=[1.0, 2.0, 5.0], slenderness=[10.0, 100.0], store="out/examples/sweep")
    for load, slenderness, value in zip(table["load"], table["slenderness"], table["deflection"], strict=True):
        print(f"P L^2/EI = {load:g}, L/h = {slenderness:g}: v/L = {value:.6f}")
    table.to_csv("out/examples/sweep.csv")
    table.plot("deflection", over="load", path="out/examples/sweep.png")
