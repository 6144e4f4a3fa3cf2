#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs relievo play, relievo probe and relievo-author as whole programs on damaged films and text files.

A finding is an end by a signal, a sanitizer's report, a failure without a word, 5 s without a word, a minute without
an end, a file left behind, or too much memory (512 MiB; the author 1 GiB). It is run again, and counts if it is seen
twice. The same seed gives the same damage. The files of a finding are kept."""
import argparse
import collections
import concurrent.futures
import glob
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # beside the sources
import damage
import seeds

SILENT_S, END_S = 5, 60
MOST_KIB = {"play": 512 * 1024, "probe": 512 * 1024, "author": 1024 * 1024}
HARD_KIB = 8 * 1024 * 1024  # of addresses, so that no run takes the machine down
SANITIZER = re.compile(r"ERROR: \w+Sanitizer|runtime error:|WARNING: ThreadSanitizer")
Run = collections.namedtuple("Run", "code said peak_kib stuck left")


def files_under(folder):
    return {os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(folder) for name in names}


def makes_film(code, said):
    """True if the author says so: also of what there was of a source that was not whole."""
    return code == 0 or (code == 1 and ": it is not whole: " in said)


def kill(process):
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def starved_s(pid):
    """How long the thread that waited longest for a processor has waited; 0 where the kernel does not tell."""
    waits = [0.0]
    for path in glob.glob(f"/proc/{pid}/task/*/schedstat"):
        try:
            with open(path, encoding="ascii") as file:
                waits.append(int(file.read().split()[1]) / 1e9)
        except OSError:  # the thread has ended
            pass
    return max(waits)


def wait(process, said):
    """The peak of memory in KiB; kills what is silent or endless, and says so. Waits for a processor do not count."""
    began = heard = time.monotonic()
    size, stuck = 0, ""
    while True:
        pid, status, used = os.wait4(process.pid, os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            return used.ru_maxrss, stuck
        now = max(time.monotonic() - starved_s(process.pid), began)
        if os.path.getsize(said) != size:
            size, heard = os.path.getsize(said), now
        heard = min(heard, now)
        if not stuck and (now - heard > SILENT_S or now - began > END_S):
            stuck = f"{SILENT_S} s without a word" if now - heard > SILENT_S else f"no end within {END_S} s"
            kill(process)
        time.sleep(0.02)


class Fuzzer:
    def __init__(self, bin_folder, seed, folder):
        self.bin, self.seed, self.folder = bin_folder, seed, folder
        self.sanitized = b"__asan_init" in open(os.path.join(bin_folder, "relievo"), "rb").read()
        self.seeds = seeds.make_seeds(os.path.join(folder, "seeds"), bin_folder)

    def command(self, program, arguments, out):
        if program == "author":
            return [os.path.join(self.bin, "relievo-author"), *arguments, "-o", out]
        command = [os.path.join(self.bin, "relievo"), program, *arguments]
        if program == "play":
            for more in (("--display", "mock"), ("--haptic", "sim"), ("--remote", "none"), ("--audio", "null")):
                command += [] if more[0] in arguments else more
            command += ["--duration", "2"]
        return command

    def run(self, program, films, arguments, scratch, out):
        """Runs one program on the films in a home of its own."""
        home, said = os.path.join(scratch, "home"), os.path.join(scratch, "said")
        os.makedirs(home, exist_ok=True)
        before = files_under(films) | {out}
        limit = "" if self.sanitized else f"ulimit -v {HARD_KIB}; "
        environment = {**os.environ, "HOME": home, "TMPDIR": home, "XDG_RUNTIME_DIR": home}
        environment |= {"GST_PLUGIN_SYSTEM_PATH_1_0": "/none", "GST_REGISTRY": "/dev/null"}  # nobody's elements and home
        environment |= {"ASAN_OPTIONS": "detect_leaks=0", "DISPLAY": "", "WAYLAND_DISPLAY": ""}
        with open(said, "wb") as output:
            command = self.command(program, arguments, os.path.join(films, out))
            process = subprocess.Popen(["sh", "-c", f'ulimit -c 0; {limit}exec "$@"', "sh", *command],
                                       cwd=films, env=environment, stdin=subprocess.DEVNULL, stdout=output,
                                       stderr=output, start_new_session=True)
            peak, stuck = wait(process, said)
        kill(process)  # nothing of its group outlives it
        with open(said, encoding="utf-8", errors="replace") as file:
            words = file.read()
        mine = {f"{out.removesuffix('.m3u8')}.segments/{part}" for part in ("init.mp4", "00000.m4s")}
        written = before | (mine if makes_film(process.returncode, words) else set())
        left = (files_under(films) - written) | files_under(home)
        return Run(process.returncode, words, peak, stuck, sorted(left))

    def fault(self, program, run, out_exists):
        if run.stuck:
            return run.stuck
        if run.code < 0:
            return f"ended by {signal.Signals(-run.code).name}"
        if SANITIZER.search(run.said):
            return "a sanitizer's report"
        if run.code not in (0, 1, 2):
            return f"exit code {run.code}"
        if run.code != 0 and not run.said.strip():
            return "failed without a word"
        if program == "author" and out_exists != makes_film(run.code, run.said):
            return f"exit code {run.code}, but the film is {'there' if out_exists else 'not there'}"
        if run.left:
            return "left behind: " + " ".join(run.left[:5])
        if run.peak_kib > MOST_KIB[program] and not self.sanitized:
            return f"{run.peak_kib // 1024} MiB of memory"
        return ""

    def item(self, number):
        """Damages one seed and gives it to each program; the findings, and each run's program, exit code and peak."""
        chance = random.Random(f"{self.seed}/{number}")
        seed = self.seeds[number % len(self.seeds)]
        findings, runs = [], []
        with tempfile.TemporaryDirectory(dir=self.folder, prefix="run-") as scratch:
            damaged = os.path.join(scratch, "damaged")
            shutil.copytree(os.path.join(self.folder, "seeds", seed.name), damaged)
            damage.damage_files([os.path.join(damaged, file) for file in seed.files], chance)
            out = "out." + chance.choice(("mkv", "mp4", "ts", "m3u8"))
            for program in seed.programs:
                run, fault = self.once_or_twice(seed, program, damaged, scratch, out)
                runs.append((program, run.code, run.peak_kib))
                if fault:
                    kept = os.path.join(self.folder, "findings", f"{self.seed}-{number}-{program}")
                    shutil.rmtree(kept, ignore_errors=True)
                    shutil.copytree(damaged, kept)
                    arguments = [part.replace("@", kept) for part in seed.arguments(program)]
                    command = self.command(program, arguments, out)
                    findings.append(f"{seed.name}: {fault}\n  {' '.join(command)}\n  {run.said[-1000:].strip()}")
        return findings, runs

    def once_or_twice(self, seed, program, damaged, scratch, out):
        """The run of a program, each time on a fresh copy; a fault only if the second run has one too."""
        films = os.path.join(scratch, "films")
        for _ in range(2):
            for folder in (films, os.path.join(scratch, "home")):
                shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(damaged, films)
            arguments = [part.replace("@", films) for part in seed.arguments(program)]
            run = self.run(program, films, arguments, scratch, out)
            fault = self.fault(program, run, os.path.exists(os.path.join(films, out)))
            if not fault:
                break
        return run, fault


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="the folder of relievo and relievo-author")
    parser.add_argument("--seed", type=int, help="begin the random numbers from here [chosen, and printed]")
    parser.add_argument("--items", type=int, default=1_000_000, help="damaged films and text files to run")
    parser.add_argument("--first", type=int, default=0, help="number of the first item [%(default)s]")
    parser.add_argument("--seconds", type=float, default=1e9, help="begin no item after so many seconds")
    parser.add_argument("--folder", default="build-check/film-fuzz", help="where seeds and findings lie [%(default)s]")
    return parser.parse_args()


