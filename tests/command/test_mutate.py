#!/usr/bin/env python3
"""scripts/mutate: which defects it can plant in a source, and that it leaves comments, texts and the lines alone;
which tests it counts as near a source; that no entry of its list of equivalent defects is old.

    test_mutate.py <source folder>
"""
import importlib.machinery
import importlib.util
import re
import sys
from pathlib import Path

SOURCE = '''#define MOST 7
/* 1 < 2 && true; */
static bool far(const axis_t *axis, double way)
{
    const char *text = "3 + 4";
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


def main():
    path = str(Path(sys.argv[1]) / "scripts/mutate")
    loader = importlib.machinery.SourceFileLoader("mutate", path)
    sys.dont_write_bytecode = True
    mutate = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
    loader.exec_module(mutate)
    found = list(mutate.defects("a.c", SOURCE))
    assert {(SOURCE[begin:end], new) for _, begin, end, new in found} == WANTED, found
    assert found == list(mutate.defects("a.c", SOURCE))
    for _, begin, end, new in found:
        assert "\n" not in SOURCE[begin:end] + new
    regex = mutate.near(["src/drive/drive_cml_exchange.c", "src/drive/drive.c"])
    for name, is_near in (("test_drive_enable", True), ("test_axis_drive_profile", True), ("test_cml_exchange", True),
                          ("test_bridge_cml_exchange", True), ("test_cml_exchanges", False),
                          ("test_drives", False), ("test_axis_home", False)):
        assert bool(re.search(regex, name)) == is_near, (name, regex)
    files = mutate.places(["src/drive/drive_io.c:3", "src/drive/drive_io.c:7-9", "src/drive/drive.c"])
    assert files == {"src/drive/drive.c": [], "src/drive/drive_io.c": [range(3, 4), range(7, 10)]}, files
    at = [SOURCE.count("\n", 0, defect[1]) + 1 for defect in found
          if mutate.is_at(defect, SOURCE, [range(7, 8), range(10, 11)])]
    assert set(at) == {7, 10}, at
    for known in mutate.EQUIVALENT: # each is a defect that its source still has
        text = (Path(sys.argv[1]) / known[0]).read_text()
        planted = ((known[0], text[text.rfind("\n", 0, begin) + 1:].split("\n", 1)[0].strip(), text[begin:end], new)
                   for _, begin, end, new in mutate.defects(known[0], text))
        assert known in planted, known
    print(f"{len(found)} defects in {SOURCE.count(chr(10))} lines")


if __name__ == "__main__":
    main()
