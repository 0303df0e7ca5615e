"""A film as a file: GIF frame by frame, MP4 by ffmpeg; in both each frame is drawn on what stands still."""

from __future__ import annotations

from pathlib import Path
from subprocess import CalledProcessError
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from matplotlib.animation import FFMpegWriter
from PIL import GifImagePlugin, Image

from towercrane.report.film.film import DOTS_PER_INCH
from towercrane.results.files import replacing

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike

    from numpy.typing import NDArray

    from towercrane.report.film.film import Film

SUFFIXES = (".gif", ".mp4")

COLOURS = 127
"""Colours of a GIF beside the transparent one; the picture has few, each with its softened edges."""

GIF_RATE = 50.0
"""Frames per second beyond which viewers slow a GIF down."""

LAST_STAYS = 1.0
"""How long the last frame of a GIF stays before the first comes back [s]."""


class Writer(Protocol):
    """Puts a film into a file."""

    def add(self, pixels: NDArray[np.uint8]) -> None:
        """Append a frame, shape (rows, columns, 4)."""

    def finish(self) -> None:
        """Complete the file."""

    def abandon(self) -> None:
        """Leave the file as it is."""


class GifWriter:
    """Frames in one palette, of each only what differs from the one before: a long film needs little memory and room.

    Parameters
    ----------
    film : Film
        Its first and last frame give the palette: between them they show every colour.
    path : Path
    frames_per_second : float
    """

    def __init__(self, film: Film, path: Path, frames_per_second: float) -> None:
        ends = np.concatenate([film.pixels(frame) for frame in (0, film.frames - 1)])
        # Of Pillow's ways to choose colours this one keeps white white.
        chosen = _image(ends).quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, kmeans=1)
        palette = chosen.getpalette() or []
        # No colour is left over for the transparent one to be taken for.
        palette = (palette + palette[:3] * 256)[: 3 * COLOURS] + palette[:3]
        self._palette = Image.new("P", (1, 1))
        self._palette.putpalette(palette)
        self._before: NDArray[np.uint8] | None = None
        # GIF counts in hundredths of a second; the frames' ends are rounded, so that the film as a whole keeps time.
        self._stays = np.diff(np.round(100.0 / frames_per_second * np.arange(film.frames + 1)))
        self._stays[-1] += round(100.0 * LAST_STAYS)
        self._added = 0
        self._file = path.open("wb")

    def add(self, pixels: NDArray[np.uint8]) -> None:
        """Append a frame, shape (rows, columns, 4)."""
        image = _image(pixels).quantize(palette=self._palette, dither=Image.Dither.NONE)
        now, offset = np.asarray(image), (0, 0)
        if self._before is None:
            image.putpalette(self._palette.getpalette() or [])
            for part in GifImagePlugin.getheader(image, info={"loop": 0})[0]:
                self._file.write(part)
        else:
            changed = now != self._before
            rows, columns = _spanned(changed.any(axis=1)), _spanned(changed.any(axis=0))
            left = np.where(changed[rows, columns], now[rows, columns], np.uint8(COLOURS))
            image, offset = Image.fromarray(left), (columns.start, rows.start)
        stays = 10 * int(self._stays[self._added])
        for part in GifImagePlugin.getdata(image, offset, duration=stays, transparency=COLOURS, disposal=1):
            self._file.write(part)
        self._before = now
        self._added += 1

    def finish(self) -> None:
        """Complete the file."""
        self._file.write(b";")
        self._file.close()

    def abandon(self) -> None:
        """Leave the file as it is."""
        self._file.close()


class Mp4Writer(FFMpegWriter):
    """Frames sent to ffmpeg as they are drawn; parameters as of :class:`GifWriter`."""

    _proc: Any

    def __init__(self, film: Film, path: Path, frames_per_second: Any) -> None:
        # Players and browsers read no other arrangement of colours.
        super().__init__(
            fps=frames_per_second, codec="h264", extra_args=["-pix_fmt", "yuv420p", "-preset", "veryfast"]
        )
        self.setup(film.figure, str(path), DOTS_PER_INCH)

    def add(self, pixels: NDArray[np.uint8]) -> None:
        """Append a frame, shape (rows, columns, 4)."""
        try:
            self._proc.stdin.write(pixels.tobytes())
        except BrokenPipeError:
            # It has ended, and says why.
            self.finish()

    def finish(self) -> None:
        """Complete the file.

        Raises
        ------
        OSError
            If ffmpeg fails.
        """
        try:
            super().finish()
        except CalledProcessError as error:
            raise OSError(f"ffmpeg failed: {error.stderr.strip()}") from error

    def abandon(self) -> None:
        """Leave the file as it is."""
        self._proc.kill()
        self._proc.communicate()


def obstacle(suffix: str, frames_per_second: float) -> str:
    """Why no film with such an ending can be written; empty if it can."""
    if suffix not in SUFFIXES:
        return f"wanted a name that ends in {' or '.join(SUFFIXES)}, got {suffix or 'none'}"
    if suffix == ".gif" and frames_per_second > GIF_RATE:
        return f"wanted at most {GIF_RATE:g} frames per second in a .gif, got {frames_per_second:g}"
    if suffix == ".mp4" and not FFMpegWriter.isAvailable():
        return "ffmpeg, which writes .mp4, is not installed; a .gif needs nothing besides"
    return ""


def save(
    film: Film, path: str | PathLike[str], frames_per_second: float, progress: Callable[[int], Any] | None = None
) -> None:
    """Write a film whole or not at all; a file that was there stays until the new one is whole.

    Parameters
    ----------
    film : Film
    path : path-like
        Ending in .gif or .mp4.
    frames_per_second : float
    progress : callable, optional
        Told the number of frames drawn.

    Raises
    ------
    ValueError
        If the ending is another, a GIF would be too fast, or ffmpeg is wanted and not installed.
    OSError
        If the file cannot be written.
    """
    suffix = Path(path).suffix
    if reason := obstacle(suffix, frames_per_second):
        raise ValueError(f"{path}: {reason}")
    with replacing(path) as temporary:
        kind = GifWriter if suffix == ".gif" else Mp4Writer
        writer: Writer = kind(film, temporary, frames_per_second)
        try:
            for frame in range(film.frames):
                writer.add(film.pixels(frame))
                if progress is not None:
                    progress(frame + 1)
            writer.finish()
        except BaseException:
            writer.abandon()
            raise


def _image(pixels: NDArray[np.uint8]) -> Image.Image:
    """Picture without its opacity."""
    return Image.fromarray(pixels).convert("RGB")


def _spanned(changed: NDArray[np.bool_]) -> slice:
    """From the first to the last place that has changed; a single one where none has."""
    places = np.flatnonzero(changed)
    return slice(int(places[0]), int(places[-1]) + 1) if len(places) else slice(0, 1)
