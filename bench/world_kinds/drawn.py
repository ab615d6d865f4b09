"""Rooms and doors that nobody has tuned the robot on, drawn by each seed."""
import math
import random

BORDER_M, FROM_SIDE_M = 0.1, 1.3
CLEAR_M = 1.15  # from a box to the start, the goal and the door
DOORS_M = (9.0, 7.0)
AHEAD_FRONT_M = {"p3dx": 0.21, "wheelchair": 0.75}  # of the body, from the axle
WALL_TURNS_DEG = 45.0  # at most


def rounded(*values):
    return [round(value, 3) for value in values]


def turned(x, y, angle):
    """The point in axes turned by `angle`."""
    c, s = math.cos(angle), math.sin(angle)
    return x * c + y * s, y * c - x * s


def is_door_wall(x, y, door):
    """Whether there is a wall at x, y: the rooms' border, or the wall between them."""
    if min(x, y, DOORS_M[0] - x, DOORS_M[1] - y) < BORDER_M:
        return True
    through, along = turned(x - DOORS_M[0] / 2, y - door["y"], door["angle"])
    return abs(through) < door["thickness"] / 2 and abs(along) > door["width"] / 2


def door(to, seed, width_m):
    rng = random.Random(seed)
    drawn = {"width": width_m, "thickness": rng.uniform(0.1, 0.3), "y": rng.uniform(1.6, 5.4)}
    drawn["angle"] = math.radians(rng.uniform(-1, 1) * WALL_TURNS_DEG)
    name = f"door_{seed}"
    world = to.drawn_map(name, DOORS_M, 0.02, lambda x, y: is_door_wall(x, y, drawn))
    start_y, goal_y, heading = rng.uniform(1.2, 5.8), rng.uniform(1.2, 5.8), rng.uniform(-math.pi, math.pi)
    robot = {"start": rounded(1.4, start_y, heading), "goal": rounded(7.6, goal_y), "model": "wheelchair", "max_speed_mps": 0.6}
    return to.scenario(name, world, robot, laser=None, seed=seed)


def doors(to, options):
    """A wheelchair, two rooms and a wall of any thickness across, at any angle, a door anywhere in it, start and heading
    anywhere in front. A goal in the slanting wall is refused: that run did not run."""
    to.experiment("doors", [door(to, seed, options.width) for seed in options.seeds], title=f"Doors of {options.width} m")


def headings(to, options):
    """A bare room; start, goal and both headings anywhere in it: it gets there, and stands as it is to stand."""
    scenarios = []
    for seed in options.seeds:
        rng = random.Random(seed)
        start, goal = ([rng.uniform(FROM_SIDE_M, side - FROM_SIDE_M) for side in DOORS_M] + [rng.uniform(-3.1, 3.1)] for _ in range(2))
        robot = {"start": rounded(*start), "goal": rounded(*goal), "max_speed_mps": 0.6}
        scenarios.append(to.scenario(f"headings_{seed}", to.bare_map("bare", *DOORS_M), robot, laser=None, seed=seed))
    to.experiment("headings", scenarios, settings={"robot.model": ["p3dx", "wheelchair"]})


def ahead(to, options):
    """A goal 2 to 5 m ahead with the heading that leads there; of even seeds a wall half a metre before the body at the
    goal. It gets there without driving past."""
    scenarios = []
    for seed in options.seeds:
        rng = random.Random(seed)
        way, aside = rng.uniform(2.0, 5.0), rng.uniform(-0.3, 0.3)
        for model, front_m in AHEAD_FRONT_M.items():
            room_m = front_m + 0.5 if seed % 2 == 0 else 6.0
            world = to.bare_map(f"{model}_{room_m}", 8.0 + room_m, 6.0)
            robot = {"model": model, "start": rounded(8.0 - way, 3.0 + aside, 0.0), "goal": [8.0, 3.0, 0.0], "max_speed_mps": 0.6}
            scenarios.append(to.scenario(f"ahead_{model}_{seed}", world, robot, laser=None, seed=seed, timeout_s=60.0))
    to.experiment("ahead", scenarios)


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


def is_room_wall(x, y, room):
    width, height = room["size"]
    if min(x, y, width - x, height - y) < BORDER_M:
        return True
    if room["wall_x"] is not None and abs(x - room["wall_x"]) < BORDER_M and abs(y - room["door_y"]) > room["door_width"] / 2:
        return True
    return any(from_box_m(box, (x, y)) == 0 for box in room["boxes"])


def drawn_people(rng):
    for _ in range(rng.randint(1, 3)):
        keys = {"kind": "wander", "count": rng.randint(1, 3), "speed_mps": round(rng.uniform(0.3, 1.3), 2)}
        keys |= {"radius_m": round(rng.uniform(0.2, 0.33), 2), "spontaneous_turns_hz": rng.choice([0, 0.05, 0.2])}
        yield keys | {"legs": rng.random() < 0.5}


def room(to, seed, model):
    """Returns the robot's model and the scenario."""
    rng = random.Random(seed)
    name, drawn = f"room_{seed}", drawn_room(rng)
    model = model or drawn["model"]
    world = to.drawn_map(name, drawn["size"], 0.05, lambda x, y: is_room_wall(x, y, drawn))
    fov, heading = rng.choice([180, 270, 270, 360]), rng.uniform(-math.pi, math.pi)
    goal = rounded(*drawn["goal"], *([] if rng.random() < 0.6 else [rng.uniform(-3.1, 3.1)]))
    robot = {"start": rounded(*drawn["start"], heading), "goal": goal, "model": model, "max_speed_mps": 0.6}
    laser = {"fov_deg": fov, "beams": 3 * fov + (fov < 360)}
    return model, to.scenario(name, world, robot, laser=laser, movers=drawn_people(rng), timeout_s=90.0, seed=seed)


def rooms(to, options):
    """Boxes, a wall with a door in most, one to nine people about, half of them on two legs; p3dx or wheelchair, a laser
    of 180, 270 or 360 degrees. A start among people is refused: that run did not run."""
    drawn = [room(to, seed, options.model) for seed in options.seeds]
    for model in sorted({model for model, _ in drawn}):
        to.experiment(model, [scenario for of, scenario in drawn if of == model])
