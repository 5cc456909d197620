"""Moving pictures: GIF by Pillow, MP4 by the ffmpeg of imageio-ffmpeg; no window, small files."""

from collections.abc import Iterator
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.atomic_write import whole
from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.results.solution import Solution
from beamfem.validation import count, flag, positive
from beamfem.view.deformed_shapes import FIELD_COLOURS, Shapes, draw_undeformed, shade
from beamfem.view.drawing import LINE, bar, equal_axes, legend_above
from beamfem.view.frames import moment_of, spread_rows
from beamfem.view.load_drawing import FORCE, draw_loads
from beamfem.view.notebook_paths import file_to_write
from beamfem.view.support_symbols import PRESCRIBED, draw_joints, supports_of

_POINTS = 600  # of all beams; what moves in a small picture needs no more
_PICTURES = 50  # of a slider
_FINEST = 1000  # pixels an inch: pictures of some inches have a hundred million
_LONGEST_FRAME = 0.5  # [s], for a solution of few rows


def animate(
    solution: Solution,
    path: str | PathLike[str] | None = None,
    fps: float = 15.0,
    seconds: float = 4.0,
    colour: str | None = None,
    undeformed: bool = True,
    supports: bool = True,
    loads: bool = True,
    dpi: int = 100,
) -> Path:
    """Write an animation of the body to a .gif or .mp4 file and return its path, see `Solution.animate`."""
    target = file_to_write(path, "an animation", ".gif", ".mp4", example="motion.gif")
    if len(solution) == 0:
        raise InputError("the solution has no rows, so there is nothing to animate")
    for name, value in (("undeformed", undeformed), ("supports", supports), ("loads", loads)):
        flag(name, value)
    if count("dpi", dpi) > _FINEST:
        raise InputError(f"dpi must be at most {_FINEST}, got {dpi}")
    fps, seconds = positive("fps", fps), positive("seconds", seconds)
    most = max(2, round(min(fps * seconds, len(solution))))
    rows = spread_rows(solution, most)
    duration = min(seconds / len(rows), _LONGEST_FRAME)
    write = _write_gif if target.suffix.lower() == ".gif" else _mp4_writer()
    shapes = Shapes(solution, rows, colour, _POINTS)
    frames = _frames(shapes, undeformed, supports, loads, dpi)
    with whole(target) as partial:
        write(partial, frames, duration)
    return target


def slider(solution: Solution, colour: str | None = None) -> Any:
    """Return pictures of the body with a slider of ipywidgets over the load factor or time."""
    import ipywidgets
    from PIL import Image

    shapes, pictures = Shapes(solution, spread_rows(solution, _PICTURES), colour, _POINTS), []
    frames = _frames(shapes, undeformed=True, supports=True, loads=True, dpi=100)
    for row, frame in zip(shapes.rows, frames, strict=True):
        data = BytesIO()
        Image.fromarray(frame).save(data, format="png")
        pictures.append((moment_of(solution, int(row)), data.getvalue()))
    moment = ipywidgets.SelectionSlider(options=pictures, index=len(pictures) - 1, layout={"width": "100%"})
    picture = ipywidgets.Image(value=moment.value, format="png", layout={"object_fit": "contain"})
    moment.observe(lambda change: setattr(picture, "value", change.new), "value")
    return ipywidgets.VBox([moment, picture])


def _frames(shapes: Shapes, undeformed: bool, supports: bool, loads: bool, dpi: int) -> Iterator[np.ndarray]:
    """Yield pictures (height, width, 3) of bytes; height and width are even, as video wants them.

    What stands still is drawn once.
    """
    solution = shapes.solution
    above = LINE if undeformed else 0.0
    figure, axes = equal_axes(shapes.box, shapes.quantity is not None, solution.model.unit("m"), above)
    figure.set_dpi(dpi)
    size = np.ceil(figure.get_size_inches() * dpi / 2.0) * 2.0
    figure.set_size_inches(size / dpi)
    if undeformed:
        legend_above(axes, [draw_undeformed(axes, shapes.points)])
    if shapes.quantity is not None:
        bar(axes, shapes)
    title = axes.set_title(" ", fontsize=10, pad=72.0 * LINE if undeformed else 6.0)
    canvas = figure.canvas
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)
    for order, row in enumerate(shapes.rows):
        canvas.restore_region(background)
        moving = shapes.draw(axes, order)
        if supports:
            moving += supports_of(solution, int(row), shapes.centre).draw(axes)
        moving += draw_joints(axes, solution, int(row))
        if loads:
            moving += draw_loads(axes, solution, np.array([row]))
        title.set_text(moment_of(solution, int(row)))
        for artist in sorted(moving, key=lambda artist: artist.get_zorder()):
            axes.draw_artist(artist)
            artist.remove()
        axes.draw_artist(title)
        yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _write_gif(path: Path, frames: Iterator[np.ndarray], duration: float) -> None:
    """Write with one palette for all frames, so that only what moves is stored."""
    with needed_for("a GIF file"):
        from PIL import Image

    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette().ravel().tolist())
    flat = [Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    # GIF counts in hundredths of a second, and browsers slow down what is below two
    milliseconds = max(20, round(100 * duration) * 10)
    flat[0].save(path, save_all=True, append_images=flat[1:], duration=milliseconds, loop=0, optimize=False)


def _palette() -> np.ndarray:
    """Return the colours of drawings (n, 3) as bytes: greys, field colours, and the others as they fade into white."""
    from matplotlib import colormaps
    from matplotlib.colors import to_rgb

    greys = np.linspace(0.0, 1.0, 18)[:, None].repeat(3, axis=1)
    fields = colormaps[FIELD_COLOURS](np.linspace(0.0, 1.0, 72))[:, :3]
    fade = np.linspace(1.0, 0.0, 9)[:-1, None]
    faded = [fade * to_rgb(colour) + 1.0 - fade for colour in (FORCE, PRESCRIBED, shade(1.0), *fields[::12])]
    return np.round(255.0 * np.concatenate([greys, fields, *faded])).astype(np.uint8)


def _mp4_writer() -> Any:
    with needed_for("an MP4 file", otherwise="a .gif file needs nothing else"):
        import imageio_ffmpeg

    def write(path: Path, frames: Iterator[np.ndarray], duration: float) -> None:
        first = next(frames)
        size = first.shape[1], first.shape[0]
        stream = imageio_ffmpeg.write_frames(
            str(path), size, pix_fmt_in="rgb24", fps=1.0 / duration, codec="libx264", quality=6, macro_block_size=2
        )
        stream.send(None)  # starts it
        try:
            stream.send(np.ascontiguousarray(first))
            for frame in frames:
                stream.send(np.ascontiguousarray(frame))
        finally:
            stream.close()

    return write
