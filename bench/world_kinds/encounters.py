"""One person, or two, whom the robot meets: nobody reacts to it."""
import math
import random

from world_kinds.walked import recorded

TIMINGS_S = [-2.0 + 4.0 * k / 7 for k in range(8)]  # the person is on the robot's line so much later than the robot would be
SPEEDS_MPS = (0.6, 1.2)
STAYS_S = 300.0
MODELS = {"robot.model": ["p3dx", "wheelchair"], "movers.legs": [False, True]}


class Place:
    """The robot drives along `y`; people cross at `x`, from `reach_m` off its line."""

    def __init__(self, to, name, start_x, x, goal_x, y, reach_m, world):
        self.to, self.name, self.world = to, name, world
        self.start_x, self.x, self.goal_x, self.y, self.reach_m = start_x, x, goal_x, y, reach_m

    def there_s(self, x, speed_mps):
        """When a robot that nothing hinders is there: half a m/s2 and its jerk take 1.3 s of its full speed."""
        return (x - self.start_x) / speed_mps + 0.65 * min(2.0, speed_mps / 0.5)

    def scenario(self, name, speed_mps, ways):
        """`ways`: a list of places and moments (t, x, y) each; the last one is where that person stays."""
        stem = f"{name}_{self.name}_{round(10 * speed_mps)}"
        rows = [(t, who, x, y) for who, way in enumerate(ways) for t, x, y in [*way, (STAYS_S, *way[-1][1:])]]
        robot = {"start": [self.start_x, self.y, 0.0], "goal": [self.goal_x, self.y], "max_speed_mps": speed_mps}
        people = recorded(self.to.ways(stem, rows), radius_m=0.25, legs=False)
        return self.to.scenario(stem, self.world, robot, laser=None, movers=[people], timeout_s=60.0)


def places(to):
    corridor = (
        (0, 1.8, 6.5, 1.8), (6.5, 1.8, 6.5, 0), (6.5, 0, 9.5, 0), (9.5, 0, 9.5, 1.8), (9.5, 1.8, 16, 1.8), (16, 1.8, 16, 4.2),
        (16, 4.2, 9.5, 4.2), (9.5, 4.2, 9.5, 6), (9.5, 6, 6.5, 6), (6.5, 6, 6.5, 4.2), (6.5, 4.2, 0, 4.2), (0, 4.2, 0, 1.8),
    )  # fmt: skip
    return (
        Place(to, "room", 1.3, 4.0, 6.9, 3.0, 2.2, to.bare_map("room", 8, 6)),
        Place(to, "corridor", 2.0, 8.0, 14.0, 3.0, 2.4, to.aria_map("corridor", (0, 0, 16, 6), *corridor)),
        Place(to, "hall", 4.0, 9.0, 16.0, 8.0, 4.5, to.bare_map("hall", 20, 16)),
    )


def walk(begins_s, speed_mps, *at):
    """Stands at the first place until then, and walks through the others."""
    way, t = [(0.0, *at[0])], max(begins_s, 0.1)
    way.append((t, *at[0]))
    for (x0, y0), (x1, y1) in zip(at, at[1:]):
        t += math.hypot(x1 - x0, y1 - y0) / speed_mps
        way.append((t, x1, y1))
    return way


def crossing(place, on_line_s, speed_mps, side, stops_m=None, ahead_m=0.0):
    """From a side (1: left) across the line, or until `stops_m` beyond it."""
    x, end_m = place.x + ahead_m, place.reach_m if stops_m is None else stops_m
    at = (x, place.y + side * place.reach_m), (x, place.y - side * end_m)
    return walk(on_line_s - place.reach_m / speed_mps, speed_mps, *at)


def crosses(place, v, chance):
    for k, late_s in enumerate(TIMINGS_S):
        yield [crossing(place, place.there_s(place.x, v) + late_s, chance.uniform(0.4, 1.6), (-1) ** k)]


def steps_in(place, v, chance):
    for side in (1, -1):
        yield [crossing(place, place.there_s(place.x, v) - chance.uniform(0.0, 2.5), chance.uniform(0.6, 1.4), side, chance.uniform(-0.3, 0.3))]


def comes_towards(place, v, chance):
    for side in (1, -1):
        y = place.y + side * chance.uniform(0.0, 0.5)
        yield [walk(chance.uniform(0.0, 2.0), chance.uniform(0.4, 1.4), (place.goal_x, y), (0.5, y))]


def walks_ahead(place, v, chance):
    """Slower than the robot, then aside."""
    for side in (1, -1):
        y, aside_y = place.y + side * chance.uniform(0.0, 0.3), place.y + side * min(0.9, place.reach_m)
        yield [walk(0.5, chance.uniform(0.25, 0.5), (place.start_x + chance.uniform(1.3, 2.0), y), (place.goal_x - 1.5, y), (place.goal_x - 1.0, aside_y))]


def sets_out(place, v, chance):
    """Stands beside the robot's line, and crosses it when the robot is 1 to 3 m off."""
    for side in (1, -1):
        beside_m, away_m = chance.uniform(0.7, 0.9), chance.uniform(1.0, 3.0)
        at = (place.x, place.y + side * beside_m), (place.x, place.y - side * place.reach_m)
        yield [walk(place.there_s(place.x - away_m, v), chance.uniform(0.6, 1.4), *at)]


def both_sides(place, v, chance):
    """Two who cross, one from either side."""
    for late_s in (-0.5, 0.5):
        there_s = place.there_s(place.x, v) + late_s
        yield [crossing(place, there_s + chance.uniform(-1.0, 1.0), chance.uniform(0.6, 1.4), side, ahead_m=0.4 * side) for side in (1, -1)]


def encounters(to, options):
    """In a room, a corridor and a hall: somebody crosses from either side (eight timings), steps in and stops, comes towards
    it, walks ahead, stands beside and sets out, two cross. Speeds, sides and moments are the seed's."""
    for kind in (crosses, steps_in, comes_towards, walks_ahead, sets_out, both_sides):
        scenarios = []
        for seed in options.seeds:
            for place in places(to):
                for v in SPEEDS_MPS:
                    chance = random.Random(f"{seed} {kind.__name__} {place.name} {v}")
                    for k, ways in enumerate(kind(place, v, chance)):
                        scenarios.append(place.scenario(f"{kind.__name__}_{seed}_{k}", v, ways))
        to.experiment(kind.__name__, scenarios, options.seeds[:1], MODELS, title=kind.__name__.replace("_", " "))
