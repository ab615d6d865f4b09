#!/usr/bin/env python3
"""Success by the strict rule on the project's four maps: the tables in docs/results.md.

A run succeeds when the goal is reached within the time limit, nothing was touched, and no mover turned because of the robot.

    bench/success_table.py --seeds 101-120 --jobs 2 --out out/success
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import re
import subprocess
import sys

from command_line import jobs_of, require_built, seeds_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/firmware/jaywalk"
OUTCOMES = ("reached", "forced_mover", "collision", "timeout", "fault")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=seeds_of, default="101-120", help="one, or first-last")
    parser.add_argument("--maps", type=int, nargs="+", default=[1, 2, 3, 4], choices=[1, 2, 3, 4])
    parser.add_argument("--movers", type=mover_count, nargs="+", default=[0, 1, 4, 16])
    parser.add_argument("--mode", default="full", choices=["full", "paper"])
    parser.add_argument("--legs", action="store_true", help="movers are people on two legs to the laser, not discs")
    parser.add_argument("--speed", type=float, help="of the movers, m/s, instead of 0.4")
    parser.add_argument("--turn-rate", type=float, help="at which movers turn, rad/s, instead of 1; the robot is not told")
    parser.add_argument("--turns-hz", type=float, help="how often movers turn unasked, a second; the robot is not told")
    parser.add_argument("--constant-speed", action="store_true", help="the robot keeps one speed from start to goal")
    parser.add_argument("--jobs", type=jobs_of, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/success"))
    return parser.parse_args()


def mover_count(text):
    """As many as the scenarios with 16 have room for, or none."""
    if not re.fullmatch(r"\d{1,2}", text) or int(text) > 64:
        raise argparse.ArgumentTypeError(f"{text}: no number of movers; give 0 to 64")
    return int(text)


def variant(options):
    """What the runs' folder is called."""
    named = {"": options.speed, "turn": options.turn_rate, "turns": options.turns_hz}
    others = "".join(f"_{name}{value}" for name, value in named.items() if value is not None)
    return options.mode + options.legs * "_legs" + options.constant_speed * "_constant" + others


def own_scenario(name):
    return ROOT / f"hal/sim/scenarios/{name}.toml"


def scenario_of(options, map_number, movers, folder):
    """The project's own, or one like it in `folder` with other movers."""
    own = own_scenario(f"map{map_number}_{movers:02d}")
    if not own.exists():
        own = own_scenario(f"map{map_number}_16")
    text = re.sub(r"\ncount = .*", f"\ncount = {movers}", own.read_text())
    if options.legs:
        text = text.replace('kind = "wander"\n', 'kind = "wander"\nlegs = true\n')
    if options.speed is not None:
        text = re.sub(r"\nspeed_mps = .*", f"\nspeed_mps = {options.speed}", text)
    for key, value in (("turn_rate_radps", options.turn_rate), ("spontaneous_turns_hz", options.turns_hz)):
        if value is not None:
            text = text.replace('kind = "wander"\n', f'kind = "wander"\n{key} = {value}\n')
    if text == own.read_text():
        return own
    folder.mkdir(parents=True, exist_ok=True)
    made = folder / "other_movers.toml"
    made.write_text(re.sub(r'yaml = "(.*)"', lambda m: f'yaml = "{(own.parent / m[1]).resolve()}"', text))
    return made


def run(job):
    options, map_number, movers, seed = job
    name = f"map{map_number}_{movers:02d}"
    out = options.out / variant(options) / name / str(seed)
    summary = out / "summary.json"
    if not summary.exists() or summary.stat().st_mtime < PROGRAM.stat().st_mtime:  # goes on where it was interrupted
        scenario = scenario_of(options, map_number, movers, out)
        command = [PROGRAM, "sim", scenario, "--seed", str(seed), "--mode", options.mode, "--out", out]
        command += ["--constant-speed"] * options.constant_speed
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}: {done.stderr.strip()}")
    return map_number, movers, json.loads(summary.read_text())


def wilson(successes, runs, z=1.96):
    """95 % interval of a share (Wilson 1927), in percent."""
    centre = (successes + z * z / 2) / (runs + z * z)
    half = z / (runs + z * z) * math.sqrt(successes * (runs - successes) / runs + z * z / 4)
    return 100 * (centre - half), 100 * (centre + half)


def row(movers, runs):
    successes = sum(r["success"] for r in runs)
    low, high = wilson(successes, len(runs))
    counts = [sum(r["outcome"] == outcome for r in runs) for outcome in OUTCOMES[1:]]
    reached = [r["path_length_m"] / r["static_shortest_path_m"] for r in runs if r["outcome"] == "reached"]
    detour = sorted(reached)[len(reached) // 2] if reached else float("nan")
    cells = [movers, f"{successes} of {len(runs)}", f"{100 * successes / len(runs):.1f} % ({low:.0f}-{high:.0f})", *counts, f"{detour:.2f}"]
    print("| " + " | ".join(map(str, cells)) + " |")


def main():
    options = arguments()
    require_built(PROGRAM)
    jobs = [(options, m, n, s) for n in options.movers for m in options.maps for s in options.seeds]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(run, jobs))
    print("| movers | success | share (95 %) | forced a mover | collision | timeout | fault | length over shortest, median |")
    print("|---|---|---|---|---|---|---|---|")
    for movers in options.movers:
        row(movers, [summary for _, n, summary in results if n == movers])
    print("\nBy map:\n\n| movers | " + " | ".join(f"map {m}" for m in options.maps) + " |\n|---|" + "---|" * len(options.maps))
    for movers in options.movers:
        cells = [[s["success"] for m, n, s in results if n == movers and m == map_number] for map_number in options.maps]
        print(f"| {movers} | " + " | ".join(f"{sum(c)} of {len(c)}" for c in cells) + " |")


if __name__ == "__main__":
    main()
