#!/usr/bin/env python3
"""Writes ../golden/frames: small pictures and animations, and what Pillow shows of them.

    python3 -m venv .venv && .venv/bin/pip install -r tests/reference/requirements.txt
    .venv/bin/python tests/reference/make_frames.py

Running it again with the same versions gives the same bytes. The animations are put together here
chunk by chunk, so that they hold every way of blending and disposing. Pillow (for WebP, libwebp) then
says what they show; only for APNG the specification's arithmetic is followed here, since Pillow takes
another one for what is half transparent on both sides. `index.json` lists the files with the time of each frame in milliseconds;
`frames.u8` holds the frames one after the other, a byte of grey a pixel: luma by Rec. 601, laid on
black. The same files are what the fuzz targets and tests/decoders.rs begin with.
"""

import io
import json
import struct
import zlib
from pathlib import Path

import numpy as np
from PIL import GifImagePlugin, Image, ImageSequence

OUT = Path(__file__).resolve().parent.parent / "golden" / "frames"
WIDTH, HEIGHT = 14, 10
KEEP, BACKGROUND, PREVIOUS = "keep", "background", "previous"

# x, y, width, height, delay in ms, whether it is laid over what is there, disposal
PATCHES = [
    (0, 0, WIDTH, HEIGHT, 40, False, KEEP),
    (2, 2, 6, 4, 120, True, BACKGROUND),
    (4, 0, 8, 6, 70, True, PREVIOUS),
    (0, 4, 4, 4, 0, False, PREVIOUS),
    (6, 4, 8, 6, 30, True, KEEP),
    (0, 0, WIDTH, HEIGHT, 50, True, BACKGROUND),
    (8, 2, 4, 4, 100, True, KEEP),
]


def noise(seed, width, height):
    return np.random.default_rng(seed).integers(0, 256, (height, width, 4), dtype=np.uint8)


def patch(seed, width, height, alphas):
    """Colours with one of these opacities each."""
    pixels = noise(seed, width, height)
    pixels[..., 3] = np.take(alphas, pixels[..., 3] % len(alphas))
    return pixels


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def deflated(pixels):
    return zlib.compress(b"".join(b"\0" + row.tobytes() for row in pixels), 9)


def apng(hidden):
    """With `hidden`, a picture that is no part of the animation comes first."""
    parts = [b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 6, 0, 0, 0))]
    parts.append(chunk(b"acTL", struct.pack(">II", len(PATCHES), 0)))
    if hidden:
        parts.append(chunk(b"IDAT", deflated(noise(99, WIDTH, HEIGHT))))
    number = 0
    disposals = {KEEP: 0, BACKGROUND: 1, PREVIOUS: 2}
    for i, (x, y, width, height, delay, over, disposal) in enumerate(PATCHES):
        control = struct.pack(">IIIIIHHBB", number, width, height, x, y, delay, 1000, disposals[disposal], over)
        parts.append(chunk(b"fcTL", control))
        number += 1
        data = deflated(patch(i, width, height, [0, 100, 200, 255]))
        if i == 0 and not hidden:
            parts.append(chunk(b"IDAT", data))
        else:
            parts.append(chunk(b"fdAT", struct.pack(">I", number) + data))
            number += 1
    return b"".join(parts) + chunk(b"IEND", b"")


