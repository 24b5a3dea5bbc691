#!/usr/bin/env python3
"""scripts/soak: which seeds it runs, what it says of those that fail, and that it fails then.

    test_soak.py <source folder>
"""
import subprocess
import sys
import tempfile
from pathlib import Path

# Appends the seeds that it is asked for to a file; seed 7 fails, among others and alone.
TEST = """#!/bin/sh
for seed in $(seq $CM1E_TEST_SEED $((CM1E_TEST_SEED + CM1E_TEST_SEEDS - 1))); do
  echo $seed >>"$0.seeds"
  [ $seed != 7 ] || { echo "x.c:1:F:all: seed 7, the reason"; exit 1; }
done
"""


# Prints what so many scenarios print; that of seed 7 fails, and is made smaller.
SCENARIO = """#!/bin/sh
while [ $# -gt 0 ]; do case $1 in --seed) first=$2; shift;; --count) count=$2; shift;; --shrink) small=1;; esac; shift; done
[ -z "$small" ] || { echo "made smaller: shrunk-$first.scenario"; exit 1; }
result=0
for seed in $(seq $first $((first + ${count:-1} - 1))); do
  echo "fault lose $((seed % 3 - 1))"
  if [ $seed = 7 ]; then
    echo "speed 7 0.5 hard stop"; echo "run 1 0.2 0 10"; echo "seed 7: FAIL: still at cycle 3: the reason"; result=1
  else echo "speed $seed 0.01 lost frames"; echo "run 0 -0.02 2 100"; fi
done
exit $result
"""


def check_scenarios(folder):
    program = folder / "bin/scenario"
    program.parent.mkdir(exist_ok=True)
    program.write_text(SCENARIO)
    program.chmod(0o755)

    def soak(*words):
        command = [Path(sys.argv[1]) / "scripts/soak", "--build", folder, "--no-build", *words]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=100,
                              check=False)
        return done.returncode, done.stdout

    code, said = soak("--scenarios", "250", "--seed", "1")
    assert code == 1 and "bin/scenario --seed 7" in said and "the reason" in said, said
    assert "shrunk-7.scenario" in said and said.count("FAIL") == 1, said
    assert "250 scenarios from seed 1 on: 1 failed. 24910 cycles. 498 axes" in said, said
    assert "| lose | 250 | 167 | 0 | 1 |" in said, said
    assert "| hard stop | 50.00 % | 7 |\n| lost frames | 1.00 % | " in said, said
    code, said = soak("--scenarios", "250", "--seed", "8")
    assert code == 0 and "250 scenarios from seed 8 on: 0 failed" in said and "FAIL" not in said, said
    code, said = soak("--hours", "0.0003")
    assert code == 0 and " 0 failed" in said, said


def main():
    with tempfile.TemporaryDirectory() as folder:
        test = Path(folder) / "bin/test_x_random"
        test.parent.mkdir()
        test.write_text(TEST)
        test.chmod(0o755)

        def soak(*words):
            command = [Path(sys.argv[1]) / "scripts/soak", "--build", folder, "--no-build", *words, test.name]
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=100,
                                  check=False)
            return done.returncode, done.stdout

        code, said = soak("--seeds", "40", "--from", "1")
        assert code == 1, said
        assert "CM1E_TEST_SEED=7 " in said and "the reason" in said and said.count("CM1E_TEST_SEED=") == 1, said
        assert "40 seeds, 1 failed" in said, said
        seeds = {int(line) for line in Path(f"{test}.seeds").read_text().split()}
        assert seeds == set(range(1, 41)), seeds

        code, said = soak("--seeds", "40", "--from", "100")
        assert code == 0 and "40 seeds, 0 failed" in said and "CM1E_TEST_SEED=" not in said, said
        code, said = soak("--minutes", "0.01")
        assert code == 0 and " from seed " in said, said
        code, said = soak()
        assert code == 2 and "--minutes" in said, said
        code, said = soak("--wire")
        assert code == 2 and "--wire needs --hours" in said, said
        check_scenarios(Path(folder))
    print("ok")


if __name__ == "__main__":
    main()
