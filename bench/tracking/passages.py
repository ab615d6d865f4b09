#!/usr/bin/env python3
"""Drives past somebody who came and stands in a passage: a table in docs/tracking.md.

Two rooms and a passage between them, 1.3 to 2.4 m wide. Somebody on two legs comes at 0.8 m/s from either room, or is there from the
start, stands in it 0.3 or 0.5 m from one side, and stays. The robot has to get past him, or to wait where there is no room.

    bench/tracking/passages.py --seeds 302-303
    bench/tracking/passages.py --seeds 302-303 --from-the-start
"""
import csv
import math
import random

from drives import all_of, drive, parser, print_head

MODELS = ("p3dx", "wheelchair")
WIDTHS = (1.3, 1.5, 1.8, 2.4)  # m
ASIDE = (0.3, 0.5)  # m, of his middle from the passage's side
DRIVES = 4  # of each kind
MAP = """2D-Map
LineMinPos: 0 0
LineMaxPos: 12000 6000
NumLines: 6
LINES
0 0 12000 0
12000 0 12000 6000
12000 6000 0 6000
0 6000 0 0
6000 0 6000 {low:.0f}
6000 {high:.0f} 6000 6000
"""
SCENARIO = """name = "passage"
timeout_s = 60.0
[map]
aria = "passage.map"
[robot]
start = [1.5, 3.0, 0.0]
goal = [10.5, 3.0]
model = "{model}"
[[movers]]
kind = "recorded"
file = "walk.csv"
radius_m = 0.27
legs = true
"""
WALK = """t_s,id,x_m,y_m
0.0,1,{from_x:.3f},{from_y:.3f}
3.0,1,6.0,{y:.3f}
900.0,1,6.0,{y:.3f}
"""


def arguments():
    made = parser(__doc__, "passages", "302-303")
    made.add_argument("--from-the-start", action="store_true", help="he stands there before the robot looks")
    made.add_argument("--model", choices=MODELS, help="this one alone")
    return made.parse_args()


def ways(seed):
    """Where he stands, from one side of the passage, and which way he came (rad)."""
    chance = random.Random(seed)
    for k in range(DRIVES):
        for aside in ASIDE:
            yield aside, math.pi * (k % 2) + math.radians(chance.uniform(-40, 40))


def run(job):
    options, model, width, seed, (aside, heading) = job
    out = options.out / f"{model}_{width}_{seed}_{aside}_{heading:.3f}{'_there' * options.from_the_start}"
    out.mkdir(parents=True, exist_ok=True)
    low, y = 3.0 - width / 2, 3.0 - width / 2 + aside
    (out / "passage.map").write_text(MAP.format(low=1000 * low, high=1000 * (low + width)))
    comes_m = 0.01 if options.from_the_start else 2.4  # he faces where he goes
    x_m, y_m = comes_m * math.cos(heading), comes_m * math.sin(heading)
    (out / "walk.csv").write_text(WALK.format(from_x=6.0 - x_m, from_y=y - y_m, y=y))
    return drive(out, SCENARIO.format(model=model), seed) | {"speed_beside_mps": speed_beside(out, 6.0, y)}


def speed_beside(out, x_m, y_m):
    """Of the robot where it is nearest to the place."""
    with (out / "robot.csv").open() as file:
        nearest = min(csv.DictReader(file), key=lambda a: math.hypot(float(a["x_m"]) - x_m, float(a["y_m"]) - y_m))
    return abs(float(nearest["v_mps"]))


def row(model, width, runs):
    touched = sum(r["contacts"] > 0 for r in runs)
    past = [r for r in runs if not r["contacts"] and r["outcome"] != "timeout"]
    waited = sum(not r["contacts"] and r["outcome"] == "timeout" for r in runs)
    nearest = f"{min(r['min_mover_clearance_m'] for r in past):.2f} m" if past else "-"
    speed = f"{max(r['speed_beside_mps'] for r in past):.2f} m/s" if past else "-"
    print(f"| {model}, {width} m | {len(past)} | {waited} | {touched} | {nearest} | {speed} |")


def main():
    options = arguments()
    kinds = [(model, width) for model in MODELS if options.model in (None, model) for width in WIDTHS]
    jobs = [(options, *kind, seed + k, way) for kind in kinds for seed in options.seeds for k, way in enumerate(ways(seed))]
    results = all_of(run, jobs, options.jobs)
    print_head("robot, passage", "got past", "waited", "touched him", "nearest, of those that got past", "their speed there, at most")
    for kind in kinds:
        row(*kind, [r for job, r in zip(jobs, results) if job[1:3] == kind])


if __name__ == "__main__":
    main()
