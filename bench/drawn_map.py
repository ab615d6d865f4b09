"""Maps that a script draws: what the random rooms and doors share."""
import math

MAP = "image: {name}.pgm\nresolution: {cell}\norigin: [0.0, 0.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


def write_map(folder, name, size_m, cell_m, is_wall):
    """NAME.pgm and NAME.yaml; `is_wall(x, y)` is asked at the middle of each cell, in metres from the lower left corner."""
    columns, rows = (round(side / cell_m) for side in size_m)
    places = (((i + 0.5) * cell_m, (rows - 0.5 - j) * cell_m) for j in range(rows) for i in range(columns))
    pixels = bytes(0 if is_wall(x, y) else 254 for x, y in places)
    (folder / f"{name}.pgm").write_bytes(b"P5\n%d %d\n255\n" % (columns, rows) + pixels)
    (folder / f"{name}.yaml").write_text(MAP.format(name=name, cell=cell_m))


def turned(x, y, angle):
    """The point in axes turned by `angle`."""
    c, s = math.cos(angle), math.sin(angle)
    return x * c + y * s, y * c - x * s