def main():
    options = parsed()
    seed = options.seed if options.seed is not None else random.SystemRandom().randrange(1_000_000)
    folder = os.path.abspath(options.folder)
    shutil.rmtree(os.path.join(folder, "seeds"), ignore_errors=True)
    os.makedirs(folder, exist_ok=True)
    fuzzer = Fuzzer(os.path.abspath(options.bin), seed, folder)
    end = time.monotonic() + options.seconds
    numbers = iter(range(options.first, options.first + options.items))
    findings, peaks, codes, items = [], collections.Counter(), collections.Counter(), 0

    def work():
        nonlocal items
        for number in numbers:
            found, runs = fuzzer.item(number)
            items += 1
            for finding in found:
                print(f"film_fuzz: seed {seed}, item {number}: {finding}", file=sys.stderr, flush=True)
            findings.extend(found)
            for program, code, peak in runs:
                peaks[program] = max(peaks[program], peak)
                codes[program, code] += 1
            if time.monotonic() > end:
                break

    print(f"film_fuzz: seed {seed}, {len(fuzzer.seeds)} films and text files to damage", flush=True)
    with concurrent.futures.ThreadPoolExecutor() as pool:
        for done in [pool.submit(work) for _ in range(os.cpu_count())]:
            done.result()
    for program, peak in peaks.items():
        ends = ", ".join(f"{count} with code {code}" for (of, code), count in sorted(codes.items()) if of == program)
        print(f"film_fuzz: {program}: {ends}; at most {peak // 1024} MiB")
    print(f"film_fuzz: {items} damaged films and text files, {len(findings) or 'nothing'} found")
    sys.exit(1 if findings else 0)


main()
