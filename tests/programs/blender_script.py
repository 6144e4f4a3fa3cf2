#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs toolchain/blender/relievo_depth.py with a stand-in for Blender whose camera sees from 0.1 to 100 m, and then the command
that it prints, over pictures of 0.7 to 1.3 m: the relief spans these and not what the camera could see. blender_script.py BIN"""
import argparse
import contextlib
import io
import os
import runpy
import subprocess
import sys
import tempfile
from unittest import mock

sys.dont_write_bytecode = True  # beside the sources
import seeds

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "toolchain", "blender", "relievo_depth.py")


def printed(folder):
    blender = mock.MagicMock()
    blender.app.version = (4, 2, 0)
    scene = blender.context.scene
    scene.camera.data.clip_start, scene.camera.data.clip_end = .1, 100.0
    scene.frame_start, scene.frame_end, scene.frame_step = 1, 0, 1  # no frames: nothing renders here
    scene.render.fps, scene.render.fps_base = 25, 1.0
    said = io.StringIO()
    with mock.patch.dict(sys.modules, bpy=blender), mock.patch.object(sys, "argv", ["blender", "--", folder]):
        with contextlib.redirect_stdout(said):
            runpy.run_path(SCRIPT, run_name="__main__")
    return said.getvalue()


def main():
    reader = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    reader.add_argument("programs", metavar="BIN", help="folder of relievo-author")
    programs = os.path.abspath(reader.parse_args().programs)
    with tempfile.TemporaryDirectory(prefix="relievo-blender-") as folder:
        make = seeds.Maker(folder, programs)
        make.pictures("color-%04d.png", seeds.COLOR)
        make.pictures("depth-%04d.png", f"{seeds.DEPTH},format=gray16le,lut=c0=700+val*600/65535", "-pix_fmt", "gray16be")
        command = printed(folder)
        said = subprocess.run(["bash", "-c", command], cwd=folder, env={**os.environ, "PATH": programs + ":" + os.environ["PATH"]},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)
        tags = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream_tags=DEPTH_NEAR,DEPTH_FAR", "-of",
                               "default=nw=1", "film.mkv"], cwd=folder, capture_output=True, text=True).stdout
    found = dict(line.removeprefix("TAG:").split("=") for line in tags.split())
    near, far = float(found.get("DEPTH_NEAR", 0)), float(found.get("DEPTH_FAR", 1e9))
    if said.returncode != 0 or near < 400 or far > 2000:
        raise SystemExit(f"blender_script: {command}{said.stderr}{tags}: the relief should span about 0.7 to 1.3 m")
    print(f"{command}the relief spans {near:g} to {far:g} mm")


if __name__ == "__main__":
    main()
