#!/usr/bin/env python3
"""How long before it had to turn each mover set out, and was known to the robot: from the failures that a campaign keeps.

A mover that met the robot again within 2 s counts once. It set out when it last stood. It is known from the first scan on after
which a track lies within 0.5 m of it that goes more than half as fast, within 20 degrees of its direction.

    bench/forced_movers.py out/harder
"""
import argparse
import collections
import csv
import math
import pathlib

ENOUGH_S = 2.0  # a robot of 0.6 m/s and 1 m/s2 clears a walker's way, 1.6 m wide, in about as much
NEAR_M, SHARE, WITHIN_RAD = 0.5, 0.5, math.radians(20.0)
STANDS_MPS = 0.1
CLASSES = ("set out less than 2 s before", "known for less than 2 s", "known for longer")


def rows(path, columns):
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            yield [float(row[c]) for c in columns]


def walks_of(run):
    """Each mover's samples: t_s, x_m, y_m, vx_mps, vy_mps, forced."""
    walks = collections.defaultdict(list)
    for mover, *sample in rows(run / "movers.csv", ("id", "t_s", "x_m", "y_m", "vx_mps", "vy_mps", "forced")):
        walks[int(mover)].append(sample)
    return walks


def forced(walk):
    """Indices at which it was made to turn."""
    last_s = -math.inf
    for k in range(1, len(walk)):
        if walk[k][5] and not walk[k - 1][5]:
            if walk[k][0] - last_s > ENOUGH_S:
                yield k
            last_s = walk[k][0]


def set_out(walk, k):
    k -= 1
    while k > 0 and math.hypot(walk[k][3], walk[k][4]) > STANDS_MPS:
        k -= 1
    return k


def shows(track, sample):
    """Whether a track is of this mover, and as it goes."""
    _, x, y, vx, vy = track
    _, true_x, true_y, true_vx, true_vy, _ = sample
    speed, true_speed = math.hypot(vx, vy), math.hypot(true_vx, true_vy)
    off = abs(math.remainder(math.atan2(vy, vx) - math.atan2(true_vy, true_vx), 2 * math.pi))
    return math.hypot(x - true_x, y - true_y) < NEAR_M and speed > SHARE * true_speed and off < WITHIN_RAD


def known_since(walk, begin, end, tracks):
    """When it was known first; None: never."""
    period = walk[1][0] - walk[0][0]
    for track in tracks:
        k = round((track[0] - walk[0][0]) / period)
        if begin < k < end and shows(track, walk[k]):
            return track[0]
    return None


def look(run):
    tracks = list(rows(run / "tracks.csv", ("t_s", "x_m", "y_m", "vx_mps", "vy_mps")))
    for mover, walk in sorted(walks_of(run).items()):
        for k in forced(walk):
            begin = set_out(walk, k)
            known = known_since(walk, begin, k, tracks)
            yield mover, walk[k][0], walk[k][0] - walk[begin][0], None if known is None else walk[k][0] - known


def class_of(walked_s, known_s):
    return CLASSES[0] if walked_s < ENOUGH_S else CLASSES[1] if (known_s or 0.0) < ENOUGH_S else CLASSES[2]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign", type=pathlib.Path, help="its folder, --out of jaywalk campaign")
    options = parser.parse_args()
    runs = sorted(p.parent for p in (options.campaign / "runs").rglob("movers.csv"))
    if not runs:
        parser.error(f"{options.campaign}: no runs/*/movers.csv; give the folder that jaywalk campaign wrote, with failures in it")
    counts = collections.defaultdict(collections.Counter)
    for run in runs:
        name = run.relative_to(options.campaign / "runs")
        for mover, t_s, walked_s, known_s in look(run):
            kind = class_of(walked_s, known_s)
            counts[name.parts[0], name.parts[1]][kind] += 1
            known = "never known" if known_s is None else f"known for {known_s:.1f} s"
            print(f"{name}: mover {mover} at {t_s:.1f} s: set out {walked_s:.1f} s before, {known}")
    for experiment, count in counts.items():
        print(*experiment, *(f"{count[c]} {c}" for c in CLASSES), sep=" | ")


if __name__ == "__main__":
    main()
