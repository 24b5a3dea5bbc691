#!/usr/bin/env python3
"""The data of the house: no struct of src/ and fb/ has more than 40 members, and the structs of src/axis/axis_parts.h
and its neighbours are written only by the sources that their comments name ("Written by a.h and b.c.").

test_structs.py SOURCE-DIRECTORY
"""
import glob
import os
import re
import sys

SOURCE = sys.argv[1]
MOST = 40
# Structs that are larger still: their members. A number here only falls, and goes when it is 40.
NOT_YET = {"cm1e_drive": 91, "cm1e_sim_cm1e": 54}
ROOMS_OF_AXES = ("axis", "assembly", "bridge", "coupling", "homing")
PARTS = ("src/axis/axis_parts.h", "src/axis/axis_move.h", "src/axis/axis_hooks.h")
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
    large = {}
    for path in expand("src/**/*.[ch]") + expand("fb/**/*.[ch]"):
        text = code(read(path))
        for match in re.finditer(r"\bstruct(?:\s+(\w+))?\s*\{", text):
            members = count_members(text[match.end():end_of_braces(text, match.end() - 1)])
            name = match.group(1) or f"line {text.count(chr(10), 0, match.start()) + 1}"
            if members > NOT_YET.get(name, MOST):
                faults.append(f"{path}: struct {name} has {members} members, {NOT_YET.get(name, MOST)} are the maximum: "
                              "make parts of it")
            if members > MOST:
                large[name] = members
    for name, members in NOT_YET.items():
        if large.get(name) != members:
            faults.append(f"tests/style/test_structs.py: NOT_YET[\"{name}\"] is {members}, but there are "
                          f"{large.get(name, f'at most {MOST}')}: write that")


def writers():
    """Member of struct cm1e_axis -> the files that may write it."""
    by_type = {}
    for path in PARTS:
        for comment, name in re.findall(r"/\*\*((?:(?!\*/).)*)\*/\ntypedef struct \w+ \{.*?\n\} (\w+);", read(path),
                                        re.DOTALL):
            _, written, sources = comment.partition("Written by ")
            if written:
                by_type[name] = set(re.findall(r"\w+\.[ch]\b", sources))
    text = code(read(PARTS[0]))
    begin = text.index("struct cm1e_axis {") + len("struct cm1e_axis ")
    members = {}
    for kind, names in re.findall(r"^\s+(\w+) (\w+(?:, \w+)*);", text[begin:end_of_braces(text, begin)], re.MULTILINE):
        for name in names.split(", "):
            if kind in by_type:
                members[name] = by_type[kind]
    unused = set(by_type) - {kind for kind in by_type if re.search(rf"^\s+{kind} ", text[begin:], re.MULTILINE)}
    if not members or unused:
        faults.append(f"{PARTS[0]}: no member of struct cm1e_axis is a {', '.join(sorted(unused)) or 'part'}")
    return members


def check_writers():
    members = writers()
    part = "|".join(members)
    access = r"(%s)->(" + part + r")\b((?:\.\w+|\[[^\]]*\])*)"
    for room in ROOMS_OF_AXES:
        for path in expand(f"src/{room}/*.[ch]"):
            text = code(read(path))
            names = "|".join(set(re.findall(r"\bcm1e_axis_t \*(\w+)", text)) | {"axis"})
            found = [*re.finditer(r"\b" + access % names + r"\s*(?:\+\+|--|(?:[-+*/|&^]|<<|>>)?=(?!=))", text),
                     *re.finditer(r"(?:\+\+|--)" + access % names, text),
                     *re.finditer(r"(?<!const )\b\w+_t \*\w+ = &" + access % names, text)]
            for match in found:
                name = match.group(2)
                if os.path.basename(path) not in members[name]:
                    line = text.count("\n", 0, match.start()) + 1
                    faults.append(f"{path}:{line}: writes {name} of an axis; that is done by "
                                  f"{', '.join(sorted(members[name]))}, by a function")


check_sizes()
check_writers()
print("\n".join(faults) if faults else "structs: fine")
sys.exit(1 if faults else 0)
