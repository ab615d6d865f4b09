#!/usr/bin/env python3
"""What moves among posts where nobody is: the BARN figures in docs/tracking.md.

Drives through every world of a folder (files of cylinders, lines `x y radius` in m) and counts tracks that move.

    bench/tracking/posts.py ../shared/data/barn
"""
import argparse
import concurrent.futures
import json
import pathlib
import re

from varied_runs import BENCH, PROGRAM, call, off_the_truth

SCENARIO = """name = "posts"
timeout_s = 120.0
[map]
cylinders = "{world}"
[robot]
start = [-2.25, 3.0, 1.5708]
goal = [-2.25, 13.0]
model = "p3dx"
max_speed_mps = 0.6
[robot.laser]
fov_deg = 270.0
beams = 811
rate_hz = 15.0
range_m = 25.0
noise_m = 0.01
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/posts"))
    return parser.parse_args()


def run(job):
    """Outcome, seconds, moving tracks a minute, m off at worst."""
    options, world = job
    out = options.out / world.stem
    out.mkdir(parents=True, exist_ok=True)
    (out / "scenario.toml").write_text(SCENARIO.format(world=world.resolve()))
    call(PROGRAM, "sim", out / "scenario.toml", "--seed", 1, "--out", out, fine=(0, 1))
    table = call(BENCH, out, "--nobody")
    summary = json.loads((out / "summary.json").read_text())
    moving = float(re.search(r"\| false moving tracks a minute +\| +([-\d.]+)", table)[1])
    return summary["outcome"], summary["duration_s"], moving, off_the_truth(out)


def main():
    options = arguments()
    worlds = sorted(options.worlds.glob("world_*.txt"))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(run, [(options, world) for world in worlds]))
    minutes = sum(r[1] for r in results) / 60
    tracks = sum(r[1] / 60 * r[2] for r in results)
    off = sorted(r[3] for r in results)
    print(f"{sum(r[0] == 'reached' for r in results)} of {len(results)} goals reached in {minutes:.1f} minutes")
    print(f"something moves in {sum(r[2] > 0 for r in results)} worlds: {tracks / minutes:.2f} tracks a minute")
    print(f"poses off at worst by {off[len(off) // 2]:.2f} m (median), {off[-1]:.2f} m (greatest)")


if __name__ == "__main__":
    main()
