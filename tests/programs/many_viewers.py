#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One author encodes a film once for many: fifty readers of HLS behind nginx, and one over SRT.

Each reader's film has every picture, and the author's memory does not grow with its length. many_viewers.py BIN; ends with 77
where nginx, or FFmpeg's SRT, is missing."""
import argparse
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True  # beside the sources
import seeds

READERS, SECONDS, RATE = 50, 12, seeds.RATE
GROWTH_KIB = 4 * 1024  # of the author's memory from the second quarter of its work, sending in real time, to the last


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as bound:
        bound.bind(("127.0.0.1", 0))
        return bound.getsockname()[1]


class Author:
    """The author at work, with its memory read ten times a second."""

    def __init__(self, programs, folder, out):
        self.command = [os.path.join(programs, "relievo-author"), "--color", os.path.join(folder, "color.mkv"), "--depth",
                        os.path.join(folder, "depth.mkv"), "-o", out]
        self.resident = []
        self.process = subprocess.Popen(self.command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.watcher = threading.Thread(target=self.watch)
        self.watcher.start()

    def watch(self):
        while self.process.poll() is None:
            with open(f"/proc/{self.process.pid}/status", encoding="utf-8") as status:
                self.resident += [int(line.split()[1]) for line in status if line.startswith("VmRSS")]
            time.sleep(.1)

    def expect_done(self):
        said = self.process.communicate()[0]
        self.watcher.join()
        if self.process.returncode != 0:
            raise SystemExit(f"many_viewers: the author ended with {self.process.returncode}: {said}")

    def expect_flat(self):
        quarter = len(self.resident) // 4
        early, late = max(self.resident[quarter:2 * quarter]), max(self.resident[-quarter:])
        if late - early > GROWTH_KIB:
            raise SystemExit(f"many_viewers: the author's memory grew from {early} to {late} KiB")
        print(f"the author's memory while it sends: {early} KiB in the second quarter, {late} in the last", flush=True)


def expect_whole(films, pictures, how):
    """Every reader has the same film, with all its pictures."""
    wrong = {film: counts for film in films if min(counts := seeds.pictures_of(film)) < pictures}
    if wrong:
        raise SystemExit(f"many_viewers: {how}: {len(wrong)} of {len(films)} films are not whole: {list(wrong.items())[:3]}")
    print(f"{how}: {len(films)} read, each with {pictures} pictures and more", flush=True)


def serve(folder):
    """nginx over the folder; its process and address."""
    port = free_port()
    conf = os.path.join(folder, "nginx.conf")
    with open(conf, "w", encoding="utf-8") as text:
        text.write(f"""daemon off; master_process off; pid {folder}/nginx.pid; error_log {folder}/nginx.log;
events {{ worker_connections 256; }}
http {{
  access_log off; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy; fastcgi_temp_path {folder}/fastcgi;
  uwsgi_temp_path {folder}/uwsgi; scgi_temp_path {folder}/scgi;
  types {{ application/vnd.apple.mpegurl m3u8; video/mp4 mp4 m4s; }}
  server {{ listen 127.0.0.1:{port}; root {folder}/out; add_header Cache-Control no-cache; }}
}}
""")
    server = subprocess.Popen(["nginx", "-e", f"{folder}/nginx.log", "-c", conf], stdin=subprocess.DEVNULL)
    for _ in range(100):
        with socket.socket() as tried:
            if tried.connect_ex(("127.0.0.1", port)) == 0:
                return server, f"http://127.0.0.1:{port}"
        time.sleep(.1)
    raise SystemExit("many_viewers: nginx did not start")


def read_by_ffmpeg(url, film):
    return subprocess.Popen(["ffmpeg", "-v", "error", "-y", "-i", url, "-map", "0:v", "-c", "copy", film],
                            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def by_hls(programs, folder):
    os.makedirs(os.path.join(folder, "out"))
    Author(programs, folder, os.path.join(folder, "out", "film.m3u8")).expect_done()
    server, address = serve(folder)
    try:
        films = [os.path.join(folder, f"reader-{i}.mkv") for i in range(READERS)]
        readers = [read_by_ffmpeg(address + "/film.m3u8", film) for film in films]
        for reader in readers:
            reader.wait(120)
        expect_whole(films, SECONDS * RATE, "HLS behind nginx")
    finally:
        server.terminate()
        server.wait()


def by_srt(programs, folder):
    address = f"srt://127.0.0.1:{free_port(socket.SOCK_DGRAM)}"
    film = os.path.join(folder, "srt.mkv")
    reader = read_by_ffmpeg(address + "?mode=listener", film)
    time.sleep(.5)
    author = Author(programs, folder, address)
    author.expect_done()
    author.expect_flat()
    reader.wait(60)
    expect_whole([film], SECONDS * RATE - RATE, "SRT")  # what is sent while the reader finds out what it reads is lost


def main():
    reader = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    reader.add_argument("programs", metavar="BIN", help="folder of relievo-author")
    programs = os.path.abspath(reader.parse_args().programs)
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    protocols = subprocess.run(["ffmpeg", "-v", "error", "-protocols"], capture_output=True, text=True).stdout.split()
    if not shutil.which("nginx") or "srt" not in protocols:
        print("nginx or FFmpeg's SRT is not here; run toolchain/setup cluster")
        return 77
    with tempfile.TemporaryDirectory(prefix="relievo-viewers-") as folder:
        make = seeds.Maker(folder, programs)
        for track, graph in (("color", seeds.COLOR), ("depth", seeds.DEPTH)):
            make.ffmpeg("-f", "lavfi", "-i", graph, "-t", str(SECONDS), "-c:v", "ffv1", make.path(f"{track}.mkv"))
        by_hls(programs, folder)
        by_srt(programs, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
