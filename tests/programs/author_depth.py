#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Films by relievo-author of every kind of input, enhancement, law, codec, bits and container, decoded by ffmpeg.

Heights are computed here, from what went in and from the codes and tags that come out; they must agree within half a
code, the error of a codec that loses, and what an enhancement may change of a smooth scene."""
import argparse
import array
import concurrent.futures
import itertools
import json
import os
import random
import struct
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # beside the sources
import seeds
from seeds import COLS, PICTURES, RATE, ROWS

NEAR, FAR = 500, 2000  # mm
TAGS_UUID = bytes.fromhex("6e1f43b70d524c9ea7")  # the first bytes of user data that hold tags
OUTPUTS = [(codec, bits, ending) for codec, most in (("h264", (8, 10)), ("hevc", (8, 10, 12)))
           for bits in most for ending in ("mkv", "mp4", "mov", "ts", "m3u8")]
OUTPUTS += [("ffv1", bits, "mkv") for bits in (8, 10, 12, 16)]
ENHANCEMENTS = ("none", "median", "dibm", "space-time")
LAWS = ("source", "linear", "inverse")
# Largest and mean error of heights, of the relief's depth, beside half a code.
LOSSY = (0.02, 0.002)
ENHANCED = (0.01, 0.002)


def scene(c, r, k):
    """A plane that rises, and an object in front of it; 0 far, 1 near."""
    step = 0.2 if 20 <= c < 36 and 14 <= r < 30 else 0
    return 0.25 + 0.2 * c / (COLS - 1) + 0.07 * r / (ROWS - 1) + 0.01 * k + step


def near_edge(c, r):
    """Whether a codec or an enhancement may mix object and plane there, or the picture ends."""
    across, down = min(abs(c - 19.5), abs(c - 35.5)), min(abs(r - 13.5), abs(r - 29.5))
    inside = 16 <= c < 40 and 10 <= r < 34
    return inside and (across < 4 or down < 4) or c < 4 or r < 4 or c >= COLS - 4 or r >= ROWS - 4


PLACES = [(c, r) for r in range(ROWS) for c in range(COLS)]
SCENE = [[scene(c, r, k) for c, r in PLACES] for k in range(PICTURES)]
INNER = [i for i, (c, r) in enumerate(PLACES) if not near_edge(c, r)]


def inverse_height(s, near=NEAR, far=FAR):
    return (far - 1 / (s / near + (1 - s) / far)) / (far - near)


class Input:
    """A film as the author gets it, and the heights that are in it."""

    def __init__(self, name, arguments, heights):
        self.name, self.arguments, self.heights = name, arguments, heights


class Inputs(seeds.Maker):
    def raw(self, name, pixels, pix_fmt, *options, cols=COLS):
        """A film of raw pictures."""
        path = self.path("work/" + name.replace("/", "-").replace("%", "") + ".raw")
        with open(path, "wb") as file:
            file.write(b"".join(pixels))
        self.ffmpeg("-f", "rawvideo", "-pix_fmt", pix_fmt, "-s", f"{cols}x{ROWS}", "-r", str(RATE), "-i", path,
                    *options, self.path(name))
        return self.path(name)

    def coded(self, name, highest, code, height, kind, *options, calibration=(), depth_name=None):
        """Depth whose codes are code(s), 0 to highest, in a film of its own."""
        codes = [[round(code(s) * highest) for s in picture] for picture in SCENE]
        wide = "B" if highest < 256 else "H"
        path = self.raw(depth_name or f"{name}/depth.mkv", [array.array(wide, picture).tobytes() for picture in codes],
                        kind, *options)
        arguments = ["--color", self.color, "--depth", path, *calibration]
        return Input(name, arguments, [[height(value / highest) for value in picture] for picture in codes])

    def make(self):
        self.pictures("color.mkv", seeds.COLOR, *seeds.H264)
        self.color = self.path("color.mkv")
        yield from self.coded_depth()
        yield from self.distances()
        yield from self.floats()
        yield from self.packed()

    def coded_depth(self):
        ffv1 = ("-c:v", "ffv1")
        yield self.coded("gray", 255, lambda s: s, lambda s: s, "gray", *ffv1)
        yield self.coded("near-low", 255, lambda s: 1 - s, lambda s: 1 - s, "gray", *ffv1,
                         calibration=("--calibration", "polarity=near-low"))
        yield self.coded("gray16", 65535, lambda s: s, lambda s: s, "gray16le", *ffv1)
        yield self.coded("inverse", 1023, lambda s: s, inverse_height, "gray10le", *ffv1,
                         calibration=("--calibration", f"law=inverse,near={NEAR},far={FAR}"))
        yield self.coded("inverse-h264", 255, lambda s: s, inverse_height, "gray", "-c:v", "libx264", "-qp", "0",
                         calibration=("--calibration", f"law=inverse,range=full,near={NEAR},far={FAR}"))
        yield self.coded("limited", 255, lambda s: (16 + 219 * s) / 255, lambda v: (255 * v - 16) / 219, "gray", *ffv1,
                         calibration=("--calibration", "range=limited"))

    def distances(self):
        said = ("--calibration", f"unit=1,invalid=0,near={NEAR},far={FAR}")
        codes = [array.array("H", [round(FAR - s * (FAR - NEAR)) for s in picture]) for picture in SCENE]
        heights = [[(FAR - z) / (FAR - NEAR) for z in picture] for picture in codes]
        raw = [picture.tobytes() for picture in codes]

        def one(name, path, options=said, color=None):
            depth = ["--depth", path] if path else []
            return Input(name, ["--color", color or self.color, *depth, *options], heights)

        yield one("mm-mkv", self.raw("mm.mkv", raw, "gray16le", "-c:v", "ffv1"))
        self.raw("mm/depth-%03d.png", raw, "gray16le")
        yield one("mm-png", self.path("mm/depth-%03d.png"), (*said, "--fps", str(RATE)))
        self.raw("mm/depth-%03d.tiff", raw, "gray16le")
        yield one("mm-tiff", self.path("mm/depth-%03d.tiff"), (*said, "--fps", str(RATE)))
        self.bytes("mm.npy", seeds.npy(raw))
        yield one("mm-npy", self.path("mm.npy"), (*said, "--fps", str(RATE)))
        colors = [bytes([128 + k]) * (3 * COLS * ROWS) for k in range(PICTURES)]
        self.bytes("film.bag", seeds.bag(colors, raw))
        yield one("mm-bag", None, said, self.path("film.bag"))
        self.raw("folder/depth/%06d.png", raw, "gray16le")
        self.pictures("folder/rgb/%06d.png", seeds.COLOR)
        yield one("mm-folder", None, (*said, "--fps", str(RATE)), self.path("folder"))

    def floats(self):
        metres = [[2.0 - 1.5 * s for s in picture] for picture in SCENE]
        said = ("--calibration", f"near={NEAR},far={FAR}", "--fps", str(RATE))
        head = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({PICTURES}, {ROWS}, {COLS}), }}".ljust(117) + "\n"
        data = b"".join(struct.pack(f"<{COLS * ROWS}f", *picture) for picture in metres)
        self.bytes("m.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + data)
        yield Input("float-npy", ["--color", self.color, "--depth", self.path("m.npy"), *said], SCENE)
        for k, picture in enumerate(metres):
            raw = array.array("H", [round(1000 * z) for z in picture]).tobytes()
            self.bytes(f"float/{k + 1:03d}.tiff", seeds.float_tiff(raw))
        mm = [[(2000 - round(1000 * z)) / 1500 for z in picture] for picture in metres]
        yield Input("float-tiff", ["--color", self.color, "--depth", self.path("float/%03d.tiff"), *said], mm)

    def packed(self):
        gray = [bytes(round(255 * s) for s in picture) for picture in SCENE]
        heights = [[value / 255 for value in picture] for picture in gray]
        chroma = bytes([128]) * (COLS * ROWS // 2)
        color = [bytes([40 + 10 * k + c % 50 for _, c in PLACES]) for k in range(PICTURES)]
        # Declared before the encoder, which would scale it (FFmpeg 7) or, as yuvj420p, make it limited (FFV1 has none).
        full = ("-vf", "setparams=range=pc", "-c:v", "ffv1", "-color_range", "pc")
        beside = [b"".join(a[r * COLS:(r + 1) * COLS] + b[r * COLS:(r + 1) * COLS] for r in range(ROWS)) + chroma * 2
                  for a, b in zip(color, gray)]
        path = self.raw("sbs.mkv", beside, "yuv420p", *full, cols=2 * COLS)
        yield Input("sbs", ["--color", path, "--packing", "sbs"], heights)
        self.raw("two-color.mkv", [picture + chroma for picture in color], "yuv420p", *full)
        self.raw("two-depth.mkv", gray, "gray", "-c:v", "ffv1")
        self.ffmpeg("-i", self.path("two-color.mkv"), "-i", self.path("two-depth.mkv"), "-map", "0:v", "-map", "1:v",
                    "-c", "copy", self.path("tracks.mkv"))
        yield Input("tracks", ["--color", self.path("tracks.mkv"), "--packing", "tracks"], heights)
        yield self.hue()

    def hue(self):
        """The hue over 360 degrees, from red (near) through yellow, green, cyan, blue and magenta: 1530 colours."""
        def rgb(step):
            up = step % 255
            return ((255, up, 0), (255 - up, 255, 0), (0, 255, up), (0, 255 - up, 255), (up, 0, 255),
                    (255, 0, 255 - up))[step // 255]

        steps = [[round(1529 * (1 - s)) for s in picture] for picture in SCENE]
        pixels = [b"".join(bytes((*rgb(step)[::-1], 0)) for step in picture) for picture in steps]
        path = self.raw("hue.mkv", pixels, "bgr0", "-c:v", "ffv1")
        return Input("hue", ["--color", self.color, "--depth", path, "--depth-code", "hue"],
                     [[1 - step / 1530 for step in picture] for picture in steps])


def output_of(*command):
    said = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True)
    if said.returncode != 0:
        raise ValueError(f"{os.path.basename(command[0])} says: {said.stderr.decode(errors='replace').strip()[-600:]}")
    return said.stdout


def decoded(film):
    """The tags of the depth, from container or stream, and its pictures as codes."""
    told = json.loads(output_of("ffprobe", "-v", "error", "-of", "json", "-show_entries",
                                "format_tags:stream_tags:stream=codec_name,pix_fmt,width,height,codec_type", film))
    track = [stream for stream in told["streams"] if stream["codec_type"] == "video"][1]
    if (track["width"], track["height"]) != (COLS, ROWS):
        raise ValueError(f"the depth has {track['width']} x {track['height']} samples")
    tags = {**told["format"].get("tags", {}), **track.get("tags", {})}
    depth = ("-v", "error", "-i", film, "-map", "0:v:1")
    if "DEPTH_LAW" not in tags:
        stream = output_of("ffmpeg", *depth, "-c", "copy", "-f", track["codec_name"], "-").replace(b"\0\0\3", b"\0\0")
        at = stream.index(TAGS_UUID) + 16
        text = stream[at:at + 600].decode("ascii", "replace")
        tags.update(line.split("=", 1) for line in text.split("\n") if line.startswith("DEPTH_"))
    raw = output_of("ffmpeg", *depth, "-fps_mode", "passthrough", "-f", "rawvideo", "-")
    wide = track["pix_fmt"].endswith("le")
    chroma = COLS * ROWS // 2 if "420" in track["pix_fmt"] else 0
    size = (COLS * ROWS + chroma) * (2 if wide else 1)
    pictures = [array.array("H" if wide else "B", raw[at:at + size])[:COLS * ROWS] for at in range(0, len(raw), size)]
    return tags, pictures


def compare(tags, pictures, heights, bits, allowed):
    """What is wrong, or nothing; and the largest and the mean error beyond half a code."""
    if len(pictures) != len(heights):
        raise ValueError(f"{len(pictures)} pictures came out, {len(heights)} went in")
    if tags["DEPTH_POLARITY"] != "near-high" or tags["DEPTH_BITS"] != str(bits):
        raise ValueError(f"tags {tags}")
    low, high = map(int, tags["DEPTH_CODES"].split("-")) if "-" in tags["DEPTH_CODES"] else (0, 2 ** bits - 1)
    inverse = tags["DEPTH_LAW"] == "inverse"
    near, far = float(tags["DEPTH_NEAR"]), float(tags["DEPTH_FAR"])

    def height(code):
        s = min(max((code - low) / (high - low), 0), 1)
        return inverse_height(s, near, far) if inverse else s

    of_code = [height(code) for code in range(2 ** bits)]
    half = [abs(of_code[min(code + 1, 2 ** bits - 1)] - of_code[max(code - 1, 0)]) / 4 for code in range(2 ** bits)]
    worst, total = 0.0, 0.0
    for picture, truth in zip(pictures, heights):
        for i in INNER:
            error = max(abs(of_code[picture[i]] - truth[i]) - 1.02 * half[picture[i]], 0)
            worst, total = max(worst, error), total + error
    mean = total / len(INNER) / len(pictures)
    if worst > allowed[0] or mean > allowed[1]:
        raise ValueError(f"heights are wrong by at most {worst:.5f}, {mean:.5f} on the average; "
                         f"allowed are {allowed[0]:.5f} and {allowed[1]:.5f}")
    return worst, mean


def allowance(codec, lossless, enhancement):
    worst, mean = 1e-4, 1e-4  # what 16 bits of floating-point depth lose
    for more in ([] if codec == "ffv1" or lossless else [LOSSY]) + ([] if enhancement == "none" else [ENHANCED]):
        worst, mean = worst + more[0], mean + more[1]
    return worst, mean


def films(inputs, first, count):
    """Every output with every law and enhancement, and the inputs in turn."""
    ways = list(itertools.product(OUTPUTS, LAWS, ENHANCEMENTS))
    random.Random(1).shuffle(ways)
    for k in range(first, first + count):
        (codec, bits, ending), law, enhancement = ways[k % len(ways)]
        yield k, inputs[k % len(inputs)], codec, bits, ending, law, enhancement, k // len(inputs) % 2 == 1


def check(author, folder, film):
    k, source, codec, bits, ending, law, enhancement, lossless = film
    out = os.path.join(folder, f"out-{k}", f"film.{ending}")
    os.makedirs(os.path.dirname(out))
    command = [author, *source.arguments, "-o", out, "--depth-codec", codec, "--depth-bits", str(bits), "--depth-law",
               law, "--enhance", enhancement, *(["--depth-crf", "0"] if lossless and codec != "ffv1" else [])]
    group = "lossless" if lossless or codec == "ffv1" else codec
    group += ", not enhanced" if enhancement == "none" else ", enhanced"
    try:
        output_of(*command)
        return group, compare(*decoded(out), source.heights, bits, allowance(codec, lossless, enhancement)), ""
    except (ValueError, KeyError, IndexError) as error:
        return group, (0, 0), f"film {k}, {source.name}: {' '.join(command)}\n  {type(error).__name__}: {error}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="the folder of relievo-author")
    parser.add_argument("--films", type=int, default=348, help="how many [%(default)s: every way of writing]")
    parser.add_argument("--first", type=int, default=0, help="number of the first film [%(default)s]")
    parser.add_argument("--keep", help="an empty folder for the films, which stay there")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        folder = options.keep or scratch
        inputs = list(Inputs(os.path.join(folder, "in"), options.bin).make())
        author = os.path.join(options.bin, "relievo-author")
        done = list(pool.map(lambda film: check(author, folder, film), films(inputs, options.first, options.films)))
    faults = [fault for _, _, fault in done if fault]
    for fault in faults:
        print(f"author_depth: {fault}", file=sys.stderr)
    for group in sorted({group for group, _, _ in done}):
        worst = max(errors[0] for of, errors, _ in done if of == group)
        mean = max(errors[1] for of, errors, _ in done if of == group)
        count = sum(of == group for of, _, _ in done)
        print(f"author_depth: {count} films {group}: beyond half a code at most {worst:.5f} of the relief, "
              f"on the average of a film {mean:.5f}")
    print(f"author_depth: {len(done)} films of {len(inputs)} kinds of input, {len(faults)} wrong")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
