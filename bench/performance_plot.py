#!/usr/bin/env python3
"""Growth with the number of cells, as SVG, and the table of docs/explanation/results.md#time, from what jaywalk bench measured.

    jaywalk bench --json bench.json && bench/performance_plot.py bench.json docs/performance.svg
"""
import argparse
import json
import math

from command_line import reading, refuse

COLOURS = {"cold solve": "#b03020", "warm solve": "#d08020", "plan, 8 movers": "#208050", "100 sweeps": "#555555",
           "dijkstra, heap": "#6060c0", "dijkstra, buckets": "#4090c0", "wavefront": "#90a0b0"}
MAP = "office"  # the one that is drawn
WIDTH, HEIGHT, LEFT, BOTTOM, RIGHT, TOP = 760, 460, 70, 50, 190, 40
LEAST_MS, MOST_MS = 0.05, 5000.0


def medians(rows):
    """{(map, size): {what: p50_ms}}"""
    found = {}
    for row in rows:
        found.setdefault((row["map"], row["size"]), {})[row["what"]] = row["p50_ms"]
    return found


def place(size, ms, sizes):
    x = LEFT + (WIDTH - LEFT - RIGHT) * math.log2(size / sizes[0]) / max(1.0, math.log2(sizes[-1] / sizes[0]))
    share = math.log(max(ms, LEAST_MS) / LEAST_MS) / math.log(MOST_MS / LEAST_MS)
    return x, HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * share


def svg(found, name):
    sizes = sorted({size for m, size in found if m == name})
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
           'font-size="12">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
           f'<text x="{LEFT}" y="20">map {name}: milliseconds of one core, median, by cells a side</text>']
    for power in range(-1, 4):
        _, y = place(sizes[0], 10.0 ** power, sizes)
        out.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                   f'<text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{10.0 ** power:g}</text>')
    for size in sizes:
        x, y = place(size, LEAST_MS, sizes)
        out.append(f'<text x="{x:.1f}" y="{y + 20:.1f}" text-anchor="middle">{size}</text>')
    for k, (what, colour) in enumerate(COLOURS.items()):
        points = [place(s, found[name, s][what], sizes) for s in sizes if what in found[name, s]]
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>'
                   f'<text x="{WIDTH - RIGHT + 16}" y="{TOP + 20 * k + 12}" fill="{colour}">{what}</text>')
    return "\n".join(out + ["</svg>"]) + "\n"


def table(found):
    lines = ["| map | cells | " + " | ".join(COLOURS) + " |", "|---|---|" + "---|" * len(COLOURS)]
    for (name, size), by_what in found.items():
        cells = [f"{by_what[w]:.2f}" if w in by_what else "" for w in COLOURS]
        lines.append(f"| {name} | {size} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("measured", help="what jaywalk bench --json wrote")
    parser.add_argument("plot", help="the SVG to write")
    options = parser.parse_args()
    with reading(options.measured, "what jaywalk bench --json wrote"):
        with open(options.measured, encoding="utf-8") as measured:
            found = medians(json.load(measured))
        if not any(name == MAP for name, _ in found):
            refuse(f"{options.measured}: nothing measured on the map {MAP}", "give what jaywalk bench --json wrote")
        drawn, rows = svg(found, MAP), table(found)
    with reading(options.plot, "a file that may be written"), open(options.plot, "w", encoding="utf-8") as out:
        out.write(drawn)
    print(rows)


if __name__ == "__main__":
    main()
