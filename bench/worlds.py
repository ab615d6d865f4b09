#!/usr/bin/env python3
"""Writes worlds and the campaign that drives in them: jaywalk campaign FOLDER/campaign.toml --out RUNS, then jaywalk report RUNS.

    bench/worlds.py doors --seeds 101-140 --out out/doors
    bench/worlds.py posts --data ../shared/data/barn --movers 4 --seeds 302-303 --out out/posts

The same kind, seeds and data give the same files. A kind is a function in bench/world_kinds.
"""
import argparse
import pathlib

from command_line import seeds_of
from world_kinds import buildings, drawn, encounters, given, walked
from world_kinds.folder import Folder

KINDS = {  # what writes it, its seeds by default, what stays of runs: tracks are scored with all of them
    "doors": (drawn.doors, "101-140", "failures"),
    "ahead": (drawn.ahead, "5701-5750", "failures"),
    "headings": (drawn.headings, "5601-5650", "failures"),
    "rooms": (drawn.rooms, "601-700", "failures"),
    "passages": (walked.passages, "302-303", "failures"),
    "people": (walked.people, "1", "all"),
    "crossings": (walked.crossings, "501-525", "failures"),
    "encounters": (encounters.encounters, "831", "failures"),
    "dynabarn": (walked.dynabarn, "1", "all"),
    "dynabarn_loops": (walked.dynabarn_loops, "701", "failures"),
    "posts": (given.posts, "302-305", "all"),
    "barn": (given.barn, "701", "failures"),
    "hall": (given.hall, "301-306", "all"),
    "scanners": (given.scanners, "301-304", "all"),
    "buildings": (buildings.buildings, "1-25", "failures"),
    "movers": (given.movers, "301-304", "all"),
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS, metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--seeds", type=seeds_of, help="one, or first-last")
    parser.add_argument("--data", type=pathlib.Path, help="barn, posts, dynabarn, people, crossings, buildings: the folder of their files")
    parser.add_argument("--width", type=float, default=0.90, help="doors: how wide, m")
    parser.add_argument("--model", help="rooms: of every robot, wheelchair say; else each room has its own")
    parser.add_argument("--movers", type=int, default=0, help="posts, buildings: how many walk among them")
    parser.add_argument("--out", type=pathlib.Path, help="default: out/worlds/KIND")
    options = parser.parse_args()
    options.seeds = options.seeds or seeds_of(KINDS[options.kind][1])
    options.out = options.out or pathlib.Path("out/worlds", options.kind)
    if options.data is None and options.kind in ("barn", "posts", "dynabarn", "dynabarn_loops", "people", "crossings", "buildings"):
        parser.error(f"{options.kind}: its files come with --data FOLDER")
    return options


def main():
    options = arguments()
    write, _, keep = KINDS[options.kind]
    folder = Folder(options.out)
    write(folder, options)
    print(f"jaywalk campaign {folder.campaign(options.kind, keep)} --out out/{options.kind}")


if __name__ == "__main__":
    main()
