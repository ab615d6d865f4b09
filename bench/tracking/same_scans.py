#!/usr/bin/env python3
"""Scores a replay of scans with poor wheels against a corrected log of the same drive that keeps another clock.

  same_scans.py RUN SCANS LOG

RUN: what `jaywalk replay SCANS` left. SCANS: lines `t dx dy dphi aperture max_range n r1..rn`. LOG: CARMEN, corrected.
A scan is found again by its ranges, to the centimetre; those of which either file has two that are alike, or two that
share a stamp, are passed over. Prints medians, and what nine tenths stay within, of the relative pose error over 10 m.
"""
import argparse
import bisect
import collections
import csv
import gzip
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from command_line import at_line, reading, refuse

WAY_M, MOST_M = 10.0, 14.0  # common scans are metres apart: a stretch ends at the first one 10 m on


def read_lines(path, expected, understand):
    """What `understand` makes of each line's words."""
    with reading(path, expected), (gzip.open if path.endswith(".gz") else open)(path, "rt") as file:
        rows = [(k, line.split()) for k, line in enumerate(file, 1) if line.strip() and line[0] != "#"]
    return [at_line(path, k, understand, words) for k, words in rows]


def after(pose, step):
    """Pose `pose`, moved by `step` in its own frame."""
    (x, y, h), (dx, dy, turn) = pose, step
    return x + math.cos(h) * dx - math.sin(h) * dy, y + math.sin(h) * dx + math.cos(h) * dy, h + turn


def seen_from(pose, other):
    dx, dy, c, s = other[0] - pose[0], other[1] - pose[1], math.cos(pose[2]), math.sin(pose[2])
    return c * dx + s * dy, c * dy - s * dx, other[2] - pose[2]


def read_scans(path):
    """(stamp, pose by the wheels, ranges in cm) a scan."""
    pose = None
    rows = read_lines(path, "lines 't dx dy dphi aperture max_range n r1..rn'",
                      lambda w: (float(w[0]), tuple(float(x) for x in w[1:4]), tuple(round(100 * float(r)) for r in w[7:])))
    for stamp, step, shape in rows:
        pose = after(pose, step) if pose else (0.0, 0.0, 0.0)
        yield stamp, pose, shape


def laser_line(w):
    """(ranges in cm, pose) of a FLASER line, nothing of others."""
    if w[0] != "FLASER":
        return None
    n = int(w[1])
    x, y, heading = map(float, w[n + 2 : n + 5])
    return tuple(round(100 * float(r)) for r in w[2 : 2 + n]), (x, y, heading)


def read_log(path):
    """Corrected poses by their scans' ranges in cm."""
    poses = collections.defaultdict(list)
    for shape, pose in filter(None, read_lines(path, "a CARMEN log", laser_line)):
        poses[shape].append(pose)
    return poses


def read_run(folder):
    path = folder + "/robot.csv"
    with reading(path, "the folder of a replay"), open(path, newline="") as file:
        rows = [[float(r[c]) for c in ("t_s", "est_x_m", "est_y_m", "est_heading_rad")] for r in csv.DictReader(file)]
    if not rows:
        refuse(f"{path}: no rows", "give the folder of a replay")
    return [r[0] for r in rows], [tuple(r[1:]) for r in rows]


def errors(true, measured):
    """(per cent of the way, degrees) of each stretch."""
    way = [0.0]
    for a, b in zip(true, true[1:]):
        way.append(way[-1] + math.hypot(b[0] - a[0], b[1] - a[1]))
    for i, at in enumerate(way):
        j = bisect.bisect_left(way, at + WAY_M)
        if j == len(way) or way[j] - at > MOST_M:
            continue
        t, m = seen_from(true[i], true[j]), seen_from(measured[i], measured[j])
        off = math.hypot(t[0] - m[0], t[1] - m[1])
        yield 100 * off / (way[j] - at), abs(math.degrees(math.remainder(t[2] - m[2], 2 * math.pi)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("run", "scans", "log"):
        parser.add_argument(name)
    args = parser.parse_args()
    scans, corrected, (times, poses) = list(read_scans(args.scans)), read_log(args.log), read_run(args.run)
    stamps, shapes = (collections.Counter(s[k] for s in scans) for k in (0, 2))
    same = [s for s in scans if stamps[s[0]] == 1 and shapes[s[2]] == 1 and len(corrected.get(s[2], ())) == 1]
    true = [corrected[s[2]][0] for s in same]
    placed = [poses[min(bisect.bisect_left(times, s[0] - 1e-6), len(poses) - 1)] for s in same]
    if not any(errors(true, true)):
        refuse(f"{args.log}: no stretch of {WAY_M:g} m between scans that {args.scans} has too", "give two recordings of one drive")
    print(f"{len(same)} scans that both have\n| over 10 m | stretches | median | nine tenths within |\n|---|---|---|---|")
    for name, measured in (("wheels alone", [s[1] for s in same]), ("replay", placed)):
        off, turned = (sorted(e[k] for e in errors(true, measured)) for k in (0, 1))
        at = [f"{off[k]:.2f} %, {turned[k]:.2f} degrees" for k in (len(off) // 2, 9 * len(off) // 10)]
        print(f"| {name} | {len(off)} | {at[0]} | {at[1]} |")


if __name__ == "__main__":
    main()
