# SPDX-License-Identifier: Apache-2.0
"""A file system of FUSE that shows a folder and stalls on request: the kernel's protocol (linux/fuse.h), no library."""
import collections
import ctypes
import errno
import os
import select
import stat
import struct
import threading
import time

LOOKUP, FORGET, GETATTR, OPEN, READ, STATFS, RELEASE, FLUSH = 1, 2, 3, 14, 15, 17, 18, 25
SETATTR, MKDIR, UNLINK, RMDIR, RENAME, WRITE, FSYNC, CREATE, RENAME2 = 4, 9, 10, 11, 12, 16, 20, 35, 45
INIT, OPENDIR, READDIR, RELEASEDIR, ACCESS, INTERRUPT, DESTROY, BATCH_FORGET = 26, 27, 28, 29, 34, 36, 38, 42
NAMES = {"lookup": LOOKUP, "getattr": GETATTR, "open": OPEN, "read": READ, "readdir": READDIR,
         "mkdir": MKDIR, "create": CREATE, "write": WRITE, "fsync": FSYNC, "rename": RENAME}
ANY = "*"
ROOT, DIRECT_IO, MNT_DETACH, SIGKILL_BIT = 1, 1, 2, 1 << 8
IN, OUT, ATTR = struct.Struct("<IIQQIIIHH"), struct.Struct("<IiQ"), struct.Struct("<6Q10I")


def mount(fd, place):
    """Fails with OSError where it is not permitted."""
    libc = ctypes.CDLL(None, use_errno=True)
    options = f"fd={fd},rootmode=40000,user_id={os.getuid()},group_id={os.getgid()}"
    if libc.mount(b"stalling", place.encode(), b"fuse", 0, options.encode()) != 0:
        raise OSError(ctypes.get_errno(), "mount")


def unmount(place):
    ctypes.CDLL(None).umount2(place.encode(), MNT_DETACH)


def is_killed(thread):
    """As a wait on NFS: it ends by a deadly signal and by no other."""
    try:
        with open(f"/proc/{thread}/status", encoding="ascii") as file:
            pending = [int(line.split()[1], 16) for line in file if line.startswith(("SigPnd", "ShdPnd"))]
    except OSError:
        return True
    return any(bits & SIGKILL_BIT for bits in pending)


