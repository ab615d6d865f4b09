#!/usr/bin/env python3
"""How a passenger is driven: figures over every run below the given folders (each with summary.json and robot.csv).

    bench/success_table.py --movers 16 --seeds 101-110 --out out/success && bench/ride_figures.py out/success
"""
import argparse
import csv
import json
import pathlib
import statistics

from command_line import refuse

LEAST_TURN_RADPS, LEAST_SPEED_MPS = 0.1, 0.03  # slower than this it turns, or drives, neither way


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    return parser.parse_args()


def reversals(values, least):
    """How often a value larger than `least` is followed, at last, by one of the other sign."""
    signs = [value > 0 for value in values if abs(value) > least]
    return sum(before != after for before, after in zip(signs, signs[1:]))


def ride(folder):
    summary = json.loads((folder / "summary.json").read_text())
    with (folder / "robot.csv").open() as table:
        rows = [(float(row["v_mps"]), float(row["w_radps"])) for row in csv.DictReader(table)]
    minutes = summary["duration_s"] / 60.0
    return {
        "length over shortest": summary["path_length_m"] / summary["static_shortest_path_m"],
        "duration, s": summary["duration_s"],
        "steering reversals a minute": reversals([w for _, w in rows], LEAST_TURN_RADPS) / minutes,
        "speed reversals a minute": reversals([v for v, _ in rows], LEAST_SPEED_MPS) / minutes,
        "share of time below 0.1 m/s, %": 100.0 * sum(abs(v) < 0.1 for v, _ in rows) / len(rows),
        "largest acceleration, m/s2": summary["accel_max_mps2"],
        "jerk p99, m/s3": summary["jerk_p99_mps3"],
        "largest jerk, m/s3": summary["jerk_max_mps3"],
    }


def main():
    options = arguments()
    folders = sorted(file.parent for root in options.folders for file in root.rglob("summary.json"))
    rides = [ride(folder) for folder in folders if (folder / "robot.csv").exists()]
    if not rides:
        refuse(f"{options.folders[0]}: no run below it", "give a folder that bench/success_table.py has written")
    print(f"{len(rides)} runs\n\n| figure | median | p95 | largest |\n|---|---|---|---|")
    for name in rides[0]:
        values = sorted(r[name] for r in rides)
        p95 = values[min(len(values) - 1, int(0.95 * len(values)))]
        print(f"| {name} | {statistics.median(values):.2f} | {p95:.2f} | {values[-1]:.2f} |")


if __name__ == "__main__":
    main()
