#!/usr/bin/env python3
"""Tracking and localisation with other laser scanners, and of other movers: the tables in docs/tracking.md.

The project's four maps with 16 movers, driven with each scanner, or each kind of movers, below in place of theirs;
means over maps and seeds.

    bench/tracking/varied_runs.py scanners --seeds 301-304
    bench/tracking/varied_runs.py movers --seeds 301-304
"""
import re

from drives import FIGURES, ROOT, all_of, drive, figures_of, means, off_the_truth, parser, print_head

MAPS = (1, 2, 3, 4)
KEYS = {
    "scanners": ("robot.laser", ("fov_deg", "beams", "rate_hz", "range_m", "noise_m", "drop_out", "mount", "turns")),
    "movers": ("[movers]", ("speed_mps", "radius_m", "count", "legs")),
}
VARIANTS = {
    "scanners": (
        (360, 1440, 10, 30, 0.01, 0.0),
        (360, 1440, 10, 30, 0.01, 0.0, "[0.0, 0.0, 3.1416]"),
        (270, 1081, 40, 30, 0.01, 0.0),
        (180, 361, 25, 30, 0.01, 0.0),
        (360, 400, 8, 12, 0.02, 0.02),
        (240, 683, 10, 5.6, 0.02, 0.0),
        (360, 1440, 10, 30, 0.01, 0.0, "[0.0, 0.0, 0.0]", "true"),
        (270, 1081, 40, 30, 0.01, 0.0, "[0.0, 0.0, 0.0]", "true"),
        (360, 400, 8, 12, 0.02, 0.02, "[0.0, 0.0, 0.0]", "true"),
    ),
    "movers": (
        (0.2, 0.27, 16),
        (0.8, 0.27, 16),
        (1.2, 0.25, 16),
        (1.6, 0.25, 16),
        (0.6, 0.15, 16),
        (0.5, 0.40, 16),
        (0.5, 0.50, 16),
        (0.5, 0.70, 8),
        (0.4, 0.27, 30),
        (0.4, 0.27, 16, "true"),
        (0.8, 0.27, 16, "true"),
        (1.2, 0.27, 16, "true"),
    ),
}


def arguments():
    made = parser(__doc__, "varied", "301-304")
    made.add_argument("what", choices=VARIANTS)
    return made.parse_args()


def with_values(text, section, values):
    """The scenario with other values in a section."""
    head, lines = re.search(rf"(\[{re.escape(section)}\]\n)((?:[a-z_]+ = .*\n)*)", text).groups()
    kept = dict(re.findall(r"([a-z_]+) = (.*)\n", lines)) | {key: str(value) for key, value in values.items()}
    return text.replace(head + lines, head + "".join(f"{key} = {value}\n" for key, value in kept.items()))


def scenario(number, section, values):
    own = ROOT / f"hal/sim/scenarios/map{number}_16.toml"
    text = with_values(own.read_text(), section, values)
    return re.sub(r'yaml = "(.*)"', lambda m: f'yaml = "{(own.parent / m[1]).resolve()}"', text)


def run(job):
    options, variant, number, seed = job
    section, keys = KEYS[options.what]
    values = dict(zip(keys, variant))
    out = options.out / "_".join(map(str, variant)) / f"map{number}_{seed}"
    outcome = drive(out, scenario(number, section, values), seed)["outcome"]
    return figures_of(out, values.get("radius_m", 0.27)), outcome in ("reached", "forced_mover"), off_the_truth(out)


def name(what, variant):
    if what == "movers":
        speed, radius, count, *legs = variant
        return f"{count} {'people on two legs' if legs else 'movers'} of {speed} m/s, {radius:.2f} m about their middle"
    fov, beams, rate, reach, noise, lost, mount, turns = (*variant, None, None)[:8]
    turned = ", one beam after another" if turns else ", its turn begins straight ahead" if mount else ""
    dropped = f", {100 * lost:.0f} % lost" if lost else ""
    return f"{fov} degrees, {beams} beams, {rate} Hz, {reach} m, noise {1000 * noise:.0f} mm{dropped}{turned}"


def row(what, variant, runs):
    figures, reached, off = zip(*runs)
    poses = f"{sum(off) / len(off):.2f}, {max(off):.2f} m"
    return f"| {name(what, variant)} | {means(figures)} | {poses} | {sum(reached)} of {len(runs)} |"


def main():
    options = arguments()
    drives = [(m, s) for m in MAPS for s in options.seeds]
    results = all_of(run, [(options, v, *d) for v in VARIANTS[options.what] for d in drives], options.jobs)
    print_head(options.what, *FIGURES, "pose off at worst, mean and greatest", "goal reached")
    for k, variant in enumerate(VARIANTS[options.what]):
        print(row(options.what, variant, results[k * len(drives) : (k + 1) * len(drives)]))


if __name__ == "__main__":
    main()
