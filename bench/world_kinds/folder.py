"""A folder of worlds as the kinds fill it: scenarios, maps, what others recorded, and the campaign."""
import json
import shutil

LASER = {"fov_deg": 270.0, "beams": 811, "rate_hz": 15.0, "range_m": 25.0, "noise_m": 0.01}  # the project's own maps'


def table(head, keys):
    """A TOML table; text, numbers, lists and truth values look as in JSON."""
    return (head + "\n" if head else "") + "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())


class Folder:
    def __init__(self, path):
        path.mkdir(parents=True, exist_ok=True)
        self.path = path
        self.experiments = []

    def write(self, name, text):
        (self.path / name).write_text(text)
        return name

    def copy(self, file):
        """Of another's file; returns its name here."""
        shutil.copy(file, self.path)
        return file.name

    def scenario(self, name, world, robot, *, laser=LASER, movers=(), timeout_s=120.0, seed=1):
        """`world`: the map's key and file; `robot`: keys over the P3-DX's; returns the file's name."""
        robot = {"model": "p3dx"} | robot
        tables = [("", {"name": name, "seed": seed, "timeout_s": timeout_s}), ("[map]", world), ("[robot]", robot)]
        tables += [("[robot.laser]", laser)] if laser else []
        tables += [("[[movers]]", keys) for keys in movers]
        return self.write(f"{name}.toml", "".join(table(*part) for part in tables))

    def aria_map(self, name, *walls):
        """Walls of two corners each, m; the first one's is the map's far corner from the origin."""
        lines = [" ".join(f"{1000 * v:.0f}" for v in wall) for wall in walls]
        far = " ".join(lines[0].split()[2:])
        text = f"2D-Map\nLineMinPos: 0 0\nLineMaxPos: {far}\nNumLines: {len(lines) - 1}\nLINES\n"
        return {"aria": self.write(f"{name}.map", text + "\n".join(lines[1:]) + "\n")}

    def bare_map(self, name, width_m, height_m):
        """A room with nothing in it."""
        corners = [(0, 0), (width_m, 0), (width_m, height_m), (0, height_m)]
        walls = [(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1])]
        return self.aria_map(name, (0, 0, width_m, height_m), *walls)

    def drawn_map(self, name, size_m, cell_m, is_wall):
        """`is_wall(x, y)` is asked at the middle of each cell, in metres from the lower left corner."""
        columns, rows = (round(side / cell_m) for side in size_m)
        places = (((i + 0.5) * cell_m, (rows - 0.5 - j) * cell_m) for j in range(rows) for i in range(columns))
        pixels = bytes(0 if is_wall(x, y) else 254 for x, y in places)
        (self.path / f"{name}.pgm").write_bytes(b"P5\n%d %d\n255\n" % (columns, rows) + pixels)
        keys = {"image": f"{name}.pgm", "resolution": cell_m, "origin": [0.0, 0.0, 0.0], "negate": 0}
        keys |= {"occupied_thresh": 0.65, "free_thresh": 0.196}
        text = "".join(f"{key}: {value}\n" for key, value in keys.items())
        return {"yaml": self.write(f"{name}.yaml", text)}

    def ways(self, name, rows):
        """Recorded movers' t, id, x, y."""
        rows = (f"{t:.2f},{mover},{x:.4f},{y:.4f}\n" for t, mover, x, y in rows)
        return self.write(f"{name}.csv", "t_s,id,x_m,y_m\n" + "".join(rows))

    def experiment(self, name, scenarios, seeds=None, settings=(), title=""):
        """`settings`: keys of the scenario, a list where it is varied; without seeds each scenario has its own."""
        keys = {"name": name, "title": title or name, "scenarios": list(scenarios)}
        keys |= {"seeds": [seeds[0], seeds[-1]]} if seeds else {}
        self.experiments.append(keys | {f"set.{key}": value for key, value in dict(settings).items()})

    def campaign(self, name, keep):
        text = table("", {"name": name, "keep": keep})
        experiments = (table("\n[[experiments]]", keys) for keys in self.experiments)
        return self.path / self.write("campaign.toml", text + "".join(experiments))
