"""What a batch of 1000 shocks costs in Python beside the same batch in Rust: whole processes, in turns.

    target/python-venv/bin/python crates/opshock-python/tests/overhead.py [PAIRS]

Prints a line a pair and the median ratios of processor and wall time; fails when the answers differ or a ratio is above 1.02.
"""

import glob
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BATCH = """
import opshock
study = opshock.Study("studies/fig13/study.toml", {"resolution.preset": "coarse"})
scene = study.scene(ramp="none", pulse_ms=2, sign="+")
runs = opshock.simulate_many((scene, 100 + 0.5 * k) for k in range(1000))
total = 0.0
for run in runs:
    total += run.min_clearance_m
print(total)
"""


def measured(command: list[str]) -> tuple[float, float, float]:
    """Answer, processor time and wall time of a process, s."""
    before, began = os.times(), time.monotonic()
    done = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT)
    wall_s, after = time.monotonic() - began, os.times()
    used_s = after.children_user + after.children_system - before.children_user - before.children_system
    return float(done.stdout), used_s, wall_s


def main() -> None:
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    programs = [path for path in glob.glob(str(ROOT / "target/release/deps/batch-*")) if os.access(path, os.X_OK)]
    rust = [max(programs, key=os.path.getmtime)]
    python = [sys.executable, "-c", BATCH]
    ratios = []
    for number in range(pairs):
        # The first of a pair is now the one, now the other.
        order = [rust, python] if number % 2 == 0 else [python, rust]
        times = {command[0]: measured(command) for command in order}
        (sum_rust, cpu_rust, wall_rust), (sum_python, cpu_python, wall_python) = times[rust[0]], times[python[0]]
        if sum_rust != sum_python:
            sys.exit(f"the answers differ: {sum_rust!r} in Rust, {sum_python!r} in Python")
        ratios.append((cpu_python / cpu_rust, wall_python / wall_rust))
        print(f"Rust {cpu_rust:.2f} s processor, {wall_rust:.2f} s wall; Python {cpu_python:.2f} s, {wall_python:.2f} s", flush=True)
    cpu, wall = (statistics.median(column) for column in zip(*ratios, strict=True))
    print(f"Python over Rust, median of {pairs} pairs: {cpu:.4f} processor, {wall:.4f} wall")
    if max(cpu, wall) > 1.02:
        sys.exit("more than 2 %")


main()
