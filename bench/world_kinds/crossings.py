"""A robot that crosses a square on which people walk as they once did."""
import math
import random

from world_kinds.walked import columns, middle, recorded, recordings

SQUARE_M, CROSSING_M, CROSSING_S = 44.0, 13.0, 90.0  # its side; straight across; at most
BEYOND_S = 12.0  # a way goes on so long beyond what was recorded: out of the square


def comes_and_goes(way):
    """A way from before to after what was recorded, straight on: nobody appears before the robot, or vanishes."""
    (t0, x0, y0), (t1, x1, y1), (t2, x2, y2), (t3, x3, y3) = *way[:2], *way[-2:]
    before, after = BEYOND_S / (t1 - t0), BEYOND_S / (t3 - t2)
    first = t0 - BEYOND_S, x0 - before * (x1 - x0), y0 - before * (y1 - y0)
    return [first, *way, (t3 + BEYOND_S, x3 + after * (x3 - x2), y3 + after * (y3 - y2))]


def square_ways(to, file):
    """The recording with its middle that of the square, each way made longer; its file here and when it ends."""
    middle_x_m, middle_y_m = middle(file)
    times, *others = columns(file, "t_s", "id", "x_m", "y_m")
    people = {}
    for t, who, x, y in zip(times, *others):
        people.setdefault(int(who), []).append((t, x - middle_x_m + SQUARE_M / 2, y - middle_y_m + SQUARE_M / 2))
    ways = {who: comes_and_goes(sorted(way)) for who, way in people.items() if len(way) > 1}
    rows = [(t, who, x, y) for who, way in ways.items() for t, x, y in way]
    return to.ways(file.stem, rows), max(times)


def across(chance):
    """Start and goal on a line through the square's middle, in a direction that is drawn."""
    heading = chance.uniform(-math.pi, math.pi)
    x_m, y_m = CROSSING_M / 2 * math.cos(heading), CROSSING_M / 2 * math.sin(heading)
    start = [round(SQUARE_M / 2 - v, 3) for v in (x_m, y_m)]
    return {"start": [*start, round(heading, 3)], "goal": [round(SQUARE_M / 2 + v, 3) for v in (x_m, y_m)]}


def crossings(to, options):
    """People on two legs as they once walked, from a moment that the seed draws, on a square that the robot crosses: they
    do not see it. A person at the start is a collision."""
    for file in recordings(options.data):
        ways, ends_s = square_ways(to, file)
        scenarios = []
        for seed in options.seeds:
            chance = random.Random(seed)
            begins_s = chance.uniform(0.0, max(ends_s - CROSSING_S, 0.0)) + BEYOND_S
            walk = recorded(ways, legs=True, start_at_s=round(-begins_s, 1))
            world = to.bare_map("square", SQUARE_M, SQUARE_M)
            scenarios.append(to.scenario(f"{file.stem}_{seed}", world, across(chance), movers=[walk], timeout_s=CROSSING_S, seed=seed))
        to.experiment(file.stem, scenarios, settings={"robot.max_speed_mps": [0.6, 1.2], "robot.laser.fov_deg": [270, 360]})
