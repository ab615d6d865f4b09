#!/usr/bin/env python3
"""How a build sees the recordings: docs/explanation/results.md#tracking-and-poses, "Recordings", has the figures.

    bench/tracking/recordings.py ../shared/data
    bench/tracking/recordings.py ../shared/data --only nobody --headings 2

False movers where nobody is, over eight headings of the map, as recorded and run backwards: what holds for one approach alone
shows so. People who walk round a robot that stands; those who walk or stand beside a wheelchair that drives. They are labelled
by background subtraction over the whole recording, in every scan, blind to any tracker (label_walkers.py, label_beside.py).
Every recording is lived through by build/bench/tracking/jaywalk_relive.
"""
import argparse
import collections
import csv
import math
import pathlib
import statistics

import label_beside
import label_walkers
from command_line import all_of, opened, said_by  # label_walkers puts its folder on the path

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RELIVE = ROOT / "build/bench/tracking/jaywalk_relive"
MATCH_M, STANDS_M, LABELS_LATE_S = 0.5, 0.4, 0.13
MOUNT = (0.850326, 0.235214, 0.734815)  # the wheelchair's laser, by the recording's own transform
WALK_BESIDE = ROOT / "bench/tracking/labels/wheelchair_walk.csv"
TURN_RAD = 0.2
LEFT_M, APPROACH_M, HEAD_ON_RAD = 0.3, 2.5, 0.35
HEAD_ON_FROM_M = 8.0
LABELLED_M = {"standing_robot_people_walk": 5.0, "standing_robot_people_walk_2": 8.0}  # reach of the labels


def relive(options, name, *files, mount=(0.0, 0.0, 0.0)):
    out = options.out / name
    said_by(options.relive, *(options.data / f for f in files), "--out", out, "--laser-mount", ",".join(map(str, mount)))
    return out


def rows_of(file):
    with opened(file) as lines:
        return list(csv.DictReader(lines))


def tracks_of(out):
    """Of every scan: (name, place, moving)."""
    scans = collections.defaultdict(list)
    for row in rows_of(out / "tracks.csv"):
        scans[float(row["t_s"])].append((int(row["id"]), (float(row["x_m"]), float(row["y_m"])), row["moving"] == "1"))
    return scans


def at(scans, t):
    near = [s for s in scans if abs(s - t) < 0.03]
    return scans[min(near, key=lambda s: abs(s - t))] if near else []


def nearest(tracks, place, within_m, moving=True):
    """The name of the nearest track; None."""
    near = [(math.dist(p, place), name) for name, p, moves in tracks if moves or not moving]
    return min((n for n in near if n[0] < within_m), default=(0, None))[1]


def backwards(options, file):
    """The same scans, the last one first."""
    with opened(options.data / file) as lines:
        scans = [line.split(" ", 1) for line in lines if line[0] != "#"]
    ends_s = float(scans[0][0]) + float(scans[-1][0])
    options.out.mkdir(parents=True, exist_ok=True)
    path = (options.out / file.replace("/", "_").replace(".gz", "")).resolve()
    path.write_text("".join(f"{ends_s - float(t):.6f} {rest}" for t, rest in reversed(scans)))
    return path


def nobody(options):
    print("| where nobody is | false movers | a minute | taken for pedestrians a minute | at a time |\n|---|---|---|---|---|")
    for side, turned in (("left", False), ("right", False), ("left", True), ("right", True)):
        jobs = [(k, f"{side}{turned:d}{k}") for k in range(options.headings)]
        file = f"static/no_people_{side}.scan.txt.gz"
        file = backwards(options, file) if turned else file
        outs = all_of(lambda job: relive(options, job[1], file, mount=(0, 0, TURN_RAD * job[0])), jobs, options.jobs)
        false, minutes, pedestrians, at_a_time = 0, 0.0, 0, []
        for out in outs:
            scans = tracks_of(out)
            names = [int(row["id"]) for row in rows_of(out / "tracks.csv") if row["pedestrian"] == "1"]  # scan after scan
            pedestrians += len(set(names))
            at_a_time.append(len(names) / len(scans))
            false += len({name for tracks in scans.values() for name, _, moves in tracks if moves})
            minutes += (max(scans) - min(scans)) / 60
        print(f"| no_people_{side}{', run backwards' if turned else ''}, {options.headings} headings | {false} | {false / minutes:.2f} | {pedestrians / minutes:.0f} | {statistics.mean(at_a_time):.1f} |", flush=True)


def dense_labels(options, name, farthest_m):
    """Trails of those who walk, by name: [(t, place in the laser's frame, walks)], every scan."""
    trails = collections.defaultdict(list)
    for t, row in label_walkers.labels_of(options.data / f"static/{name}.scan.txt.gz", farthest_m):
        for person, place, walks in row:
            trails[person].append((t, place, walks))
    return [trail for trail in trails.values() if any(walks for _, _, walks in trail)]


def walk_figures(trail, scans):
    """Labels, those found by a moving track, those by its commonest name, and s from 0.3 m walked until it moves."""
    found = [nearest(at(scans, t), place, MATCH_M) for t, place, walks in trail if walks]
    names = collections.Counter(name for name in found if name is not None)
    began = next((t for t, place, _ in trail if math.dist(place, trail[0][1]) > LEFT_M), None)
    moves = next((t for t, place, _ in trail if nearest(at(scans, t), place, MATCH_M) is not None), math.inf)
    late_s = None if began is None else max(0.0, moves - began)
    return len(found), sum(names.values()), max(names.values(), default=0), late_s


