#!/usr/bin/env python3
"""A wheelchair and doors that nobody has tuned it on: two rooms, a wall of any thickness across at any angle, a door anywhere in it,
start and heading anywhere in front. One line a door, and how many were passed without contact.

    bench/random_doors.py --seeds 101-140 --width 0.90 --out out/doors
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import subprocess
import sys

from command_line import jobs_of, require_built, seeds_of
from drawn_map import turned, write_map

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/jaywalk"
ROOM_M, CELL_M, BORDER_M = (9.0, 7.0), 0.02, 0.1

SCENARIO = """name = "{name}"
seed = {seed}
timeout_s = 120.0
[map]
yaml = "{name}.yaml"
[robot]
start = [1.4, {start_y:.3f}, {heading:.3f}]
goal = [7.6, {goal_y:.3f}]
model = "wheelchair"
max_speed_mps = 0.6
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=seeds_of, default="101-140", help="one, or first-last")
    parser.add_argument("--width", type=float, default=0.90, help="of the door, m")
    parser.add_argument("--angle", type=float, default=45.0, help="the wall turns by at most this, degrees")
    parser.add_argument("--jobs", type=jobs_of, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/doors"))
    return parser.parse_args()


def is_wall(x, y, door, width):
    """Whether there is a wall at x, y: the rooms' border, or the wall between them."""
    if min(x, y, ROOM_M[0] - x, ROOM_M[1] - y) < BORDER_M:
        return True
    through, along = turned(x - ROOM_M[0] / 2, y - door["y"], door["angle"])
    return abs(through) < door["thickness"] / 2 and abs(along) > width / 2


def write(seed, options):
    """Map and scenario of a seed; returns the scenario's path and the door."""
    rng = random.Random(seed)
    door = {"thickness": rng.uniform(0.1, 0.3), "y": rng.uniform(1.6, 5.4), "angle": math.radians(rng.uniform(-1, 1) * options.angle)}
    name, folder = f"door_{seed}", options.out
    write_map(folder, name, ROOM_M, CELL_M, lambda x, y: is_wall(x, y, door, options.width))
    where = {"start_y": rng.uniform(1.2, 5.8), "goal_y": rng.uniform(1.2, 5.8), "heading": rng.uniform(-math.pi, math.pi)}
    (folder / f"{name}.toml").write_text(SCENARIO.format(name=name, seed=seed, **where))
    return folder / f"{name}.toml", door


def run(job):
    options, seed = job
    scenario, door = write(seed, options)
    out = options.out / f"run_{seed}"
    done = subprocess.run([PROGRAM, "sim", scenario, "--out", out], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return seed, door, None, done.stderr.strip().rpartition("\n")[2] or f"exit {done.returncode}"
    return seed, door, json.loads((out / "summary.json").read_text()), ""


def main():
    options = arguments()
    require_built(PROGRAM)
    options.out.mkdir(parents=True, exist_ok=True)
    passed = doors = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for seed, door, summary, refused in pool.map(run, [(options, seed) for seed in options.seeds]):
            place = f"{seed}: {math.degrees(door['angle']):6.1f} degrees, wall {door['thickness']:.2f} m: "
            if summary is None:  # a goal in the slanting wall, say
                print(f"{place}not counted: {refused}")
                continue
            doors += 1
            passed += summary["success"]
            print(f"{place}{summary['outcome']} after {summary['duration_s']:.0f} s, {summary['min_clearance_m']:.3f} m clear")
    print(f"{passed} of {doors} doors of {options.width} m passed")
    return 0 if doors else 1


if __name__ == "__main__":
    sys.exit(main())