def gif():
    """Seven colours and a transparent one; the third frame has colours of its own."""
    colours = noise(50, 8, 2)[..., :3]
    parts = [b"GIF89a", struct.pack("<HHBBB", WIDTH, HEIGHT, 0xF2, 0, 0), colours[0].tobytes()]
    disposals = {KEEP: 1, BACKGROUND: 2, PREVIOUS: 3}
    for i, (x, y, width, height, delay, _, disposal) in enumerate(PATCHES):
        parts.append(b"\x21\xf9\x04" + struct.pack("<BHBB", disposals[disposal] << 2 | 1, delay // 10, 7, 0))
        own = i == 2
        parts.append(b"\x2c" + struct.pack("<HHHHB", x, y, width, height, 0x82 if own else 0))
        parts.append(colours[1].tobytes() if own else b"")
        indices = noise(60 + i, width, height)[..., 0] % (7 if i == 0 else 8)
        parts.append(b"\x03" + sub_blocks(lzw(indices.ravel())))
    return b"".join(parts) + b"\x3b"


def lzw(indices):
    """Codes of four bits, with a clear code (8) so often that they never grow; 9 ends."""
    codes = []
    for start in range(0, len(indices), 6):
        codes += [8, *indices[start : start + 6]]
    codes.append(9)
    codes += [0] * (len(codes) % 2)
    return bytes(int(low) | int(high) << 4 for low, high in zip(codes[::2], codes[1::2]))


def sub_blocks(data):
    blocks = [data[i : i + 255] for i in range(0, len(data), 255)]
    return b"".join(bytes([len(block)]) + block for block in blocks) + b"\0"


def riff(chunks):
    return b"RIFF" + struct.pack("<I", len(chunks) + 4) + b"WEBP" + chunks


def riff_chunk(name, data):
    return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def still(pixels, **options):
    """The chunks of one picture, without the header that says it has alpha."""
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, "webp", **options)
    chunks = out.getvalue()[12:]
    return chunks[18:] if chunks.startswith(b"VP8X") else chunks


def webp(lossless, alphas):
    """WebP knows no disposal to what was there before, and only even offsets."""
    triple = lambda value: struct.pack("<I", value)[:3]
    header = bytes([0x12, 0, 0, 0]) + triple(WIDTH - 1) + triple(HEIGHT - 1)
    chunks = riff_chunk(b"VP8X", header) + riff_chunk(b"ANIM", struct.pack("<IH", 0xFFFFFFFF, 0))
    for i, (x, y, width, height, delay, over, disposal) in enumerate(PATCHES):
        pixels = patch(20 + i, width, height, alphas)
        if not lossless:
            # Of flat colours every decoder makes the same.
            pixels[...] = pixels[0, 0]
            pixels[..., 3] = patch(20 + i, width, height, alphas)[..., 3]
        picture = still(pixels, lossless=lossless, quality=90, exact=True)
        flags = (0 if over else 2) | (disposal == BACKGROUND)
        frame = triple(x // 2) + triple(y // 2) + triple(width - 1) + triple(height - 1) + triple(delay)
        chunks += riff_chunk(b"ANMF", frame + bytes([flags]) + picture)
    return riff(chunks)


def y4m():
    """4:2:0 in limited range; Pillow knows no such files, so only the decoders' tests use it."""
    head = f"YUV4MPEG2 W{WIDTH} H{HEIGHT} F25:1 Ip A1:1 C420jpeg\n".encode()
    len_ = WIDTH * HEIGHT + 2 * ((WIDTH + 1) // 2) * ((HEIGHT + 1) // 2)
    frame = lambda i: b"FRAME\n" + np.random.default_rng(i).integers(16, 236, len_, dtype=np.uint8).tobytes()
    return head + b"".join(frame(i) for i in range(3))


def saved(pixels, kind, **options):
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, kind, **options)
    return out.getvalue()


def files():
    rgba = patch(1, WIDTH, HEIGHT, [0, 60, 255])
    smooth = np.linspace(0, 255, WIDTH * HEIGHT * 3).reshape(HEIGHT, WIDTH, 3).astype(np.uint8)
    return {
        "still.png": saved(rgba, "png", optimize=True),
        "still.jpg": saved(smooth, "jpeg", quality=95, subsampling=0),
        "still.bmp": saved(smooth, "bmp"),
        "still.webp": saved(rgba, "webp", lossless=True, exact=True),
        "still-lossy.webp": saved(smooth, "webp", quality=95),
        "moving.gif": gif(),
        "moving.png": apng(hidden=False),
        "moving-hidden.png": apng(hidden=True),
        "moving.webp": webp(lossless=True, alphas=[0, 100, 200, 255]),
        "moving-lossy.webp": webp(lossless=False, alphas=[0, 100, 200, 255]),
    }


def greys(pixels):
    r, g, b, a = (pixels[..., i].astype(np.float64) for i in range(4))
    return np.rint((0.299 * r + 0.587 * g + 0.114 * b) * a / 255).astype(np.uint8)


def shown(data):
    """Every frame's pixels, and its time."""
    frames, time = [], 0
    for frame in ImageSequence.Iterator(Image.open(io.BytesIO(data))):
        frames.append((time, greys(np.asarray(frame.convert("RGBA")))))
        time += int(round(frame.info.get("duration", 0)))
    return frames


def composed():
    """What the APNGs show: colours with alpha, in floats."""
    canvas, frames, time = np.zeros((HEIGHT, WIDTH, 4)), [], 0
    for i, (x, y, width, height, delay, over, disposal) in enumerate(PATCHES):
        before = canvas.copy()
        here = canvas[y : y + height, x : x + width]
        new = patch(i, width, height, [0, 100, 200, 255]) / 255
        here[...] = laid_over(new, here) if over else new
        frames.append((time, greys(canvas * 255)))
        time += delay
        if disposal != KEEP:
            here[...] = 0 if disposal == BACKGROUND else before[y : y + height, x : x + width]
    return frames


def laid_over(new, old):
    a, b = new[..., 3:], old[..., 3:] * (1 - new[..., 3:])
    colours = (new[..., :3] * a + old[..., :3] * b) / np.maximum(a + b, 1e-9)
    return np.concatenate([colours, a + b], axis=2)


def main():
    # A GIF's frames with all their colours, the first too.
    GifImagePlugin.LOADING_STRATEGY = GifImagePlugin.LoadingStrategy.RGB_ALWAYS
    OUT.mkdir(parents=True, exist_ok=True)
    index, values = [], []
    for name, data in files().items():
        (OUT / name).write_bytes(data)
        frames = composed() if name.startswith("moving") and name.endswith(".png") else shown(data)
        times = [time for time, _ in frames] if name.startswith("moving") else [None]
        index.append({"file": name, "width": WIDTH, "height": HEIGHT, "times_ms": times})
        values += [pixels.tobytes() for _, pixels in frames]
    (OUT / "moving.y4m").write_bytes(y4m())
    (OUT / "frames.u8").write_bytes(b"".join(values))
    lines = ",\n".join("  " + json.dumps(entry) for entry in index)
    (OUT / "index.json").write_text(f"[\n{lines}\n]\n")
    print(f"{len(index)} files, {len(values)} frames in {OUT.name}/")


if __name__ == "__main__":
    main()
