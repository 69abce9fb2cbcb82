"""Mutated files through every reader: ``python -m tests.thorough.fuzz [TARGET ...] --count 20000``.

Each target is a module of this folder with three functions: ``seeds(folder)`` writes small valid files, ``mutate(content, rng)`` changes
one, and ``check(path)`` reads the result, which must be refused with a sentence or be read. Checks run in a child process with limits on
time and memory, so that a crash, a hang or excessive memory is a finding too; the file that caused it is kept.
"""

import argparse
import importlib
import json
import multiprocessing
import os
import resource
import shutil
import signal
import sys
import tempfile
import traceback
from pathlib import Path

import numpy as np

TARGETS = ("recipes", "labels", "recordings", "corpora")
SECONDS_EACH = 20
MEMORY = 8_000_000_000  # bytes of address space


def fuzz(target, count, seed, keep):
    """Run ``count`` mutations and return the findings; the file of each is kept in ``keep``."""
    module = importlib.import_module(f"tests.thorough.fuzz.{target}")
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "seeds").mkdir()
        contents = [(path.suffix, path.read_bytes()) for path in module.seeds(place / "seeds")]
        first = 0
        while first < count:
            first, sentence = _batch(module, contents, range(first, count), seed, place)
            if sentence is not None:
                kept = keep / f"{target}-{seed}-{first}"
                keep.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(next(place.glob("mutated*")), kept)
                findings.append({"target": target, "number": first, "file": str(kept), "what": sentence})
                first += 1
    return findings


def _batch(module, contents, numbers, seed, place):
    """Check mutations in a child until one fails; return its number and the failure, or the number after the last and None."""
    context = multiprocessing.get_context("fork")
    at, told = context.Value("q", numbers.start), context.SimpleQueue()
    child = context.Process(target=_work, args=(module, contents, numbers, seed, place, at, told))
    child.start()
    child.join()
    if child.exitcode == 0:
        return numbers.stop, None
    reason = {-signal.SIGALRM: f"no end after {SECONDS_EACH} s", 1: None}.get(
        child.exitcode, f"ended with {child.exitcode}"
    )
    return at.value, "no reason given" if reason is None and told.empty() else reason or told.get()


def _work(module, contents, numbers, seed, place, at, told):
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for number in numbers:
        at.value = number
        signal.alarm(SECONDS_EACH)
        try:
            suffix, content = _mutated(module, contents, number, seed)
            for last in place.glob("mutated*"):
                last.unlink()
            path = place / f"mutated{suffix}"
            path.write_bytes(content)
            module.check(path)
        except BaseException:  # noqa: BLE001 - whatever it is, it is the finding
            told.put(traceback.format_exc(limit=-4))
            sys.exit(1)
        signal.alarm(0)


def _mutated(module, contents, number, seed):
    suffix, content = contents[number % len(contents)]
    return suffix, module.mutate(content, np.random.default_rng([seed, number]))


def main():
    """Run the command line; exit code 1 if anything was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("targets", nargs="*", default=TARGETS, metavar="TARGET", help=", ".join(TARGETS))
    parser.add_argument("--count", type=int, default=2000, help="mutations of each target")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, default=Path("out/fuzz"), help="folder for the files of findings")
    given = parser.parse_args()
    os.environ["OMP_NUM_THREADS"] = "1"  # OpenMP threads do not survive a fork
    findings = []
    for target in given.targets:
        found = fuzz(target, given.count, given.seed, given.keep)
        findings += found
        sys.stderr.write(f"{target}: {given.count} mutations, {len(found)} findings\n")
    sys.stdout.write(json.dumps(findings, indent=1) + "\n")
    sys.exit(bool(findings))


if __name__ == "__main__":
    main()
