#!/usr/bin/env python3
"""The documentation names nothing that is not there: every error of error.h stands in docs/FUNCTION-BLOCKS.md with its
ErrorID and its text, every rule of the cross-checker in docs/CHECK-RULES.md and in a test, every proof in a table of
features or of safety is a test, a case in one, or a file, every point of `cm1e prove` that is named exists, every
relative link leads to a file and to a heading in it, every path of the repository that is mentioned exists, the rooms use
each other as docs/DESIGN.md says, figures of docs/PERFORMANCE.md were printed by a command.

test_docs.py SOURCE-DIRECTORY
"""
import fnmatch
import glob
import os
import re
import sys

SOURCE = sys.argv[1]
PATH = re.compile(r"(?<![\w/.:-])((?:bindings|scripts|examples|bench|docs|src|fb|include|tests|tools|cmake)/[\w./*-]*)(<?)")
TABLES_WITH_PROOF = ("docs/FEATURES.md", "docs/SAFETY.md")
faults = []


def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read()


def expand(pattern):
    return sorted(os.path.relpath(path, SOURCE) for path in glob.glob(os.path.join(SOURCE, pattern)))


def without_programs(text):
    """The same lines, but blocks of code empty."""
    return re.sub(r"^```.*?^```", lambda block: "\n" * block.group().count("\n"), text, flags=re.DOTALL | re.MULTILINE)


def rows(text):
    """(line, cells) of every row of a table."""
    for number, line in enumerate(without_programs(text).splitlines(), 1):
        if line.startswith("|") and not re.fullmatch(r"[|\s:-]+", line):
            yield number, [cell.strip() for cell in line.strip().strip("|").split("|")]


# ---- errors ---------------------------------------------------------------------------------------------------------

def check_errors():
    known = {f"0x{0x1E00 - int(value):04X}" if name != "OK" else "0": (name, text) for name, value, text in
             re.findall(r'X\((\w+), (-?\d+), "([^"]*)"\)', read("include/cm1e/error.h"))}
    if len(known) < 2:
        faults.append("include/cm1e/error.h: its list of errors cannot be read")
    told = {}
    for number, cells in rows(read("docs/FUNCTION-BLOCKS.md")):
        if re.fullmatch(r"`(0|0x1E[0-9A-F]{2})`", cells[0]):
            error_id = cells[0].strip("`")
            if error_id in told:
                faults.append(f"docs/FUNCTION-BLOCKS.md:{number}: {error_id} stands there twice")
            told[error_id] = (number, cells)
    for error_id, (name, text) in known.items():
        if error_id not in told:
            faults.append(f"docs/FUNCTION-BLOCKS.md lacks {error_id}, CM1E_{name}")
            continue
        number, cells = told[error_id]
        if cells[1:3] != [f"`{name}`", text]:
            faults.append(f"docs/FUNCTION-BLOCKS.md:{number}: {error_id} is `{name}`, \"{text}\"")
    for error_id in set(told) - set(known):
        faults.append(f"docs/FUNCTION-BLOCKS.md:{told[error_id][0]}: there is no error with ErrorID {error_id}")


# ---- keys of the bus file ------------------------------------------------------------------------------------------

# Fields of the configuration that a text may name although they are no keys: it is about a configuration made by hand.
FIELDS_IN_TEXTS = {"axis_count", "slave_count", "complete_access"}  # the last is one of the control socket


def keys_of_schema():
    """Every key, and every way to one: "velocity", "limits", "limits.velocity"."""
    text = read("src/busfile/schema.c")
    tables = {name: re.findall(r'\w+\(\s*"(\w+)"(?:, (\w+_fields))?', body) for name, body in
              re.findall(r"cyaml_schema_field_t (\w+)\[\] = \{(.*?)\n\};", text, re.DOTALL)}
    keys = set()
    for table in tables.values():
        for key, group in table:
            keys.add(key)
            keys.update(f"{key}.{below}" for below, _ in tables.get(group, []))
    return keys


