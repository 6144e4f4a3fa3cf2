#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lists that come over the network name local films in every way: relievo and relievo-author open none of them.

The kernel (inotify) says which films are opened. The same lists as local files may name them: that run shows that an
opened film is noticed."""
import argparse
import ctypes
import functools
import http.server
import os
import signal
import subprocess
import sys
import tempfile
import threading

sys.dont_write_bytecode = True  # beside the sources
import seeds

IN_OPEN = 0x20
END_S = 60


class Opened:
    """The files of a folder that are opened, by whom it may be."""

    def __init__(self, folder):
        libc = ctypes.CDLL(None, use_errno=True)
        self.fd = libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        if self.fd < 0 or libc.inotify_add_watch(self.fd, os.fsencode(folder), IN_OPEN) < 0:
            raise OSError(ctypes.get_errno(), "inotify")

    def take(self):
        """Their names since the last call."""
        names = set()
        while True:
            try:
                events = os.read(self.fd, 65536)
            except BlockingIOError:
                return sorted(names - {""})
            while events:
                size = int.from_bytes(events[12:16], sys.byteorder)
                names.add(os.fsdecode(events[16:16 + size].rstrip(b"\0")))
                events = events[16 + size:]


def hls(part, before=""):
    return f"#EXTM3U\n#EXT-X-TARGETDURATION:1\n{before}#EXTINF:0.3,\n{part}\n#EXT-X-ENDLIST\n"


def dash(where):
    return ('<?xml version="1.0"?><MPD xmlns="urn:mpeg:dash:schema:mpd:2011" type="static" minBufferTime="PT1S" '
            'profiles="urn:mpeg:dash:profile:isoff-on-demand:2011" mediaPresentationDuration="PT0.3S"><Period>'
            f'<AdaptationSet contentType="video"><Representation id="0" mimeType="video/mp4" codecs="avc1.64000a" '
            f'width="64" height="48" bandwidth="9"><BaseURL>{where}</BaseURL><SegmentBase indexRange="0-9"/>'
            '</Representation></AdaptationSet></Period></MPD>')


def lists(folder, served):
    """Name and text of each list that names the films of `folder`, also by a path from the folder that is served."""
    film, near = os.path.join(folder, "film.ts"), os.path.relpath(os.path.join(folder, "film.ts"), served)
    ways = {"path": film, "near": near, "file": "file:" + film, "url": "file://" + film, "concat": "concat:" + film,
            "cached": "cache:" + film, "part": f"subfile,,start,0,end,0,,:{film}", "crypt": "crypto:" + film}
    made = {}
    for way, place in ways.items():
        made[f"{way}.m3u8"] = hls(place)
        made[f"{way}-master.m3u8"] = f"#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=9\n{place}\n"
        made[f"{way}.m3u"] = f"#EXTM3U\n#EXTINF:1,film\n{place}\n"
        made[f"{way}.ffconcat"] = f"ffconcat version 1.0\nfile '{place}'\n"
        made[f"{way}.mpd"] = dash(place)
    made["key.m3u8"] = hls("film.ts", f'#EXT-X-KEY:METHOD=AES-128,URI="file://{folder}/key"\n')
    made["map.m3u8"] = hls("film.ts", f'#EXT-X-MAP:URI="file://{folder}/film.mp4"\n')
    made["depth.m3u"] = f"#EXTM3U\n#RELIEVO-DEPTH:{folder}/depth.mkv\nfilm.ts\n"
    made["associations.txt"] = f"0.0 {film} 0.0 {folder}/depth.mkv\n"
    made["film.sdp"] = ("v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 1 RTP/AVP 96\n"
                        f"a=control:{film}\n")
    return made


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def run(programs, program, source, home):
    """Runs one program to its end; False if it had to be killed."""
    command = [os.path.join(programs, "relievo"), program, source]
    if program == "play":
        command += ["--display", "mock", "--haptic", "none", "--audio", "null", "--remote", "none", "--duration", "0.5"]
    if program == "author":
        out = os.path.join(home, "out.mkv")
        command = [os.path.join(programs, "relievo-author"), "--color", source, "-o", out, "--force"]
    quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen(command, cwd=home, env={**os.environ, "HOME": home}, start_new_session=True, **quiet)
    try:
        process.wait(END_S)
        return process.returncode in (0, 1, 2)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="the folder of relievo and relievo-author")
    programs = parser.parse_args().bin
    with tempfile.TemporaryDirectory() as place:
        films, served, home = (os.path.join(place, name) for name in ("films", "served", "home"))
        for folder in (films, served, home):
            os.mkdir(folder)
        make = seeds.Maker(films, programs)
        for name in ("film.ts", "film.mp4", "depth.mkv"):
            make.film(name, "-c:v", "libx264")
        make.film(os.path.join(served, "film.ts"), "-c:v", "libx264")
        with open(make.path("key"), "wb") as key:
            key.write(bytes(16))
        made = lists(films, served)
        for name, text in made.items():
            with open(os.path.join(served, name), "w", encoding="utf-8") as file:
                file.write(text)
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=served))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        opened, faults, noticed = Opened(films), 0, 0
        for name in made:
            for program in ("probe", "play", "author"):
                ended = run(programs, program, f"http://127.0.0.1:{server.server_port}/{name}", home)
                taken = opened.take()
                if taken or not ended:
                    faults += 1
                    what = "has opened " + " ".join(taken) if taken else f"has no end within {END_S} s, or crashed"
                    print(f"network_lists: {program} of {name} {what}", file=sys.stderr, flush=True)
            run(programs, "probe", os.path.join(served, name), home)
            noticed += bool(opened.take())
        server.shutdown()
    print(f"network_lists: {len(made)} lists, {faults} faults; as local files {noticed} of them open a film")
    sys.exit(1 if faults or noticed < 8 else 0)


main()
