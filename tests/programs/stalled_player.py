# SPDX-License-Identifier: Apache-2.0
"""The player on a mount that stalls, or that answers late: quit, a signal and the next open work at once."""
import os
import signal
import struct

SAID = "does not answer within 10 s; check the mount"
MOST_READS = 100  # of a file of which nothing is wanted any more


def pages(count):
    """A TIFF of so many pages of 16 gray samples each."""
    tags, pixels = (256, 257, 258, 262, 273, 277, 278, 279), 8
    file = struct.pack("<2sHI", b"II", 42, 8 + 16) + bytes(16)
    for number in range(count):
        values = (4, 4, 8, 1, pixels, 1, 4, 16)
        entries = b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in zip(tags, values))
        file += struct.pack("<H", len(tags)) + entries
        file += struct.pack("<I", len(file) + 4 if number + 1 < count else 0)
    return file


def at_once(case, what, passed, code=0):
    """`what` happened before the file system was given up."""
    words = case.words()
    if not passed or SAID in words or code != 0:
        return f"{what}: exit code {code}: {words}"
    return ""


def quit_works(case):
    case.files.stall("read", "film.mkv")
    case.start_player()
    case.ask("open " + os.path.join(case.place, "film.mkv"))
    met = case.meets_stall()
    case.ask("quit")
    return at_once(case, "quit", met, case.code())


def signal_works(case):
    case.files.stall("open", "film.mkv")
    case.start_player()
    case.ask("open " + os.path.join(case.place, "film.mkv"))
    met = case.meets_stall()
    case.process.send_signal(signal.SIGTERM)
    return at_once(case, "SIGTERM", met, case.code())


def quit_works_on_slow(case, file, pause_s):
    """Each read is answered, and there are many before it is known what the file is."""
    case.files.slow = {file: pause_s}
    case.start_player()
    case.ask("open " + os.path.join(case.place, file))
    met = case.meets_stall()
    before = case.files.count("read", file)
    case.ask("quit")
    finding, more = at_once(case, "quit", met, case.code()), case.files.count("read", file) - before
    return finding or (f"{more} reads after quit" if more > MOST_READS else "")


def next_open_works(case, operation, file):
    case.files.stall(operation, file)
    case.start_player()
    case.ask("open " + os.path.join(case.place, "film.mkv"))
    met = case.meets_stall()
    good = os.path.join(case.films, "film.mkv")
    case.ask("open " + good)
    case.ask("loop on")
    return at_once(case, "the next open", met and case.plays(good))


def plays_when_released(case):
    case.files.stall("lookup", "film.mkv")
    case.start_player()
    film = os.path.join(case.place, "film.mkv")
    case.ask("loop on")
    case.ask("open " + film)
    met = case.meets_stall()
    case.files.release()
    return at_once(case, "the release", met and case.plays(film))


TESTS = (
    ("quit", quit_works),
    ("SIGTERM", signal_works),
    ("quit, while a slow mount shows a film of TIFF", lambda case: quit_works_on_slow(case, "pages.tiff", 0.05)),
    ("quit, while a slow mount shows a large photo", lambda case: quit_works_on_slow(case, "large.jpg", 0.005)),
    ("the next open, after a look-up", lambda case: next_open_works(case, "lookup", "film.mkv")),
    ("the next open, after the film's folder", lambda case: next_open_works(case, "readdir", "")),
    ("the next open, after subtitles beside the film", lambda case: next_open_works(case, "read", "film.srt")),
    ("a release", plays_when_released),
)
