# SPDX-License-Identifier: Apache-2.0
"""Damages files, the same for the same generator of random numbers."""

# What a size, a count or a time can be that nobody expects, 1, 2, 4 and 8 bytes wide.
NUMBERS = (0, 1, 2**7, 2**8 - 1, 2**15, 2**16 - 1, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1, 2**64 - 1)
WORDS = ("", "0", "-1", "nan", "inf", "1e308", "-1e308", "1e-320", "99999999999999999999", "0x7fffffff", "\0",
         "\x1b[2J", "%s%n", "../..", "/", "/dev/zero", "/dev/null", ".", "@", "[[[[", '"', "'", "\ufeff", "\u202e",
         "\r", "a" * 70_000)


def damage_bytes(data, random):
    """Turns bits, overwrites bytes and numbers, removes, doubles or moves pieces, cuts the end off; more often in the
    head of the file, which holds sizes and tables."""
    data = bytearray(data)
    for _ in range(random.randint(1, 12)):
        if not data:
            break
        reach = min(len(data), 1024) if random.random() < 0.5 else len(data)
        at = random.randrange(reach)
        length = min(random.randint(1, 64), len(data) - at)
        way = random.randrange(8)
        if way == 0:
            data[at] ^= 1 << random.randrange(8)
        elif way == 1:
            data[at:at + length] = random.randbytes(length)
        elif way == 2:
            del data[at:at + length]
        elif way == 3:
            data[at:at] = data[at:at + length]
        elif way == 4:
            data[at:at + length] = bytes([random.choice((0, 255))]) * length
        elif way == 5:
            piece = data[at:at + length]
            del data[at:at + length]
            to = random.randrange(len(data) + 1)
            data[to:to] = piece
        elif way == 6:
            wide = random.choice((1, 2, 4, 8))
            number = random.choice(NUMBERS) % 256 ** wide
            data[at:at + wide] = number.to_bytes(wide, random.choice(("big", "little")))
        elif random.random() < 0.25:
            del data[at:]
    return bytes(data)


def damage_text(data, random):
    """Removes, doubles or exchanges lines, and replaces words; one time in four it damages the bytes."""
    if random.random() < 0.25:
        return damage_bytes(data, random)
    lines = data.decode("utf-8", "replace").split("\n")
    for _ in range(random.randint(1, 6)):
        at = random.randrange(len(lines))
        way = random.randrange(6)
        if way == 0 and len(lines) > 1:
            del lines[at]
        elif way == 1:
            lines[at:at] = [lines[at]] * random.choice((1, 2, 2000))
        elif way == 2:
            other = random.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        else:
            word = random.choice(WORDS)
            separators = [i for i, c in enumerate(lines[at]) if c in " ,=:[]/."] + [-1, len(lines[at])]
            begin = random.choice(separators) + 1
            end = min((i for i in separators if i >= begin), default=len(lines[at]))
            lines[at] = lines[at][:begin] + word + lines[at][end:]
    return "\n".join(lines).encode("utf-8", "surrogatepass")


TEXT = (".txt", ".toml", ".csv", ".m3u", ".m3u8")


def damage_files(paths, random):
    """Damages one of the files or, one time in five, all of them; a few become empty."""
    chosen = paths if random.random() < 0.2 else [random.choice(paths)]
    for path in chosen:
        with open(path, "rb") as file:
            data = file.read()
        if random.random() < 0.02:
            data = b""
        else:
            data = damage_text(data, random) if path.endswith(TEXT) else damage_bytes(data, random)
        with open(path, "wb") as file:
            file.write(data)
