#!/usr/bin/env python3
"""How movers of 1 m are tracked that go at up to 1.9 m/s and through one another: the DynaBARN figures in docs/tracking.md.

Every world of a folder (`worlds.txt`, a line `index movers radius : names`, and `trajectories/NAME.txt`, lines `t x y` in s and m),
in a bare hall. Movers go there and back on their ways, since those of a loop would be elsewhere at once.

    bench/tracking/dynabarn.py ../shared/data/dynabarn
"""
import collections
import csv
import pathlib

from drives import FIGURES, HALL, LASER, all_of, drive, figures_of, means, parser, print_head

from command_line import reading  # drives puts its folder on the path

SCENARIO = """name = "dynabarn"
timeout_s = 120.0
[map]
aria = "hall.map"
[robot]
start = [23.0, 12.0, 3.1416]
goal = [3.0, 12.0]
model = "p3dx"
max_speed_mps = 0.6
"""
MOVERS = """[[movers]]
kind = "recorded"
file = "movers.csv"
offset = [12.0, 12.0]
radius_m = {radius}
"""
STEP_S, LASTS_S = 0.2, 120.0


def arguments():
    made = parser(__doc__, "dynabarn", None)
    made.add_argument("folder", type=pathlib.Path)
    return made.parse_args()


def lines_of(path):
    with reading(path, "DynaBARN's folder"):
        return [line for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]


def way_of(path):
    """Places at times: t, x, y."""
    with reading(path, "DynaBARN's folder"):
        return [tuple(map(float, line.split())) for line in lines_of(path)]


def place(way, t):
    """On the way there, and then back."""
    lasts = way[-1][0]
    t = lasts - abs(t % (2 * lasts) - lasts)
    (t0, *a), (t1, *b) = next(pair for pair in zip(way, way[1:]) if pair[1][0] >= t)
    return [p + (q - p) * (t - t0) / (t1 - t0) for p, q in zip(a, b)]


def write_movers(path, ways):
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(("t_s", "id", "x_m", "y_m"))
        for k in range(round(LASTS_S / STEP_S) + 1):
            for mover, way in enumerate(ways):
                table.writerow((f"{k * STEP_S:.1f}", mover, *(f"{v:.4f}" for v in place(way, k * STEP_S))))


def run(job):
    options, world = job
    with reading(options.folder, "DynaBARN's folder"):
        head, names = world.split(":")
        index, _, radius = head.split()
        ways = [way_of(options.folder / "trajectories" / f"{name}.txt") for name in names.split()]
    out = options.out / index
    out.mkdir(parents=True, exist_ok=True)
    (out / "hall.map").write_text(HALL)
    write_movers(out / "movers.csv", ways)
    outcome = drive(out, SCENARIO + LASER + MOVERS.format(radius=float(radius)))["outcome"]
    return outcome, figures_of(out, float(radius))


def main():
    options = arguments()
    results = all_of(run, [(options, world) for world in lines_of(options.folder / "worlds.txt")], options.jobs)
    outcomes = collections.Counter(outcome for outcome, _ in results)
    print_head("worlds", *FIGURES, "drives")
    print(f"| {len(results)} | {means([figures for _, figures in results])} | {', '.join(f'{n} {what}' for what, n in outcomes.most_common())} |")


if __name__ == "__main__":
    main()
