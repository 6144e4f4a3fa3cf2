# SPDX-License-Identifier: Apache-2.0
"""Small films of every kind that the programs read, by ffmpeg, by relievo-author or byte by byte, and text files."""
import base64
import dataclasses
import os
import struct
import subprocess

COLS, ROWS, PICTURES, RATE = 64, 48, 8, 25
COLOR = f"testsrc2=size={COLS}x{ROWS}:rate={RATE}"
DEPTH = f"gradients=size={COLS}x{ROWS}:rate={RATE}:seed=1:n=2:c0=black:c1=white:speed=0.05"
# The depth as distances in mm, from 500 to 4000.
DISTANCE = f"{DEPTH},format=gray16le,lut=c0=500+val*3500/65535"


def pictures_of(film):
    """How many pictures of each track ffmpeg decodes; -1 if it complains."""
    counts = []
    for track in (0, 1):
        command = ["ffmpeg", "-v", "error", "-xerror", "-i", film, "-map", f"0:v:{track}", "-f", "framecrc", "-"]
        said = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        lines = [line for line in said.stdout.splitlines() if line and not line.startswith("#")]
        counts.append(-1 if said.returncode != 0 or said.stderr else len(lines))
    return counts


@dataclasses.dataclass
class Seed:
    """Arguments that name a film, `@` being its folder, the files to damage, and which programs read it."""

    name: str
    source: list
    files: list
    depth: str = ""
    options: list = dataclasses.field(default_factory=list)
    programs: tuple = ("play", "probe", "author")

    def arguments(self, program):
        color = ["--color"] if program == "author" else []
        depth = ["--depth", self.depth] if self.depth else []
        return color + self.source + depth + self.options


