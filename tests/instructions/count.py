"""Counts instructions of the programs of this folder under valgrind and judges them.

count.py judge BIN FILE         what is switched off costs what it costs when it is not compiled in, and no kernel needs
                                more instructions than FILE says
count.py update BIN FILE        writes FILE anew

BIN is the folder of the built programs. Exit codes: 0 all well; 1 a count is off; 2 cannot count; 77 all well, but FILE
is of another compiler (ctest shows the test as skipped).
"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

COSTS_NOTHING = 0.001  # relative difference that counts as none
RISE = 0.03  # relative rise of a kernel that fails
SKIPPED = 77

# (what is off, case that has it off, program without it, case of the whole program that has it on)
FEATURES = (
    ("contact", "plain", "count_without_contact", "contact"),
    ("viscosity", "contact", "count_without_viscosity", "contact_viscous"),
    ("plasticity", "plain", "count_without_plasticity", "plastic_elastic_3d"),
    ("return map", "plastic_elastic", "count_without_return_map", "plastic_flowing"),
    ("damping", "plain", "count_without_damping", "damped"),
    ("output", "plain", "count_without_output", "recorded"),
    ("regions at rest", "pulse", "count_without_rest", "pulse_resting"),
    ("rest, all moves", "plain", "count_without_rest", "pulse_resting"),
    ("fracture", "plain", "count_without_fracture", "breakable"),
    ("penalty of SPH", "sph_plain", "count_without_penalty", "sph_penalty"),
    ("viscosity of SPH", "sph_penalty", "count_without_viscosity", "sph_viscous"),
)
# A body of which half the groups flow, between none and all of them: (none, half, all).
FLOWING = [tuple(f"stress_plastic_{where}_{part}" for part in ("0", "half", "all")) for where in ("plane", "3d")]


class CannotCount(Exception):
    pass


def dumps(folder):
    """{name: instructions} of what counted() wrote."""
    found = {}
    for path in folder.iterdir():
        text = path.read_text(errors="replace")
        name = re.search(r"^desc: Trigger: Client Request: (.+)$", text, re.M)
        total = re.search(r"^(?:summary|totals): (\d+)", text, re.M)
        if name and total:
            found[name.group(1).strip()] = int(total.group(1))
    return found


def count(program, cases=()):
    """({case: instructions a particle a step}, what the program was compiled with)."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--instr-atstart=no", "--quiet",
                   f"--callgrind-out-file={folder}/out", str(program), *cases]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            raise CannotCount(f"{program} {' '.join(cases)}: exit code {run.returncode}\n{run.stdout}{run.stderr}")
        found = dumps(Path(folder))
    return read_counts(run.stdout, found)


def read_counts(printed, found):
    """From what the program printed and the dumps it left."""
    counts, compiled = {}, ""
    for line in printed.splitlines():
        if match := re.fullmatch(r"compiled (.+)", line):
            compiled = match.group(1)
        if match := re.fullmatch(r"case (\S+) steps (\d+) particles (\d+)", line):
            name, steps, particles = match.group(1), int(match.group(2)), int(match.group(3))
            try:
                counts[name] = (found[f"{name} twice"] - found[f"{name} once"]) / (steps * particles)
            except KeyError as missing:
                raise CannotCount(f"{name}: no count of {missing}; is this valgrind's callgrind?") from None
    return counts, compiled


def judge_features(whole, without):
    """Lines of a table and whether all is well. whole: {case: count}; without: {program: {case: count}}."""
    lines, well = [f"{'off':18} {'case':16} {'there':>9} {'not there':>9} {'difference':>10}   {'on':>9}"], True
    for feature, off, program, on in FEATURES:
        here, lean, used = whole[off], without[program][off], whole[on]
        difference = here / lean - 1
        verdict = []
        if abs(difference) > COSTS_NOTHING:
            verdict.append(f"more than {COSTS_NOTHING:.1%}: what is off is paid for")
        if abs(used / here - 1) <= COSTS_NOTHING:
            verdict.append("switched on it changes nothing either: this test sees nothing")
        well = well and not verdict
        lines.append(f"{feature:18} {off:16} {here:9.2f} {lean:9.2f} {difference:+10.3%}   {used:9.2f}  {'; '.join(verdict)}")
    return lines, well


