#!/usr/bin/env python3
"""Drives through corridors of posts: the BARN figures in docs/tracking.md and docs/results.md.

Through every world of a folder (files of cylinders, lines `x y radius` in m). Where nobody is it counts tracks that move.

    bench/tracking/posts.py ../shared/data/barn --seeds 302-305
    bench/tracking/posts.py ../shared/data/barn --movers 4 --seeds 302-303
"""
import collections
import pathlib
import re
import sys

from drives import BENCH, LASER, all_of, call, drive, off_the_truth, parser

SCENARIO = """name = "posts"
timeout_s = 120.0
[map]
cylinders = "{world}"
[robot]
start = [-2.25, 3.0, 1.5708]
goal = [-2.25, 13.0]
model = "p3dx"
max_speed_mps = 0.6
"""
MOVERS = """[[movers]]
kind = "wander"
count = {count}
speed_mps = 0.4
radius_m = 0.27
"""


def arguments():
    made = parser(__doc__, "posts", "302-305")
    made.add_argument("worlds", type=pathlib.Path)
    made.add_argument("--movers", type=int, default=0)
    return made.parse_args()


def run(job):
    """Summary, moving tracks a minute where nobody is, m off at worst."""
    options, world, seed = job
    out = options.out / f"{world.stem}_{options.movers}_{seed}"
    movers = MOVERS.format(count=options.movers) if options.movers else ""
    summary = drive(out, SCENARIO.format(world=world.resolve()) + LASER + movers, seed)
    return summary, 0.0 if options.movers else moving_tracks_a_minute(out), off_the_truth(out)


def moving_tracks_a_minute(out):
    return float(re.search(r"\| false moving tracks a minute +\| +([-\d.]+)", call(BENCH, out, "--nobody"))[1])


def main():
    options = arguments()
    worlds = sorted(options.worlds.glob("world_*.txt"))
    if not worlds:
        sys.exit(f"{options.worlds}: no world_*.txt in it: give the folder of BARN's worlds")
    results = all_of(run, [(options, world, seed) for world in worlds for seed in options.seeds], options.jobs)
    minutes = sum(r[0]["duration_s"] for r in results) / 60
    outcomes = collections.Counter(r[0]["outcome"] for r in results)
    off = sorted(r[2] for r in results)
    print(f"{len(results)} drives, {minutes:.1f} minutes: {', '.join(f'{n} {what}' for what, n in outcomes.most_common())}")
    print(f"poses off at worst by {off[len(off) // 2]:.2f} m (median), {off[-1]:.2f} m (greatest)")
    if options.movers == 0:
        tracks = sum(r[0]["duration_s"] / 60 * r[1] for r in results)
        print(f"something moves in {sum(r[1] > 0 for r in results)} drives: {tracks / minutes:.2f} tracks a minute")


if __name__ == "__main__":
    main()
