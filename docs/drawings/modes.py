"""Modes of a clamped beam, and how a compressive force lowers its first frequency."""

import matplotlib.pyplot as plt
import numpy as np

import beamfem as bf

COLOURS = ("#0077BB", "#CC3311", "#228833")


def column(share=0.0):
    section, steel = bf.Rectangle(0.01, 0.01), bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
    euler = np.pi**2 / 4.0 * section.rigidity(steel).bending
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=4), section, steel)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-share * euler, 0.0))])


def main():
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 3.2), layout="constrained")
    beam, model = column()
    modes, at = bf.solve_modes(model, count=3), np.linspace(0.0, 1.0, 81)
    for number, colour in enumerate(COLOURS):
        shape = modes.solution(mode=number, amplitude=1.0, frames=5)
        row = int(np.abs(shape.displacement(beam.end)[:, 1]).argmax())
        deflection = np.array([shape.displacement(beam.at(float(fraction)))[row, 1] for fraction in at])
        left.plot(at, deflection / deflection[-1], color=colour, label=f"{modes.frequencies[number]:.2f} Hz")
    left.axhline(0.0, color="0.6", linewidth=0.8)
    left.set(xlabel="$s/L$", title="modes of a clamped beam", xlim=(0, 1))
    left.legend(fontsize=9, loc="lower left")
    shares = np.array([-1.0, -0.5, 0.0, 0.3, 0.6, 0.8, 0.9, 0.96, 0.99, 0.999])
    found = []
    for share in shares:
        _, loaded = column(float(share))
        found.append(bf.solve_modes(loaded, count=1, about=bf.solve_static(loaded)).frequencies[0])
    squares = (np.array(found) / modes.frequencies[0]) ** 2
    right.plot(shares, squares, "o-", color=COLOURS[0], markersize=4)
    right.axvline(1.0, color="0.6", linewidth=0.8, linestyle=":")
    right.axhline(0.0, color="0.6", linewidth=0.8)
    right.set(
        xlabel="compressive force / Euler's load", ylabel="$(f/f_0)^2$", title="the first frequency under a force"
    )
    for axes in (left, right):
        axes.title.set_fontsize(11)
        axes.grid(True, color="0.9", linewidth=0.6)
    figure.savefig("modes.png", dpi=110)


if __name__ == "__main__":
    main()
