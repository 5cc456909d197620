"""Moving pictures: frames, durations, sizes."""

import sys
from itertools import pairwise
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from drawn import cantilever, frame, pendulum, share_of_ink
from PIL import Image, ImageSequence

import beamfem as bf
from beamfem.view.animation import _palette
from beamfem.view.load_drawing import FORCE
from beamfem.view.support_symbols import PRESCRIBED


@pytest.fixture(scope="module")
def falling():
    return pendulum()


def frames_of(path):
    with Image.open(path) as picture:
        return [(np.asarray(one.convert("RGB")), one.info["duration"]) for one in ImageSequence.Iterator(picture)]


def test_gif_has_a_frame_a_row_and_lasts_as_long_as_asked(falling, tmp_path):
    path = falling.animate(tmp_path / "new" / "fall.gif", fps=10, seconds=2.0, colour="moment")
    frames = frames_of(path)
    assert len(frames) == 20
    assert sum(duration for _, duration in frames) == 2000
    pictures = [picture for picture, _ in frames]
    assert all(0.005 < share_of_ink(picture) < 0.4 for picture in pictures)
    changed = [np.mean(np.any(a != b, axis=-1)) for a, b in pairwise(pictures)]
    assert min(changed) > 1e-4
    assert all(size % 2 == 0 for size in pictures[0].shape[:2])


def test_defaults_stay_small(falling, tmp_path):
    path = falling.animate(tmp_path / "fall.gif")
    assert len(frames_of(path)) == 60
    assert path.stat().st_size < 500_000


def test_a_solution_of_few_rows_shows_each_for_long(tmp_path):
    for solution in (cantilever(), frame()):
        frames = frames_of(solution.animate(tmp_path / "bent.gif"))
        assert [duration for _, duration in frames] == [500] * len(solution)
        # white is white and the red of forces is red: the palette has the colours of drawings
        last = frames[-1][0].astype(int)
        assert (last[0, 0] == 255).all()
        assert np.any((last[..., 0] > 180) & (last[..., 1] < 80) & (last[..., 2] < 80))


def test_other_suffixes_are_refused(falling, tmp_path):
    with pytest.raises(bf.InputError, match=r'fall\.gif" would be right'):
        falling.animate(tmp_path / "fall.avi")
    with pytest.raises(bf.InputError, match="fps must be greater than zero"):
        falling.animate(tmp_path / "fall.gif", fps=0)


def test_mp4_without_its_library_names_the_extra(falling, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(bf.BeamfemError, match=r"beamfem\[video\]"):
        falling.animate(tmp_path / "fall.mp4")
    assert not list(tmp_path.iterdir())


def test_mp4_gives_every_frame_to_ffmpeg(falling, tmp_path, monkeypatch):
    """A stand-in for the library counts what it is given."""
    seen = {}

    def write_frames(path, size, **options):
        seen.update(options, path=path, size=size, frames=[])
        picture = yield
        try:
            while True:
                seen["frames"].append(picture)
                picture = yield
        finally:
            Path(path).write_bytes(b"a video")
            seen["closed"] = True

    library = ModuleType("imageio_ffmpeg")
    library.write_frames = write_frames
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", library)
    falling.animate(tmp_path / "fall.mp4", fps=10, seconds=2.0)
    width, height = seen["size"]
    assert width % 2 == height % 2 == 0
    assert len(seen["frames"]) == 20
    assert all(picture.shape == (height, width, 3) and picture.dtype == np.uint8 for picture in seen["frames"])
    assert seen["fps"] == pytest.approx(10.0)
    assert seen["closed"]
    assert (tmp_path / "fall.mp4").read_bytes() == b"a video"


def test_mp4_of_ffmpeg(falling, tmp_path):
    library = pytest.importorskip("imageio_ffmpeg")
    path = falling.animate(tmp_path / "fall.mp4", fps=10, seconds=2.0)
    frames, seconds = library.count_frames_and_secs(str(path))
    assert frames == 20
    assert seconds == pytest.approx(2.0, abs=0.1)


def test_an_animation_has_the_colours_of_drawings_and_shades_close_to_their_edges():
    """Edges are drawn with shares of a colour over white; the colour itself must be there as it is."""
    palette = _palette().astype(float)
    for name in (FORCE, PRESCRIBED):
        colour = np.array([int(name[i : i + 2], 16) for i in (1, 3, 5)])
        for share in np.linspace(0.0, 1.0, 30):
            wanted = share * colour + (1.0 - share) * 255.0
            apart = np.abs(palette - wanted).max(axis=1).min()
            assert apart < 20.0 if share < 1.0 else apart == 0.0
