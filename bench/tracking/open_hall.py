#!/usr/bin/env python3
"""Tracking and poses where a laser does not reach the walls: the open hall's table in docs/tracking.md.

Sixteen movers of 0.8 m/s, discs or people on two legs, in an empty hall of 24 m by 24 m. The robot drives across it, or
creeps in its middle, where a laser of 10 m sees nobody but them. Means over the seeds.

    bench/tracking/open_hall.py --seeds 301-306
"""
import re

from drives import FIGURES, HALL, LASER, all_of, drive, figures_of, means, off_the_truth, parser, print_head

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


def run(job):
    options, ((name, way, reach_m), legs), seed = job
    out = options.out / f"{name}, {legs}, {seed}".replace(", ", "_").replace(" ", "_")
    out.mkdir(parents=True, exist_ok=True)
    (out / "hall.map").write_text(HALL)
    laser = re.sub(r"range_m = .*", f"range_m = {reach_m}", LASER)
    drive(out, SCENARIO.format(**way, laser=laser, legs=str(legs).lower()), seed)
    return figures_of(out, 0.27), off_the_truth(out)


def row(variant, runs):
    (name, _, _), legs = variant
    off = [r[1] for r in runs]
    return f"| {name}, {'two legs' if legs else 'discs'} | {means([r[0] for r in runs])} | {sum(off) / len(off):.2f}, {max(off):.2f} m |"


def main():
    options = parser(__doc__, "open_hall", "301-306").parse_args()
    results = all_of(run, [(options, variant, seed) for variant in VARIANTS for seed in options.seeds], options.jobs)
    print_head("drive", *FIGURES, "pose off at worst, mean and greatest")
    for k, variant in enumerate(VARIANTS):
        print(row(variant, results[k * len(options.seeds) : (k + 1) * len(options.seeds)]))


if __name__ == "__main__":
    main()
