#!/usr/bin/env python3
"""A recording of today as a program before it wrote it, in version 4: without the stick and the paths of plans.
usage: as_version_4.py NEW.jwr OLD.jwr"""
import struct
import sys
import zlib

# Behind lost ticks 8, two flags, now 8, wheels 47 and the input's first 51 bytes stands the stick: a flag and two numbers.
STICK, STICK_BYTES = 116, 17
# Before a path stand, without it: lost ticks 8, two flags, now 8, wheels 47, input 51, pose 48, plan 14, wanted 16, verdict 28, command 24, times 24.
BEFORE_PATH = 270

new = open(sys.argv[1], "rb").read()
setup_bytes = struct.unpack_from("<I", new, 12)[0]
header = new[:8] + struct.pack("<I", 4) + new[12 : 16 + setup_bytes]
old = header + struct.pack("<I", zlib.crc32(header))
at, paths = len(old), 0
while True:
    length = struct.unpack_from("<I", new, at)[0]
    if length == 0:
        break
    entry = new[at + 12 : at + 12 + length]
    entry = entry[:STICK] + entry[STICK + STICK_BYTES :]
    points, behind = struct.unpack_from("<I", entry, BEFORE_PATH)[0], BEFORE_PATH + 4
    if points:
        paths, behind, left = paths + 1, behind + 8, 2 * points
        while left:
            left -= entry[behind] < 0x80
            behind += 1
    entry = entry[:BEFORE_PATH] + entry[behind:]
    old += struct.pack("<III", len(entry), len(entry) ^ 0xFFFFFFFF, zlib.crc32(entry)) + entry
    at += 12 + length
open(sys.argv[2], "wb").write(old + new[at:])
print(f"{paths} paths left out, {len(new)} bytes now {len(old) + len(new) - at}")