def check_keys_in_texts():
    """No sentence of ours names a key that the bus file does not have."""
    keys = keys_of_schema()
    if not {"limits.position_lag", "homing.method", "interface"} <= keys:
        faults.append("src/busfile/schema.c: its keys cannot be read")
    fields = set(re.findall(r"^    [\w ]*?\b(\w*_\w*)(?:\[\w+\])?(?:, \w+)*;", read("include/cm1e/config.h"),
                            re.MULTILINE))
    fields -= FIELDS_IN_TEXTS | keys
    for path in expand("src/*/*.c") + expand("fb/*.c") + expand("tools/*.c"):
        text = re.sub(r"/\*.*?\*/", lambda comment: "\n" * comment.group().count("\n"), read(path), flags=re.DOTALL)
        for number, line in enumerate(text.splitlines(), 1):
            if line.startswith("#include"):
                continue
            for literal in re.findall(r'"((?:[^"\\]|\\.)*)"', line):
                named = set(re.findall(r"(?<![\w.%/-])[a-z]\w*(?:\.[a-z]\w*)?(?![\w.(/-])", literal + " "))
                groups = {key.partition(".")[0] for key in keys if "." in key}
                for word in sorted(named):
                    if word in fields or (word.partition(".")[0] in groups and "." in word and word not in keys):
                        faults.append(f"{path}:{number}: \"{word}\" is no key of the bus file")


# ---- rules of the cross-checker -------------------------------------------------------------------------------------

def check_rules():
    """Every rule has a row in docs/CHECK-RULES.md that says whether it is an error, and a test that breaks a file in
    that way: one that has its name in quotes, its enumerator, or it in a row BREAKS(...) of broken_description.h."""
    page = "docs/CHECK-RULES.md"
    known = {name: (enumerator, is_error == "true") for enumerator, name, is_error in
             re.findall(r'X\((\w+), "([\w-]+)", (true|false)\)', read("src/description/check.h"))}
    if not known:
        faults.append("src/description/check.h: its list of rules cannot be read")
    told = {}
    for number, cells in rows(read(page)):
        match = re.fullmatch(r"`([\w-]+)`( \(warning\))?", cells[0])
        if not match:
            continue
        if match[1] in told:
            faults.append(f"{page}:{number}: `{match[1]}` stands there twice")
        told[match[1]] = number
        if match[1] not in known:
            faults.append(f"{page}:{number}: there is no rule `{match[1]}`")
        elif known[match[1]][1] == bool(match[2]):
            faults.append(f"{page}:{number}: `{match[1]}` is {'an error' if match[2] else 'a warning'}")
    tests = "".join(read(path) for path in expand("tests/*/test_*.c"))
    proved = set(re.findall(r"\b(?:CM1E_RULE_|BREAKS\()(\w+)", tests)) | set(re.findall(r'"([\w-]+)"', tests))
    for name, (enumerator, _) in known.items():
        if name not in told:
            faults.append(f"{page} lacks the rule `{name}`")
        if enumerator not in proved and name not in proved:
            faults.append(f"no test breaks a file in the way of the rule `{name}`")


# ---- tests ----------------------------------------------------------------------------------------------------------

def test_names():
    """As tests/CMakeLists.txt makes them: a test per source, and those it names."""
    names = {os.path.splitext(os.path.basename(path))[0]
             for area in ("unit", "bus", "fb", "rt") for path in expand(f"tests/{area}/test_*.c")}
    return names | set(re.findall(r"(?:cm1e_script_test\(|add_test\(NAME )(\w+)\s", read("tests/CMakeLists.txt")))


def case_names():
    text = "".join(read(path) for path in expand("tests/*/test_*.c"))
    python = "".join(read(path) for path in expand("bindings/python/tests/test_*.py"))
    return set(re.findall(r"^START_TEST\((\w+)\)|^static void (test_\w+)\(void\)", text, re.MULTILINE)) | \
        set(re.findall(r"^(?:async )?def (test_\w+)()\(", python, re.MULTILINE))


def check_proofs():
    tests = test_names()
    cases = {name for pair in case_names() for name in pair if name}
    if not tests or not cases:
        faults.append("tests: neither tests nor cases in them are found")
    for path in TABLES_WITH_PROOF:
        for number, cells in rows(read(path)):
            for name in re.findall(r"`([^`]+)`", re.split(f"{ON_A_MOTOR}|{NO_POINT}", cells[-1])[0]):
                if not fnmatch.filter(tests | cases, name) and not exists(name):
                    faults.append(f"{path}:{number}: `{name}` is no test, no case of a test and no file")


# ---- points of cm1e prove -------------------------------------------------------------------------------------------

ON_A_MOTOR, NO_POINT = "on a real motor:", "no point:"


