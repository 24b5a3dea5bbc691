#!/usr/bin/env python3
"""The data of the house: no struct of src/ and fb/ has more than 40 members, and the parts of an axis, a drive and a
simulated CM1-E (the structs of src/axis/axis_parts.h and its neighbours, of src/drive/drive_parts.h and of
src/sim/cm1e_app.h) are written only by the sources that their comments name ("Written by a.h and b.c.").

test_structs.py SOURCE-DIRECTORY
"""
import glob
import os
import re
import sys

SOURCE = sys.argv[1]
MOST = 40
ROOMS_OF_AXES = ("axis", "assembly", "bridge", "coupling", "homing")
# What is made of parts: its type, the headers of the parts (its own first), the rooms that reach it, and a way to it.
MADE_OF_PARTS = (
    ("cm1e_axis", ("src/axis/axis_parts.h", "src/axis/axis_move.h", "src/axis/axis_hooks.h"), ROOMS_OF_AXES, "axis->"),
    ("cm1e_drive", ("src/drive/drive_parts.h",), ("drive", *ROOMS_OF_AXES), "axis->drive."),
    ("cm1e_sim_cm1e", ("src/sim/cm1e_app.h",), ("sim",), "call->drive->"),
)
faults = []


def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read()


def expand(pattern):
    return sorted(os.path.relpath(path, SOURCE) for path in glob.glob(os.path.join(SOURCE, pattern), recursive=True))


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def code(text):
    """The same lines without comments, strings and lines of the preprocessor."""
    text = re.sub(r"/\*.*?\*/", blank, text, flags=re.DOTALL)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', blank, text)
    return re.sub(r"^[ \t]*#(?:.*\\\n)*.*", blank, text, flags=re.MULTILINE)


def end_of_braces(text, begin):
    depth = 0
    for place in range(begin, len(text)):
        depth += (text[place] == "{") - (text[place] == "}")
        if depth == 0:
            return place
    return len(text)


def count_members(body):
    """Of a struct; one within it counts as one."""
    count, depth, commas = 0, 0, 0
    for character in body:
        if character in "{([":
            depth += 1
        elif character in "})]":
            depth -= 1
        elif depth == 0 and character == ",":
            commas += 1
        elif depth == 0 and character == ";":
            count += 1 + commas
            commas = 0
    return count


def check_sizes():
    for path in expand("src/**/*.[ch]") + expand("fb/**/*.[ch]"):
        text = code(read(path))
        for match in re.finditer(r"\bstruct(?:\s+(\w+))?\s*\{", text):
            members = count_members(text[match.end():end_of_braces(text, match.end() - 1)])
            name = match.group(1) or f"line {text.count(chr(10), 0, match.start()) + 1}"
            if members > MOST:
                faults.append(f"{path}: struct {name} has {members} members, {MOST} are the maximum: make parts of it")


def writers(struct, headers):
    """Member of the struct -> the files that may write it."""
    by_type = {}
    for path in headers:
        for comment, name in re.findall(r"/\*\*((?:(?!\*/).)*)\*/\ntypedef struct \w+ \{.*?\n\} (\w+);", read(path),
                                        re.DOTALL):
            _, written, sources = comment.partition("Written by ")
            if written:
                by_type[name] = set(re.findall(r"\w+\.[ch]\b", sources))
    text = code(read(headers[0]))
    begin = text.index(f"struct {struct} {{") + len(f"struct {struct} ")
    body = text[begin:end_of_braces(text, begin)]
    members = {}
    for kind, names in re.findall(r"^\s+(\w+) (\w+(?:, \w+)*);", body, re.MULTILINE):
        for name in names.split(", "):
            if kind in by_type:
                members[name] = by_type[kind]
    unused = set(by_type) - {kind for kind in by_type if re.search(rf"^\s+{kind} ", body, re.MULTILINE)}
    if not members or unused:
        faults.append(f"{headers[0]}: no member of struct {struct} is a {', '.join(sorted(unused)) or 'part'}")
    return members


def check_writers(struct, headers, rooms, reach):
    members = writers(struct, headers)
    part = "|".join(members)
    for path in [path for room in rooms for path in expand(f"src/{room}/*.[ch]")]:
        text = code(read(path))
        names = {f"{name}->" for name in re.findall(rf"\b{struct}(?:_t)? \*(\w+)", text)} | {reach}
        access = f"(?:{'|'.join(map(re.escape, sorted(names)))})({part})" + r"\b((?:\.\w+|\[[^\]]*\])*)"
        found = [*re.finditer(r"\b" + access + r"\s*(?:\+\+|--|(?:[-+*/|&^]|<<|>>)?=(?!=))", text),
                 *re.finditer(r"(?:\+\+|--)" + access, text),
                 *re.finditer(r"(?<!const )\b\w+_t \*\w+ = &" + access, text)]
        for match in found:
            name = match.group(1)
            if os.path.basename(path) not in members[name]:
                line = text.count("\n", 0, match.start()) + 1
                faults.append(f"{path}:{line}: writes {name} of a {struct}; that is done by "
                              f"{', '.join(sorted(members[name]))}, by a function")


check_sizes()
for made in MADE_OF_PARTS:
    check_writers(*made)
print("\n".join(faults) if faults else "structs: fine")
sys.exit(1 if faults else 0)
