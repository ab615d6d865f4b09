"""Worlds in which recorded movers walk."""
import csv
import math
import random

from command_line import files_in, reading

from world_kinds.given import bare_hall

PASSAGES_M, ASIDE_M, WAYS = (1.3, 1.5, 1.8, 2.4), (0.3, 0.5), 4
WALL_M = 0.1  # thick, as partitions are
HALL_MIDDLE = (12.0, 13.5)  # m, of people's ways in the hall
SQUARE_M, CROSSING_M, CROSSING_S = 44.0, 13.0, 90.0  # the square's side; straight across; at most
BEYOND_S = 12.0  # a way goes on so long beyond what was recorded: out of the square


def recorded(file, **keys):
    return {"kind": "recorded", "file": file} | keys


def wall_across(x, foot, end):
    """Both faces and the end: a line alone cannot be seen edge-on, which no real wall is like."""
    faces = [(x + side * WALL_M / 2, foot, x + side * WALL_M / 2, end) for side in (-1, 1)]
    return faces + [(x - WALL_M / 2, end, x + WALL_M / 2, end)]


def passage(to, name, width_m, aside_m, heading, seed, comes_m):
    """Two rooms and a passage; somebody on two legs comes at 0.8 m/s, or is there, stands at its side and stays."""
    low, y = 3.0 - width_m / 2, 3.0 - width_m / 2 + aside_m
    walls = [(0, 0, 12, 6), (0, 0, 12, 0), (12, 0, 12, 6), (12, 6, 0, 6), (0, 6, 0, 0)]
    walls += wall_across(6.0, 0.0, low) + wall_across(6.0, 6.0, low + width_m)
    x_m, y_m = comes_m * math.cos(heading), comes_m * math.sin(heading)
    walk = f"t_s,id,x_m,y_m\n0.0,1,{6.0 - x_m:.3f},{y - y_m:.3f}\n3.0,1,6.0,{y:.3f}\n900.0,1,6.0,{y:.3f}\n"
    stands = recorded(to.write(f"{name}.csv", walk), radius_m=0.27, legs=True)
    robot = {"start": [1.5, 3.0, 0.0], "goal": [10.5, 3.0]}
    return to.scenario(name, to.aria_map(name, *walls), robot, laser=None, movers=[stands], timeout_s=60.0, seed=seed)


def passages(to, options):
    """Past somebody who came and stands in a passage 1.3 to 2.4 m wide, 0.3 or 0.5 m from one side, or stood there from
    the start; the robot gets past, or waits where there is no room."""
    for how, comes_m in (("comes", 2.4), ("there", 0.01)):
        for width_m in PASSAGES_M:
            stem, scenarios = f"{how}_{round(100 * width_m)}cm", []
            for seed in options.seeds:
                chance = random.Random(seed)
                ways = [(aside, math.pi * (k % 2) + math.radians(chance.uniform(-40, 40))) for k in range(WAYS) for aside in ASIDE_M]
                scenarios += [passage(to, f"{stem}_{seed}_{k}", width_m, *way, seed + k, comes_m) for k, way in enumerate(ways)]
            to.experiment(stem, scenarios, settings={"robot.model": ["p3dx", "wheelchair"]})


def columns(file, *names):
    with reading(file, "recorded ways: t_s,id,x_m,y_m"), file.open() as rows:
        return list(zip(*([float(row[name]) for name in names] for row in csv.DictReader(rows))))


def middle(file):
    return [(min(values) + max(values)) / 2 for values in columns(file, "x_m", "y_m")]


def recordings(data):
    return files_in(data, "*.csv", ".csv", "give a folder of recorded ways")


def people(to, options):
    """As people once walked (20 m by 20 m at most), as discs and on two legs, past a robot that creeps along a wall."""
    robot = {"start": [2.0, 1.5, 0.0], "goal": [22.5, 1.5], "max_speed_mps": 0.1}
    for file in recordings(options.data):
        offset = [round(wanted - there, 2) for wanted, there in zip(HALL_MIDDLE, middle(file))]
        walkers = recorded(to.copy(file), offset=offset, legs=False)
        scenario = to.scenario(f"way_{file.stem}", bare_hall(to), robot, movers=[walkers], timeout_s=200.0)
        to.experiment(file.stem, [scenario], options.seeds, {"movers.legs": [False, True]})


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


def lines_of(path):
    with reading(path, "DynaBARN's folder"):
        return [line for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]


def worlds_of(data):
    """Index, radius and ways (t, x, y) of each world: `index movers radius : names`, and a file of `t x y` a name."""
    for line in lines_of(data / "worlds.txt"):
        with reading(data, "DynaBARN's folder"):
            head, names = line.split(":")
            index, _, radius = head.split()
            files = (data / "trajectories" / f"{name}.txt" for name in names.split())
            yield index, float(radius), [[tuple(map(float, row.split())) for row in lines_of(file)] for file in files]


def there_and_back(way, t):
    lasts = way[-1][0]
    t = lasts - abs(t % (2 * lasts) - lasts)
    (t0, *a), (t1, *b) = next(pair for pair in zip(way, way[1:]) if pair[1][0] >= t)
    return [p + (q - p) * (t - t0) / (t1 - t0) for p, q in zip(a, b)]


def dynabarn_robot(speed_mps):
    return {"start": [23.0, 12.0, 3.1416], "goal": [3.0, 12.0], "max_speed_mps": speed_mps}


def dynabarn(to, options):
    """Movers of 1 m at up to 1.9 m/s and through one another, in a bare hall, there and back on their ways for 120 s."""
    scenarios = []
    for index, radius, ways in worlds_of(options.data):
        rows = ((0.2 * k, mover, *there_and_back(way, 0.2 * k)) for k in range(601) for mover, way in enumerate(ways))
        movers = recorded(to.ways(f"world_{index}", rows), offset=[12.0, 12.0], radius_m=radius, loop=False)
        scenarios.append(to.scenario(f"dynabarn_{index}", bare_hall(to), dynabarn_robot(0.6), movers=[movers]))
    to.experiment("dynabarn", scenarios, options.seeds)


def dynabarn_loops(to, options):
    """As the benchmark does it: each mover begins anew at its way's end, and the robot drives at up to 1 m/s."""
    scenarios = []
    for index, radius, ways in worlds_of(options.data):
        files = [to.ways(f"world_{index}_{mover}", ((t, mover, x, y) for t, x, y in way)) for mover, way in enumerate(ways)]
        movers = [recorded(file, offset=[12.0, 12.0], radius_m=radius, loop=True) for file in files]
        scenarios.append(to.scenario(f"dynabarn_{index}", bare_hall(to), dynabarn_robot(1.0), movers=movers))
    to.experiment("dynabarn_loops", scenarios, options.seeds)
