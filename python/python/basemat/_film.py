"""Films: figures in which a few artists move, drawn over an image of all the rest, and their files."""

from __future__ import annotations

import base64
import io
import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._errors import InputError
from ._files import replace

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist

_PLAYER = """
<p><img id="film" alt="the run in motion" style="max-width: 100%"><br>
<button id="play">pause</button> <input id="frame" type="range" min="0" value="0" style="width: 70%"></p>
<script>
const frames = FRAMES, film = document.getElementById("film"), play = document.getElementById("play");
const slider = document.getElementById("frame"); slider.max = frames.length - 1;
let timer = null;
function show(k) { film.src = "data:image/png;base64," + frames[k]; slider.value = k; }
function start() { play.textContent = "pause"; timer = setInterval(() => show((+slider.value + 1) % frames.length), INTERVAL); }
function stop() { play.textContent = "play"; clearInterval(timer); timer = null; }
play.onclick = () => timer ? stop() : start();
slider.oninput = () => { stop(); show(+slider.value); };
show(0); start();
</script>
"""
_VIDEOS = (".mp4", ".m4v", ".mov", ".avi", ".mkv", ".webm")
"""Files that matplotlib writes by the program ffmpeg."""


class Film(NamedTuple):
    """A figure, the function that draws one of its frames and returns the artists that move, and the time of a frame."""

    figure: Any
    draw: Callable[[int], list[Artist]]
    frames: int
    #: ms
    interval: float

    @contextmanager
    def baked(self, dpi: float | None = None) -> Iterator[Callable[[], Any]]:
        """Context in which the artists that do not move are one image; its value is a function of a frame's pixels."""
        from matplotlib import artist, rcParams
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        figure = self.figure
        dpi_before, canvas_before = figure.dpi, figure.canvas
        usual = rcParams["savefig.dpi"]
        figure.dpi = dpi or (figure.dpi if usual == "figure" else usual)
        moving = set(self.draw(0))
        axes = list(figure.axes)
        shown = [axis.axison for axis in axes]
        parts = [item for part in (figure, *axes) for item in part.get_children() if item not in (figure.patch, *axes)]
        still = [item for item in parts if item not in moving and item.get_visible()]

        class Canvas(FigureCanvasAgg):
            """A canvas that is drawn only when its pixels are read."""

            def draw_idle(self, *_: Any, **__: Any) -> None:
                pass

        class Still(artist.Artist):
            """The image."""

            def draw(self, renderer: Any) -> None:
                renderer.draw_image(renderer.new_gc(), 0, 0, pixels)

        canvas: Any = Canvas(figure)
        image = Still()
        try:
            for item in moving:
                item.set_visible(False)
            canvas.draw()
            pixels = np.array(canvas.buffer_rgba())[::-1]
            figure.add_artist(image)
            image.set_zorder(-10.0)
            for item in moving:
                item.set_visible(True)
            for item in still:
                item.set_visible(False)
            for part in axes:
                part.axison = False

            def frame() -> Any:
                canvas.draw()
                return np.asarray(canvas.buffer_rgba())

            yield frame
        finally:
            image.remove()
            for item in (*moving, *still):
                item.set_visible(True)
            for part, before in zip(axes, shown):
                part.axison = before
            figure.dpi = dpi_before
            figure.set_canvas(canvas_before)


def quantized(pixels: Any) -> Any:
    """Pixels as an image of 64 colours, which halves a file."""
    from PIL import Image

    return Image.fromarray(pixels[..., :3]).quantize(64, method=Image.Quantize.FASTOCTREE)


def player(film: Film, dpi: float | None = None, interval: float | None = None) -> str:
    """Frames of a film as part of a page, with the lines that play them; ``interval``: of two frames, ms."""
    frames = []
    with film.baked(dpi) as pixels:
        for number in range(film.frames):
            film.draw(number)
            file = io.BytesIO()
            quantized(pixels()).save(file, format="png")
            frames.append(base64.b64encode(file.getvalue()).decode("ascii"))
    return _PLAYER.replace("FRAMES", json.dumps(frames)).replace("INTERVAL", f"{interval or film.interval:.0f}")


def _page(film: Film, dpi: float | None, fps: float | None) -> bytes:
    """A page for a browser that plays the film."""
    heading = '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>basemat</title>'
    body = player(film, dpi, None if fps is None else 1e3 / fps)
    return f'<!DOCTYPE html>\n<html lang="en"><head>{heading}</head><body>{body}</body></html>\n'.encode()


def _require_ffmpeg(path: str) -> None:
    """An error for a video where the program that writes it is missing."""
    from matplotlib.animation import writers

    if not writers.is_available("ffmpeg"):
        stem, extension = os.path.splitext(path)
        raise InputError(
            f"{path}: a file of the kind {extension} needs the program ffmpeg, which is not installed. Install it (apt install "
            f"ffmpeg, conda install ffmpeg), or write {stem}.gif or {stem}.html, which need no other program"
        )


def moving(film: Film) -> FuncAnimation:
    """An animation of matplotlib whose files are drawn as fast as its window."""
    from matplotlib.animation import FuncAnimation, PillowWriter

    class Moving(FuncAnimation):
        """Saves frames of a film."""

        def save(
            self, filename: Any, writer: Any = None, fps: Any = None, dpi: Any = None, *others: Any, **options: Any
        ) -> None:
            path = os.fspath(filename)
            picture_dpi = None if dpi == "figure" else dpi
            if writer is None and path.lower().endswith((".html", ".htm")):
                replace(path, _page(film, picture_dpi, fps))
                return
            if writer in (None, "ffmpeg") and path.lower().endswith(_VIDEOS):
                _require_ffmpeg(path)
            with film.baked(picture_dpi) as frame:

                class Gif(PillowWriter):
                    """Frames without another drawing."""

                    def grab_frame(self, **_: Any) -> None:
                        writer: Any = self
                        writer._frames.append(quantized(frame()))

                if path.lower().endswith(".gif") and writer in (None, "pillow"):
                    made: Any = Gif
                    writer = made(fps=fps or 1e3 / film.interval)
                super().save(filename, writer, fps, dpi, *others, **options)

    return Moving(film.figure, film.draw, frames=film.frames, interval=film.interval, blit=True)
