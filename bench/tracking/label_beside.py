#!/usr/bin/env python3
"""Labels people who walk in a recording of a laser that drives, by what the whole recording says of each place.

The rule, blind to any tracker; poses come from the odometry and scans (`robot.csv` of a run):
1. Every scan is laid into one map of cells of 0.1 m: how many scans end in a cell, and how many pass through it.
2. Foreground: a hit within 5 m whose cell and its neighbours are passed through in at least 7 of 10 scans that say
   anything of them.
3. People and names as label_walkers.py has them, in the map.
4. Walking: under one name for at least 1 s, and at least 0.35 m from 0.5 s before to 0.5 s after; others: walks = 0.

label_beside.py SCAN.txt.gz ROBOT.csv --laser-mount X,Y,YAW > LABELS.csv     (t_bag,id,x,y,walks in the laser's frame)
bench/tracking/labels/wheelchair_walk.csv: so, with the poses of commit d185322.
"""
import argparse
import bisect
import csv
import math

import label_walkers as lw
from command_line import reading  # label_walkers puts its folder on the path

CELL_M, PASSED, KNOWN_S, HALF_S = 0.1, 0.7, 1.0, 0.5
FARTHEST_M, UNSEEN_SCANS = 5.0, 3


def in_map(pose, place):
    x, y, h = pose
    return x + math.cos(h) * place[0] - math.sin(h) * place[1], y + math.sin(h) * place[0] + math.cos(h) * place[1]


def poses_at(path, mount, times):
    """Of the laser in the map."""
    with reading(path, "robot.csv of a run"), open(path) as file:
        rows = [[float(r[k]) for k in ("t_s", "est_x_m", "est_y_m", "est_heading_rad")] for r in csv.DictReader(file)]
    robots = (rows[min(bisect.bisect_left(rows, t - 1e-6, key=lambda row: row[0]), len(rows) - 1)][1:] for t in times)
    return [(*in_map(robot, mount), robot[2] + mount[2]) for robot in robots]


def ends_of(scan, pose):
    """(beam, place in the map) of each hit."""
    _, first, step, ranges = scan
    x, y, h = pose
    return [(b, (x + r * math.cos(h + first + b * step), y + r * math.sin(h + first + b * step))) for b, r in enumerate(ranges) if r < math.inf]


def cell(p):
    return math.floor(p[0] / CELL_M), math.floor(p[1] / CELL_M)


def ground(scans, poses):
    """Of every cell: scans that end there, scans that pass."""
    hits, passes = {}, {}
    for scan, pose in zip(scans, poses):
        ended = {cell(p) for _, p in ends_of(scan, pose)}
        passed = set()
        for _, (px, py) in ends_of(scan, pose):
            length = math.dist(pose[:2], (px, py))
            for k in range(int(min(length - 2 * CELL_M, FARTHEST_M + 1) / CELL_M)):
                share = k * CELL_M / length
                passed.add(cell((pose[0] + share * (px - pose[0]), pose[1] + share * (py - pose[1]))))
        for c in ended:
            hits[c] = hits.get(c, 0) + 1
        for c in passed - ended:
            passes[c] = passes.get(c, 0) + 1
    return hits, passes


def foreground(scan, pose, hits, passes):
    kept = []
    for b, p in ends_of(scan, pose):
        if math.dist(p, pose[:2]) > FARTHEST_M:
            continue
        i, j = cell(p)
        near = [(i + a, j + c) for a in (-1, 0, 1) for c in (-1, 0, 1)]
        ended, passed = sum(hits.get(c, 0) for c in near), sum(passes.get(c, 0) for c in near)
        if passed > PASSED * (ended + passed):
            kept.append((b, p))
    return kept


def trails_of(named, times):
    trails = {}
    for k, row in enumerate(named):
        for name, p, width in row:
            if width < lw.WIDEST_M:
                trails.setdefault(name, []).append((times[k], p))
    return trails


def walks(trail, t):
    if trail[-1][0] - trail[0][0] < KNOWN_S:
        return False
    ago = [p for s, p in trail if t - HALF_S - 0.1 <= s <= t - HALF_S + 0.1] or [trail[0][1]]
    ahead = [p for s, p in trail if t + HALF_S - 0.1 <= s <= t + HALF_S + 0.1] or [trail[-1][1]]
    return math.dist(ago[0], ahead[0]) > lw.WALKED_M


def labels_of(path, robot, mount):
    """Of every scan: its time, the laser's pose, and (name, place in the map, walks)."""
    scans = lw.read_scans(path)
    poses = poses_at(robot, mount, [scan[0] for scan in scans])
    hits, passes = ground(scans, poses)
    found = [lw.people(foreground(s, p, hits, passes), p[:2]) for s, p in zip(scans, poses)]
    times = [scan[0] for scan in scans]
    named = lw.name_them(found, UNSEEN_SCANS)
    trails = trails_of(named, times)
    for t, pose, row in zip(times, poses, named):
        yield t, pose, [(name, p, width < lw.WIDEST_M and name in trails and walks(trails[name], t)) for name, p, width in row]


def main(options):
    print("t_bag,id,x,y,walks")
    for t, (x, y, h), row in labels_of(options.scans, options.robot, options.laser_mount):
        for name, (px, py), walking in row:
            dx, dy = px - x, py - y
            a, b = math.cos(h) * dx + math.sin(h) * dy, -math.sin(h) * dx + math.cos(h) * dy
            print(f"{t:.6f},{name},{a:.3f},{b:.3f},{int(walking)}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scans", help="SCAN.txt or SCAN.txt.gz")
    parser.add_argument("robot", help="robot.csv of a run over it")
    parser.add_argument("--laser-mount", type=lambda t: tuple(map(float, t.split(","))), default=(0.0, 0.0, 0.0), help="X,Y,YAW")
    main(parser.parse_args())
