#!/usr/bin/env python3
"""Draws the project's own maps: python3 make_maps.py [FOLDER], by default the folder of this file.

Walls are rectangles in metres (x0, y0, x1, y1), origin at the lower left. Each map becomes NAME.png
(8 bit grey, 0 wall, 254 free) and NAME.yaml for ROS map_server. The lengths of the shortest paths
from (1.5, 1.5) to (24, 24) are meant to be near those of the paper's four maps and are tested in
tests/sim/own_maps_test.cc.
"""
import os
import struct
import sys
import zlib

CELL = 0.1  # m
THICK = 0.2  # m, every wall


def across(y, x0, x1):
    """A wall along x."""
    return (x0, y - THICK / 2, x1, y + THICK / 2)


def along(x, y0, y1):
    """A wall along y."""
    return (x - THICK / 2, y0, x + THICK / 2, y1)


def outer(width, height):
    return [(0, 0, width, THICK), (0, height - THICK, width, height),
            (0, 0, THICK, height), (width - THICK, 0, width, height)]


SIDE = 25.6

# Two long partitions make an S; office bays along the sides. About 46 m.
MAP1 = outer(SIDE, SIDE) + [
    along(8.5, 0, 16.8), along(17.0, 8.9, SIDE),
    across(6.0, 0, 2.6), across(12.0, 0, 2.6), across(18.0, 0, 3.2),
    across(12.0, 11.6, 14.0), along(12.8, 10.8, 13.2),
    across(7.6, 22.8, SIDE), across(13.6, 23.0, SIDE), along(12.8, 22.4, SIDE), along(12.8, 0, 3.2)]

# Two walls from side to side but for one opening each: the longest way. About 67 m.
MAP2 = outer(SIDE, SIDE) + [
    across(8.5, 0, 22.5), across(17.1, 2.9, SIDE),
    along(7.0, 6.0, 8.5), along(14.0, 0, 2.2), along(14.0, 6.2, 8.5),
    along(9.0, 8.5, 11.0), along(16.5, 14.6, 17.1), along(18.5, 8.5, 10.8),
    along(9.0, 17.1, 19.3), along(9.0, 23.0, SIDE), along(16.0, 17.1, 19.6), along(21.0, 17.1, 19.0)]

# Three half walls, a maze of rooms between them. About 48 m.
MAP3 = outer(SIDE, SIDE) + [
    across(6.6, 0, 14.9), across(12.8, 5.9, SIDE), across(19.0, 0, 18.3),
    along(19.5, 0, 3.2), along(20.5, 9.6, 12.8), across(6.6, 22.4, SIDE),
    along(10.5, 0, 2.2), along(5.5, 19.0, 22.0), along(12.0, 22.6, SIDE), along(15.0, 12.8, 15.4)]

# Nine rooms, their doors 2.8 m wide; two of them lead nowhere. About 49 m.
MAP4 = outer(SIDE, SIDE) + [
    along(8.5, 0, 4.2), along(8.5, 7.0, 10.6), along(8.5, 13.4, 20.6), along(8.5, 23.4, SIDE),
    along(17.1, 0, 2.2), along(17.1, 5.0, 20.2), along(17.1, 23.0, SIDE),
    across(8.5, 0, 14.0), across(8.5, 16.8, 20.0), across(8.5, 22.8, SIDE),
    across(17.1, 0, 1.8), across(17.1, 4.6, SIDE)]

# The demo's: two rooms, a hall between them with four pillars. 20 m x 14 m.
CROSSING = outer(20.0, 14.0) + [
    along(5.0, 0, 5.6), along(5.0, 8.6, 14.0), along(15.0, 0, 5.4), along(15.0, 8.4, 14.0),
    (7.9, 3.4, 8.3, 3.8), (11.7, 3.4, 12.1, 3.8), (7.9, 10.2, 8.3, 10.6), (11.7, 10.2, 12.1, 10.6)]


# Tight places for a wheelchair of 0.65 m x 1.10 m. Two rooms and a door of 0.90 m; 8.2 m x 5 m inside.
DOOR = outer(8.6, 5.4) + [along(4.3, 0, 2.3), along(4.3, 3.2, 5.4)]

# A corridor of 1.2 m with one corner; 5 m long either way.
CORNER = outer(5.4, 5.4) + [(0, 1.4, 4.0, 5.4)]

# A room, and off it a dead end 1.2 m wide and 2.5 m deep.
DEAD_END = outer(7.9, 5.4) + [(5.2, 0, 7.9, 2.0), (5.2, 3.2, 7.9, 5.4)]


def rasterise(width, height, walls):
    """Rows of grey values from the top, as pictures have them."""
    columns, rows = round(width / CELL), round(height / CELL)
    grey = [bytearray([254] * columns) for _ in range(rows)]
    for x0, y0, x1, y1 in walls:
        for row in range(max(0, round(y0 / CELL)), min(rows, round(y1 / CELL))):
            for column in range(max(0, round(x0 / CELL)), min(columns, round(x1 / CELL))):
                grey[rows - 1 - row][column] = 0
    return grey


def png(grey):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", len(grey[0]), len(grey), 8, 0, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + bytes(row) for row in grey), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")


def write_map(folder, name, width, height, walls):
    with open(os.path.join(folder, name + ".png"), "wb") as out:
        out.write(png(rasterise(width, height, walls)))
    with open(os.path.join(folder, name + ".yaml"), "w", encoding="ascii") as out:
        out.write(f"image: {name}.png\nresolution: {CELL}\norigin: [0.0, 0.0, 0.0]\n"
                  "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for name, walls in (("map1", MAP1), ("map2", MAP2), ("map3", MAP3), ("map4", MAP4)):
        write_map(folder, name, SIDE, SIDE, walls)
    write_map(folder, "crossing", 20.0, 14.0, CROSSING)
    write_map(folder, "door", 8.6, 5.4, DOOR)
    write_map(folder, "corner", 5.4, 5.4, CORNER)
    write_map(folder, "dead_end", 7.9, 5.4, DEAD_END)


if __name__ == "__main__":
    main()
