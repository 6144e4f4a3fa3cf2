#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Stands for a program that guesses depth: it knows it, since the film's blue is its inverse depth. Over so many pictures
it drifts by 20 % in scale and offset, it flickers by 5 % from picture to picture, and it answers three pictures late.

  relievo-author --color FILM --depth-from 'mock_estimator.py PICTURES' -o OUT
"""
import math
import os
import sys

LATE = 3
samples = int(os.environ["RELIEVO_WIDTH"]) * int(os.environ["RELIEVO_HEIGHT"])
pictures = int(sys.argv[1])


def depth_of(rgb, k):
    """Codes of 16 bits, the low byte first."""
    gone = k / pictures
    scale = 60 * (1 + 0.2 * gone) * (1 + 0.05 * math.sqrt(2) * math.sin(2.3 * k))
    offset = 8000 + 60 * 204 * (0.2 * gone + 0.05 * math.sqrt(2) * math.cos(1.7 * k))
    codes = [round(scale * blue + offset) for blue in range(256)]
    depth = bytearray(2 * samples)
    depth[0::2] = rgb[2::3].translate(bytes(code % 256 for code in codes))
    depth[1::2] = rgb[2::3].translate(bytes(code // 256 for code in codes))
    return depth


waiting = []
for k in range(sys.maxsize):
    rgb = sys.stdin.buffer.read(3 * samples)
    if len(rgb) < 3 * samples:
        break
    waiting.append(depth_of(rgb, k))
    if len(waiting) > LATE:
        sys.stdout.buffer.write(waiting.pop(0))
        sys.stdout.buffer.flush()
sys.stdout.buffer.write(b"".join(waiting))
