#!/usr/bin/env python3
"""scripts/mutate: which defects it can plant in a source, and that it leaves comments, texts and the lines alone;
which tests it runs for a line, and its table; that no entry of its list of equivalent defects is old; that a program
with a defect, which may wait for ever, ends with the script, however that ends; and that a test which could not run
has not seen a defect.

    test_mutate.py <source folder>
"""
import importlib.machinery
import importlib.util
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCE = '''#define MOST 7
/* 1 < 2 && true; */
static bool far(const axis_t *axis, double way)
{
    char where[32], text[256] = "3 + 4";
    if (way > 2.5 && axis->count == 1)
        return false;
    axis->now = stop(axis);
    write(text);
    return way < -turn / 2.0 + 0.0;
}
'''
WANTED = {
    (" > ", " >= "), (" && ", " || "), (" == ", " != "), (" < ", " <= "), (" / ", " * "), ("false;", "true;"),
    ("2.5", "(2.5 * 4.0)"), ("2.0", "(2.0 * 4.0)"), ("0.0", "1.0"), (" + ", " - "),
    ("1", "2"), ("axis->now = stop(axis);", ";"), ("write(text);", ";"),
    ("way > 2.5 && axis->count == 1", "!(way > 2.5 && axis->count == 1)"),
}


WAITS = """#!/bin/sh
echo $$ >"$0.pids.new"
mv "$0.pids.new" "$0.pids"
exec sleep 1000
"""


def runs(pid):
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state != "Z" # nobody may be there to wait for it


def until(condition, what):
    deadline = time.monotonic() + 30
    while not condition():
        assert time.monotonic() < deadline, what
        time.sleep(0.02)


def check_ends_with_the_script(number):
    """Starts this file anew, as a script that runs a program which waits for ever, and ends that."""
    with tempfile.TemporaryDirectory() as folder:
        program, pids = Path(folder) / "waits", Path(folder) / "waits.pids"
        (Path(folder) / "tests").mkdir()
        program.write_text(WAITS)
        program.chmod(0o755)
        script = subprocess.Popen([sys.executable, __file__, sys.argv[1], folder], stderr=subprocess.DEVNULL)
        until(pids.exists, "the program began")
        pid = int(pids.read_text())
        assert runs(pid)
        script.send_signal(number)
        script.wait(30)
        until(lambda: not runs(pid), f"the program ended after signal {number}")


def check_results(mutate):
    """A test that could not run has seen nothing."""
    with tempfile.TemporaryDirectory() as folder:
        build = Path(folder)
        (build / "tests").mkdir()
        for status, wanted in ((0, (-1e-9, 1.0)), (mutate.SKIPPED, (float("inf"), float("inf")))):
            took = mutate.run_test(["sh", "-c", f"exit {status}"], 10, build)
            assert wanted[0] <= took <= wanted[1], (status, took)
        assert mutate.run_test(["false"], 10, build) is None
        assert mutate.run_test(["sleep", "0.3"], 0.1, build, True) is None
        assert mutate.run_test(["sleep", "0.3"], 10, build, True) >= 0.3 > mutate.run_test(["sleep", "0.3"], 10, build)


def run_one(mutate, folder):
    mutate.BUILD = Path(folder)
    mutate.arguments = lambda: mutate.argparse.Namespace(sources=[])
    mutate.places = lambda sources: mutate.run_test([mutate.BUILD / "waits"], 1000, mutate.BUILD)
    mutate.main()


def main():
    path = str(Path(sys.argv[1]) / "scripts/mutate")
    loader = importlib.machinery.SourceFileLoader("mutate", path)
    sys.dont_write_bytecode = True
    mutate = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
    loader.exec_module(mutate)
    if len(sys.argv) > 2:
        run_one(mutate, sys.argv[2])
        return
    for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        check_ends_with_the_script(number)
    check_results(mutate)
    found = list(mutate.defects("a.c", SOURCE))
    assert {(SOURCE[begin:end], new) for _, begin, end, new in found} == WANTED, found
    assert found == list(mutate.defects("a.c", SOURCE))
    for _, begin, end, new in found:
        assert "\n" not in SOURCE[begin:end] + new
    tests = {"quick": (0.1, {"a.c": {3, 5}}), "slow": (2.0, {"a.c": {5}, "b.c": {3}}), "other": (0.1, {"b.c": {3}})}
    for path, line, coded, names in (("a.c", 3, True, ["quick"]), ("a.c", 5, True, ["quick", "slow"]),
                                     ("a.c", 4, True, []), ("a.c", 4, False, ["quick", "slow"]),
                                     ("b.c", 3, True, ["slow", "other"]), ("c.c", 3, True, [])):
        assert mutate.that_run(tests, path, line, coded) == names, (path, line)
    texts = [re.sub(":[0-9]+:", ":", mutate.shown(defect, SOURCE)) for defect in found]
    assert 'a.c: " > " -> " >= " in: if (way > 2.5 && axis->count == 1)' in texts
    output = "\n".join(f"{mutate.shown(defect, SOURCE)} (3 programs run it, control could not judge it)"
                       for defect in found)
    assert set(texts) <= mutate.survivors(output)
    shown = mutate.table({"a.c": {"killed": 3, "survived": 1, "same code": 2, "no code": 0}, "b.c":
                          {"killed": 4, "survived": 0, "same code": 0, "no code": 1}}).splitlines()
    assert [line.split() for line in shown[1:]] == [["a.c", "4", "3", "1", "2", "0"], ["b.c", "4", "4", "0", "0", "1"],
                                                    ["all", "8", "7", "1", "2", "1"], ["87.5", "%", "killed"]], shown
    files = mutate.places(["src/drive/drive_io.c:3", "src/drive/drive_io.c:7-9", "src/drive/drive.c"])
    assert files == {"src/drive/drive.c": [], "src/drive/drive_io.c": [range(3, 4), range(7, 10)]}, files
    at = [SOURCE.count("\n", 0, defect[1]) + 1 for defect in found
          if mutate.is_at(defect, SOURCE, [range(7, 8), range(10, 11)])]
    assert set(at) == {7, 10}, at
    line = "    x = 1 + 1 + y;\n"
    text = SOURCE + line
    equals = [mutate.among_equals(defect, text) for defect in mutate.defects("a.c", text) if defect[1] >= len(SOURCE)]
    assert sorted(equals) == [(1, 1), (1, 2), (1, 2), (2, 2), (2, 2)], equals # the statement, two sums, two numbers
    mutate.EQUIVALENT["a.c", line.strip(), "1", "2", 2] = "a number that nobody reads"
    ones = [defect for defect in mutate.defects("a.c", text) if text[defect[1]:defect[2]] == "1" and
            defect[1] >= len(SOURCE)]
    assert [mutate.is_equivalent(defect, text) for defect in ones] == [False, True]
    assert [' "1" number 1 -> "2" in: ' in mutate.shown(defect, text) for defect in ones] == [True, False]
    del mutate.EQUIVALENT["a.c", line.strip(), "1", "2", 2]
    for known in mutate.EQUIVALENT: # each is a defect that its source still has
        text = (Path(sys.argv[1]) / known[0]).read_text()
        assert any(mutate.whole_line(defect, text).strip() == known[1] and text[defect[1]:defect[2]] == known[2] and
                   defect[3] == known[3] and mutate.among_equals(defect, text)[0] in (known[4:] or range(1, 99))
                   for defect in mutate.defects(known[0], text)), known
    print(f"{len(found)} defects in {SOURCE.count(chr(10))} lines")


if __name__ == "__main__":
    main()
