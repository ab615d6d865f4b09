#!/usr/bin/env python3
"""Tracking and localisation with other laser scanners: the table in docs/tracking.md.

The project's four maps with 16 movers, driven with each scanner below in place of theirs; means of the four runs.

    bench/tracking/other_scanners.py --seed 302 --jobs 2 --out out/scanners
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
# field of view in degrees, beams, rate in Hz, range in m, noise in m, share of beams lost
SCANNERS = (
    (360, 1440, 10, 30, 0.01, 0.0),
    (270, 1081, 40, 30, 0.01, 0.0),
    (180, 361, 25, 30, 0.01, 0.0),
    (360, 400, 8, 12, 0.02, 0.02),
    (240, 683, 10, 5.6, 0.02, 0.0),
)
FIGURES = ("MOTA", "false positives", "identity switches", "found within 0.6 s of moving in view", "normalised and squared, mean; 2 is right")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=302)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/scanners"))
    return parser.parse_args()


def write_scenario(folder, number, scanner):
    """The map's own scenario, with another laser."""
    own = ROOT / f"hal/sim/scenarios/map{number}_16.toml"
    values = zip(("fov_deg", "beams", "rate_hz", "range_m", "noise_m", "drop_out"), scanner)
    laser = "[robot.laser]\n" + "".join(f"{key} = {value}\n" for key, value in values)
    text = re.sub(r"\[robot\.laser\]\n([a-z_]+ = .*\n)*", laser, own.read_text())
    text = re.sub(r'yaml = "(.*)"', lambda m: f'yaml = "{(own.parent / m[1]).resolve()}"', text)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.toml").write_text(text)


def run(job):
    options, scanner, number = job
    out = options.out / "_".join(map(str, scanner[:3])) / f"map{number}"
    write_scenario(out, number, scanner)
    command = [PROGRAM, "sim", out / "scenario.toml", "--seed", str(options.seed), "--out", out]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}: {done.stderr.strip()}")
    table = subprocess.run([BENCH, out], capture_output=True, text=True, check=True).stdout
    figures = [float(re.search(rf"\| {re.escape(f)} +\| +([-\d.]+|nan)", table)[1]) for f in FIGURES]
    return scanner, figures, json.loads((out / "summary.json").read_text())["outcome"], off_the_truth(out)


def off_the_truth(out):
    """How far the pose was wrong at worst, m."""
    rows = (line.split(",") for line in (out / "robot.csv").read_text().splitlines()[1:])
    return max(math.hypot(float(r[1]) - float(r[6]), float(r[2]) - float(r[7])) for r in rows)


def main():
    options = arguments()
    jobs = [(options, s, m) for s in SCANNERS for m in MAPS]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(run, jobs))
    print("| scanner | MOTA | false places | identity switches | known within 0.6 s | innovations | pose off at worst | goal reached |")
    print("|---|---|---|---|---|---|---|---|")
    for scanner in SCANNERS:
        runs = [r for r in results if r[0] == scanner]
        mota, false, switched, soon, innovations = (sum(r[1][k] for r in runs) / len(runs) for k in range(len(FIGURES)))
        reached = sum(r[2] in ("reached", "forced_mover") for r in runs)
        fov, beams, rate, reach, noise, lost = scanner
        name = f"{fov} degrees, {beams} beams, {rate} Hz, {reach} m, noise {1000 * noise:.0f} mm" + (f", {100 * lost:.0f} % lost" if lost else "")
        print(f"| {name} | {mota:.1f} % | {false:.1f} | {switched:.1f} | {soon:.0f} % | {innovations:.2f} | {max(r[3] for r in runs):.2f} m | {reached} of {len(runs)} |")


if __name__ == "__main__":
    main()
