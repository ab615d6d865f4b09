#!/usr/bin/env python3
"""How much of a recording `kill -9` costs: python3 bench/kill_loss.py [--runs 20] [--scenario FILE] [--part-bytes N]

Runs the controller at wall-clock pace, watches its recording grow, kills it at some moment and counts what is on the
disk. Ticks are a fixed time apart, and one is written no earlier than it was lived through: the least of "when the file
had so many ticks" less "so many ticks' time" is when the run began. What was lost is the time from the last tick on
the disk to the kill.
"""
import argparse
import json
import os
import pathlib
import random
import signal
import struct
import subprocess
import tempfile
import time

from command_line import require_built

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = struct.Struct("<8sII")  # magic, version, bytes of the setup
ENTRY = struct.Struct("<III")  # length, its inverse, check sum


def entries_in(recording):
    """Where each whole tick ends in the file, and a tick's time (s)."""
    magic, _, setup_bytes = HEAD.unpack_from(recording)
    if magic != b"JAYWALK\n":
        raise ValueError("no recording")
    rate_hz = json.loads(recording[HEAD.size:HEAD.size + setup_bytes])["rate_hz"]
    at, ends = HEAD.size + setup_bytes + 4, []
    while at + ENTRY.size <= len(recording):
        length = ENTRY.unpack_from(recording, at)[0]
        at += ENTRY.size + length
        if length == 0 or at > len(recording):
            break
        ends.append(at)
    return ends, 1.0 / rate_hz


def recordings(folder):
    """Its parts, oldest first, or the whole."""
    return sorted(folder.glob("part-*/recording.jwr")) or [folder / "recording.jwr"]


def watch(folder, until):
    """(when, file, bytes) each time the newest recording has grown."""
    grown, before = [], None
    while time.monotonic() < until:
        file = recordings(folder)[-1]
        now = file, file.stat().st_size if file.exists() else 0
        if now != before:
            grown.append((time.monotonic(), *now))
            before = now
        time.sleep(0.001)
    return grown


def lost_s(program, scenario, after_s, folder, part_bytes):
    run = subprocess.Popen([program, "sim", scenario, "--realtime", "--out", folder, "--keep-parts", "1000",
                            "--part-bytes", str(part_bytes)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    grown = watch(folder, time.monotonic() + after_s)
    killed = time.monotonic()
    os.kill(run.pid, signal.SIGKILL)
    run.wait()
    ticks, ticks_at = 0, {}
    for file in recordings(folder):
        content = file.read_bytes()
        ends, tick_s = entries_in(content) if content else ([], tick_s)
        ticks_at |= {(file, end): ticks + number + 1 for number, end in enumerate(ends)}
        ticks += len(ends)
    begun = min(when - ticks_at[file, size] * tick_s for when, file, size in grown if (file, size) in ticks_at)
    return killed - begun - ticks * tick_s


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--scenario", type=pathlib.Path, default=ROOT / "hal/sim/scenarios/crossing.toml")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/jaywalk")
    parser.add_argument("--part-bytes", type=int, default=0)
    options = parser.parse_args()
    require_built(options.program)
    draw = random.Random(1)
    losses = []
    for run in range(options.runs):
        with tempfile.TemporaryDirectory() as folder:
            losses.append(lost_s(options.program, options.scenario, draw.uniform(3.0, 5.0), pathlib.Path(folder),
                                 options.part_bytes))
        print(f"run {run + 1}: {1000 * losses[-1]:.0f} ms lost", flush=True)
    losses.sort()
    print(f"{len(losses)} runs: median {1000 * losses[len(losses) // 2]:.0f} ms, most {1000 * losses[-1]:.0f} ms")


if __name__ == "__main__":
    main()
