"""Compares the benchmarks of two builds in interleaved runs: ratios of CPU times with confidence intervals.

./concord bench --compare REV calls this. A round runs both programs once each, the order changing from round to round
(A B, B A, ...), so that drift of the machine's speed hits both alike; a run repeats every benchmark a few times. The
round's ratio is that of the two medians; the answer is the median over rounds, its interval a bootstrap over rounds.
"""

import argparse
import json
import os
import random
import re
import statistics
import subprocess
import sys
from pathlib import Path

RESAMPLES = 4000  # the interval's ends then scatter by less than a tenth of its width
SEED = 1
NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}


class BadInput(Exception):
    """What was asked for cannot be compared: exit code 2."""


class BrokenRun(Exception):
    """A benchmark program failed: exit code 3."""


class Side:
    """One build: its program, the sources it reads its scenes from, and its name in messages."""

    def __init__(self, name, program, home):
        self.name, self.program, self.home = name, program, home

    def start(self, *options):
        environment = dict(os.environ, CONCORD_HOME=self.home)
        environment.setdefault("OPENBLAS_NUM_THREADS", "1")
        run = subprocess.run([self.program, *options], capture_output=True, text=True, env=environment)
        if run.returncode != 0:
            raise BrokenRun(f"benchmarks of {self.name}: exit code {run.returncode}\n{run.stderr.strip()}")
        return run.stdout

    def names(self, wanted):
        try:
            listed = self.start("--benchmark_list_tests=true", f"--benchmark_filter={wanted}")
        except BrokenRun as error:
            raise BadInput(f"FILTER: found {wanted!r}; allowed: a regular expression of benchmark names ({error})") from None
        return [line.strip() for line in listed.splitlines() if line.strip() and not line.startswith("Failed to match")]

    def times(self, names, repeats, seconds):
        """{benchmark: median time of a run in ns}"""
        exactly = "^(" + "|".join(re.escape(name) for name in names) + ")$"
        return read_times(self.start("--benchmark_format=json", f"--benchmark_filter={exactly}",
                                     f"--benchmark_repetitions={repeats}", f"--benchmark_min_time={seconds}"))


def counts_wall_time(name):
    """A run of several threads is timed by the clock (its CPU time is that of the calling thread alone), and what asks for it."""
    match = re.search(r"\bthreads:(\d+)", name)
    return name.endswith("/real_time") or (match is not None and int(match.group(1)) > 1)


def read_times(text):
    """{benchmark: median time in ns} of google-benchmark's JSON; CPU time but for runs of several threads."""
    samples = {}
    for entry in json.loads(text)["benchmarks"]:
        if entry.get("error_occurred"):
            raise BrokenRun(f"{entry['name']}: {entry.get('error_message', 'failed')}")
        if entry.get("run_type") != "iteration":
            continue
        name = entry["run_name"]
        time = entry["real_time" if counts_wall_time(name) else "cpu_time"]
        samples.setdefault(name, []).append(time * NANOSECONDS[entry["time_unit"]])
    return {name: statistics.median(times) for name, times in samples.items()}


def interval(ratios, resamples=RESAMPLES):
    """Median of the rounds' ratios and its 95 % interval (percentile bootstrap over rounds, fixed seed)."""
    generator = random.Random(SEED)
    medians = sorted(statistics.median(generator.choices(ratios, k=len(ratios))) for _ in range(resamples))
    return statistics.median(ratios), medians[int(0.025 * resamples)], medians[int(0.975 * resamples) - 1]


def verdict(low, high):
    if low <= 1 <= high:
        return "no difference seen"
    return "faster" if high < 1 else "slower"


