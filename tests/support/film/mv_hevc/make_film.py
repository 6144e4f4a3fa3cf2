#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes two_views.mov, which README.md describes: make_film.py X265 [FOLDER]. X265 is the program of x265 4.0 or later,
configured with ENABLE_MULTIVIEW=ON; it writes the coded views, this script their pictures and the boxes around them
(ISO/IEC 14496-12; 14496-15, 9; Apple's "ISO Base Media File Format and Apple HEVC Stereo Video")."""
import math
import struct
import subprocess
import sys
import tempfile

COLS, ROWS, PICTURES, GROUP, RATE = 128, 96, 8, 4, 25
CHROMA = {"left": 100, "right": 156}  # Cb of the whole picture; Cr is 128


def noise(i, j, seed):
    h = (i * 0x9E3779B1 ^ j * 0x85EBCA77 ^ seed * 0xC2B2AE3D) & 0xFFFFFFFF
    h = (h ^ h >> 15) * 0x2C1B3C6D & 0xFFFFFFFF
    h = (h ^ h >> 12) * 0x297A2D39 & 0xFFFFFFFF
    return ((h ^ h >> 15) & 0xFFFF) / 65535 - 0.5


def smooth(x, y, seed):
    i, j = math.floor(x), math.floor(y)
    a, b = ((3 - 2 * t) * t * t for t in (x - i, y - j))
    above, below = (noise(i, k, seed) * (1 - a) + noise(i + 1, k, seed) * a for k in (j, j + 1))
    return above * (1 - b) + below * b


def texture(c, r, seed, mean):
    return mean + 70 * smooth(c / 5, r / 5, seed) + 30 * smooth(c / 13, r / 13, seed + 7)


def luma(view, c, r, k):
    """A board before a wall; the board moves right by two columns a picture. Disparities: 6 and 2 columns."""
    in_left = c if view == "left" else c + 6
    if 40 + 2 * k <= in_left < 88 + 2 * k and 24 <= r < 72:
        return texture(in_left - 2 * k, r, 2, 150)
    return texture(c if view == "left" else c + 2, r, 1, 100)


def pictures(view):
    chroma = bytes([CHROMA[view]]) * (COLS * ROWS // 4) + bytes([128]) * (COLS * ROWS // 4)
    places = [(c, r) for r in range(ROWS) for c in range(COLS)]
    return b"".join(bytes(int(luma(view, c, r, k)) for c, r in places) + chroma for k in range(PICTURES))


def coded(x265, folder):
    for view in CHROMA:
        with open(f"{folder}/{view}.yuv", "wb") as file:
            file.write(pictures(view))
    with open(f"{folder}/views", "w") as file:
        file.write(f'--num-views 2\n--format 0\n--input "{folder}/left.yuv"\n--input "{folder}/right.yuv"\n')
    subprocess.run([x265, "--multiview-config", f"{folder}/views", "--input-res", f"{COLS}x{ROWS}", "--fps", str(RATE),
                    "--frames", str(PICTURES), "--input-csp", "i420", "--input-depth", "8", "--crf", "22", "--keyint",
                    str(GROUP), "--min-keyint", str(GROUP), "--no-open-gop", "--bframes", "2", "--b-adapt", "0", "--no-info",
                    "--log-level", "error", "--output", f"{folder}/film.hevc"], check=True)
    with open(f"{folder}/film.hevc", "rb") as file:
        return [unit.rstrip(b"\0") for unit in file.read().split(b"\0\0\1") if unit.rstrip(b"\0")]


def kind(unit):
    return unit[0] >> 1 & 0x3F


def layer(unit):
    return (unit[0] & 1) << 5 | unit[1] >> 3


def order_in_group(unit):
    """slice_pic_order_cnt_lsb of a slice (H.265, 7.3.6.1), of x265's parameters."""
    if kind(unit) in (19, 20):
        return 0
    bits = "".join(f"{byte:08b}" for byte in unit[2:12])
    at = 4  # first_slice_segment_in_pic_flag 1, slice_pic_parameter_set_id 0, two extra bits
    at += 2 * (bits.index("1", at) - at) + 1  # slice_type
    return int(bits[at:at + 8], 2)


def box(name, *content):
    content = b"".join(content)
    return struct.pack(">I4s", 8 + len(content), name) + content


def full(name, *content, version=0, flags=0):
    return box(name, struct.pack(">I", version << 24 | flags), *content)


def numbers(*values):
    return struct.pack(f">{len(values)}I", *values)


def arrays(units):
    return bytes([len(units)]) + b"".join(struct.pack(">BHH", 0x80 | kind(u), 1, len(u)) + u for u in units)


def sample_entry(sets):
    base, second = ([u for u in sets if layer(u) == n] for n in (0, 1))
    profile = next(u for u in base if kind(u) == 33).replace(b"\0\0\3", b"\0\0")[3:15]
    hvcc = box(b"hvcC", b"\1", profile, bytes.fromhex("f000fcfdf8f800000f"), arrays(base))
    lhvc = box(b"lhvC", bytes.fromhex("01f000fccf"), arrays(second))
    eyes = box(b"eyes", full(b"stri", bytes([3])), full(b"hero", bytes([1])))  # both eyes, not reversed; the left leads
    picture = bytes(6) + struct.pack(">H", 1) + bytes(16) + struct.pack(">HHIIIH", COLS, ROWS, 72 << 16, 72 << 16, 0, 1)
    return box(b"hvc1", picture, bytes(32), struct.pack(">Hh", 24, -1), hvcc, lhvc, box(b"vexu", eyes))


def film(units):
    sets = [u for u in units if kind(u) in (32, 33, 34)]
    samples = []
    begins = []
    for unit in units:
        if kind(unit) in (32, 33, 34):
            continue
        prefix = kind(unit) == 39
        if not samples or (layer(unit) == 0 and begins[-1]):
            samples.append([])
            begins.append(False)
        samples[-1].append(unit)
        begins[-1] = begins[-1] or not prefix
    slices = [next(u for u in s if kind(u) < 32) for s in samples]
    group = [sum(kind(u) >= 16 for u in slices[:i + 1]) - 1 for i in range(len(slices))]
    shown = [GROUP * g + order_in_group(u) for g, u in zip(group, slices)]
    late = max(i - at for i, at in enumerate(shown))
    data = [b"".join(struct.pack(">I", len(u)) + u for u in s) for s in samples]
    length, size = len(samples), struct.pack(">II", COLS << 16, ROWS << 16)
    unity = numbers(1 << 16, 0, 0, 0, 1 << 16, 0, 0, 0, 1 << 30)
    mdat = box(b"mdat", *data)
    ftyp = box(b"ftyp", b"qt  ", numbers(0), b"qt  ")
    table = box(b"stbl", full(b"stsd", numbers(1), sample_entry(sets)), full(b"stts", numbers(1, length, 1)),
                full(b"ctts", numbers(length), *(numbers(1, at - i + late) for i, at in enumerate(shown))),
                full(b"stss", numbers(2, 1, GROUP + 1)), full(b"stsc", numbers(1, 1, length, 1)),
                full(b"stsz", numbers(0, length, *map(len, data))), full(b"stco", numbers(1, len(ftyp) + 8)))
    media = box(b"mdia", full(b"mdhd", numbers(0, 0, RATE, length, 0x55C40000)),
                full(b"hdlr", b"mhlrvide", bytes(13)),
                box(b"minf", full(b"vmhd", bytes(8), flags=1),
                    box(b"dinf", full(b"dref", numbers(1), full(b"url ", flags=1))), table))
    edits = box(b"edts", full(b"elst", numbers(1, length, late, 1 << 16)))
    track = box(b"trak", full(b"tkhd", numbers(0, 0, 1, 0, length, 0, 0, 0, 0), unity, size, flags=7), edits, media)
    head = full(b"mvhd", numbers(0, 0, RATE, length, 1 << 16, 0x01000000, 0, 0), unity, bytes(24), numbers(2))
    return ftyp + mdat + box(b"moov", head, track)


def main():
    folder = sys.argv[2] if len(sys.argv) > 2 else "."
    with tempfile.TemporaryDirectory() as scratch:
        data = film(coded(sys.argv[1], scratch))
    with open(f"{folder}/two_views.mov", "wb") as file:
        file.write(data)


main()
