#!/usr/bin/env python3
"""How movers of 1 m are tracked that go at up to 1.9 m/s and through one another: the DynaBARN figures in docs/tracking.md.

Every world of a folder (`worlds.txt`, a line `index movers radius : names`, and `trajectories/NAME.txt`, lines `t x y` in s and m),
in a bare hall. Movers go there and back on their ways, since those of a loop would be elsewhere at once. `--loops`: as the benchmark
does it, each begins anew at its way's end, and the robot drives at up to 1 m/s; only how drives end is told.

    bench/tracking/dynabarn.py ../shared/data/dynabarn
    bench/tracking/dynabarn.py ../shared/data/dynabarn --loops --seeds 701
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
max_speed_mps = {speed}
"""
MOVERS = """[[movers]]
kind = "recorded"
file = "{file}"
offset = [12.0, 12.0]
radius_m = {radius}
loop = {loop}
"""
STEP_S, LASTS_S = 0.2, 120.0


def arguments():
    made = parser(__doc__, "dynabarn", "1")
    made.add_argument("folder", type=pathlib.Path)
    made.add_argument("--loops", action="store_true", help="as the benchmark has it")
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


def write_loops(out, ways):
    """A file a mover, since each has its own period."""
    for mover, way in enumerate(ways):
        rows = "".join(f"{t:.2f},{mover},{x:.4f},{y:.4f}\n" for t, x, y in way)
        (out / f"mover_{mover}.csv").write_text("t_s,id,x_m,y_m\n" + rows)


def run(job):
    options, world, seed = job
    with reading(options.folder, "DynaBARN's folder"):
        head, names = world.split(":")
        index, _, radius = head.split()
        ways = [way_of(options.folder / "trajectories" / f"{name}.txt") for name in names.split()]
    out = options.out / (f"loops_{index}_{seed}" if options.loops else f"{index}_{seed}")
    out.mkdir(parents=True, exist_ok=True)
    (out / "hall.map").write_text(HALL)
    files = [f"mover_{k}.csv" for k in range(len(ways))] if options.loops else ["movers.csv"]
    if options.loops:
        write_loops(out, ways)
    else:
        write_movers(out / "movers.csv", ways)
    loop = str(options.loops).lower()
    movers = "".join(MOVERS.format(file=file, radius=float(radius), loop=loop) for file in files)
    summary = drive(out, SCENARIO.format(speed=1.0 if options.loops else 0.6) + LASER + movers, seed)
    return summary, None if options.loops else figures_of(out, float(radius))


def main():
    options = arguments()
    worlds = lines_of(options.folder / "worlds.txt")
    results = all_of(run, [(options, world, seed) for world in worlds for seed in options.seeds], options.jobs)
    outcomes = collections.Counter(summary["outcome"] for summary, _ in results)
    drives = ", ".join(f"{n} {what}" for what, n in outcomes.most_common())
    if options.loops:
        arrived = [s for s, _ in results if s["outcome"] in ("reached", "forced_mover")]
        free = sum(s["contacts"] == 0 for s in arrived)
        caused = sum(s["contacts_caused"] > 0 for s, _ in results)
        print(f"{len(results)} drives: {drives}; {free} contact-free at the goal, {caused} touched a mover while driving")
        return
    print_head("worlds", *FIGURES, "drives")
    print(f"| {len(results)} | {means([figures for _, figures in results])} | {drives} |")


if __name__ == "__main__":
    main()
