#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the lines of toolchain/catalogue.md as they stand there, with GNU parallel and with a Slurm of this machine alone.

Of twenty films one job is killed, and Slurm's daemon of the machine is started again meanwhile. Submitted once more, every film is
whole, and none was made twice. A film made in segments has one code for one distance before and after the join.
catalogue.py BIN; ends with 77 where GNU parallel or Slurm is missing."""
import argparse
import contextlib
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # beside the sources
import seeds

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "toolchain", "catalogue.md")
FILMS, PICTURES = 20, 60
NEEDED = {"parallel": "parallel", "munged": "munge", "slurmctld": "slurmctld", "slurmd": "slurmd", "sbatch": "slurm-client"}


def blocks_below(heading):
    """The texts between ``` below a heading of the page."""
    with open(PAGE, encoding="utf-8") as page:
        section = page.read().split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return re.findall(r"^```\n(.*?)^```$", section, re.S | re.M)


def free_port():
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return listening.getsockname()[1]


class Catalogue:
    """A folder with films.tsv as the page shows it, over one pair of tracks."""

    def __init__(self, programs, folder, environment=None):
        self.folder = folder
        self.environment = {**os.environ, **(environment or {}), "PATH": programs + ":" + os.environ["PATH"]}
        for name in ("color", "depth", "out", "logs"):
            os.makedirs(os.path.join(folder, name))
        make = seeds.Maker(folder, programs)
        for track, graph in (("color", seeds.COLOR), ("depth", seeds.DEPTH)):
            make.ffmpeg("-f", "lavfi", "-i", graph, "-frames:v", str(PICTURES), "-c:v", "ffv1", make.path(f"{track}.mkv"))
        self.names = [f"film-{i:02}.mkv" for i in range(FILMS)]
        with open(self.path("films.tsv"), "w", encoding="utf-8") as table:
            for name in self.names:
                for track in ("color", "depth"):
                    os.symlink(f"../{track}.mkv", self.path(track, name))
                table.write(f"color/{name}\tdepth/{name}\tout/{name}\tlaw=inverse,near=520,far=1260\n")

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def start(self, line):
        return subprocess.Popen(["bash", "-c", line], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def run(self, line):
        return self.start(line).communicate()[0]

    def made(self):
        """The finished films, each with its file and time."""
        status = {name: os.stat(self.path("out", name)) for name in self.names if os.path.exists(self.path("out", name))}
        return {name: (s.st_ino, s.st_mtime_ns) for name, s in status.items()}

    def kill_one(self, running):
        """Kills an author at work here, once a few films are made; its film."""
        while running():
            for process in filter(str.isdigit, os.listdir("/proc")) if len(self.made()) >= 3 else ():
                with contextlib.suppress(OSError):
                    with open(f"/proc/{process}/cmdline", "rb") as line:
                        words = line.read().decode().split("\0")
                    if words[0].endswith("relievo-author") and os.readlink(f"/proc/{process}/cwd") == self.folder:
                        film = os.path.basename(words[words.index("-o") + 1])
                        os.kill(int(process), signal.SIGSTOP)
                        if film not in self.made():
                            os.kill(int(process), signal.SIGKILL)
                            return film
                        os.kill(int(process), signal.SIGCONT)
            time.sleep(.01)
        raise SystemExit("catalogue: no author was at work")

    def expect_whole(self, before, how):
        """Every film is whole, those made before were not made again, and nothing else is left."""
        after = self.made()
        again = [name for name in before if after.get(name) != before[name]]
        wrong = [name for name in self.names if seeds.pictures_of(self.path("out", name)) != [PICTURES, PICTURES]]
        left = sorted(set(os.listdir(self.path("out"))) - set(self.names))
        if again or wrong or left:
            raise SystemExit(f"catalogue: {how}: made again: {again}; not whole: {wrong}; left: {left}")
        print(f"{how}: {FILMS} films, {len(before)} of them before a job was made again; all whole, none made twice", flush=True)


def by_parallel(programs, folder):
    films = Catalogue(programs, folder)
    line = next(block for block in blocks_below("One job per film, GNU parallel") if block.startswith("parallel"))
    batch = films.start(line)
    killed = films.kill_one(lambda: batch.poll() is None)
    said = batch.communicate()[0]
    before = films.made()
    if batch.returncode == 0 or killed in before:
        raise SystemExit(f"catalogue: parallel did not tell that {killed} failed: {batch.returncode}, {said}")
    films.run(line.replace("parallel ", "parallel --resume-failed ", 1))
    films.expect_whole(before, f"parallel, {killed} killed")


def by_segments(programs, folder):
    """The left half stays at 1 m while the right half grows from .4 m deep to 1.9 m where the second segment begins."""
    make = seeds.Maker(folder, programs)
    depth = f"nullsrc=size={seeds.COLS}x{seeds.ROWS}:rate=5,format=gray16le,geq=lum='if(lt(X,W/2),1000,800+Y*(8+32*gte(T,10)))'"
    for track, graph, coding in (("color.mp4", "testsrc2=rate=5", ["-g", "5"]), ("depth.mkv", depth, ["-c:v", "ffv1", "-g", "5"])):
        make.ffmpeg("-f", "lavfi", "-i", graph, "-s", f"{seeds.COLS}x{seeds.ROWS}", "-frames:v", str(PICTURES), *coding,
                    make.path(f"film-{track}"))
    (block,) = blocks_below("One job per segment")
    environment = {**os.environ, "PATH": programs + ":" + os.environ["PATH"]}
    said = subprocess.run(["bash", "-ec", block], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    gray = ["ffmpeg", "-v", "error", "-i", make.path("film.mkv"), "-map", "0:v:1", "-f", "rawvideo", "-pix_fmt", "gray", "-"]
    codes = subprocess.run(gray, stdin=subprocess.DEVNULL, capture_output=True).stdout
    picture, place = seeds.COLS * seeds.ROWS, seeds.ROWS // 2 * seeds.COLS + seeds.COLS // 4
    seen = list(codes[place::picture])
    if said.returncode != 0 or len(seen) != PICTURES or max(seen) - min(seen) > 1:
        raise SystemExit(f"catalogue: the codes of one distance, in segments: {seen}; {said.stdout[-2000:]}")
    print(f"in two segments: one distance has the codes {sorted(set(seen))}", flush=True)


class Slurm:
    """A cluster of this machine alone, with files and sockets in a folder."""

    def __init__(self, folder):
        self.folder, self.host = folder, socket.gethostname().split(".")[0]
        self.running = {}
        for name in ("state", "spool"):
            os.makedirs(os.path.join(folder, name))
        os.chmod(folder, 0o755)  # munged wants its socket where all may reach it
        with open(self.path("key"), "wb") as key:
            key.write(os.urandom(128))
        os.chmod(self.path("key"), 0o400)
        settings = {
            "ClusterName": "films", "SlurmctldHost": f"{self.host}(127.0.0.1)", "SlurmctldPort": free_port(),
            "SlurmdPort": free_port(), "AuthType": "auth/munge", "AuthInfo": f"socket={self.path('socket')}",
            "SlurmUser": "root", "StateSaveLocation": self.path("state"), "SlurmdSpoolDir": self.path("spool"),
            "SlurmctldPidFile": self.path("slurmctld.pid"), "SlurmdPidFile": self.path("slurmd.pid"),
            "ProctrackType": "proctrack/linuxproc", "TaskPlugin": "task/none", "MpiDefault": "none",
            "SelectType": "select/cons_tres", "SelectTypeParameters": "CR_CPU_Memory", "ReturnToService": 2,
            "SlurmdParameters": "config_overrides",
        }
        with open(self.path("slurm.conf"), "w", encoding="utf-8") as conf:
            conf.writelines(f"{key}={value}\n" for key, value in settings.items())
            conf.write(f"NodeName={self.host} NodeAddr=127.0.0.1 CPUs=4 RealMemory=4000\n"
                       f"PartitionName=films Nodes={self.host} Default=YES State=UP\n")
        self.environment = {"SLURM_CONF": self.path("slurm.conf")}
        self.start("munged", "--foreground", "--force", "--key-file", self.path("key"), "--socket", self.path("socket"),
                   "--pid-file", self.path("munged.pid"), "--seed-file", self.path("seed"), "--log-file", self.path("munged.log"))
        self.wait(lambda: os.path.exists(self.path("socket")), "munged")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        self.wait(lambda: "idle" in self.say("sinfo", "-h", "-o", "%T"), "slurmd")

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, program, *options):
        with open(self.path(program + ".out"), "ab") as log:
            self.running[program] = subprocess.Popen([program, *options], env={**os.environ, **getattr(self, "environment", {})},
                                                     stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def stop(self, program):
        self.running[program].terminate()
        self.running[program].wait(30)

    def say(self, *command):
        said = subprocess.run(command, env={**os.environ, **self.environment}, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        return said.stdout

    def wait(self, done, what, most_s=120):
        for _ in range(most_s * 10):
            if done():
                return
            time.sleep(.1)
        logs = [open(self.path(name), encoding="utf-8", errors="replace").read()[-800:]
                for name in sorted(os.listdir(self.folder)) if name.endswith((".out", ".log"))]
        raise SystemExit(f"catalogue: {what} did not answer within {most_s} s\n" + "\n".join(logs))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for program in reversed(list(self.running)):
            with contextlib.suppress(Exception):
                self.stop(program)


def by_slurm(programs, folder):
    with Slurm(os.path.join(folder, "slurm")) as slurm:
        films = Catalogue(programs, os.path.join(folder, "films"), slurm.environment)
        script, line = blocks_below("Slurm")
        with open(films.path("make.sh"), "w", encoding="utf-8") as make:
            make.write(script)
        busy = lambda: slurm.say("squeue", "-h").strip() != ""
        if "Submitted batch job" not in (said := films.run(line)):
            raise SystemExit(f"catalogue: {line}: {said}")
        killed = films.kill_one(busy)
        slurm.stop("slurmd")
        slurm.start("slurmd", "-D")
        slurm.wait(lambda: not busy(), "the first batch")
        before = films.made()
        if killed in before:
            raise SystemExit(f"catalogue: {killed} was made by a killed job")
        films.run(line)
        slurm.wait(lambda: not busy(), "the second batch")
        films.expect_whole(before, f"Slurm, {killed} killed and slurmd started again")


def main():
    reader = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    reader.add_argument("programs", metavar="BIN", help="folder of relievo-author")
    programs = os.path.abspath(reader.parse_args().programs)
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    if missing := [package for program, package in NEEDED.items() if not shutil.which(program)]:
        print("not installed: " + ", ".join(missing) + "; run toolchain/setup cluster")
        return 77
    if os.geteuid() != 0:
        print("Slurm's daemons are started as root here; use sudo")
        return 77
    with tempfile.TemporaryDirectory(prefix="relievo-catalogue-") as folder:
        by_segments(programs, os.path.join(folder, "segments"))
        by_parallel(programs, os.path.join(folder, "parallel"))
        by_slurm(programs, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
