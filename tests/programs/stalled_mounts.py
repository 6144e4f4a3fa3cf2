#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gives the three programs files of a mount that stalls at one operation, to read and to write (stalled_writing.py).

Each program says so in one line after 10 s and ends with exit code 1. Until then, quit, a signal and the next open work
at once: without that line. Nothing is left behind. Ends with code 77 where a file system of FUSE may not be mounted."""
import argparse
import concurrent.futures
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # beside the sources
import seeds
import stalled_player
import stalled_writing
import stalling_files

END_S = 120  # for an end of any kind, on a busy machine
IN_NAMESPACE = "RELIEVO_STALLED_MOUNTS"
H264 = ("-c:v", "libx264", "-threads", "1", "-pix_fmt", "yuv420p", "-g", "4")

# The command, the operation and the file that stall, and the thing that the error message must name; @ is the mount.
GIVEN_UP = (
    ("relievo probe @/film.mkv", "lookup", "film.mkv", "@/film.mkv"),
    ("relievo probe @/film.mkv", "getattr", "film.mkv", "@/film.mkv"),
    ("relievo probe @/film.mkv", "open", "film.mkv", "@/film.mkv"),
    ("relievo probe @/film.mkv", "read", "film.mkv", "@/film.mkv"),
    ("relievo probe @/film.m3u8", "open", "film0.ts", "@/film.m3u8"),
    ("relievo probe @/folder", "readdir", "folder", "@/folder"),
    ("relievo probe @/folder", "read", "folder/color/000001.png", "@/folder"),
    ("relievo probe @/film.mkv --depth @/depth.npy", "read", "depth.npy", "@/depth.npy"),
    ("relievo probe @/film.mkv --calibration @/depth.txt", "read", "depth.txt", "--calibration @/depth.txt"),
    ("relievo play @/list.m3u --display mock --haptic none --remote none", "read", "list.m3u", "@/list.m3u"),
    ("relievo play mock: --display mock --config @/relievo.toml", "open", "relievo.toml", "@/relievo.toml"),
    ("relievo-author --color @/film.mkv -o out.mkv", "read", "film.mkv", "@/film.mkv"),
    ("relievo-author --color @/film.mkv --depth @/depth.mkv -o out.mkv", "lookup", "depth.mkv", "@/depth.mkv"),
    ("relievo-author --color mock: -o @/out.mkv", "lookup", "out.mkv", "@/out.mkv"),
    ("relievo-lab trace --depth @/depth.mkv --hip @/hip.csv --out out.csv --method relievo", "open", "depth.mkv",
     "@/depth.mkv"),
    ("relievo-lab trace --depth @/depth.mkv --hip @/hip.csv --out out.csv --method relievo", "read", "hip.csv",
     "@/hip.csv"),
)


def make_files(folder, programs):
    """Films, pictures and text files of every kind that the programs read by name."""
    make = seeds.Maker(folder, programs)
    make.film("film.mkv", *H264)
    make.film("film.m3u8", *H264, "-hls_time", "0.16", "-hls_list_size", "0")
    make.pictures("depth.mkv", seeds.DEPTH, "-c:v", "ffv1", "-pix_fmt", "gray")
    make.pictures("folder/color/%06d.png", seeds.COLOR)
    make.pictures("folder/depth/%06d.png", seeds.DISTANCE)
    make.bytes("depth.npy", seeds.npy(make.gray16()))
    make.bytes("pages.tiff", stalled_player.pages(400))
    make.bytes("large.jpg", b"\xff\xd8\xff\xe1" + bytes(60_000_000))
    make.text("depth.txt", "unit=1\n")
    make.text("list.m3u", "#EXTM3U\nfilm.mkv\n")
    make.text("relievo.toml", "")
    make.text("hip.csv", "t_s,x_mm,y_mm,z_mm\n" + "".join(f"{k / 1000},0,0,20\n" for k in range(100)))
    make.text("film.srt", "1\n00:00:00,000 --> 00:00:01,000\nwords\n")


class Case:
    """A mount, a program that meets it, and what the program said. The mount shows the films, or an empty folder."""

    def __init__(self, programs, films, scratch, writes):
        self.programs, self.films, self.scratch = programs, films, scratch
        self.place, self.home, self.shown = (os.path.join(scratch, name) for name in ("mount", "home", "shown"))
        self.said = os.path.join(scratch, "said")
        for folder in (self.place, self.home, self.shown):
            os.makedirs(folder)
        self.files = stalling_files.StallingFiles(self.shown if writes else films, self.place)
        self.process = self.socket = None
        self.asked = 0

    def start(self, line, **more):
        """`line` may name the mount as @, and a film elsewhere as &; `more` is of the environment."""
        film = os.path.join(self.films, "film.mkv")
        program, *arguments = line.replace("@", self.place).replace("&", film).split()
        environment = {**os.environ, "HOME": self.home, "XDG_RUNTIME_DIR": self.home, "DISPLAY": "",
                       "WAYLAND_DISPLAY": "", "XDG_CONFIG_HOME": self.home, **more}
        with open(self.said, "wb") as said:
            self.process = subprocess.Popen([os.path.join(self.programs, program), *arguments], cwd=self.home,
                                            env=environment, stdin=subprocess.DEVNULL, stdout=said, stderr=said)

    def start_player(self, more="", display="mock", **environment):
        """A player that waits for commands."""
        address = os.path.join(self.scratch, "socket")
        self.start(f"relievo play --control {address} --display {display} --haptic mock --audio null --remote none {more}",
                   **environment)
        self.socket = socket.socket(socket.AF_UNIX)
        end = time.monotonic() + END_S
        while time.monotonic() < end:
            try:
                self.socket.connect(address)
                break
            except OSError:
                time.sleep(0.05)
        self.socket.settimeout(END_S)

    def ask(self, words):
        self.asked += 1
        self.socket.sendall(json.dumps({"do": words, "id": self.asked}).encode() + b"\n")
        heard = b""
        while True:
            heard += self.socket.recv(1 << 16)
            for line in heard.split(b"\n")[:-1]:
                if b'"ok"' in line:
                    return json.loads(line)

    def plays(self, film):
        """Two pictures of the film at different times."""
        end, seen = time.monotonic() + END_S, set()
        while time.monotonic() < end and len(seen) < 2:
            status = self.ask("status")
            if status.get("state") == "playing" and status.get("source") == film:
                seen.add(status["position_s"])
            time.sleep(0.05)
        return len(seen) == 2

    def meets_stall(self):
        return self.files.arrived.wait(END_S)

    def code(self):
        """The exit code; None if it had to be killed."""
        try:
            return self.process.wait(END_S)
        except subprocess.TimeoutExpired:
            return None

    def words(self):
        with open(self.said, encoding="utf-8", errors="replace") as file:
            return file.read()

    def close(self):
        if self.process and self.process.poll() is None:
            self.process.kill()
        self.files.close()
        if self.process:
            self.process.wait()


def given_up(case, line, operation, file, thing):
    case.files.stall(operation, file)
    case.start(line)
    code, words = case.code(), case.words()
    if code != 1 or f"{thing.replace('@', case.place)}: the file system {stalled_player.SAID}" not in words:
        return f"exit code {code}: {words}"
    left = os.listdir(case.home)
    return f"left behind: {left}" if left else ""


def author_stops(case):
    case.files.stall("read", "film.mkv")
    case.start("relievo-author --color @/film.mkv -o out.mkv")
    met = case.meets_stall()
    case.process.send_signal(signal.SIGTERM)
    code = case.code()
    return stalled_player.at_once(case, "SIGTERM", met and code is not None and not os.listdir(case.home))


def author_copies(case):
    """The file is opened for its sound when its pictures are read already."""
    case.start("relievo-author --color @/film.mkv -o out.mkv")
    code, opens = case.code(), case.files.count("open", "film.mkv")
    os.remove(os.path.join(case.home, "out.mkv"))
    if code != 0 or opens < 2:
        return f"exit code {code}: {case.words()}"
    case.files.stall("open", "film.mkv", opens - 1)
    case.start("relievo-author --color @/film.mkv -o out.mkv")
    code = case.code()
    return "" if code == 1 and stalled_player.SAID in case.words() else f"exit code {code}: {case.words()}"


AT_ONCE = (
    ("SIGTERM to the author", author_stops),
    ("sound of the author's colour", author_copies),
)


def tests():
    """Name and function of each case, and whether it writes."""
    for given in GIVEN_UP:
        yield f"{given[0]} ({given[1]} of {given[2]})", lambda case, given=given: given_up(case, *given), False
    for each in (*AT_ONCE, *stalled_player.TESTS):
        yield *each, False
    for each in stalled_writing.tests():
        yield *each, True


def run(programs, films, folder, number, test, writes):
    scratch = os.path.join(folder, str(number))
    os.makedirs(scratch)
    case = Case(programs, films, scratch, writes)
    try:
        return test(case)
    finally:
        case.close()


def may_mount(folder):
    place = os.path.join(folder, "try")
    os.makedirs(place)
    try:
        stalling_files.StallingFiles(folder, place).close()
    except OSError as error:
        print(f"stalled_mounts: skipped: no file system of FUSE may be mounted here ({error.strerror})")
        return False
    return True


def in_own_namespace():
    """Runs this program again where its mounts are nobody else's, and end with it."""
    unshare = ["unshare", "-m"] if os.getuid() == 0 else ["unshare", "-r", "-m"]
    if subprocess.run([*unshare, "true"], capture_output=True).returncode != 0:
        print("stalled_mounts: skipped: no own namespace of mounts is permitted here")
        sys.exit(77)
    environment = {**os.environ, IN_NAMESPACE: "1"}
    os.execvpe("unshare", [*unshare, sys.executable, *sys.argv], environment)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="the folder of the programs")
    parser.add_argument("--only", default="", help="only the cases whose names contain this")
    options = parser.parse_args()
    if IN_NAMESPACE not in os.environ:
        in_own_namespace()
    programs = os.path.abspath(options.bin)
    folder = tempfile.mkdtemp(prefix="relievo-stalled-")
    try:
        if not may_mount(folder):
            sys.exit(77)
        films = os.path.join(folder, "films")
        make_files(films, programs)
        chosen = [test for test in tests() if options.only in test[0]]
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            jobs = [pool.submit(run, programs, films, folder, number, *test[1:]) for number, test in enumerate(chosen)]
            findings = [f"{test[0]}: {job.result()}" for test, job in zip(chosen, jobs) if job.result()]
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for finding in findings:
        print(f"stalled_mounts: {finding}", file=sys.stderr)
    print(f"stalled_mounts: {len(chosen)} cases, {len(findings) or 'nothing'} found")
    sys.exit(1 if findings else 0)


main()
