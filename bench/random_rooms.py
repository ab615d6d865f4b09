#!/usr/bin/env python3
"""Drives through rooms that nobody has tuned them on: boxes, a wall with a door in most, one to nine people about, half of them on two
legs; p3dx or wheelchair, a laser of 180, 270 or 360 degrees. One line a drive, then what came of each robot's drives.

    bench/random_rooms.py --seeds 601-700 --out out/rooms
"""
import argparse
import collections
import concurrent.futures
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys

from command_line import jobs_of, require_built, seeds_of
from drawn_map import write_map

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/jaywalk"
CELL_M, BORDER_M, FROM_SIDE_M = 0.05, 0.1, 1.3
CLEAR_M = 1.15  # from a box to the start, the goal and the door
SCENARIO = """name = "{name}"
seed = {seed}
timeout_s = 90.0
[map]
yaml = "{name}.yaml"
[robot]
start = [{start[0]:.3f}, {start[1]:.3f}, {heading:.3f}]
goal = [{goal}]
model = "{model}"
max_speed_mps = 0.6
[robot.laser]
fov_deg = {fov}
beams = {beams}
"""
PEOPLE = """[[movers]]
kind = "wander"
count = {count}
speed_mps = {speed:.2f}
radius_m = {radius:.2f}
spontaneous_turns_hz = {turns}
legs = {legs}
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=seeds_of, default="601-700", help="one, or first-last")
    parser.add_argument("--jobs", type=jobs_of, default=2)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/rooms"))
    return parser.parse_args()


def drawn_room(rng):
    """A room whose boxes leave start, goal and door free; `wall_x` is None where it has no wall across."""
    size = rng.uniform(8, 11), rng.uniform(6, 8)
    door_width, wall_x, door_y = rng.uniform(1.1, 1.8), size[0] / 2 + rng.uniform(-1, 1), rng.uniform(1.6, size[1] - 1.6)
    boxes = [(rng.uniform(1, size[0] - 1), rng.uniform(1, size[1] - 1), rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.5)) for _ in range(rng.randint(1, 5))]
    if rng.random() >= 0.7:
        wall_x = None
    model = rng.choice(["p3dx", "wheelchair", "wheelchair"])
    start, goal = (FROM_SIDE_M, rng.uniform(FROM_SIDE_M, size[1] - FROM_SIDE_M)), (size[0] - FROM_SIDE_M, rng.uniform(FROM_SIDE_M, size[1] - FROM_SIDE_M))
    free = [start, goal] + ([] if wall_x is None else [(wall_x, door_y)])
    boxes = [box for box in boxes if all(from_box_m(box, place) >= CLEAR_M for place in free)]
    return {"size": size, "wall_x": wall_x, "door_y": door_y, "door_width": door_width, "boxes": boxes, "model": model, "start": start, "goal": goal}


def from_box_m(box, place):
    """A box is its middle and half its sides."""
    return math.hypot(max(abs(box[0] - place[0]) - box[2], 0), max(abs(box[1] - place[1]) - box[3], 0))


def is_wall(x, y, room):
    width, height = room["size"]
    if min(x, y, width - x, height - y) < BORDER_M:
        return True
    if room["wall_x"] is not None and abs(x - room["wall_x"]) < BORDER_M and abs(y - room["door_y"]) > room["door_width"] / 2:
        return True
    return any(from_box_m(box, (x, y)) == 0 for box in room["boxes"])


def drawn_people(rng):
    return "".join(
        PEOPLE.format(
            count=rng.randint(1, 3), speed=rng.uniform(0.3, 1.3), radius=rng.uniform(0.2, 0.33),
            turns=rng.choice([0, 0.05, 0.2]), legs=str(rng.random() < 0.5).lower(),
        )
        for _ in range(rng.randint(1, 3))
    )  # fmt: skip


def write(seed, folder):
    """Map and scenario of a seed; returns the scenario's path, the robot's model and the laser's degrees."""
    rng = random.Random(seed)
    name, room = f"room_{seed}", drawn_room(rng)
    write_map(folder, name, room["size"], CELL_M, lambda x, y: is_wall(x, y, room))
    fov, heading = rng.choice([180, 270, 270, 360]), rng.uniform(-math.pi, math.pi)
    goal = [*room["goal"]] + ([] if rng.random() < 0.6 else [rng.uniform(-3.1, 3.1)])
    scenario = SCENARIO.format(
        name=name, seed=seed, start=room["start"], heading=heading, goal=", ".join(f"{x:.3f}" for x in goal),
        model=room["model"], fov=fov, beams=3 * fov + (fov < 360),
    )  # fmt: skip
    (folder / f"{name}.toml").write_text(scenario + drawn_people(rng))
    return folder / f"{name}.toml", room["model"], fov


def run(job):
    """Drives a seed; only who touched something or did not arrive keeps its recording."""
    options, seed = job
    scenario, model, fov = write(seed, options.out)
    out = options.out / f"run_{seed}"
    done = subprocess.run([PROGRAM, "sim", scenario, "--out", out], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return seed, model, fov, None, done.stderr.strip().rpartition("\n")[2] or f"exit {done.returncode}"
    summary = json.loads((out / "summary.json").read_text())
    if summary["outcome"] in ("reached", "forced_mover") and not summary["contacts"]:
        shutil.rmtree(out)
    return seed, model, fov, summary, ""


def line_of(seed, model, fov, summary):
    nearest = summary["min_mover_clearance_m"]
    near = "nobody near" if nearest is None else f"nobody nearer than {nearest:.3f} m"
    touched = f"; touched {summary['contacts']} times, {summary['contacts_caused']} of them moving" if summary["contacts"] else ""
    return f"{seed}: {model}, {fov} degrees: {summary['outcome']} after {summary['duration_s']:.1f} s, {near}, made {summary['forced_movers']} turn{touched}"


def total_of(model, summaries):
    ends = collections.Counter(summary["outcome"] for summary in summaries)
    mean_s = sum(summary["duration_s"] for summary in summaries) / len(summaries)
    return (
        f"{model}: {len(summaries)} drives: " + ", ".join(f"{count} {end}" for end, count in sorted(ends.items()))
        + f"; {sum(summary['contacts'] > 0 for summary in summaries)} touched something; {mean_s:.1f} s on average; made "
        + f"{sum(summary['forced_movers'] for summary in summaries)} turn"
    )  # fmt: skip


def main():
    options = arguments()
    require_built(PROGRAM)
    options.out.mkdir(parents=True, exist_ok=True)
    of_model = collections.defaultdict(list)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for seed, model, fov, summary, refused in pool.map(run, [(options, seed) for seed in options.seeds]):
            if summary is None:  # a start among people, say
                print(f"{seed}: not counted: {refused}", flush=True)
                continue
            of_model[model].append(summary)
            print(line_of(seed, model, fov, summary), flush=True)
    for model, summaries in sorted(of_model.items()):
        print(total_of(model, summaries))
    return 0 if of_model else 1


if __name__ == "__main__":
    sys.exit(main())