def summarise(rounds):
    """One row a benchmark from [(old {name: ns}, new {name: ns}), ...], in the order of the first run."""
    rows = []
    for name in rounds[0][0]:
        pairs = [(old[name], new[name]) for old, new in rounds if name in old and name in new]
        ratio, low, high = interval([new / old for old, new in pairs])
        rows.append({"name": name, "time": "wall" if counts_wall_time(name) else "cpu",
                     "old_ns": statistics.median(old for old, _ in pairs), "new_ns": statistics.median(new for _, new in pairs),
                     "ratio": ratio, "low": low, "high": high, "rounds": len(pairs), "verdict": verdict(low, high)})
    return rows


def time_text(ns):
    for unit in ("s", "ms", "us"):
        if ns >= NANOSECONDS[unit]:
            return f"{ns / NANOSECONDS[unit]:.3g} {unit}"
    return f"{ns:.3g} ns"


def table(rows, old, new):
    width = max([len(row["name"]) for row in rows] + [9])
    lines = [f"ratio: time of {new} over time of {old}; below 1 is faster",
             f"{'benchmark':{width}}  {'old':>9}  {'new':>9}  {'ratio':>6}  95 % interval"]
    for row in rows:
        lines.append(f"{row['name']:{width}}  {time_text(row['old_ns']):>9}  {time_text(row['new_ns']):>9}  {row['ratio']:6.3f}"
                     f"  {row['low']:.3f} to {row['high']:.3f}  {row['verdict']}")
    return "\n".join(lines)


def common(old, new, wanted):
    """Benchmarks that both sides have; tells of the others."""
    there, here = old.names(wanted), new.names(wanted)
    for side, names, others in ((old, there, here), (new, here, there)):
        for name in names:
            if name not in others:
                print(f"only in {side.name}: {name}")
    names = [name for name in there if name in here]
    if not names:
        raise BadInput(f"FILTER: found {wanted!r}, which matches no benchmark that both {old.name} ({len(there)}) and {new.name} "
                       f"({len(here)}) have; ./concord bench --benchmark_list_tests shows all")
    return names


def measure(old, new, names, arguments):
    rounds = []
    for k in range(arguments.rounds):
        order = (old, new) if k % 2 == 0 else (new, old)
        times = {side: side.times(names, arguments.repeats, arguments.seconds) for side in order}
        rounds.append((times[old], times[new]))
        print(f"round {k + 1} of {arguments.rounds} done", file=sys.stderr, flush=True)
    return rounds


def positive(convert, least):
    def read(text):
        value = convert(text)
        if not value >= least:
            raise argparse.ArgumentTypeError(f"found {text}; allowed: {least} or more")
        return value
    return read


def main(given):
    parser = argparse.ArgumentParser(prog="./concord bench --compare REV", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("filter", nargs="?", default="-edge:100|setup", metavar="FILTER",
                        help="regular expression; -REGEX: all but these (default: %(default)s, neither the million particles nor set-up, which take long)")
    parser.add_argument("--rounds", type=positive(int, 5), default=10, help="5 or more, default %(default)s")
    parser.add_argument("--repeats", type=positive(int, 1), default=3, help="of every benchmark in a round, default %(default)s")
    parser.add_argument("--seconds", type=positive(float, 0.001), default=0.1, help="a repeat lasts at least this long, default %(default)s")
    parser.add_argument("--old", nargs=3, required=True, help=argparse.SUPPRESS)  # name, program, home: set by the launcher
    parser.add_argument("--new", nargs=3, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--out", required=True, type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args(given)
    old, new = Side(*arguments.old), Side(*arguments.new)
    try:
        names = common(old, new, arguments.filter)
        rows = summarise(measure(old, new, names, arguments))
    except BadInput as error:
        print(f"concord: {error}", file=sys.stderr)
        return 2
    except BrokenRun as error:
        print(f"concord: {error}", file=sys.stderr)
        return 3
    print(table(rows, old.name, new.name))
    arguments.out.write_text(json.dumps({"old": old.name, "new": new.name, "rounds": arguments.rounds,
                                         "repeats": arguments.repeats, "seconds": arguments.seconds, "rows": rows}, indent=1) + "\n")
    print(f"written: {arguments.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
