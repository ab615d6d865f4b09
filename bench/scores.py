#!/usr/bin/env python3
"""What jaywalk report does not know of a campaign's runs: a row for each of its rows.

    bench/scores.py out/movers                            tracks and poses against the truth, means; wants keep = "all"
    bench/scores.py out/posts --nobody                    where nobody is: every track that moves is false
    bench/scores.py out/barn --barn ../shared/data/barn   the benchmark's own score
    bench/scores.py out/encounters --encounters           by robot and top speed

BARN's score is success x OT / clip(T, 2 OT, 8 OT), with OT the benchmark's planned path at 2 m/s; 0.5 is perfect.
"""
import argparse
import csv
import json
import math
import pathlib
import re

from command_line import all_of, reading, refuse, said_by

ROOT = pathlib.Path(__file__).resolve().parent.parent
TRACK_BENCH = ROOT / "build/bench/tracking/jaywalk_track_bench"
FIGURES = {  # column: row of the first table of jaywalk_track_bench that has it, how it is written
    "in view": ("targets in view, all frames", "{:.0f}"),
    "MOTA": ("MOTA", "{:.1f} %"),
    "false places": ("false positives", "{:.1f}"),
    "identity switches": ("identity switches", "{:.1f}"),
    "known within 0.6 s": ("found within 0.6 s of moving in view", "{:.0f} %"),
    "velocity RMSE": ("velocity RMSE of tracks older than 1 s", "{:.2f} m/s"),
    "innovations": ("normalised and squared, mean; 2 is right", "{:.2f}"),
}
NOBODY = {"moving tracks a minute": ("false moving tracks a minute", "{:.2f}")}
BARN_MPS = 2.0


def off_the_truth_m(run):
    """How far the pose was wrong at worst."""
    with (run / "robot.csv").open() as file:
        return max(math.hypot(float(r["x_m"]) - float(r["est_x_m"]), float(r["y_m"]) - float(r["est_y_m"])) for r in csv.DictReader(file))


def track_figures(run, command, options):
    varied = re.search(r"movers\.radius_m=([\d.]+)", command)
    rule = ["--nobody"] if options.nobody else ["--radius", varied[1] if varied else options.radius]
    said = said_by(options.track_bench, run, *rule)
    found = (re.search(rf"\| {re.escape(row)} +\| +([-\d.]+)", said) for row, _ in options.figures.values())
    return [float(figure[1]) if figure else math.nan for figure in found] + [off_the_truth_m(run)]


def mean(values):
    """Of those that are known: a run in which nothing was in view has no MOTA."""
    known = [value for value in values if not math.isnan(value)]
    return sum(known) / len(known) if known else math.nan


def track_cells(results, options):
    *figures, off = zip(*results)
    means = [written.format(mean(column)) for column, (_, written) in zip(figures, options.figures.values())]
    return means + [f"{sum(off) / len(off):.2f}, {max(off):.2f} m"]


def barn_score(reached, took_s, path_m):
    best_s = path_m / BARN_MPS
    return reached * best_s / min(max(took_s, 2 * best_s), 8 * best_s)


def barn_cells(runs, folder):
    """A world counts as reached where nothing was touched."""
    with reading(folder / "path_lengths.csv", "BARN's folder"), (folder / "path_lengths.csv").open() as table:
        paths = {row["world"]: float(row["path_m"]) for row in csv.DictReader(table)}
    scores = []
    for run, planned in runs:
        result = json.loads((run / "run.json").read_text())
        reached = result["outcome"] == "reached" and result["figures"]["contacts"] == 0
        scores.append(barn_score(reached, result["figures"]["duration_s"], paths[planned["scenario"].removeprefix("world_")]))
    return [str(sum(s > 0 for s in scores)), str(sum(s >= 0.5 for s in scores)), f"{sum(scores) / len(scores):.3f}"]


def at_share(values, share):
    """The smallest value that at least that share of all do not exceed."""
    return sorted(values)[max(math.ceil(share * len(values)) - 1, 0)]