def check_points():
    """Every row of the features that rests on the simulator names the points of `cm1e prove` that settle it on a real
    motor, or says why there is none; every point that is named exists."""
    page = "docs/FEATURES.md"
    points = re.findall(r'^    \{"([a-z]+\.[\w.-]+)", ', read("tools/prove/points.c"), re.MULTILINE)
    if len(points) < 50 or len(points) != len(set(points)):
        faults.append("tools/prove/points.c: its points cannot be read, or two have one name")
    section = {}
    heading = ""
    for number, line in enumerate(read(page).splitlines(), 1):
        heading = line if line.startswith("## ") else heading
        section[number] = heading
    for number, cells in rows(read(page)):
        named = re.findall(r"`([^`]+)`", cells[-1].partition(ON_A_MOTOR)[2])
        for name in named:
            if not fnmatch.filter(points, name):
                faults.append(f"{page}:{number}: `cm1e prove` has no point `{name}`")
        rests = section[number] == "## Simulated segment" or re.search(r"\bsimulated\b", " ".join(cells))
        if rests and cells[0] != "feature" and not named and NO_POINT not in cells[-1]:
            faults.append(f"{page}:{number}: it rests on the simulator: which point of `cm1e prove` settles it? Write "
                          f"\"{ON_A_MOTOR} `POINT`\", or \"{NO_POINT} WHY\"")


# ---- rooms ----------------------------------------------------------------------------------------------------------

def check_rooms():
    """The table of rooms in docs/DESIGN.md against the includes of their sources."""
    folders = {path.rstrip("/"): os.path.basename(path.rstrip("/")) for path in ("fb", "tools", *expand("src/*"))}
    rooms = set(folders.values())
    told = {}
    for _, cells in rows(read("docs/DESIGN.md")):
        folder = cells[0].strip("`").rstrip("/")
        if folder in folders:
            told[folder] = set(re.findall(r"\w+", cells[2])) & rooms
    for folder, room in folders.items():
        used = {name for path in expand(f"{folder}/*.[ch]")
                for name in re.findall(r'^#include "(\w+)/', read(path), re.MULTILINE)} & rooms - {room}
        if told.get(folder) != used:
            faults.append(f"docs/DESIGN.md: {folder}/ uses {', '.join(sorted(used))}; told is "
                          f"{', '.join(sorted(told.get(folder, ())))}")


# ---- links and paths ------------------------------------------------------------------------------------------------

def exists(path):
    """A path, a pattern, or a program named without its .c."""
    return bool(expand(path) or expand(path + ".c"))


def anchors(path):
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
            for heading in re.findall(r"^#+ (.*)$", without_programs(read(path)), re.MULTILINE)}


def check_links(path, text):
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"\w+:", target):
            continue
        file, _, anchor = target.partition("#")
        file = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
        if not os.path.exists(os.path.join(SOURCE, file)):
            faults.append(f"{path}: the link {target} leads nowhere")
        elif anchor and anchor not in anchors(file):
            faults.append(f"{path}: the link {target} leads to no heading")


def check_paths(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        for mentioned, placeholder in PATH.findall(line):
            mentioned = mentioned.rstrip(".") if not placeholder else os.path.dirname(mentioned)
            if not exists(mentioned):
                faults.append(f"{path}:{number}: there is no {mentioned}")


MEASURED = ("docs/PERFORMANCE.md", "docs/RELIABILITY.md")


def check_measured(path):
    """Every figure of the page is in a block that a command has printed, and scripts/document can run that command."""
    blocks = re.compile(r"^```console\n\$ (\S+)([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
    text = read(path)
    for command, words, shown in blocks.findall(text):
        program = re.fullmatch(r"build-release/bin/(\w+)", command)
        if not exists(f"bench/{program[1]}.c" if program else command):
            faults.append(f"{path}: there is no {command}")
        if len(shown.strip()) < 10:
            faults.append(f"{path}: {command}{words} has printed nothing: scripts/document {path} \"{command}{words}\"")
    if not blocks.search(text):
        faults.append(f"{path}: no command has printed anything")
    for number, _ in rows(blocks.sub(lambda block: "\n" * block[0].count("\n"), text)):
        faults.append(f"{path}:{number}: a table that no command has printed")


def main():
    documents = expand("*.md") + expand("docs/*.md") + expand("docs/blocks/*.md") + expand("bench/*.md") \
        + expand("fb/interface/*.md") + expand("examples/*.md")
    check_errors()
    check_rules()
    check_keys_in_texts()
    check_proofs()
    check_points()
    check_rooms()
    for path in MEASURED:
        check_measured(path)
    for path in documents:
        text = read(path)
        check_links(path, text)
        check_paths(path, text)
    print("\n".join(faults) or f"{len(documents)} documents: every error, test, link and path in them is there")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
