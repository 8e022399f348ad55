"""Reads a log of writes that QEMU's driver blklogwrites has made, and makes the card that a loss of power leaves.

power_log.py count LOG                 the number of entries so far
power_log.py card LOG BASE OUT N SEED  BASE as it is after N entries, when then the power goes: what was flushed is there,
                                       of each write after the last flush all, a part or nothing

The format is that of the kernel's dm-log-writes (drivers/md/dm-log-writes.c): in sectors, a head with the magic number,
then entries, each a head and its data.
"""

import os
import random
import struct
import subprocess
import sys

MAGIC = 0x6A736677736872
FLUSH, FUA, DISCARD, MARK = 1, 2, 4, 8


def entries(log):
    """(sector, count of sectors, flags, place of the data) of each whole entry."""
    with open(log, "rb") as file:
        end = os.fstat(file.fileno()).st_size
        magic, version, _, sector_bytes = struct.unpack("<QQQL", file.read(28))
        if magic != MAGIC or version != 1:
            sys.exit(f"{log}: no log of writes")
        at = sector_bytes
        while at + sector_bytes <= end:
            file.seek(at)
            sector, count, flags, marked = struct.unpack("<QQQQ", file.read(32))
            if (sector, count, flags, marked) == (0, 0, 0, 0):
                return
            size = 0 if flags & DISCARD else count * sector_bytes
            at += sector_bytes
            if at + size > end:
                return
            yield sector * sector_bytes, size, flags, at
            at += size


def write_card(log, base, out, cut, seed):
    chance = random.Random(seed)
    known = list(entries(log))[:cut]
    flushed = max((i for i, entry in enumerate(known) if entry[2] & FLUSH), default=-1)
    subprocess.run(["cp", "--sparse=always", base, out], check=True)
    kept = 0
    with open(log, "rb") as source, open(out, "r+b") as card:
        for i, (place, size, flags, at) in enumerate(known):
            if i > flushed and not flags & FUA:
                part = chance.choice([0, 0, 1, chance.random()])
                size = int(size * part) // 512 * 512
                kept += size > 0
            if size > 0:
                source.seek(at)
                card.seek(place)
                card.write(source.read(size))
    print(f"{len(known)} entries, {len(known) - 1 - flushed} since the last flush, of which {kept} are there")


def main():
    if sys.argv[1:2] == ["count"] and len(sys.argv) == 3:
        print(sum(1 for _ in entries(sys.argv[2])))
    elif sys.argv[1:2] == ["card"] and len(sys.argv) == 7:
        write_card(sys.argv[2], sys.argv[3], sys.argv[4], int(sys.argv[5]), sys.argv[6])
    else:
        sys.exit(__doc__)


main()
