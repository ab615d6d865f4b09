#!/usr/bin/env python3
"""Labels people in a recording of a laser that stands still, by background subtraction over the whole recording.

The rule, blind to any tracker:
1. Background: a beam's nearest range (in steps of 0.1 m) to which a sixth of its scans return. Whoever stands still
   for less than that is no background.
2. Foreground: a hit more than 0.25 m before its beam's background, nearer than --farthest, in a piece of at least 3
   beams.
3. A person: pieces whose centres lie within 0.55 m of one another (legs in stride). The label is the mean of the
   pieces' centres, each moved 5 cm back along its beams: a leg's axis lies behind the arc that is seen.
4. A name holds from scan to scan while exactly one person continues exactly one (within 0.35 m of where its last six
   places lead, after at most 0.3 s unseen); where two come together names end.
5. Walking: at least 0.35 m between 0.5 s before and 0.5 s after, under one name, alone.
Every --every-th scan is written with all its people; those who stand, whose name has just begun or is about to end, or who
are wider than one person (0.85 m) are written with walks = 0: to find them is neither right nor wrong.

label_walkers.py SCAN.txt.gz > LABELS.csv
bench/tracking/labels: standing_robot_people_walk.csv as above, standing_robot_people_walk_2.csv with --farthest 8 --every 2.
"""
import argparse
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from command_line import read_lines, refuse

STEP_M, SHARE, BEFORE_M, FEWEST = 0.1, 1 / 6, 0.25, 3
LEG_JUMP_M, STRIDE_M, LEG_RADIUS_M, WIDEST_M = 0.12, 0.55, 0.05, 0.85
FOLLOW_M, UNSEEN_S, HALF_S, WALKED_M = 0.35, 0.3, 0.5, 0.35


def scan_of(words):
    t, first, step, low, high, beams, *ranges = map(float, words)
    if beams != len(ranges):
        raise ValueError
    return t, first, step, [r if low <= r <= high else math.inf for r in ranges]


def read_scans(path):
    scans = read_lines(path, "lines 't angle_min angle_inc range_min range_max n r1..rn'", scan_of)
    if len({len(ranges) for _, _, _, ranges in scans}) != 1:
        refuse(f"{path}: {'scans of several lengths' if scans else 'no scan in it'}", "give a recording of one laser")
    return scans


def background(scans):
    beams = len(scans[0][3])
    counts = [{} for _ in range(beams)]
    for _, _, _, ranges in scans:
        for count, r in zip(counts, ranges):
            if r < math.inf:
                count[int(r / STEP_M)] = count.get(int(r / STEP_M), 0) + 1
    need = SHARE * len(scans)
    return [min((k * STEP_M for k in c if c[k] + c.get(k + 1, 0) >= need), default=math.inf) for c in counts]


def foreground(scan, behind, farthest_m):
    """(beam, place) of hits before the background: rule 2."""
    _, first, step, ranges = scan
    before = ((b, r) for b, r in enumerate(ranges) if r < min(behind[b] - BEFORE_M, farthest_m))
    return [(b, (r * math.cos(first + b * step), r * math.sin(first + b * step))) for b, r in before]


def pieces(hits):
    """Runs of neighbouring beams: (x, y) of each."""
    runs, last = [], None
    for b, p in hits:
        if last is None or b - last[0] > 2 or math.dist(p, last[1]) > LEG_JUMP_M:
            runs.append([])
        runs[-1].append(p)
        last = (b, p)
    return [run for run in runs if len(run) >= FEWEST]


def centre(run, laser):
    x, y = sum(p[0] for p in run) / len(run), sum(p[1] for p in run) / len(run)
    back = LEG_RADIUS_M / max(math.dist((x, y), laser), 1e-3)
    return x + back * (x - laser[0]), y + back * (y - laser[1])


def people(hits, laser=(0.0, 0.0)):
    """Places and widths of those in one scan's foreground."""
    groups = []
    for run in pieces(hits):
        c = centre(run, laser)
        near = [g for g in groups if any(math.dist(c, centre(r, laser)) < STRIDE_M for r in g)]
        groups = [g for g in groups if g not in near] + [[run] + [r for g in near for r in g]]
    found = []
    for g in groups:
        c = [centre(run, laser) for run in g]
        ends = [p for run in g for p in (run[0], run[-1])]
        width = max(math.dist(p, q) for p in ends for q in ends)
        found.append(((sum(p[0] for p in c) / len(c), sum(p[1] for p in c) / len(c)), width))
    return found


def name_them(frames, unseen_scans):
    """A list a scan of (name, place, width): rule 4."""
    open_names, named, newest = {}, [], 0
    for k, found in enumerate(frames):
        places = {}
        for name, trail in open_names.items():
            (k1, p1), (k0, p0) = trail[-1], trail[0]
            share = (k - k1) / (k1 - k0) if k1 > k0 else 0.0
            places[name] = (p1[0] + share * (p1[0] - p0[0]), p1[1] + share * (p1[1] - p0[1]))
        claims = [[n for n in places if math.dist(places[n], p) < FOLLOW_M] for p, _ in found]
        row = []
        for claim, (p, width) in zip(claims, found):
            alone = len(claim) == 1 and sum(claim[0] in c for c in claims) == 1 and width < WIDEST_M
            if alone:
                name = claim[0]
            else:
                newest += 1
                name = newest
                for n in claim:
                    open_names.pop(n, None)
            open_names.setdefault(name, []).append((k, p))
            row.append((name, p, width))
        open_names = {n: t[-6:] for n, t in open_names.items() if k - t[-1][0] <= unseen_scans}
        named.append(row)
    return named


def walks(named, k, name, width, half_s_scans):
    ago, ahead = max(0, k - half_s_scans), min(len(named) - 1, k + half_s_scans)
    ends = [[p for n, p, w in named[j] if n == name and w < WIDEST_M] for j in (ago, ahead)]
    return width < WIDEST_M and all(ends) and math.dist(ends[0][0], ends[1][0]) > WALKED_M


def labels_of(path, farthest_m):
    """Of every scan: its time, and (name, place, walks)."""
    scans = read_scans(path)
    behind = background(scans)
    period_s = (scans[-1][0] - scans[0][0]) / max(1, len(scans) - 1)
    if not period_s > 0.01:
        refuse(f"{path}: no scans one after the other", "give a recording of a laser")
    named = name_them([people(foreground(scan, behind, farthest_m)) for scan in scans], round(UNSEEN_S / period_s))
    for k, row in enumerate(named):
        yield scans[k][0], [(name, place, walks(named, k, name, width, round(HALF_S / period_s))) for name, place, width in row]


def main(path, farthest_m, every):
    labels = list(labels_of(path, farthest_m))
    print("t_bag,id,x,y,walks")
    for t, row in labels[::every]:
        for name, (x, y), walking in row:
            print(f"{t:.6f},{name},{x:.3f},{y:.3f},{int(walking)}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scans", help="SCAN.txt or SCAN.txt.gz")
    parser.add_argument("--farthest", type=float, default=5.0, help="m: what is farther is not labelled (default: 5)")
    parser.add_argument("--every", type=int, choices=range(1, 101), default=5, metavar="1-100",
                        help="scans: one in so many is written (default: 5)")
    options = parser.parse_args()
    main(options.scans, options.farthest, options.every)
