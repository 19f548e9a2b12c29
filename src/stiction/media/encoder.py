"""Frames to a film: H.264, VP9 or GIF."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiction.errors import ResultError

CODECS = {"mp4": "libx264", "webm": "libvpx-vp9"}
KINDS = (*CODECS, "gif")
# of each codec: quality, and speed on two cores
OPTIONS = {"mp4": {"crf": "20", "preset": "veryfast"},
           "webm": {"crf": "32", "b": "0", "deadline": "realtime", "cpu-used": "8"}}  # fmt: skip
HALF = 2  # of the frames of a GIF, which is large, are left out
COLORS, COMMON = 64, 32  # of a GIF: hues, and the commonest colours
APART = 8  # of 255, colours of a palette
MISSING = (
    "mp4 and webm need the package av; install stiction[film], or run: uv run --extra film"
    " stiction; a gif does without"
)

Frames = Iterator[NDArray[np.uint8]]


def encode(frames: Frames, rate: int, kind: str) -> bytes:
    """Return the film of frames, (height, width, 3), at `rate` a second.

    Raises
    ------
    ResultError
        If the package that encodes it is missing.
    """
    return as_gif(frames, rate) if kind == "gif" else as_video(frames, rate, kind)


def as_video(frames: Frames, rate: int, kind: str) -> bytes:
    """Return a video."""
    try:
        import av
    except ImportError:
        raise ResultError(MISSING) from None
    made = BytesIO()
    with av.open(made, "w", format=kind) as file:
        stream: Any = file.add_stream(CODECS[kind], rate=rate, options=OPTIONS[kind])
        stream.pix_fmt = "yuv420p"  # which every player shows
        for number, frame in enumerate(frames):
            if not number:
                stream.height, stream.width = frame.shape[:2]
            picture = av.VideoFrame.from_ndarray(np.ascontiguousarray(frame), format="rgb24")
            file.mux(stream.encode(picture))
        file.mux(stream.encode())
    return made.getvalue()


def palette(picture: Any) -> Any:
    """Return an image whose palette has the commonest colours of a picture and all its hues.

    Areas keep their colours exactly: the mean of many is another one, and grey was pink. Thin lines
    keep their hues: the library's default divides the colours of most pixels only.
    """
    from PIL import Image

    counted = sorted(picture.getcolors(picture.width * picture.height), reverse=True)
    flat = picture.quantize(COLORS, Image.Quantize.MAXCOVERAGE).getpalette()[: 3 * COLORS]
    hues = np.reshape(flat, (-1, 3))
    known = np.array([color for _, color in counted[:COMMON]])
    chosen: list[NDArray[Any]] = []
    for color in (*known, *hues):  # the library takes the nearest but for a few steps of 255
        if all(np.abs(color - each).max() >= APART for each in chosen):
            chosen.append(color)
    found = Image.new("P", (1, 1))
    found.putpalette([int(channel) for channel in np.ravel(chosen)])
    return found


def as_gif(frames: Frames, rate: int) -> bytes:
    """Return an animated GIF of half the rate."""
    from PIL import Image

    pictures = []
    for number, frame in enumerate(frames):
        if number % HALF:
            continue
        image = Image.fromarray(np.ascontiguousarray(frame))
        pictures.append(image.quantize(palette=palette(image), dither=Image.Dither.NONE))
    made = BytesIO()
    pause = round(1e3 * HALF / rate)
    pictures[0].save(made, "GIF", save_all=True, append_images=pictures[1:], duration=pause, loop=0)
    return made.getvalue()