ENCOUNTERS = ["strict", "touched while driving", "run into at rest", "with a loop", "way over shortest: median, 95 %", "lost, s", "hard brakes a minute"]


def encounter_cells(runs):
    """Ways and times of the runs that arrived; a scenario's name ends with the top speed in dm/s (bench/world_kinds/encounters.py)."""
    results = [(json.loads((run / "run.json").read_text()), int(planned["scenario"].rsplit("_", 1)[1]) / 10) for run, planned in runs]
    figures = [result["figures"] for result, _ in results]
    arrived = [(result["figures"], mps) for result, mps in results if result["outcome"] in ("reached", "forced_mover")]
    ways = [f["path_length_m"] / f["static_shortest_path_m"] for f, _ in arrived]
    lost = [f["duration_s"] - f["static_shortest_path_m"] / mps for f, mps in arrived]
    driving = sum(f["contacts_caused"] > 0 for f in figures)
    minutes = sum(f["duration_s"] for f in figures) / 60
    counts = [sum(r["outcome"] == "reached" for r, _ in results), driving, sum(f["contacts"] > 0 for f in figures) - driving, sum(f["loops"] > 0 for f in figures)]
    brakes = sum(f["hard_brakes"] for f in figures) / minutes
    return [str(count) for count in counts] + [f"{at_share(ways, 0.5):.2f}, {at_share(ways, 0.95):.2f}", f"{at_share(lost, 0.5):.1f}", f"{brakes:.1f}"]


def by_robot_and_speed(rows):
    regrouped = {}
    for run, planned in (one for runs in rows.values() for one in runs):
        model = re.search(r"robot\.model (\w+)", planned["row"])[1]
        regrouped.setdefault(f"{model}, {int(planned['scenario'].rsplit('_', 1)[1]) / 10} m/s", []).append((run, planned))
    return regrouped


def rows_of(campaign):
    """Experiment and row: folder and plan of each run that is finished and was driven."""
    rows = {}
    with reading(campaign / "campaign.json", "the folder that jaywalk campaign wrote"):
        experiments = json.loads((campaign / "campaign.json").read_text())["experiments"]
        for experiment in experiments:
            for planned in experiment["runs"]:
                run = campaign / "runs" / planned["folder"]
                if (run / "summary.json").exists():
                    rows.setdefault(f"{experiment['title']}, {planned['row']}", []).append((run, planned))
    if not rows:
        refuse(f"{campaign}: no run in it", "run the campaign first")
    return rows


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign", type=pathlib.Path, help="its folder, --out of jaywalk campaign")
    parser.add_argument("--nobody", action="store_true", help="no movers were there")
    parser.add_argument("--radius", default="0.27", help="of movers where the campaign does not set it, m (default: 0.27)")
    parser.add_argument("--barn", type=pathlib.Path, help="folder of BARN's path_lengths.csv")
    parser.add_argument("--encounters", action="store_true", help="encounters, by robot and top speed")
    parser.add_argument("--track-bench", type=pathlib.Path, default=TRACK_BENCH, help="another build's jaywalk_track_bench")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    options.figures = NOBODY if options.nobody else FIGURES
    return options


def main():
    options = arguments()
    rows = rows_of(options.campaign)
    head = ["reached", "perfect", "score"] if options.barn else ENCOUNTERS if options.encounters else [*options.figures, "pose off at worst, mean and greatest"]
    rows = by_robot_and_speed(rows) if options.encounters else rows
    lines = [f"| | runs | {' | '.join(head)} |", f"|{'---|' * (len(head) + 2)}"]
    for name, runs in rows.items():
        if options.barn:
            cells = barn_cells(runs, options.barn)
        elif options.encounters:
            cells = encounter_cells(runs)
        else:
            figures = all_of(lambda run: track_figures(run[0], run[1]["command"], options), runs, options.jobs)
            cells = track_cells(figures, options)
        lines.append(f"| {name} | {len(runs)} | {' | '.join(cells)} |")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
