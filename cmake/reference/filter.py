#!/usr/bin/env python3
"""A public header as Doxygen reads it (INPUT_FILTER): the same lines, with what is written once elsewhere. Members of
function blocks get their meaning from fb/interface/, errors their texts, and each header is a group of its name.

filter.py HEADER
"""
import os
import re
import sys

SOURCE = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
sys.path.insert(0, os.path.join(SOURCE, "fb/interface"))
import generate  # noqa: E402
import pages  # noqa: E402
import st  # noqa: E402
import tables  # noqa: E402

COMMENT = r"(?P<comment>\s*/\*\*<.*?\*/)?"
MEMBER = re.compile(r"^(?P<indent> {4,})(?P<type>(?:const |struct |unsigned )*\w+ )(?P<names>[*\w\[\], ]+);" + COMMENT,
                    re.MULTILINE | re.DOTALL)
STRUCT = re.compile(r"^typedef struct (\w+) \{\n(.*?)^\} ", re.MULTILINE | re.DOTALL)
RUN = re.compile(r"^(/\*\*(?:(?!\*/).)*\*/\n)((?:(?:#define \w+ [^\\\n]+|typedef [^{}\n]+;)\n){2,})",
                 re.MULTILINE | re.DOTALL)
CALL = re.compile(r"^CM1E_API void (\w+)\(\1_t \*fb\)", re.MULTILINE)
PRIVATE = "belongs to the block"
SAID_BY_NAME = "&nbsp;"  # of a member without a comment: Doxygen would warn


def one_line(text):
    return " ".join(text.split())


def first_sentence(text):
    return re.split(r"(?<=[.]) (?=[A-Z])", one_line(text))[0]


class Blocks:
    """The function blocks as fb/interface/ declares them."""
    def __init__(self):
        self.tables = tables.Tables(generate.read("fb/interface/classes.md"), generate.read("include/cm1e/error.h"))
        self.by_name = {block.name: block for name in generate.FILES for block in
                        st.Reader(f"fb/interface/{name}", generate.read(f"fb/interface/{name}")).read().blocks()}

    def meaning(self, struct, member):
        block = self.by_name.get(struct.removesuffix("_t"))
        for variable in block.variables if block else ():
            if variable.name == member:
                return pages.meaning(variable, block, self.tables)
        return PRIVATE if block else ""


def documented_members(struct, body, blocks):
    """Each member with a comment of its own, also where several share a line."""
    def split(match):
        said = one_line((match["comment"] or "").replace("/**<", "").replace("*/", ""))
        parts = []
        for name in (name.strip() for name in match["names"].split(",")):
            text = said or blocks.meaning(struct, re.sub(r"[*\[].*|^\*+", "", name.lstrip("*")))
            parts.append(f"{match['type']}{name}; /**< {text or SAID_BY_NAME} */")
        return match["indent"] + " ".join(parts) + "\n" * match[0].count("\n")
    return MEMBER.sub(split, body)


def documented_calls(text, blocks):
    def call(match):
        block = blocks.by_name[match[1]]
        return f"/** {first_sentence(block.doc)} Inputs and outputs: {match[1]}_t. @rtcycle */ {match[0]}"
    return CALL.sub(call, text)


def with_diagrams(text, blocks):
    """The clause of a block behind its text, and its timing, at its struct."""
    for name, block in blocks.by_name.items():
        clause = " ".join(block.tags.get("clause", []))
        end = text.find(f"*/\ntypedef struct {name}_t {{")
        begin = text.rfind("/** ", 0, end)
        said = text[begin:end].removeprefix(f"/** {clause}. ")
        if end < 0 or said == text[begin:end]:
            continue
        has_image = os.path.exists(os.path.join(SOURCE, f"docs/blocks/{name}.svg"))
        image = f"@image html {name}.svg " if has_image else ""
        clause = clause.replace(",", r"\,")
        text = f"{text[:begin]}/** {said}@clause{{{clause}}} {image}{text[end:]}"
    return text


def with_errors(text):
    """The enumerators that a macro makes."""
    rows = re.findall(r'X\((\w+), (-?\d+), "([^"]*)"\)', text)
    made = " ".join(f"CM1E_{name} = {value}, /**< {said}; ErrorID 0x{-int(value) and 0x1E00 - int(value):04X} */"
                    for name, value, said in rows)
    text = text.replace("    CM1E_ERRORS(CM1E_ERROR_ENUM)\n", made + "\n")
    return re.sub(r"^#(define|undef) CM1E_ERROR_ENUM.*", "", text, flags=re.MULTILINE)


def with_runs(text):
    """A comment above several lines is that of each of them."""
    def repeat(match):
        said = one_line(match[1].replace("\n *", " ").strip("/* \n"))
        first, *others = match[2].splitlines()
        lines = [line if "/**<" in line else f"{line} /**< {said} */" for line in others]
        return match[1] + "\n".join([first, *lines]) + "\n"
    return RUN.sub(repeat, text)


def as_group(text, name):
    """The comment at the top is that of a group, which holds all that the header declares."""
    group = name.removesuffix(".h")
    top = re.match(rf"/\*\*\n \* @file {re.escape(name)}\n(.*?)\*/\n", text, re.DOTALL)
    if not top:
        sys.exit(f"{name}: it does not begin with /** and @file {name}")
    include = f'@code{{.c}} #include <cm1e/{name}> @endcode'
    begin = f"/** @file {name} @ref {group} */ /** @addtogroup {group}\n * {include}\n{top[1]}@{{ */\n"
    return begin + text[top.end():] + "/** @} */\n"


def main(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    blocks = Blocks()
    text = with_diagrams(text, blocks)
    text = documented_calls(text, blocks)
    text = STRUCT.sub(lambda match: match[0].replace(match[2], documented_members(match[1], match[2], blocks)), text)
    text = as_group(with_runs(with_errors(text)), os.path.basename(path))
    text = text.replace("(@rt cycle)", "(in the cycle only)")
    sys.stdout.write(re.sub(r"@rt (cycle|any|init|block)\b", r"@rt\1", text))


if __name__ == "__main__":
    main(sys.argv[1])
