#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills relievo-author at random moments, in every container, with and without an older film of that name.

After a kill the name holds a whole film or none, over an older film that one or the new one; after the next run on the
same name nothing else is in the folder."""
import argparse
import collections
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # beside the sources
import seeds

ENDINGS = ("mkv", "mp4", "m4v", "mov", "ts", "m3u8")
LENGTHS = {"old": 20, "new": 60}  # pictures
QUIET = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def litter(folder, out):
    """Files and folders that are not of the film."""
    mine = {out, os.path.splitext(out)[0] + ".segments"} if out.endswith("m3u8") else {out}
    return sorted(set(os.listdir(folder)) - mine)


class Killer:
    def __init__(self, programs, folder, chance):
        self.author = os.path.join(programs, "relievo-author")
        self.folder, self.chance = folder, chance
        self.whole_s = {}
        make = seeds.Maker(folder, programs)
        for name, length in LENGTHS.items():
            for track, graph in (("color", seeds.COLOR), ("depth", seeds.DEPTH)):
                make.ffmpeg("-f", "lavfi", "-i", graph, "-frames:v", str(length), "-c:v", "ffv1",
                            make.path(f"{name}-{track}.mkv"))

    def command(self, name, out, *options):
        return [self.author, "--color", os.path.join(self.folder, f"{name}-color.mkv"), "--depth",
                os.path.join(self.folder, f"{name}-depth.mkv"), "-o", out, *options]

    def timed(self, ending, out):
        """The time of a whole run, measured once for each container."""
        if ending not in self.whole_s:
            began = time.monotonic()
            subprocess.run(self.command("new", out, "--force"), check=True, **QUIET)
            self.whole_s[ending] = time.monotonic() - began
        return self.whole_s[ending]

    def once(self, ending, older):
        """One kill; how it ended, and what was wrong."""
        folder = tempfile.mkdtemp(dir=self.folder)
        out = os.path.join(folder, f"film.{ending}")
        whole_s = self.timed(ending, os.path.join(self.folder, f"whole.{ending}"))
        if older:
            subprocess.run(self.command("old", out), check=True, **QUIET)
        process = subprocess.Popen(self.command("new", out, "--force"), **QUIET)
        time.sleep(self.chance.uniform(0, whole_s))
        process.kill()
        end = "killed" if process.wait() == -signal.SIGKILL else "done"
        wrong = []
        lengths = {-1}
        if os.path.exists(out):
            lengths = set(seeds.pictures_of(out))
            end += ", old film" if lengths == {LENGTHS["old"]} else ", new film"
        else:
            end += ", no film"
        meant = ({LENGTHS["new"]}, *([{LENGTHS["old"]}] if older else []))
        if (os.path.exists(out) or older) and lengths not in meant:
            wrong.append(f"the film has {lengths} pictures")
        if litter(folder, f"film.{ending}"):
            end += ", litter"
        again = subprocess.run(self.command("new", out, "--force"), capture_output=True, text=True)
        if again.returncode != 0:
            wrong.append("the next run says: " + again.stderr.strip())
        elif seeds.pictures_of(out) != [LENGTHS["new"]] * 2:
            wrong.append(f"the next film has {seeds.pictures_of(out)} pictures")
        if litter(folder, f"film.{ending}"):
            wrong.append("after the next run: " + " ".join(litter(folder, f"film.{ending}")))
        shutil.rmtree(folder)
        return end, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="the folder of relievo-author")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="of the moments [%(default)s]")
    options = parser.parse_args()
    ends, faults = collections.Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        killer = Killer(options.bin, folder, random.Random(options.seed))
        for k in range(options.kills):
            ending, older = ENDINGS[k % len(ENDINGS)], k // len(ENDINGS) % 2 == 1
            end, wrong = killer.once(ending, older)
            ends[end] += 1
            faults += bool(wrong)
            for what in wrong:
                over = " over an older film" if older else ""
                print(f"author_kills: kill {k}, .{ending}{over}: {what}", file=sys.stderr, flush=True)
    for end, count in sorted(ends.items()):
        print(f"author_kills: {count} {end}")
    print(f"author_kills: {options.kills} kills over {' '.join(ENDINGS)}, {faults} wrong")
    sys.exit(1 if faults else 0)


main()
