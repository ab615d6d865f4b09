"""Worlds of others, a bare hall, and the project's four maps with other scanners or movers."""
import os
import pathlib

from command_line import files_in

from world_kinds.folder import LASER

SCENARIOS = pathlib.Path(__file__).resolve().parent.parent.parent / "hal/sim/scenarios"
KEYS = {
    "scanners": [f"robot.laser.{key}" for key in ("fov_deg", "beams", "rate_hz", "range_m", "noise_m", "drop_out", "turns")],
    "movers": [f"movers.{key}" for key in ("speed_mps", "radius_m", "count", "legs")],
}
SCANNERS = (
    (360, 1440, 10, 30, 0.01, 0.0),
    (270, 1081, 40, 30, 0.01, 0.0),
    (180, 361, 25, 30, 0.01, 0.0),
    (360, 400, 8, 12, 0.02, 0.02),
    (240, 683, 10, 5.6, 0.02, 0.0),
    (360, 1440, 10, 30, 0.01, 0.0, True),
    (270, 1081, 40, 30, 0.01, 0.0, True),
    (360, 400, 8, 12, 0.02, 0.02, True),
)
MOVERS = (
    (0.2, 0.27, 16), (0.8, 0.27, 16), (1.2, 0.25, 16), (1.6, 0.25, 16), (0.6, 0.15, 16), (0.5, 0.40, 16), (0.5, 0.50, 16),
    (0.5, 0.70, 8), (0.4, 0.27, 30), (0.4, 0.27, 16, True), (0.8, 0.27, 16, True), (1.2, 0.27, 16, True),
)  # fmt: skip


def bare_hall(to):
    """24 m by 24 m."""
    return to.bare_map("hall", 24, 24)


def cylinders(to, data):
    """Name and map of each world of BARN's: lines `x y radius` in m."""
    files = files_in(data, "world_*.txt", "world_*.txt", "give the folder of BARN's worlds")
    return [(file.stem, {"cylinders": to.copy(file)}) for file in files]


def posts(to, options):
    """Corridors of posts, with `--movers` that walk among them."""
    robot = {"start": [-2.25, 3.0, 1.5708], "goal": [-2.25, 13.0], "max_speed_mps": 0.6}
    walk = {"kind": "wander", "count": options.movers, "speed_mps": 0.4, "radius_m": 0.27}
    movers = [walk] if options.movers else []
    scenarios = [to.scenario(name, world, robot, movers=movers) for name, world in cylinders(to, options.data)]
    to.experiment("posts", scenarios, options.seeds)


def barn(to, options):
    """The same corridors as the benchmark has them: a Jackal at 2 m/s, 100 s, to within 1 m. bench/scores.py has its score."""
    robot = {"start": [-2.0, 3.0, 1.5708], "goal": [-2.0, 13.0], "goal_tolerance_m": 1.0, "model": to.copy(options.data / "jackal.toml")}
    scenarios = [to.scenario(name, world, robot, laser=None, timeout_s=100.0) for name, world in cylinders(to, options.data)]
    to.experiment("barn", scenarios, options.seeds)


def hall(to, options):
    """Sixteen movers of 0.8 m/s, discs or people on two legs, in a hall whose walls a laser of 10 m does not reach. The
    robot drives across it, or creeps in its middle."""
    walk = {"kind": "wander", "count": 16, "speed_mps": 0.8, "radius_m": 0.27, "legs": False}
    across = {"start": [2.0, 2.0, 0.785], "goal": [21.0, 21.0], "max_speed_mps": 0.3}
    creeps = {"start": [11.0, 11.0, 0.785], "goal": [14.0, 14.0], "max_speed_mps": 0.05}
    for name, robot, timeout_s, reach_m in (("across_25m", across, 120.0, 25.0), ("across_10m", across, 120.0, 10.0), ("middle_10m", creeps, 60.0, 10.0)):
        laser = LASER | {"range_m": reach_m}
        scenario = to.scenario(name, bare_hall(to), robot, laser=laser, movers=[walk], timeout_s=timeout_s)
        to.experiment(name, [scenario], options.seeds, {"movers.legs": [False, True]})


def on_four_maps(to, options, kind, values, mapped=()):
    """16 movers' scenarios, or those in `mapped`, with these values of the kind's keys."""
    name = "_".join(str(value) for value in values).replace(".", "p")
    own = [os.path.relpath(SCENARIOS / f"map{k}_16.toml", to.path.resolve()) for k in (1, 2, 3, 4)]
    to.experiment(f"turned_{name}" if mapped else name, mapped or own, options.seeds, zip(KEYS[kind], values))


def turned_scanner(to, number):
    """A map's own scenario with a scanner whose turn begins straight ahead."""
    file = SCENARIOS / f"map{number}_16.toml"
    maps = os.path.relpath(SCENARIOS.parent / "maps", to.path.resolve())
    text = file.read_text().replace("../maps", maps).replace("[robot.laser]\n", "[robot.laser]\nmount = [0.0, 0.0, 3.1416]\n")
    return to.write(file.name, text)


def scanners(to, options):
    for values in SCANNERS:
        on_four_maps(to, options, "scanners", values)
    on_four_maps(to, options, "scanners", SCANNERS[0], [turned_scanner(to, k) for k in (1, 2, 3, 4)])


def movers(to, options):
    for values in MOVERS:
        on_four_maps(to, options, "movers", values)
