#!/usr/bin/env python3
"""The poses of a corrected log at another recording's times of the same drive, whose clock differs: t,x,y,h.

  same_scans.py SCANS LOG >POSES.csv
  jaywalk_track_bench RUN --reference POSES.csv    (RUN: what `jaywalk replay SCANS` left)

SCANS: lines `t dx dy dphi aperture max_range n r1..rn`. LOG: CARMEN, corrected. A scan is found again by its ranges, to
the centimetre; those of which either file has two that are alike, or two that share a stamp, are passed over.
"""
import argparse
import collections
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from command_line import read_lines, refuse


def scan_of(w):
    """(stamp, ranges in cm)."""
    return float(w[0]), tuple(round(100 * float(r)) for r in w[7:])


def laser_line(w):
    """(ranges in cm, pose) of a FLASER line, nothing of others."""
    if w[0] != "FLASER":
        return None
    n = int(w[1])
    x, y, heading = map(float, w[n + 2 : n + 5])
    return tuple(round(100 * float(r)) for r in w[2 : 2 + n]), (x, y, heading)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scans")
    parser.add_argument("log")
    args = parser.parse_args()
    scans = read_lines(args.scans, "lines 't dx dy dphi aperture max_range n r1..rn'", scan_of)
    corrected = collections.defaultdict(list)
    for shape, pose in filter(None, read_lines(args.log, "a CARMEN log", laser_line)):
        corrected[shape].append(pose)
    stamps, shapes = (collections.Counter(column) for column in zip(*scans)) if scans else ({}, {})
    same = [(t, *corrected[s][0]) for t, s in scans if stamps[t] == 1 and shapes[s] == 1 and len(corrected.get(s, ())) == 1]
    if not same:
        refuse(f"{args.log}: no scan that {args.scans} has too", "give two recordings of one drive")
    print("t,x,y,h")
    for row in same:
        print(*map("{:.6f}".format, row), sep=",")


if __name__ == "__main__":
    main()
