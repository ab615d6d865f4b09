#!/usr/bin/env python3
"""Tracking and poses where a laser does not reach the walls: the open hall's table in docs/tracking.md.

Sixteen movers of 0.8 m/s, discs or people on two legs, in an empty hall of 24 m by 24 m. The robot drives across it, or
creeps in its middle, where a laser of 10 m sees nobody but them. Means over the seeds.

    bench/tracking/open_hall.py --seeds 301-306
"""
import argparse
import concurrent.futures
import pathlib
import re

from real_ways import HALL
from varied_runs import FIGURES, LASER, PROGRAM, call, figures_of, means, off_the_truth

SCENARIO = """name = "open_hall"
timeout_s = {timeout_s}
[map]
aria = "hall.map"
[robot]
start = {start}
goal = {goal}
model = "p3dx"
max_speed_mps = {speed}
{laser}
[[movers]]
kind = "wander"
count = 16
speed_mps = 0.8
radius_m = 0.27
legs = {legs}
"""
ACROSS = {"start": [2.0, 2.0, 0.785], "goal": [21.0, 21.0], "speed": 0.3, "timeout_s": 120.0}
IN_THE_MIDDLE = {"start": [11.0, 11.0, 0.785], "goal": [14.0, 14.0], "speed": 0.05, "timeout_s": 60.0}
PLACES = (("across, reach 25 m", ACROSS, 25.0), ("across, 10 m", ACROSS, 10.0), ("in the middle, 10 m", IN_THE_MIDDLE, 10.0))
VARIANTS = [(place, legs) for place in PLACES for legs in (False, True)]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="301-306", help="one, or first-last")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/open_hall"))
    return parser.parse_args()


def run(job):
    options, ((name, drive, reach_m), legs), seed = job
    out = options.out / f"{name}, {legs}, {seed}".replace(", ", "_").replace(" ", "_")
    out.mkdir(parents=True, exist_ok=True)
    (out / "hall.map").write_text(HALL)
    laser = re.sub(r"range_m = .*", f"range_m = {reach_m}", LASER)
    (out / "scenario.toml").write_text(SCENARIO.format(**drive, laser=laser, legs=str(legs).lower()))
    call(PROGRAM, "sim", out / "scenario.toml", "--seed", seed, "--out", out, fine=(0, 1))
    return figures_of(out, 0.27), off_the_truth(out)


def row(variant, runs):
    (name, _, _), legs = variant
    off = [r[1] for r in runs]
    return f"| {name}, {'two legs' if legs else 'discs'} | {means([r[0] for r in runs])} | {sum(off) / len(off):.2f}, {max(off):.2f} m |"


def main():
    options = arguments()
    first, _, last = options.seeds.partition("-")
    seeds = range(int(first), int(last or first) + 1)
    jobs = [(options, variant, seed) for variant in VARIANTS for seed in seeds]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(run, jobs))
    columns = ("drive", *FIGURES, "pose off at worst, mean and greatest")
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    for k, variant in enumerate(VARIANTS):
        print(row(variant, results[k * len(seeds) : (k + 1) * len(seeds)]))


if __name__ == "__main__":
    main()