def walkers(options):
    print("\n| who walks round a standing robot | labels | recall of moving | walks with one name for 90 % | s to moving: median, 90 %, most |\n|---|---|---|---|---|")
    for name, farthest_m in LABELLED_M.items():
        scans = tracks_of(relive(options, name, f"static/{name}.scan.txt.gz"))
        figures = [walk_figures(trail, scans) for trail in dense_labels(options, name, farthest_m)]
        labels, found = sum(f[0] for f in figures), sum(f[1] for f in figures)
        whole = sum(f[2] >= 0.9 * f[0] for f in figures)
        late = sorted(f[3] for f in figures if f[3] is not None)
        print(f"| {name} | {labels} | {100 * found / labels:.1f} % | {whole} of {len(figures)} | "
              f"{statistics.median(late):.2f}, {late[int(0.9 * (len(late) - 1))]:.2f}, {late[-1]:.2f} |", flush=True)


def head_on(options):
    """Those who come straight towards a standing robot, from farther off than labels are counted elsewhere."""
    print("\n| who comes straight on | names | of them moving | moving from, m |\n|---|---|---|---|")
    for name in LABELLED_M:
        scans = tracks_of(relive(options, name, f"static/{name}.scan.txt.gz"))
        for trail in dense_labels(options, name, HEAD_ON_FROM_M):
            ranges = [math.hypot(*place) for _, place, _ in trail]
            bearings = [math.atan2(place[1], place[0]) for _, place, _ in trail]
            far, near = ranges.index(max(ranges)), ranges.index(min(ranges))
            if not (far < near and ranges[far] - ranges[near] > APPROACH_M) or abs(bearings[far] - bearings[near]) > HEAD_ON_RAD:
                continue
            way = trail[far : near + 1]
            names = [nearest(at(scans, t), place, MATCH_M, False) for t, place, _ in way]
            moving = [nearest(at(scans, t), place, MATCH_M) for t, place, _ in way]
            first = next((math.hypot(*way[k][1]) for k, n in enumerate(moving) if n is not None), math.nan)
            print(f"| {name}, {way[0][0] - min(scans):.1f} s: {ranges[far]:.1f} to {ranges[near]:.1f} m in {way[-1][0] - way[0][0]:.1f} s | "
                  f"{len(set(names) - {None})} | {len(set(moving) - {None})} | {first:.1f} |", flush=True)


def robot_poses(out, times):
    return dict(zip(times, label_beside.poses_at(out / "robot.csv", MOUNT, times)))


def wheelchair(options):
    files = ("wheelchair/scan.txt.gz", "wheelchair/odom.txt.gz")
    out = relive(options, "wheelchair", *files, mount=MOUNT)
    scans = tracks_of(out)
    walking = collections.defaultdict(list)  # by time, in the laser's frame: another run's map lies elsewhere
    for r in rows_of(WALK_BESIDE):
        if r["walks"] == "1":
            walking[float(r["t_bag"])].append((float(r["x"]), float(r["y"])))
    poses = robot_poses(out, list(walking))
    found = {t: [nearest(at(scans, t), label_beside.in_map(poses[t], p), MATCH_M) is not None for p in places] for t, places in walking.items()}
    seen, every = {t: any(row) for t, row in found.items()}, [one for row in found.values() for one in row]
    people = rows_of(options.data / "wheelchair/people.csv.gz")
    labels = [(float(r["t_bag"]) - LABELS_LATE_S, (float(r["x"]), float(r["y"]))) for r in people]
    poses = robot_poses(out, [t for t, _ in labels])
    stands = sum(nearest(at(scans, t), label_beside.in_map(poses[t], p), STANDS_M, False) is not None for t, p in labels)
    moves = len({name for tracks in scans.values() for name, _, m in tracks if m})
    print("\n| beside a driving wheelchair | |\n|---|---|")
    print(f"| scans with somebody walking within 5 m that show one moving there | {sum(seen.values())} of {len(seen)}, {100 * sum(seen.values()) / len(seen):.0f} % |")
    print(f"| of all who walk in them | {sum(every)} of {len(every)}, {100 * sum(every) / len(every):.0f} % |")
    print(f"| labels of people with any track within {STANDS_M} m | {stands} of {len(labels)}, {100 * stands / len(labels):.0f} % |")
    print(f"| names of tracks that move | {moves} |", flush=True)


PARTS = {"nobody": nobody, "walkers": walkers, "head_on": head_on, "wheelchair": wheelchair}


def arguments():
    made = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("data", type=pathlib.Path, help="folder of the recordings")
    made.add_argument("--only", choices=PARTS, action="append", help="this part; may be given again")
    made.add_argument("--relive", type=pathlib.Path, default=RELIVE, help="another build's jaywalk_relive")
    made.add_argument("--headings", type=int, default=8)
    made.add_argument("--jobs", type=int, default=2)
    made.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/recordings"))
    return made.parse_args()


def main():
    options = arguments()
    for part in options.only or PARTS:
        PARTS[part](options)


if __name__ == "__main__":
    main()
