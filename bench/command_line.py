"""What the scripts here make of what they are given: where it is of no use, one line that says why, and exit code 2."""
import argparse
import concurrent.futures
import contextlib
import gzip
import pathlib
import re
import subprocess
import sys
import zlib


def refuse(cause, remedy):
    print(f"{pathlib.Path(sys.argv[0]).name}: {cause}; {remedy}", file=sys.stderr)
    sys.exit(2)


def seeds_of(text):
    """A range of seeds: one, or first-last."""
    given = re.fullmatch(r"(\d+)(?:-(\d+))?", text)
    if not given:
        raise argparse.ArgumentTypeError(f"{text}: no seeds; give one, or first-last")
    seeds = range(int(given[1]), int(given[2] or given[1]) + 1)
    if not seeds:
        raise argparse.ArgumentTypeError(f"{text}: the last seed is before the first")
    return seeds


def said_by(program, *arguments):
    """What a program prints."""
    if not program.exists():
        refuse(f"{program}: not there", "build the project first (README.md)")
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        refuse(f"{program.name} {' '.join(map(str, arguments))}: exit {done.returncode}", done.stderr.strip() or "it said nothing")
    return done.stdout


def all_of(job, inputs, at_once):
    """What a job makes of each input, in their order."""
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        return list(pool.map(job, inputs))


@contextlib.contextmanager
def reading(path, expected):
    """Around what opens and understands a file; `expected` says what to give instead."""
    try:
        yield
    except OSError as error:
        refuse(f"{path}: {error.strerror or error}", f"give {expected}")
    except (EOFError, zlib.error):
        refuse(f"{path}: the compressed file is damaged or cut", "fetch it again")
    except (ValueError, KeyError, IndexError, TypeError, AttributeError):
        refuse(f"{path}: not what was expected", f"give {expected}")


def files_in(folder, pattern, named, remedy):
    files = sorted(folder.glob(pattern))
    if not files:
        refuse(f"{folder}: no {named} in it", remedy)
    return files


def opened(path):
    """A text, plain or gzip."""
    return (gzip.open if str(path).endswith(".gz") else open)(path, "rt")


def read_lines(path, expected, understand):
    """What `understand` makes of the words of each line, but for empty ones and comments."""
    rows = []
    with reading(path, expected), opened(path) as lines:
        for number, line in enumerate(lines, 1):
            if line.strip() and line[0] != "#":
                try:
                    rows.append(understand(line.split()))
                except (ValueError, IndexError, OverflowError):
                    refuse(f"{path}:{number}: a line that is none", "repair or delete it")
    return rows
