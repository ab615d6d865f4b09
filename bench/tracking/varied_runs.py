#!/usr/bin/env python3
"""Tracking and localisation with other laser scanners, and of other movers: the tables in docs/tracking.md.

The project's four maps with 16 movers, driven with each scanner, or each kind of movers, below in place of theirs;
means of the four runs.

    bench/tracking/varied_runs.py scanners --seed 302
    bench/tracking/varied_runs.py movers --seed 302
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM, BENCH = ROOT / "build/firmware/jaywalk", ROOT / "build/bench/tracking/jaywalk_track_bench"
MAPS = (1, 2, 3, 4)
LASER = """[robot.laser]
fov_deg = 270.0
beams = 811
rate_hz = 15.0
range_m = 25.0
noise_m = 0.01
"""  # the project's own maps', for scenarios that are made
KEYS = {
    "scanners": ("robot.laser", ("fov_deg", "beams", "rate_hz", "range_m", "noise_m", "drop_out", "mount")),
    "movers": ("[movers]", ("speed_mps", "radius_m", "count", "legs")),
}
VARIANTS = {
    "scanners": (
        (360, 1440, 10, 30, 0.01, 0.0),
        (360, 1440, 10, 30, 0.01, 0.0, "[0.0, 0.0, 3.1416]"),
        (270, 1081, 40, 30, 0.01, 0.0),
        (180, 361, 25, 30, 0.01, 0.0),
        (360, 400, 8, 12, 0.02, 0.02),
        (240, 683, 10, 5.6, 0.02, 0.0),
    ),
    "movers": (
        (0.2, 0.27, 16),
        (0.8, 0.27, 16),
        (1.2, 0.25, 16),
        (1.6, 0.25, 16),
        (0.6, 0.15, 16),
        (0.5, 0.40, 16),
        (0.4, 0.27, 30),
        (0.4, 0.27, 16, "true"),
        (0.8, 0.27, 16, "true"),
        (1.2, 0.27, 16, "true"),
    ),
}
FIGURES = {
    "MOTA": "MOTA",
    "false places": "false positives",
    "identity switches": "identity switches",
    "known within 0.6 s": "found within 0.6 s of moving in view",
    "velocity RMSE": "velocity RMSE of tracks older than 1 s",
    "innovations": "normalised and squared, mean; 2 is right",
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=VARIANTS)
    parser.add_argument("--seed", type=int, default=302)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/varied"))
    return parser.parse_args()


def with_values(text, section, values):
    """The scenario with other values in a section."""
    head, lines = re.search(rf"(\[{re.escape(section)}\]\n)((?:[a-z_]+ = .*\n)*)", text).groups()
    kept = dict(re.findall(r"([a-z_]+) = (.*)\n", lines)) | {key: str(value) for key, value in values.items()}
    return text.replace(head + lines, head + "".join(f"{key} = {value}\n" for key, value in kept.items()))


def write_scenario(folder, number, section, values):
    own = ROOT / f"hal/sim/scenarios/map{number}_16.toml"
    text = with_values(own.read_text(), section, values)
    text = re.sub(r'yaml = "(.*)"', lambda m: f'yaml = "{(own.parent / m[1]).resolve()}"', text)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.toml").write_text(text)


def call(*command, fine=(0,)):
    if not command[0].exists():
        sys.exit(f"{command[0]}: not there: build the project first (README.md)")
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode not in fine:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def figures_of(out, radius_m):
    table = call(BENCH, out, "--radius", radius_m)
    return [float(re.search(rf"\| {re.escape(f)} +\| +([-\d.]+|nan)", table)[1]) for f in FIGURES.values()]


def means(figures):
    """Columns of FIGURES: the means over runs."""
    mota, false, switched, soon, rmse, innovations = (sum(column) / len(figures) for column in zip(*figures))
    return f"{mota:.1f} % | {false:.1f} | {switched:.1f} | {soon:.0f} % | {rmse:.2f} m/s | {innovations:.2f}"


def run(job):
    options, variant, number = job
    section, keys = KEYS[options.what]
    values = dict(zip(keys, variant))
    out = options.out / "_".join(map(str, variant)) / f"map{number}"
    write_scenario(out, number, section, values)
    call(PROGRAM, "sim", out / "scenario.toml", "--seed", options.seed, "--out", out, fine=(0, 1))
    return variant, figures_of(out, values.get("radius_m", 0.27)), json.loads((out / "summary.json").read_text())["outcome"], off_the_truth(out)


def off_the_truth(out):
    """How far the pose was wrong at worst, m."""
    rows = (line.split(",") for line in (out / "robot.csv").read_text().splitlines()[1:])
    return max(math.hypot(float(r[1]) - float(r[6]), float(r[2]) - float(r[7])) for r in rows)


def name(what, variant):
    if what == "movers":
        speed, radius, count, *legs = variant
        return f"{count} {'people on two legs' if legs else 'movers'} of {speed} m/s, {radius:.2f} m about their middle"
    fov, beams, rate, reach, noise, lost, *mount = variant
    turned = ", its turn begins straight ahead" if mount else ""
    dropped = f", {100 * lost:.0f} % lost" if lost else ""
    return f"{fov} degrees, {beams} beams, {rate} Hz, {reach} m, noise {1000 * noise:.0f} mm{dropped}{turned}"


def row(what, variant, runs):
    reached = sum(r[2] in ("reached", "forced_mover") for r in runs)
    return f"| {name(what, variant)} | {means([r[1] for r in runs])} | {max(r[3] for r in runs):.2f} m | {reached} of {len(runs)} |"


def main():
    options = arguments()
    jobs = [(options, v, m) for v in VARIANTS[options.what] for m in MAPS]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(run, jobs))
    columns = (options.what, *FIGURES, "pose off at worst", "goal reached")
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    for variant in VARIANTS[options.what]:
        print(row(options.what, variant, [r for r in results if r[0] == variant]))


if __name__ == "__main__":
    main()
