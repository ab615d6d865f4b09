#!/usr/bin/env python3
"""How people are tracked who walk as people once did: a table in docs/tracking.md.

Ways that were recorded by hand (a folder of files of `t_s,id,x_m,y_m`, 20 m by 20 m at most) are walked in a bare hall, by
discs and by people on two legs, past a robot that creeps along a wall. Whose recording begins or ends is there or gone at once.

    bench/tracking/real_ways.py ../shared/data/people
"""
import csv
import pathlib
import re
import sys

from drives import BENCH, HALL, LASER, all_of, call, drive, parser, print_head

SCENARIO = """name = "real_ways"
timeout_s = 200.0
[map]
aria = "hall.map"
[robot]
start = [2.0, 1.5, 0.0]
goal = [22.5, 1.5]
model = "p3dx"
max_speed_mps = 0.1
"""
WALKERS = """[[movers]]
kind = "recorded"
file = "{ways}"
offset = [{x:.2f}, {y:.2f}]
legs = {legs}
"""
COLUMNS = {  # row of the scores, in the first table or the second, how it is written
    "in view": ("targets in view, all frames", 0, "{:.0f}"),
    "MOTA": ("MOTA", 0, "{:.1f} %"),
    "found by any track": ("recall", 1, "{:.1f} %"),
    "false places": ("false positives", 0, "{:.0f}"),
    "identity switches": ("identity switches", 0, "{:.0f}"),
    "known within 0.6 s": ("found within 0.6 s of moving in view", 0, "{:.0f} %"),
    "velocity RMSE": ("velocity RMSE of tracks older than 1 s", 0, "{:.2f} m/s"),
}
MIDDLE = (12.0, 13.5)  # m, of their ways in the hall


def arguments():
    made = parser(__doc__, "real_ways", None)
    made.add_argument("folder", type=pathlib.Path)
    return made.parse_args()


def middle(ways):
    with ways.open() as file:
        rows = [(float(row["x_m"]), float(row["y_m"])) for row in csv.DictReader(file)]
    return [(min(values) + max(values)) / 2 for values in zip(*rows)]


def run(job):
    options, ways, legs = job
    out = options.out / f"{ways.stem}{'_legs' * legs}"
    out.mkdir(parents=True, exist_ok=True)
    (out / "hall.map").write_text(HALL)
    x, y = (wanted - there for wanted, there in zip(MIDDLE, middle(ways)))
    walkers = WALKERS.format(ways=ways.resolve(), x=x, y=y, legs=str(legs).lower())
    drive(out, SCENARIO + LASER + walkers)
    table = call(BENCH, out, "--radius", 0.25)
    return [float(re.findall(rf"\| {re.escape(row)} +\| +([-\d.]+|nan)", table)[which]) for row, which, _ in COLUMNS.values()]


def main():
    options = arguments()
    files = sorted(options.folder.glob("*.csv"))
    if not files:
        sys.exit(f"{options.folder}: no .csv in it: give a folder of recorded ways")
    jobs = [(options, ways, legs) for ways in files for legs in (False, True)]
    results = all_of(run, jobs, options.jobs)
    print_head("ways", *COLUMNS)
    for (_, ways, legs), figures in zip(jobs, results):
        cells = [written.format(figure) for (_, _, written), figure in zip(COLUMNS.values(), figures)]
        print(f"| {ways.stem}, {'two legs' if legs else 'discs'} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