class Maker:
    """Writes the seeds into `folder`; `programs` is the folder of relievo and relievo-author."""

    def __init__(self, folder, programs):
        self.folder, self.programs = folder, programs

    def path(self, name):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def run(self, *command):
        said = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if said.returncode != 0:
            raise SystemExit(f"{' '.join(command)}: {said.stderr[-2000:]}")
        return said.stdout

    def ffmpeg(self, *arguments):
        self.run("ffmpeg", "-v", "error", "-y", "-bitexact", *arguments)

    def film(self, name, *options):
        """Colour and depth as two tracks."""
        self.ffmpeg("-f", "lavfi", "-i", COLOR, "-f", "lavfi", "-i", DEPTH, "-map", "0:v", "-map", "1:v",
                    "-frames:v", str(PICTURES), *options, self.path(name))

    def pictures(self, name, graph, *options):
        self.ffmpeg("-f", "lavfi", "-i", graph, "-frames:v", str(PICTURES), *options, self.path(name))

    def author(self, name, *options):
        self.run(os.path.join(self.programs, "relievo-author"), "--color", self.path("two/color.mkv"), "--depth",
                 self.path("two/depth.mkv"), "-o", self.path(name), "--force", *options)

    def text(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def bytes(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def gray16(self, graph=DISTANCE):
        """The depth's pictures as bytes, little endian."""
        path = self.path("work/depth.raw")
        self.ffmpeg("-f", "lavfi", "-i", graph, "-frames:v", str(PICTURES), "-pix_fmt", "gray16le", "-f", "rawvideo",
                    path)
        with open(path, "rb") as file:
            data = file.read()
        return [data[at:at + 2 * COLS * ROWS] for at in range(0, len(data), 2 * COLS * ROWS)]


H264 = ("-c:v", "libx264", "-threads", "1", "-pix_fmt", "yuv420p", "-g", "4")


def written_by_ffmpeg(make):
    """Films of two tracks and of packed pictures."""
    for ending in ("mkv", "mp4", "mov", "ts", "nut", "avi", "flv"):
        if ending == "flv":  # holds one track
            make.pictures("flv/film.flv", f"{COLOR},split[a][b];[b]format=gray[c];[a][c]hstack", *H264)
            yield Seed("flv", ["@/film.flv"], ["film.flv"], options=["--packing", "sbs"])
            continue
        make.film(f"{ending}/film.{ending}", *H264)
        yield Seed(ending, [f"@/film.{ending}"], [f"film.{ending}"])
    make.film("webm/film.webm", "-c:v", "libvpx", "-deadline", "realtime",
              "-threads", "1", "-pix_fmt", "yuv420p")
    yield Seed("webm", ["@/film.webm"], ["film.webm"])
    make.film("hevc/film.mp4", "-c:v", "libx265", "-x265-params", "log-level=error:pools=1")
    yield Seed("hevc", ["@/film.mp4"], ["film.mp4"])
    make.film("ffv1/film.mkv", "-c:v", "ffv1", "-level", "3", "-pix_fmt", "gray16le")
    yield Seed("ffv1", ["@/film.mkv"], ["film.mkv"], options=["--calibration", "unit=1"])
    make.pictures("y4m/film.y4m", f"{COLOR},split[a][b];[a][b]vstack,format=yuv420p")
    yield Seed("y4m", ["@/film.y4m"], ["film.y4m"], options=["--packing", "tb"])
    make.film("hls-ts/film.m3u8", *H264, "-hls_time", "0.16", "-hls_list_size", "0")
    yield Seed("hls-ts", ["@/film.m3u8"], ["film0.ts", "film1.ts"])
    make.pictures("two/color.mkv", COLOR, *H264)
    make.pictures("two/depth.mkv", DEPTH, "-c:v", "ffv1", "-pix_fmt", "gray")
    yield Seed("two", ["@/color.mkv"], ["color.mkv", "depth.mkv"], depth="@/depth.mkv")


def written_by_the_author(make):
    for name, file, options in (("author-mkv", "film.mkv", ()),
                                ("author-ffv1", "film.mkv", ("--depth-codec", "ffv1", "--depth-bits", "16")),
                                ("author-mp4", "film.mp4", ("--depth-bits", "10")),
                                ("author-mov", "film.mov", ("--depth-chroma", "flat")),
                                ("author-ts", "film.ts", ("--depth-codec", "hevc", "--depth-bits", "12")),
                                ("author-hls", "film.m3u8", ())):
        make.author(f"{name}/{file}", *options)
        parts = [f"film.segments/{part}" for part in sorted(os.listdir(make.path(f"{name}/film.segments")))] \
            if file.endswith("m3u8") else [file]
        yield Seed(name, [f"@/{file}"], parts)


def still_pictures(make):
    """Pictures with numbers, folders, and depth in floating point."""
    for name, color, depth, graph, options in (
            ("png", "png", "png", DISTANCE, ()), ("jpeg", "jpg", "png", DISTANCE, ()),
            ("tiff", "png", "tiff", DISTANCE, ()), ("exr", "png", "exr", DEPTH, ("-pix_fmt", "grayf32le")),
            ("pfm", "png", "pfm", DEPTH, ("-pix_fmt", "grayf32le"))):
        make.pictures(f"{name}/color/%06d.{color}", COLOR)
        make.pictures(f"{name}/depth/%06d.{depth}", graph, *options)
        files = [f"color/{k:06d}.{color}" for k in (1, 2)] + [f"depth/{k:06d}.{depth}" for k in (1, 2)]
        yield Seed(name, [f"@/color/%06d.{color}"], files, depth=f"@/depth/%06d.{depth}",
                   options=["--calibration", "unit=1,invalid=0"] if graph is DISTANCE else [])
    yield Seed("folder", ["@"], ["color/000001.png", "depth/000001.png"])
    make.pictures("folder/color/%06d.png", COLOR)
    make.pictures("folder/depth/%06d.png", DISTANCE)


def npy(pictures):
    head = f"{{'descr': '<u2', 'fortran_order': False, 'shape': ({len(pictures)}, {ROWS}, {COLS}), }}"
    head += " " * (118 - 1 - len(head)) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + b"".join(pictures)


def float_tiff(picture):
    """A TIFF of 32-bit floats in one strip."""
    metres = [value / 1000 for value in struct.unpack(f"<{COLS * ROWS}H", picture)]
    tags = ((256, COLS), (257, ROWS), (258, 32), (259, 1), (262, 1), (273, 8), (277, 1), (278, ROWS),
            (279, 4 * COLS * ROWS), (339, 3))
    directory = struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in tags)
    samples = struct.pack(f"<{COLS * ROWS}f", *metres)
    return b"II*\0" + struct.pack("<I", 8 + len(samples)) + samples + directory + bytes(4)


def bag(colors, depths):
    """A ROS bag of one plain chunk, without an index, as a recorder leaves it that was killed."""
    def text(data):
        return struct.pack("<I", len(data)) + data

    def record(fields, data):
        return text(b"".join(text(name + b"=" + value) for name, value in fields)) + text(data)

    def connection(number, topic):
        more = (b"topic", topic), (b"type", b"sensor_msgs/Image"), (b"md5sum", b"*"), (b"message_definition", b"#")
        return record([(b"op", b"\x07"), (b"conn", struct.pack("<I", number)), (b"topic", topic)],
                      b"".join(text(name + b"=" + value) for name, value in more))

    def image(number, k, encoding, step, data):
        time = struct.pack("<II", 1000 + k // RATE, k % RATE * 1_000_000_000 // RATE)
        message = struct.pack("<I", k) + time + text(b"camera") + struct.pack("<II", ROWS, COLS) + text(encoding) + \
            b"\0" + struct.pack("<I", step) + text(data)
        return record([(b"op", b"\x02"), (b"conn", struct.pack("<I", number)), (b"time", time)], message)

    head = record([(b"op", b"\x03"), (b"index_pos", bytes(8)), (b"conn_count", bytes(4)),
                   (b"chunk_count", bytes(4))], b"")
    data = connection(0, b"/camera/rgb/image_color") + connection(1, b"/camera/depth/image")
    for k, (color, depth) in enumerate(zip(colors, depths)):
        data += image(0, k, b"rgb8", 3 * COLS, color) + image(1, k, b"16UC1", 2 * COLS, depth)
    chunk = record([(b"op", b"\x05"), (b"compression", b"none"), (b"size", struct.pack("<I", len(data)))], data)
    return b"#ROSBAG V2.0\n" + head[:-4] + text(b" " * (4096 - len(head))) + chunk


def gdepth(color, depth):
    """A JPEG whose XMP holds a PNG of the depth."""
    head = (b'http://ns.adobe.com/xap/1.0/\0<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf='
            b'"http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description xmlns:GDepth='
            b'"http://ns.google.com/photos/1.0/depthmap/" GDepth:Format="RangeInverse" GDepth:Near="0.5" '
            b'GDepth:Far="4" GDepth:Mime="image/png" GDepth:Data="')
    xmp = head + base64.b64encode(depth) + b'"/></rdf:RDF></x:xmpmeta>'
    return color[:2] + b"\xff\xe1" + struct.pack(">H", len(xmp) + 2) + xmp + color[2:]


def written_byte_by_byte(make):
    depths = make.gray16()
    make.bytes("npy/depth.npy", npy(depths))
    make.pictures("npy/color.mkv", COLOR, *H264)
    yield Seed("npy", ["@/color.mkv"], ["depth.npy"], depth="@/depth.npy", options=["--calibration", "unit=1"])
    for k, picture in enumerate(depths):
        make.bytes(f"float-tiff/depth/{k + 1:06d}.tiff", float_tiff(picture))
    make.pictures("float-tiff/color/%06d.png", COLOR)
    yield Seed("float-tiff", ["@/color/%06d.png"], ["depth/000001.tiff", "depth/000003.tiff"],
               depth="@/depth/%06d.tiff")
    path = make.path("work/color.raw")
    make.ffmpeg("-f", "lavfi", "-i", COLOR, "-frames:v", str(PICTURES), "-pix_fmt", "rgb24", "-f", "rawvideo", path)
    with open(path, "rb") as file:
        colors = [file.read(3 * COLS * ROWS) for _ in range(PICTURES)]
    make.bytes("bag/film.bag", bag(colors, depths))
    yield Seed("bag", ["@/film.bag"], ["film.bag"])
    parts = []
    for name, graph in (("work/still.jpg", COLOR), ("work/still.png", f"{DEPTH},format=gray")):
        make.ffmpeg("-f", "lavfi", "-i", graph, "-frames:v", "1", make.path(name))
        with open(make.path(name), "rb") as file:
            parts.append(file.read())
    make.bytes("gdepth/photo.jpg", gdepth(*parts))
    yield Seed("gdepth", ["@/photo.jpg"], ["photo.jpg"])


REGISTRATION = f"""[depth]
size = [{COLS}, {ROWS}]
focal = [60.5, 60]
center = [31.5, 23.5]
unit_mm = 1
distortion = [0.1, -0.2, 0.001, 0.002, 0.05]
[color]
size = [{COLS}, {ROWS}]
focal = [62, 62]
center = [32, 24]
[depth_to_color]
rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
translation_mm = [-15, 0.5, 0]
"""


def text_files(make):
    """Text files beside a film that is whole."""
    relievo = os.path.join(make.programs, "relievo")

    def beside(name, file, text, options=(), programs=("play", "probe", "author"), source=("@/film.mkv",)):
        make.film(f"{name}/film.mkv", *H264)
        make.text(f"{name}/{file}", text)
        return Seed(name, list(source), [file], options=list(options), programs=programs)

    yield beside("calibration", "calibration.txt",
                 "law=inverse\npolarity=near-high\nrange=full\nbits=8\ncodes=1-255\ninvalid=0\nnear=400\nfar=4000\n",
                 ("--calibration", "@/calibration.txt"))
    yield beside("registration", "rig.toml", REGISTRATION, ("--registration", "@/rig.toml"))
    yield beside("list", "list.m3u", "#EXTM3U\n#EXTINF:1,One\nfilm.mkv\n#EXTINF:1,Two\nfilm.mkv\n",
                 source=("@/list.m3u",))
    yield beside("keys", "keys.txt", make.run(relievo, "play", "--print-keys"), ("--keys", "@/keys.txt"), ("play",))
    yield beside("configuration", "relievo.toml",
                 make.run(relievo, "play", "--print-config", "film.mkv").replace('"film.mkv"', '"mock:"'),
                 ("--config", "@/relievo.toml"), ("play",))
    yield beside("hand", "hand.csv",
                 "t_s,x_mm,y_mm,z_mm\n" + "".join(f"{k / 10},{k - 5},{5 - k},{40 - 4 * k}\n" for k in range(11)),
                 ("--haptic", "sim:@/hand.csv"), ("play",))
    yield beside("remote", "remote.txt", "0.1 SPACE\n0.2 SPACE\n0.3 RIGHT\n0.4 TAB\n0.5 S\n0.6 LEFTBRACE\n",
                 ("--remote", "script:@/remote.txt"), ("play",))
    recorded = beside("replay", "run.csv", "", ("--haptic", "replay:@/run.csv"), ("play",))
    make.run(relievo, "play", make.path("replay/film.mkv"), "--display", "mock", "--haptic", "sim", "--remote", "none",
             "--record", make.path("replay/run.csv"))
    yield recorded
    make.film("hls-list/film.m3u8", *H264, "-hls_time", "0.16", "-hls_list_size", "0")
    yield Seed("hls-list", ["@/film.m3u8"], ["film.m3u8"])
    make.text("hls-master/master.m3u8", "#EXTM3U\n#EXT-X-VERSION:7\n#EXT-X-STREAM-INF:BANDWIDTH=800000\nfilm.m3u8\n"
              "#EXT-X-STREAM-INF:BANDWIDTH=400000\nfilm.m3u8\n")
    make.film("hls-master/film.m3u8", *H264, "-hls_time", "0.16", "-hls_list_size", "0", "-hls_segment_type",
              "fmp4")
    yield Seed("hls-master", ["@/master.m3u8"], ["master.m3u8", "film.m3u8"])
    make.pictures("associations/rgb/%d.png", COLOR)
    make.pictures("associations/depth/%d.png", DISTANCE)
    make.text("associations/associations.txt",
              "".join(f"{k * 0.04:.6f} rgb/{k}.png {k * 0.04:.6f} depth/{k}.png\n" for k in range(1, PICTURES + 1)))
    yield Seed("associations", ["@/associations.txt"], ["associations.txt"])


def make_seeds(folder, programs):
    make = Maker(folder, programs)
    kinds = (written_by_ffmpeg, written_by_the_author, still_pictures, written_byte_by_byte, text_files)
    return [seed for kind in kinds for seed in kind(make)]