def judge_flowing(counts):
    """Whether elastic particles pay for those that flow elsewhere: the half-flowing body costs the mean of the other two."""
    lines, well = [], True
    for none, half, everything in FLOWING:
        difference = counts[half] / (0.5 * (counts[none] + counts[everything])) - 1
        verdict = []
        if abs(difference) > COSTS_NOTHING:
            verdict.append(f"more than {COSTS_NOTHING:.1%}: elastic particles pay for the flow of others")
        if counts[everything] < counts[none] * (1 + COSTS_NOTHING):
            verdict.append("flow costs nothing: this test sees nothing")
        well = well and not verdict
        lines.append(f"{half}: {counts[half]:.2f}, {difference:+.3%} from the mean of {counts[none]:.2f} (elastic) and "
                     f"{counts[everything]:.2f} (all flow)  {'; '.join(verdict)}")
    return lines, well


def read_file(text):
    """(compiled with, {case: count}) of the stored counts."""
    compiled, counts = "", {}
    for line in text.splitlines():
        if match := re.fullmatch(r"# compiled: (.+)", line):
            compiled = match.group(1)
        elif line and not line.startswith("#"):
            name, value = line.split()
            counts[name] = float(value)
    return compiled, counts


def file_text(compiled, counts):
    rows = "".join(f"{name:32} {value:10.1f}\n" for name, value in counts.items())
    return f"""# Instructions a particle a step, counted by valgrind: what the kernels cost, not whether they are right.
# A rise above {RISE:.0%} fails the test. Where it is worth it: {UPDATE}
# compiled: {compiled}
{rows}"""


UPDATE = "/usr/bin/python3 tests/instructions/count.py update build/release/bin tests/instructions/counts.txt"


def judge_kernels(stored, counts):
    lines, well = [f"{'kernel':32} {'stored':>10} {'now':>10} {'change':>8}"], True
    for name in sorted(stored.keys() | counts.keys()):
        if name not in stored or name not in counts:
            lines.append(f"{name:32} {'is not in the file' if name in counts else 'is in the file alone'}: update it")
            well = False
            continue
        change = counts[name] / stored[name] - 1
        remark = ""
        if change > RISE:
            remark, well = f"a rise above {RISE:.0%}", False
        elif change < -RISE:
            remark = "cheaper than the file says: please update it, or a later rise goes unseen"
        lines.append(f"{name:32} {stored[name]:10.1f} {counts[name]:10.1f} {change:+8.2%}  {remark}")
    if not well:
        lines.append(f"If this is meant to be so, say why in the commit and update the file:\n  {UPDATE}")
    return lines, well


def kernels(folder):
    counts, compiled = count(folder / "count_steps")
    counts.update(count(folder / "count_stress")[0])
    return counts, compiled


def features(folder, whole):
    """Prints the judgement on what is off; whether all is well. whole: {case: count}."""
    without = {}
    for program in sorted({program for _, _, program, _ in FEATURES}):
        without[program], _ = count(folder / program, [off for _, off, one, _ in FEATURES if one == program])
    lines, well = judge_features(whole, without)
    more, also_well = judge_flowing(whole)
    print("\n".join(lines + more))
    return well and also_well


def main(arguments):
    if len(arguments) != 3 or arguments[0] not in ("judge", "update"):
        print(__doc__, file=sys.stderr)
        return 2
    job, folder, path = arguments[0], Path(arguments[1]), Path(arguments[2])
    if shutil.which("valgrind") is None:
        print("valgrind is not here: apt-get install valgrind (./concord test does)", file=sys.stderr)
        return 2
    try:
        counts, compiled = kernels(folder)
        if job == "update":
            path.write_text(file_text(compiled, counts))
            print(f"wrote {path}")
            return 0
        free = features(folder, counts)
        stored_with, stored = read_file(path.read_text())
        if stored_with != compiled:
            print(f"SKIPPED: {path.name} was counted with {stored_with}; this is {compiled}. Counts of different compilers"
                  " do not compare; those of Debian 12 are the ones kept.")
            return SKIPPED if free else 1
        lines, well = judge_kernels(stored, counts)
        print("\n".join(lines))
        return 0 if well and free else 1
    except (CannotCount, OSError) as error:
        print(f"count.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
