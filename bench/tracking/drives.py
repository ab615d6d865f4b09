"""What the tables of simulated drives share: the programs, a laser, a hall, and how a drive is scored."""
import argparse
import concurrent.futures
import json
import math
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.append(str(ROOT / "bench"))
from command_line import seeds_of

PROGRAM, BENCH = ROOT / "build/jaywalk", ROOT / "build/bench/tracking/jaywalk_track_bench"
LASER = """[robot.laser]
fov_deg = 270.0
beams = 811
rate_hz = 15.0
range_m = 25.0
noise_m = 0.01
"""  # the project's own maps'
HALL = """2D-Map
LineMinPos: 0 0
LineMaxPos: 24000 24000
NumLines: 4
LINES
0 0 24000 0
24000 0 24000 24000
24000 24000 0 24000
0 24000 0 0
"""  # bare, mm
FIGURES = {
    "MOTA": "MOTA",
    "false places": "false positives",
    "identity switches": "identity switches",
    "known within 0.6 s": "found within 0.6 s of moving in view",
    "velocity RMSE": "velocity RMSE of tracks older than 1 s",
    "innovations": "normalised and squared, mean; 2 is right",
}  # column of a table: row of the scores


def parser(doc, out, seeds):
    """The options that all have; `seeds`: by default, or None where there is no choice."""
    made = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    if seeds:
        made.add_argument("--seeds", type=seeds_of, default=seeds, help="one, or first-last")
    made.add_argument("--jobs", type=int, default=2)
    made.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out") / out)
    return made


def all_of(run, jobs, at_once):
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(run, jobs))


def call(*command, fine=(0,)):
    if not command[0].exists():
        sys.exit(f"{command[0]}: not there: build the project first (README.md)")
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode not in fine:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def drive(out, scenario, seed=1):
    """Drives it in the folder `out`: its summary."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "scenario.toml").write_text(scenario)
    call(PROGRAM, "sim", out / "scenario.toml", "--seed", seed, "--out", out, fine=(0, 1))
    return json.loads((out / "summary.json").read_text())


def figures_of(out, radius_m):
    table = call(BENCH, out, "--radius", radius_m)
    return [float(re.search(rf"\| {re.escape(f)} +\| +([-\d.]+|nan)", table)[1]) for f in FIGURES.values()]


def means(figures):
    """Columns of FIGURES: the means over runs."""
    mota, false, switched, soon, rmse, innovations = (sum(column) / len(figures) for column in zip(*figures))
    return f"{mota:.1f} % | {false:.1f} | {switched:.1f} | {soon:.0f} % | {rmse:.2f} m/s | {innovations:.2f}"


def off_the_truth(out):
    """How far the pose was wrong at worst, m."""
    rows = (line.split(",") for line in (out / "robot.csv").read_text().splitlines()[1:])
    return max(math.hypot(float(r[1]) - float(r[6]), float(r[2]) - float(r[7])) for r in rows)


def print_head(*columns):
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
