"""Every support, joint and load as beamfem draws it, one panel each."""

import matplotlib.pyplot as plt
import numpy as np

import beamfem as bf

STEEL = bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)


def beam(*ends):
    return bf.Beam(bf.Line(*(ends or ((0, 0), (0.3, 0)))), 4, bf.CRBF(order=2), bf.Rectangle(0.01, 0.015), STEEL)


def supported(name):
    one = beam()
    clamp, far = bf.Clamp(one.start), one.end
    return {
        "Clamp": lambda: bf.Model([one], [clamp]),
        "Pin": lambda: bf.Model([one], [clamp, bf.Pin(far)]),
        "Roller": lambda: bf.Model([one], [clamp, bf.Roller(far)]),
        "Roller(normal=...)": lambda: bf.Model([one], [clamp, bf.Roller(far, normal=(-0.5, 1.0))]),
        "Prescribed": lambda: bf.Model([one], [clamp, bf.Prescribed(far, uy=0.1)]),
        "Spring": lambda: bf.Model([one], [clamp, bf.Spring(far, (0.0, 1e4))]),
        "Foundation": lambda: bf.Model([one], [clamp, bf.Foundation(one, (0.0, 1e4))]),
        "PointForce": lambda: bf.Model([one], [clamp], [bf.PointForce(far, (0.0, 10.0))]),
        "PointMoment": lambda: bf.Model([one], [clamp], [bf.PointMoment(far, 10.0)]),
        "DistributedLoad": lambda: bf.Model([one], [clamp], [bf.DistributedLoad(one, (0.0, 10.0))]),
        "Pressure": lambda: bf.Model([one], [clamp], [bf.Pressure(one, 10.0)]),
        "Motor": lambda: bf.Model([one], [bf.Pin(one.start)], [bf.Motor(one.start, speed=1.0)]),
        "Gravity": lambda: bf.Model([one], [clamp], [bf.Gravity((0.0, -9.81))]),
    }[name]()


def joined(joint):
    one, other = beam((0, 0), (0.15, 0.04)), beam((0.15, 0.04), (0.3, 0))
    return bf.Model([one, other], [bf.Clamp(one.start), bf.Clamp(other.end)], joints=[joint(one.end, other.start)])


def panel(axes, name, model):
    drawn = model.plot()
    drawn.set_size_inches(2.6, 1.3)  # symbols keep their size
    drawn.set_dpi(200)
    drawn.axes[0].set(xlim=(-0.05, 0.36), ylim=(-0.07, 0.08))
    drawn.axes[0].axis("off")
    drawn.axes[0].set_title("")
    drawn.canvas.draw()
    image = np.asarray(drawn.canvas.buffer_rgba())[..., :3]
    rows = np.flatnonzero((image < 250).any(axis=(1, 2)))
    axes.imshow(image[max(rows[0] - 10, 0) : rows[-1] + 10])
    axes.set_title(name, family="monospace", fontsize=10)
    axes.axis("off")
    plt.close(drawn)


def main():
    names = ["Clamp", "Pin", "Roller", "Roller(normal=...)", "Prescribed", "Spring", "Foundation", "Rigid", "Hinge"]
    names += ["PointForce", "PointMoment", "DistributedLoad", "Pressure", "Gravity", "Motor"]
    figure, grid = plt.subplots(4, 4, figsize=(12.0, 4.6), layout="constrained")
    for axes in grid.flat[len(names) :]:
        axes.axis("off")
    for axes, name in zip(grid.flat, names, strict=False):
        panel(axes, name, joined(getattr(bf, name)) if name in ("Rigid", "Hinge") else supported(name))
    figure.savefig("supports.png", dpi=110)


if __name__ == "__main__":
    main()
