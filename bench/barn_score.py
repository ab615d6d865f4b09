#!/usr/bin/env python3
"""The BARN benchmark's own score: success x OT / clip(T, 2 OT, 8 OT), with OT the planned path at 2 m/s; 0.5 is perfect.

Every world of a folder (`world_NNN.txt` of cylinders, `path_lengths.csv`, `jackal.toml`): from (-2, 3), looking along y, to within
1 m of (-2, 13), 100 s at most. A world counts as reached when nothing was touched.

    bench/barn_score.py ../shared/data/barn --seeds 701
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import subprocess
import sys

from command_line import jobs_of, reading, refuse, require_built, seeds_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/jaywalk"
FASTEST_MPS = 2.0
SCENARIO = """name = "barn"
timeout_s = 100.0
[map]
cylinders = "{world}"
[robot]
start = [-2.0, 3.0, 1.5708]
goal = [-2.0, 13.0]
goal_tolerance_m = 1.0
model = "{model}"
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds", type=pathlib.Path)
    parser.add_argument("--every", type=jobs_of, default=1, help="only every so many worlds")
    parser.add_argument("--seeds", type=seeds_of, default="701", help="one, or first-last")
    parser.add_argument("--jobs", type=jobs_of, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/barn_score"))
    return parser.parse_args()


def score(reached, took_s, path_m):
    best_s = path_m / FASTEST_MPS
    return reached * best_s / min(max(took_s, 2 * best_s), 8 * best_s)


def run(job):
    options, world, seed = job
    out = options.out / f"{world.stem}_{seed}"
    out.mkdir(parents=True, exist_ok=True)
    model = options.worlds / "jackal.toml"
    (out / "scenario.toml").write_text(SCENARIO.format(world=world.resolve(), model=model.resolve()))
    command = [PROGRAM, "sim", out / "scenario.toml", "--seed", str(seed), "--out", out]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}: {done.stderr.strip()}")
    return json.loads((out / "summary.json").read_text())


def main():
    options = arguments()
    require_built(PROGRAM)
    with reading(options.worlds / "path_lengths.csv", "BARN's folder"), (options.worlds / "path_lengths.csv").open() as table:
        paths = {row["world"]: float(row["path_m"]) for row in csv.DictReader(table)}
    worlds = sorted(options.worlds.glob("world_*.txt"))[:: options.every]
    if not worlds:
        refuse(f"{options.worlds}: no world_*.txt in it", "give the folder of BARN's worlds")
    jobs = [(options, world, seed) for world in worlds for seed in options.seeds]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        summaries = list(pool.map(run, jobs))
    scores = []
    for (_, world, seed), summary in zip(jobs, summaries):
        reached = summary["outcome"] == "reached" and summary["contacts"] == 0
        scores.append(score(reached, summary["duration_s"], paths[world.stem.removeprefix("world_")]))
        if scores[-1] < 0.5:
            print(f"{world.stem} seed {seed}: {summary['outcome']} in {summary['duration_s']:.1f} s, score {scores[-1]:.3f}")
    reached = sum(s > 0 for s in scores)
    contacts = sum(s["contacts"] > 0 for s in summaries)
    print(f"{len(scores)} runs: {reached} reached, {contacts} touched, {sum(s >= 0.5 for s in scores)} perfect, score {sum(scores) / len(scores):.3f}")


if __name__ == "__main__":
    main()
