#!/usr/bin/env python3
"""`cm1e explain`: every code of every table is found by its number and by its text, with what to do; all meanings of a
number are shown with whose they are; what is unknown is refused, with what is near.

test_explain.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import re
import subprocess
import sys

BIN, SOURCE = sys.argv[1], sys.argv[2]
FAILED, WRONG_USE = 1, 2
faults = []


def run(*words):
    return subprocess.run([os.path.join(BIN, "cm1e"), "explain", *words], capture_output=True, text=True, timeout=60)


def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read()


def expect(condition, what, result):
    if not condition:
        faults.append(f"{what}: exit status {result.returncode}\n{result.stdout}{result.stderr}")


def rows(path, pattern):
    """[(code, text)]"""
    found = re.findall(pattern, read(path), re.DOTALL)
    if len(found) < 5:
        faults.append(f"{path}: its table cannot be read")
    return found


def check_every_code():
    errors = [(f"0x{0x1E00 - int(number):04X}", text) for name, number, text in
              rows("include/cm1e/error.h", r'X\(ERROR_(\w+), (-\d+), "([^"]*)"\)')]
    tables = [
        ("error code of a CM1-E", "UG 7.3.1", rows("src/device/errors.c", r'ERROR\((0x\w+), .*?"([^"]*)"')),
        ("error code of a CiA 402", "CiA", rows("src/device/cia402_errors.c", r'FAULT\((0x\w+), 0x\w+, "([^"]*)"')),
        ("ErrorID", "", errors),
        ("AL status code", "ETG.1000.6", rows("src/core/codes.c", r'\{(0x00\w\w), "([^"]*)"')),
        ("SDO abort code", "ETG.1000.6", rows("src/core/codes.c", r'\{(0x0[568]\w{6}), "([^"]*)"')),
        ("error code of FoE", "ETG.1000.6 section 5.8", rows("src/core/codes.c", r'\{(0x80\w\w), "([^"]*)"')),
    ]
    total = 0
    for whose, clause, table in tables:
        for code, text in table:
            result = run("--json", code)
            mine = [row for row in json.loads(result.stdout) if row["whose"].startswith(whose)]
            expect(result.returncode == 0 and len(mine) == 1 and mine[0]["text"] == text and clause in
                   mine[0]["clause"], f"{whose} {code}", result)
            told = mine and (mine[0]["cure"] or " first" in text or ": " in text or int(code, 16) == 0)
            expect(told, f"{whose} {code}: what to do", result)
            for page in mine[0]["page"].split(", ") if mine and mine[0]["page"] else []:
                expect(os.path.exists(os.path.join(SOURCE, page)), f"{code}: page {page}", result)
            total += 1
        code, text = table[-1]
        by_text = run("--json", *re.sub(r"[^\w ]", " ", text).split())
        expect(int(code, 16) in [row["code"] for row in json.loads(by_text.stdout)], f"{whose} by its text", by_text)
    return total


def check_questions():
    for word, texts in (("0xFF05", ["24V drive power", "CM1-E", "UG 7.3.1", "24 V motor power on", "MC_Reset.md"]),
                        ("FF05h", ["24V drive power"]), ("16#ff05", ["24V drive power"]), ("FF05", ["24V drive power"]),
                        ("65285", ["24V drive power"]), ("-71", ["0x1E47", "ERROR_AXIS_LAG"]),
                        ("lag", ["0x1E47", "the position lag is above its limit"]),
                        ("CM1E_ERROR_AXIS_LAG", ["0x1E47"]), ("error_axis_lag", ["0x1E47"]),
                        ("0x7320", ["Position Error overflow", "error code of a CiA 402 servo drive"]),
                        ("27", ["watchdog", "free run"]), ("0x80", ["temperature alarm", "CM1", "CM2", "BR 7.4"]),
                        ("0x0010", ["motor free"]), ("0x0008", ["in position", "a state, not an error"]),
                        ("0x06060000", ["hardware error", "SDO abort"])):
        result = run(word)
        for text in texts:
            expect(result.returncode == 0 and text in result.stdout, f"explain {word}: \"{text}\"", result)
    both = json.loads(run("--json", "0x4").stdout)
    whose = "".join(row["whose"] for row in both)
    for of in ("AL status code", "CM1 behind", "CM2 behind"):
        if of not in whose:
            faults.append(f"explain 0x4 lacks the meaning of \"{of}\": {whose}")
    two = run("position", "lag")
    expect(two.returncode == 0 and "0x1E47" in two.stdout, "two words", two)


def check_unknown():
    for words, status, text in ((["0xFF06"], FAILED, "0xFF05"), (["0x7301"], FAILED, "0x7310"),
                                (["0x3299"], FAILED, "of the class: voltage inside the device"),
                                (["velocty"], FAILED, "did you mean \"velocity\"?"), (["0x100000000"], FAILED, "0x1000"),
                                (["-9999"], FAILED, "-9999"), (["-150"], FAILED, "0x1E95"),
                                (["zzzzzz"], FAILED, "no text has \"zzzzzz\""), ([], WRONG_USE, "0xFF05"),
                                (["x" * 200], WRONG_USE, "too long"), (["a"] * 40, WRONG_USE, "too many")):
        result = run(*words)
        expect(result.returncode == status and text.lower() in result.stderr.lower() and result.stdout == "",
               f"explain {words}: \"{text}\"", result)
    told = run("--json", "0xFF06")
    expect(told.returncode == FAILED and json.loads(told.stdout) == [], "unknown as JSON", told)


def main():
    total = check_every_code()
    check_questions()
    check_unknown()
    print("\n".join(faults) or f"{total} codes are explained")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
