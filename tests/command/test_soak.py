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
    print("ok")


if __name__ == "__main__":
    main()
