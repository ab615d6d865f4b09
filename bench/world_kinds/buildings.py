"""Drives from place to place through buildings that robots have mapped.

docs/explanation/results.md uses two maps, fr079.yaml and intel.yaml. `jaywalk replay LOG --save-map` made them from the
Freiburg 079 and Intel logs with SLAM's poses. Keep these names: a map's name and the seed decide which places are drawn.
"""
import heapq
import math
import random
import re

from command_line import files_in, reading, refuse

from world_kinds.drawn import rounded

WAY_M = (15.0, 60.0)
PASSES_M = {"p3dx": 0.35, "wheelchair": 0.45}  # half of the narrowest gap on the way that is counted on
STANDS_M = {"p3dx": 0.75, "wheelchair": 1.0}  # from a wall to start and goal
WALL, FREE = 0, 254
STEPS = [(i, j, math.hypot(i, j)) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
TRIES = 200


class Building:
    """A map as `--save-map` leaves it. What was never seen is wall here: the simulation would let laser and robot into it."""

    def __init__(self, file):
        with reading(file, "a map as jaywalk replay --save-map leaves it"):
            self.keys = dict(line.split(": ", 1) for line in file.read_text().splitlines() if ": " in line)
            self.cell_m = float(self.keys["resolution"])
            self.low = [float(v) for v in self.keys["origin"].strip("[]").split(",")[:2]]
            image = (file.parent / self.keys["image"]).read_bytes()
            head = re.match(rb"P5\s+(\d+)\s+(\d+)\s+255\s", image)
            self.columns, self.rows = int(head[1]), int(head[2])
            self.pixels = [FREE if shade >= 250 else WALL for shade in image[head.end() :]]
            if len(self.pixels) != self.columns * self.rows:
                raise ValueError
        self.name = file.stem

    def written(self, to):
        size = b"P5\n%d %d\n255\n" % (self.columns, self.rows)
        (to.path / f"{self.name}.pgm").write_bytes(size + bytes(self.pixels))
        keys = self.keys | {"image": f"{self.name}.pgm"}
        return {"yaml": to.write(f"{self.name}.yaml", "".join(f"{key}: {value}\n" for key, value in keys.items()))}

    def clear_of(self, room_m):
        """The cells, as (column, row), whose middles are at least so far from a wall's."""
        reach = int(room_m / self.cell_m)
        disc = [(i, j) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1) if math.hypot(i, j) * self.cell_m < room_m]
        cells = {(n % self.columns, n // self.columns) for n, pixel in enumerate(self.pixels) if pixel == FREE}
        rim = {(i + di, j + dj) for i, j in cells for di, dj, _ in STEPS} - cells
        return cells - {(i + di, j + dj) for i, j in rim for di, dj in disc}

    def place(self, cell):
        """Its middle in the map, m."""
        return [self.low[0] + (cell[0] + 0.5) * self.cell_m, self.low[1] + (self.rows - cell[1] - 0.5) * self.cell_m]


def ways_from(start, cells, cell_m):
    """Length of the shortest way to each cell that has one, m."""
    length, queue = {start: 0.0}, [(0.0, start)]
    while queue:
        so_far, (i, j) = heapq.heappop(queue)
        if so_far > length[i, j]:
            continue
        for di, dj, step in STEPS:
            there, way = (i + di, j + dj), so_far + step * cell_m
            if there in cells and way < length.get(there, math.inf):
                length[there] = way
                heapq.heappush(queue, (way, there))
    return length


def pair(building, passable, standing, rng):
    """Start, goal and the way between them."""
    for _ in range(TRIES if standing else 0):
        start = rng.choice(standing)
        ways = ways_from(start, passable, building.cell_m)
        goals = [cell for cell in standing if WAY_M[0] <= ways.get(cell, 0.0) <= WAY_M[1]]
        if goals:
            goal = rng.choice(goals)
            return start, goal, ways[goal]
    refuse(f"{building.name}: no way of {WAY_M[0]:g} to {WAY_M[1]:g} m in it", "give the map of a building")


def buildings(to, options):
    """A P3-DX and a wheelchair, each seed a pair of places 15 to 60 m apart by the way, nobody about but `--movers`, the
    map not known to them. `--data`: a folder of maps."""
    files = files_in(options.data, "*.yaml", "map.yaml", "give the folder of a map, as jaywalk replay --save-map leaves it")
    walk = {"kind": "wander", "count": options.movers, "speed_mps": 0.4, "radius_m": 0.27}
    for model, passes_m in PASSES_M.items():
        scenarios = []
        for building in map(Building, files):
            world, passable = building.written(to), building.clear_of(passes_m)
            standing = sorted(building.clear_of(STANDS_M[model]))
            for seed in options.seeds:
                rng = random.Random(f"{building.name} {seed}")
                start, goal, way_m = pair(building, passable, standing, rng)
                robot = {"start": rounded(*building.place(start), rng.uniform(-math.pi, math.pi)), "goal": rounded(*building.place(goal))}
                robot |= {"model": model, "max_speed_mps": 0.6}
                name, timeout_s = f"{building.name}_{model}_{seed}", round(30.0 + 5.0 * way_m / 0.6)
                scenarios.append(to.scenario(name, world, robot, laser=None, movers=[walk] if options.movers else [], timeout_s=timeout_s, seed=seed))
        to.experiment(model, scenarios, title=f"{model}, from place to place")
