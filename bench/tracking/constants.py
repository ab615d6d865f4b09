#!/usr/bin/env python3
"""The named constants of perception, and how many: docs/explanation/results.md#tracking-and-poses, "Constants".

    bench/tracking/constants.py
    bench/tracking/constants.py planner/localization

One row each: file, name, value, and the comment beside it.
"""
import argparse
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
STATEMENT = re.compile(r"constexpr [^;()]*?\b(k[A-Z]\w*\s*=[^;]*);(?:[ \t]*//[/<!]*[ \t]*(.*))?")
PART = re.compile(r"\b(k[A-Z]\w*)\s*=\s*(.*?)(?=,\s*k[A-Z]\w*\s*=|$)", re.S)


def constants(folder):
    """(file, name, value, comment) of all in its sources."""
    for path in sorted(p for p in folder.glob("*.*") if p.suffix in (".h", ".cc")):
        for values, comment in STATEMENT.findall(path.read_text()):
            for name, value in PART.findall(values):
                yield path.name, name, " ".join(value.split()), comment


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "planner/tracking")
    folder = parser.parse_args().folder
    rows = list(constants(folder))
    if not rows:
        sys.exit(f"{folder}: no constant in its *.h and *.cc: give a folder of sources")
    print("| file | constant | value | |\n|---|---|---|---|")
    for row in rows:
        print(f"| {' | '.join(row)} |")
    print(f"\n{len(rows)} constants")


if __name__ == "__main__":
    main()