class StallingFiles:
    """Shows `shown` at `place`. Requests that `stall` names wait until `release`; `arrived` is set by the first."""

    def __init__(self, shown, place):
        self.shown, self.place = shown, place
        self.paths = {ROOT: ""}
        self.stalls, self.waiting, self.arrived = {}, [], threading.Event()
        self.slow = {}  # seconds that each read of a file takes, by name
        self.seen = collections.Counter()  # requests by operation and name
        self.guard, self.ending = threading.Lock(), False
        self.fd = os.open("/dev/fuse", os.O_RDWR | os.O_CLOEXEC)
        try:
            mount(self.fd, place)
        except OSError:
            os.close(self.fd)
            raise
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def stall(self, operation, name, spared=0):
        """From now on: `operation` on the file or folder `name`, of the folder shown, or on ANY. The first ones may be
        spared."""
        with self.guard:
            self.seen.clear()
            self.stalls[NAMES[operation], name] = spared

    def count(self, operation, name):
        with self.guard:
            return self.seen[NAMES[operation], name]

    def release(self):
        with self.guard:
            self.stalls.clear()

    def close(self):
        self.ending = True
        self.release()
        unmount(self.place)
        self.thread.join()
        os.close(self.fd)

    def serve(self):
        while True:
            self.answer_waiting()
            if select.select([self.fd], [], [], 0.02)[0]:
                try:
                    request = os.read(self.fd, 1 << 17)
                except OSError as error:
                    if error.errno in (errno.ENOENT, errno.EINTR, errno.EAGAIN):  # the caller has gone away
                        continue
                    return
                self.take(request)
            elif self.ending and not self.waiting:
                return

    def answer_waiting(self):
        with self.guard:
            free = not self.stalls
        for request in self.waiting[:]:
            killed = is_killed(IN.unpack_from(request)[6])
            if free or killed:
                self.waiting.remove(request)
                self.reply(request, -errno.EINTR if killed and not free else self.handle(request))

    def take(self, request):
        if self.is_stalled(request):
            self.waiting.append(request)
            self.arrived.set()
            return
        _, operation, _, node, *_ = IN.unpack_from(request)
        if operation == READ and self.paths[node] in self.slow:
            self.arrived.set()
            time.sleep(self.slow[self.paths[node]])
        self.reply(request, self.handle(request))

    def is_stalled(self, request):
        _, operation, _, node, *_ = IN.unpack_from(request)
        operation = RENAME if operation == RENAME2 else operation
        name = self.paths.get(node, "")
        if operation == LOOKUP:
            name = os.path.join(name, self.text(request))
        with self.guard:
            for each in (name, ANY):
                self.seen[operation, each] += 1
            return any(self.seen[key] > spared for key, spared in self.stalls.items() if key[1] in (name, ANY)
                       and key[0] == operation)

    @staticmethod
    def text(request):
        return os.fsdecode(request[IN.size:].split(b"\0", 1)[0])

    def reply(self, request, answer):
        """`answer` is the content, an error below 0, or None where none is expected."""
        if answer is None:
            return
        code, content = (answer, b"") if isinstance(answer, int) else (0, answer)
        unique = IN.unpack_from(request)[2]
        try:
            os.write(self.fd, OUT.pack(OUT.size + len(content), code, unique) + content)
        except OSError:  # interrupted meanwhile
            pass

    def real(self, node):
        return os.path.join(self.shown, self.paths[node])

    def attributes(self, node):
        of = os.stat(self.real(node))
        times = [int(of.st_atime), int(of.st_mtime), int(of.st_ctime)]
        return ATTR.pack(node, of.st_size, of.st_blocks, *times, 0, 0, 0, of.st_mode, 1, of.st_uid, of.st_gid, 0, 4096, 0)

    def handle(self, request):
        _, operation, _, node, *_ = IN.unpack_from(request)
        body = request[IN.size:]
        try:
            if operation == INIT:
                return struct.pack("<4I2H2I2H8I", 7, 31, 1 << 17, 0, 0, 0, 1 << 16, 1, 0, 0, *[0] * 8)
            if operation == LOOKUP:
                return self.look_up(node, self.text(request))
            if operation == GETATTR:
                return struct.pack("<Q2I", 0, 0, 0) + self.attributes(node)
            if operation in (OPEN, OPENDIR):
                return struct.pack("<Q2I", 0, DIRECT_IO if operation == OPEN else 0, 0)
            if operation in (READ, READDIR):
                _, offset, size = struct.unpack_from("<2QI", body)
                return self.read(node, offset, size) if operation == READ else self.list(node, offset, size)
            if operation in CHANGES:
                return CHANGES[operation](self, node, body)
        except OSError as error:
            return -error.errno
        if operation == STATFS:
            return struct.pack("<5Q4I6I", *[0] * 5, 4096, 255, 4096, 0, *[0] * 6)
        if operation in (FORGET, BATCH_FORGET, INTERRUPT):
            return None
        return b"" if operation in (RELEASE, RELEASEDIR, FLUSH, FSYNC, DESTROY) else -errno.ENOSYS

    def look_up(self, parent, name):
        path = os.path.join(self.paths[parent], name)
        os.stat(os.path.join(self.shown, path))
        node = next((n for n, known in self.paths.items() if known == path), len(self.paths) + 1)
        self.paths[node] = path
        return struct.pack("<4Q2I", node, 0, 0, 0, 0, 0) + self.attributes(node)  # the kernel is to ask each time

    def read(self, node, offset, size):
        with open(self.real(node), "rb") as file:
            file.seek(offset)
            return file.read(size)

    def list(self, node, offset, size):
        content = b""
        for number, name in enumerate(sorted(os.listdir(self.real(node)))):
            raw = os.fsencode(name)
            kind = stat.S_IFMT(os.stat(os.path.join(self.real(node), name)).st_mode) >> 12
            entry = struct.pack("<2Q2I", number + 2, number + 1, len(raw), kind) + raw
            entry += b"\0" * (-len(entry) % 8)
            if number >= offset and len(content) + len(entry) <= size:
                content += entry
        return content

    def child(self, parent, name):
        return os.path.join(self.shown, self.paths[parent], os.fsdecode(name.split(b"\0", 1)[0]))

    def create(self, parent, body):
        flags, mode = struct.unpack_from("<2I", body)
        how = flags & (os.O_EXCL | os.O_TRUNC) | os.O_CREAT
        os.close(os.open(self.child(parent, body[16:]), how, mode))
        return self.look_up(parent, os.fsdecode(body[16:].split(b"\0", 1)[0])) + struct.pack("<Q2I", 0, DIRECT_IO, 0)

    def make_folder(self, parent, body):
        os.mkdir(self.child(parent, body[8:]), struct.unpack_from("<I", body)[0])
        return self.look_up(parent, os.fsdecode(body[8:].split(b"\0", 1)[0]))

    def remove(self, parent, body):
        path = self.child(parent, body)
        (os.rmdir if os.path.isdir(path) else os.unlink)(path)
        return b""

    def write(self, node, body):
        _, offset, size = struct.unpack_from("<2QI", body)
        with open(self.real(node), "r+b") as file:
            file.seek(offset)
            file.write(body[40:40 + size])
        return struct.pack("<2I", size, 0)

    def change(self, node, body):
        """Mode and size."""
        valid, size, mode = (struct.unpack_from(kind, body, at)[0] for kind, at in (("<I", 0), ("<Q", 16), ("<I", 68)))
        if valid & 1:
            os.chmod(self.real(node), stat.S_IMODE(mode))
        if valid & 8:
            os.truncate(self.real(node), size)
        return struct.pack("<Q2I", 0, 0, 0) + self.attributes(node)

    def rename(self, parent, body):
        return self.rename_so(parent, struct.unpack_from("<Q", body)[0], 0, body[8:])

    def rename2(self, parent, body):
        return self.rename_so(parent, *struct.unpack_from("<QI", body), body[16:])

    def rename_so(self, parent, to_folder, flags, names):
        """Also as an exchange, or only to a name that is free."""
        old, new = names.split(b"\0")[:2]
        old, new = self.child(parent, old), self.child(to_folder, new)
        if ctypes.CDLL(None, use_errno=True).renameat2(-100, os.fsencode(old), -100, os.fsencode(new), flags) != 0:
            return -ctypes.get_errno()
        old, new = (os.path.relpath(path, self.shown) for path in (old, new))
        swapped = {old: new, new: old} if flags & 2 else {old: new}
        for node, path in self.paths.items():
            for of, to in swapped.items():
                if path == of or path.startswith(of + "/"):
                    self.paths[node] = to + path[len(of):]
                    break
        return b""


CHANGES = {SETATTR: StallingFiles.change, MKDIR: StallingFiles.make_folder, UNLINK: StallingFiles.remove,
           RMDIR: StallingFiles.remove, WRITE: StallingFiles.write, CREATE: StallingFiles.create,
           RENAME: StallingFiles.rename, RENAME2: StallingFiles.rename2}
