#!/usr/bin/env python3
"""Cuts scenes out of campaigns' failures: from a few seconds before a mover had to turn, everybody within reach, as scenarios of a few
seconds. The robot begins at rest where it was; movers walk as they walked and heed nobody. Those in which it makes nobody turn and
touches nobody are kept: they are tests, tests/firmware/moments.

    bench/moments.py out/first out/second --out tests/firmware/moments
"""
import argparse
import csv
import itertools
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile

from command_line import require_built
from forced_movers import forced, rows, walks_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/jaywalk"
BEFORE_S, LASTS_S = 4.5, 8.0
REACH_M = 6.0  # from the robot, at any time of the scene
OFF_M = 0.02  # a walk is straight where no sample is farther off
SCENARIO = """name = "{name}"   # {source}
timeout_s = {lasts}
[map]
yaml = "{map}"
[robot]
start = [{x:.2f}, {y:.2f}, {heading:.2f}]
goal = {goal}
model = "p3dx"
max_speed_mps = 0.6
[[movers]]
kind = "recorded"
file = "{name}.csv"
radius_m = {radius}
legs = {legs}
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaigns", type=pathlib.Path, nargs="+", help="folders, --out of jaywalk campaign")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/moments"))
    parser.add_argument("--most", type=int, default=30, help="scenes to keep")
    return parser.parse_args()


def off_line(sample, a, b):
    """From where a mover was to where it would be on a straight walk between two samples t, x, y."""
    share = (sample[0] - a[0]) / (b[0] - a[0])
    return math.hypot(*(sample[k] - a[k] - share * (b[k] - a[k]) for k in (1, 2)))


def bends(walk):
    """Its first and last sample, and those between at which it changes course (Ramer 1972, Douglas and Peucker 1973)."""
    if len(walk) < 3:
        return walk
    off, at = max((off_line(walk[k], walk[0], walk[-1]), k) for k in range(1, len(walk) - 1))
    return [walk[0], walk[-1]] if off < OFF_M else bends(walk[: at + 1])[:-1] + bends(walk[at:])


def scene_at(run, walks, begin_s):
    """The robot's pose and everybody's walks near it."""
    poses = [p for p in rows(run / "robot.csv", ("t_s", "x_m", "y_m", "heading_rad")) if begin_s <= p[0] <= begin_s + LASTS_S]
    near = {}
    for mover, samples in walks.items():
        walk = [(s[0] - begin_s, s[1], s[2]) for s in samples if begin_s <= s[0] <= begin_s + LASTS_S]
        if len(walk) > 1 and min(math.hypot(s[1] - p[1], s[2] - p[2]) for s in walk[::10] for p in poses[::50]) < REACH_M:
            near[mover] = bends(walk)
    return poses[0], near


def write(folder, name, source, settings, pose, walks):
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / f"{name}.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("t_s", "id", "x_m", "y_m"))
        out.writerows((f"{t:.2f}", mover, f"{x:.2f}", f"{y:.2f}") for mover, walk in sorted(walks.items()) for t, x, y in walk)
    (folder / f"{name}.toml").write_text(SCENARIO.format(name=name, source=source, lasts=LASTS_S, x=pose[1], y=pose[2], heading=pose[3], **settings))


def passes(scenario):
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([PROGRAM, "sim", scenario, "--backend", "cpu", "--out", out], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        summary = json.loads(pathlib.Path(out, "summary.json").read_text())
    return summary["forced_movers"] == 0 and summary["contacts"] == 0


def settings_of(run):
    """Of the scenario that a run of the campaign drove."""
    scenario = next(word for word in run["command"].split() if word.endswith(".toml"))
    text = (ROOT / scenario).read_text()
    yaml = (ROOT / scenario).parent / re.search(r'yaml = "([^"]+)"', text)[1]
    given = dict(word.split("=", 1) for word in run["command"].split() if "=" in word)
    radius = given.get("movers.radius_m") or re.search(r"radius_m = ([\d.]+)", text)[1]
    return {"map": yaml.resolve(), "goal": re.search(r"goal = (\[.+?\])", text)[1], "radius": radius, "legs": given.get("movers.legs", "false")}


def failures(campaign):
    """Each failed run, with its moments but for those that another one's scene holds: run, folder, walks, when the scene begins (s)."""
    for experiment in json.loads((campaign / "campaign.json").read_text())["experiments"]:
        for run in experiment["runs"]:
            folder = campaign / "runs" / run["folder"]
            if not (folder / "movers.csv").exists():
                continue
            walks = walks_of(folder)
            last_s = -math.inf
            for begin_s in sorted(max(0.0, walk[k][0] - BEFORE_S) for walk in walks.values() for k in forced(walk)):
                if begin_s > last_s + LASTS_S:
                    yield run, folder, walks, begin_s
                    last_s = begin_s


def main():
    options = arguments()
    require_built(PROGRAM)
    kept = tried = 0
    for run, folder, walks, begin_s in itertools.chain(*map(failures, options.campaigns)):
        if kept == options.most:
            break
        tried += 1
        settings = settings_of(run)
        settings["map"] = os.path.relpath(settings["map"], options.out.resolve())
        name = f"{kept + 1:02d}"
        write(options.out, name, f"{run['folder']}, from {begin_s:.1f} s on", settings, *scene_at(folder, walks, begin_s))
        good = passes(options.out / f"{name}.toml")
        print(f"{name} {run['folder']} {begin_s:.1f} s: {'passes' if good else 'fails'}", flush=True)
        if good:
            kept += 1
        else:
            for file in options.out.glob(f"{name}.*"):
                file.unlink()
    print(f"{kept} scenes of {tried} moments are in {options.out}")


if __name__ == "__main__":
    main()
