#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Drives relievo play over its control socket: opens, seeks, pauses, pulls devices, and lets networks and files fail.

A finding is an answer later than 50 ms or missing, a film that does not play again after all was mended, an exit code
other than 0, a sanitizer's report, or a force or slew over its limit. The same seed gives the same requests."""
import argparse
import http.server
import json
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True  # beside the sources
import damage
import seeds

ANSWER_S, PLAYS_AGAIN_S, MISSING_S = 0.05, 20, 10
SLEW_N_PER_S, PEAK_N = 50, 8.5  # of the scene; of the strongest simulated device
SANITIZER = re.compile(r"ERROR: \w+Sanitizer|runtime error:|WARNING: ThreadSanitizer")
KEPT = ("play", "pause", "play-pause", "step", "step-back", "faster", "slower", "normal-speed", "next", "previous",
        "loop on", "loop off", "layout", "swap-eyes", "info", "statistics", "keys", "mute", "audio", "subtitles",
        "chapter +1", "ab-loop", "aspect", "rotate +90", "zoom +0.1", "zoom -0.1", "depth +0.1", "screen +2",
        "screen -2", "volume -5", "status", "metrics on", "metrics off", "stop")


class Unreliable(http.server.BaseHTTPRequestHandler):
    """Gives a film whole, in part, slowly, never, or something else: the first part of the address says which."""

    protocol_version = "HTTP/1.1"
    folder = ""

    def do_GET(self):
        how, _, name = self.path.lstrip("/").partition("/")
        try:
            with open(os.path.join(self.folder, name), "rb") as file:
                data = file.read()
        except OSError:
            data, how = b"", "missing"
        if how == "missing":
            self.send_error(404)
            return
        if how == "silent":
            time.sleep(60)
            return
        self.send_response(200)
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        parts = {"cut": data[:len(data) // 2], "stall": data[:len(data) // 2], "garbage": b"\0\xff" * len(data)}
        part = parts.get(how, data)[:len(data)]
        for at in range(0, len(part), 2048):
            self.wfile.write(part[at:at + 2048])
            if how == "slow":
                time.sleep(0.05)
        if how == "stall":
            time.sleep(60)
        self.close_connection = True

    def log_message(self, *_):
        pass


class Quiet(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def handle_error(self, *_):  # the player left
        pass


class Player:
    """A player that waits for commands, and what it said."""

    def __init__(self, program, haptic, folder):
        self.folder, self.haptic = folder, haptic
        self.address, self.report, self.said = (os.path.join(folder, name) for name in ("socket", "report", "said"))
        command = [program, "play", "--control", self.address, "--display", "mock", "--haptic", haptic, "--audio", "null",
                   "--remote", "none", "--report", self.report]
        environment = {**os.environ, "HOME": folder, "XDG_RUNTIME_DIR": folder, "DISPLAY": "", "WAYLAND_DISPLAY": ""}
        with open(self.said, "wb") as said:
            self.process = subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=said,
                                            stderr=said, start_new_session=True)
        self.socket = socket.socket(socket.AF_UNIX)
        for _ in range(600):
            try:
                self.socket.connect(self.address)
                break
            except OSError:
                time.sleep(0.05)
        self.heard, self.asked, self.slowest_s, self.ran_s = b"", 0, 0, 0

    @staticmethod
    def thread_s(task):
        """How long a thread has run, and how long it has waited for a processor."""
        try:
            with open(f"/proc/{task}/schedstat", encoding="ascii") as file:
                return [int(word) / 1e9 for word in file.read().split()[:2]]
        except OSError:
            return [0, 0]

    def main_thread_s(self):
        return self.thread_s(f"{self.process.pid}/task/{self.process.pid}")

    def starved_s(self):
        return self.main_thread_s()[1]

    def ask(self, words):
        """The answer and the seconds until it came, without those that the player or this program waited for a
        processor: those of the longer wait, since both may have waited at once."""
        self.asked += 1
        mine = f"self/task/{threading.get_native_id()}"
        (ran, starved), (_, delayed), began = self.main_thread_s(), self.thread_s(mine), time.monotonic()
        try:
            self.socket.sendall(json.dumps({"do": words, "id": self.asked}).encode() + b"\n")
            self.socket.settimeout(MISSING_S)
            while True:
                while b"\n" not in self.heard:
                    more = self.socket.recv(1 << 16)
                    if not more:
                        return None, time.monotonic() - began
                    self.heard += more
                line, _, self.heard = self.heard.partition(b"\n")
                answer = json.loads(line)
                if "ok" in answer:  # one for each request, in turn
                    break
                if time.monotonic() - began > MISSING_S:
                    return None, MISSING_S
        except OSError:
            return None, time.monotonic() - began
        took, now = time.monotonic() - began, self.main_thread_s()
        took -= max(now[1] - starved, self.thread_s(mine)[1] - delayed)
        self.ran_s = now[0] - ran
        self.slowest_s = max(self.slowest_s, took)
        return answer, took

    def words(self):
        with open(self.said, encoding="utf-8", errors="replace") as file:
            return file.read()

    def end(self):
        """The exit code; what does not end is killed."""
        self.ask("quit")
        try:
            return self.process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            return self.process.wait()


class Faults:
    def __init__(self, programs, seed, folder):
        self.program, self.seed, self.folder = os.path.join(programs, "relievo"), seed, folder
        self.films = os.path.join(folder, "seeds")
        self.seeds = [s for s in seeds.make_seeds(self.films, programs) if "play" in s.programs and not s.options]
        self.whole = os.path.join(self.films, "mkv", "film.mkv")
        Unreliable.folder = self.films
        self.server = Quiet(("127.0.0.1", 0), Unreliable)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.silent = socket.create_server(("127.0.0.1", 0))  # takes connections, and says nothing
        self.fifo = os.path.join(folder, "fifo")
        if not os.path.exists(self.fifo):
            os.mkfifo(self.fifo)

    def source(self, chance, scratch):
        """A film, whole or damaged, from a file, a network, or what is no film at all."""
        seed = chance.choice(self.seeds)
        if seed.depth:
            return self.whole
        name = seed.source[0]
        kind = chance.random()
        path = name.replace("@", os.path.join(self.films, seed.name))
        if kind < 0.3:
            return path
        if kind < 0.5:
            copy = os.path.join(scratch, f"{seed.name}-{chance.randrange(8)}")
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(os.path.join(self.films, seed.name), copy)
            damage.damage_files([os.path.join(copy, file) for file in seed.files], chance)
            return name.replace("@", copy)
        if kind < 0.8:
            how = chance.choice(("whole", "cut", "slow", "stall", "silent", "garbage", "missing"))
            host, port = self.server.server_address
            return f"http://{host}:{port}/{how}/{name.replace('@', seed.name)}"
        host, port = self.silent.getsockname()
        return chance.choice((self.fifo, "/dev/zero", "/dev/null", "/nowhere.mkv", self.films, "mock:", self.program,
                              f"tcp://{host}:{port}", f"rtsp://{host}:{port}/a", "http://127.0.0.1:1/a.mkv",
                              "udp://127.0.0.1:9", "x" * 5000, "http://[", "/dev/ptmx"))

    def request(self, chance, scratch):
        kind = chance.random()
        if kind < 0.25:
            return "open " + self.source(chance, scratch)
        if kind < 0.45:
            return "seek " + chance.choice((f"+{chance.random():.2f}", f"-{chance.random():.2f}", "0", "1e5", "100%",
                                            f"{chance.randrange(101)}%"))
        if kind < 0.6:
            return "fault " + chance.choice(("haptic unplug", "haptic plug", "haptic glitch", "display unplug",
                                             "display plug"))
        return chance.choice(KEPT)

    def plays_again(self, player):
        """After all is mended, a whole film plays: two pictures at different times."""
        for words in ("fault haptic plug", "fault display plug", "normal-speed", "loop on", "open " + self.whole, "play"):
            player.ask(words)
        end, seen = time.monotonic() - player.starved_s() + PLAYS_AGAIN_S, set()
        while time.monotonic() - player.starved_s() < end:
            status, _ = player.ask("status")
            if status is None:
                return "no answer to status"
            if status["state"] == "playing" and status["source"] == self.whole:
                seen.add(status["position_s"])
                if len(seen) > 1:
                    return ""
            time.sleep(0.05)
        return f"does not play again: {status}"

    def run(self, number, requests):
        """One life of a player: its findings, and the slowest answer."""
        chance = random.Random(f"{self.seed}/{number}")
        haptic = chance.choice(("mock", "sim:phantom,stroking", "sim:falcon,tapping", "sim:polhem,shaking"))
        findings = []
        with tempfile.TemporaryDirectory(dir=self.folder, prefix="run-") as scratch:
            player = Player(self.program, haptic, scratch)
            last = []
            for i in range(requests):
                words = self.request(chance, scratch)
                last = [*last[-5:], words[:200]]
                answer, took = player.ask(words)
                if answer is None or took > ANSWER_S:
                    late = f"an answer after {1e3 * took:.0f} ms, of which its thread ran {1e3 * player.ran_s:.0f} ms"
                    findings.append(f"{'no answer' if answer is None else late}: {last}")
                if answer is None:
                    break
                time.sleep(chance.choice((0, 0, 0.01, 0.1, 0.5)))
                if i % 50 == 49 and (stuck := self.plays_again(player)):
                    findings.append(f"{stuck}: {last}")
            code = player.end()
            findings += self.judge(player, code)
            if findings:
                kept = os.path.join(self.folder, "findings", f"{self.seed}-{number}")
                shutil.rmtree(kept, ignore_errors=True)
                shutil.copytree(scratch, kept, ignore=lambda at, names: [n for n in names if n == "socket"])
        return findings, player.slowest_s

    @staticmethod
    def judge(player, code):
        findings = []
        if code != 0:
            findings.append(f"exit code {code}")
        if SANITIZER.search(player.words()):
            findings.append("a sanitizer's report")
        try:
            with open(player.report, encoding="utf-8") as file:
                force = json.load(file)["force"]
        except (OSError, ValueError) as error:
            return findings + [f"no report: {error}"]
        if force["max_n"] > PEAK_N or force["max_scene_slew_n_per_s"] > SLEW_N_PER_S * 1.0001:
            findings.append(f"force over its limit: {force}")
        return findings


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="the folder of relievo and relievo-author")
    parser.add_argument("--seed", type=int, help="begin the random numbers from here [chosen, and printed]")
    parser.add_argument("--minutes", type=float, default=60, help="begin no player after so many minutes [%(default)s]")
    parser.add_argument("--requests", type=int, default=400, help="requests to one player [%(default)s]")
    parser.add_argument("--folder", default="build-check/player-faults", help="where findings lie [%(default)s]")
    options = parser.parse_args()
    seed = options.seed if options.seed is not None else random.SystemRandom().randrange(1_000_000)
    folder = os.path.abspath(options.folder)
    shutil.rmtree(os.path.join(folder, "seeds"), ignore_errors=True)
    os.makedirs(folder, exist_ok=True)
    faults = Faults(os.path.abspath(options.bin), seed, folder)
    print(f"player_faults: seed {seed}", flush=True)
    end, number, found, slowest = time.monotonic() + 60 * options.minutes, 0, 0, 0.0
    while number == 0 or time.monotonic() < end:
        findings, slow = faults.run(number, options.requests)
        for finding in findings:
            print(f"player_faults: seed {seed}, player {number}: {finding}", file=sys.stderr, flush=True)
        number, found, slowest = number + 1, found + len(findings), max(slowest, slow)
        print(f"player_faults: {number} players, slowest answer {1e3 * slowest:.0f} ms, {found or 'nothing'} found",
              flush=True)
    sys.exit(1 if found else 0)


main()
