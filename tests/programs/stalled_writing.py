# SPDX-License-Identifier: Apache-2.0
"""Cases of stalled_mounts.py in which a program writes to the mount that stalls. Functions return what is wrong."""
import os
import signal

SAID = "the file system does not answer within 10 s; check the mount"
PLAY = "relievo play & --display mock --haptic sim --audio null --remote none"
AUTHOR = "relievo-author --color & -o @/"

# The command, the operation that stalls, and the output; @ is the mount, & a film elsewhere.
GIVEN_UP = tuple((f"{AUTHOR}out.{kind}", operation, f"out.{kind}") for kind, operations in (
    ("mkv", ("create", "write", "fsync", "rename")), ("mp4", ("write", "read")), ("ts", ("write",)),
    ("m3u8", ("mkdir", "create", "write", "fsync", "rename"))) for operation in operations) + (
    (f"{PLAY} --report @/report.json", "write", "report.json"),
    (f"{PLAY} --report @/report.json", "rename", "report.json"),
    (f"{PLAY} --record @/hand.csv", "create", "hand.csv"),
    (f"{PLAY} --record @/hand.csv", "write", "hand.csv"))


def given_up(case, line, operation, output):
    case.files.stall(operation, "*")
    case.start(line)
    code, words = case.code(), case.words()
    if code != 1 or words.count(SAID) != 1 or f"{case.place}/{output}: {SAID}" not in words:
        return f"exit code {code}: {words}"
    return f"{output} is there" if os.path.exists(os.path.join(case.shown, output)) else ""


def written(case, line, output):
    """Nothing stalls: this file system shows that what is written is whole."""
    case.start(line)
    code = case.code()
    film = os.path.join(case.shown, output)
    if code != 0 or not os.path.exists(film):
        return f"exit code {code}: {case.words()}"
    left = sorted(os.listdir(case.shown))
    if left != [output] and left != [output, output.replace(".m3u8", ".segments")]:
        return f"left behind: {left}"
    if "author" not in line:
        return ""
    case.start(f"relievo probe {film}")
    return "" if case.code() == 0 else case.words()


def author_stops(case, kind):
    case.files.stall("write", "*")
    case.start(f"{AUTHOR}out.{kind}")
    met = case.meets_stall()
    case.process.send_signal(signal.SIGTERM)
    code, words = case.code(), case.words()
    return "" if met and code == 1 and "interrupted" in words and SAID not in words else f"exit code {code}: {words}"


def records_on(case):
    """What cannot be recorded costs the player its recording."""
    case.files.stall("write", "*")
    case.start_player("--record " + os.path.join(case.place, "hand.csv"))
    film = os.path.join(case.films, "film.mkv")
    case.ask("loop on")
    case.ask("open " + film)
    if not case.meets_stall() or not case.plays(film):
        return f"does not play: {case.words()}"
    case.ask("quit")
    code, words = case.code(), case.words()
    return "" if code == 1 and words.count(SAID) == 1 else f"exit code {code}: {words}"


def goes_on(case, film):
    """The player answers, plays and ends before the mount is given up, and tells of its file in one line."""
    played = case.plays(film)
    case.ask("quit")
    code, words = case.code(), case.words()
    told = [line for line in words.splitlines() if case.place in line]
    return "" if played and code == 0 and SAID not in words and len(told) == 1 else f"exit code {code}: {words}"


def screenshot_stalls(case, operation):
    """The first picture does not wait for the screenshot before it, nor does the end."""
    film = os.path.join(case.films, "film.mkv")
    case.start_player("--size 160x90", "offscreen", XDG_PICTURES_DIR=case.place)
    case.ask("loop on")
    case.ask("open " + film)
    if not case.plays(film):
        return f"does not play: {case.words()}"
    case.files.stall(operation, "*")
    case.ask("screenshot")
    if not case.meets_stall():
        return f"no screenshot: {case.words()}"
    return goes_on(case, film)


def volume_stalls(case):
    film = os.path.join(case.films, "film.mkv")
    case.start_player(XDG_STATE_HOME=case.place)
    case.ask("loop on")
    case.ask("open " + film)
    case.ask("volume -10")
    case.files.stall("mkdir", "*")
    return goes_on(case, film)


def pipe_without_reader(case):
    os.mkfifo(os.path.join(case.home, "pipe"))
    case.start(f"{PLAY} --record {case.home}/pipe")
    code, words = case.code(), case.words()
    return "" if code == 1 and "no program reads this pipe" in words else f"exit code {code}: {words}"


def tests():
    """Name and function of each case."""
    for line, operation, output in GIVEN_UP:
        yield (f"{line} ({operation})",
               lambda case, line=line, operation=operation, output=output: given_up(case, line, operation, output))
    for kind in ("mkv", "mp4", "ts", "m3u8"):
        yield f"a whole {kind}", lambda case, kind=kind: written(case, f"{AUTHOR}out.{kind}", f"out.{kind}")
        yield f"SIGTERM to the author of {kind}", lambda case, kind=kind: author_stops(case, kind)
    yield "a whole report", lambda case: written(case, f"{PLAY} --report @/report.json", "report.json")
    yield "a recording that stalls", records_on
    for operation in ("lookup", "create", "write"):
        yield f"a screenshot ({operation})", lambda case, operation=operation: screenshot_stalls(case, operation)
    yield "the volume", volume_stalls
    yield "a pipe without a reader", pipe_without_reader
