"""Films: figures in which a few artists move, drawn over an image of all the rest."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.artist import Artist


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


def moving(film: Film) -> FuncAnimation:
    """An animation of matplotlib whose files are drawn as fast as its window."""
    from matplotlib.animation import FuncAnimation, PillowWriter

    class Moving(FuncAnimation):
        """Saves frames of a film."""

        def save(
            self, filename: Any, writer: Any = None, fps: Any = None, dpi: Any = None, *others: Any, **options: Any
        ) -> None:
            with film.baked(None if dpi == "figure" else dpi) as frame:

                class Gif(PillowWriter):
                    """Frames without another drawing."""

                    def grab_frame(self, **_: Any) -> None:
                        writer: Any = self
                        writer._frames.append(quantized(frame()))

                if str(os.fspath(filename)).lower().endswith(".gif") and writer in (None, "pillow"):
                    made: Any = Gif
                    writer = made(fps=fps or 1e3 / film.interval)
                super().save(filename, writer, fps, dpi, *others, **options)

    return Moving(film.figure, film.draw, frames=film.frames, interval=film.interval, blit=True)
