#!/usr/bin/env python3
"""real_time_runner: a test that fails is run again where the machine stood still, and only there.

test_runner.py RUNNER
"""
import os
import subprocess
import sys
import tempfile

STAND_STILL = "kill -STOP $PPID; sleep 0.05; kill -CONT $PPID; sleep 0.1; "  # so the runner wakes too late


def runs(script):
    """The exit status, how often it ran, and what was said."""
    with tempfile.TemporaryDirectory() as folder:
        count = os.path.join(folder, "count")
        done = subprocess.run([sys.argv[1], "sh", "-c", f"echo x >>{count}; " + script], capture_output=True, text=True,
                              env={**os.environ, "COUNT": count}, timeout=60)
        with open(count, encoding="ascii") as file:
            return done.returncode, len(file.readlines()), done.stdout


def main():
    for script, status, times in (("exit 0", 0, 1), ("exit 77", 77, 1), (STAND_STILL + "exit 0", 0, 1),
                                  (STAND_STILL + "exit 77", 77, 1), (STAND_STILL + "exit 4", 4, 5),
                                  (STAND_STILL + "kill -9 $$", 137, 5), (STAND_STILL + "exit 78", 77, 2),
                                  (STAND_STILL + 'test $(wc -l <"$COUNT") = 2', 0, 2)):
        found = runs(script)
        assert found[:2] == (status, times) and found[2].count("RUNS AGAIN: ") == times - 1, f"{script}: {found}"
    # A failure without a pause is one. Short, so that one of a few tries meets no pause of this machine's own.
    for status in (3, 78):
        assert any(runs(f"exit {status}")[:2] == (status, 1) for _ in range(20)), f"{status} without a pause runs again"
    assert subprocess.run([sys.argv[1], "/no/such/program"], capture_output=True).returncode == 127


main()
