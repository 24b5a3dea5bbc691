"""Writes blocks.py: a class for each enumeration, structure and function block of the declarations in fb/interface/."""
import keyword
import textwrap

import c_header
import st

PYTHON = {"BOOL": "bool", "LREAL": "float", "TIME": "timedelta", "STRING(80)": "str", "AXIS_REF": "AXIS_REF",
          "AXES_GROUP_REF": "AXES_GROUP_REF"}
HEAD = '''"""The function blocks and their types, with the names of IEC 61131-3 and PLCopen. Times are datetime.timedelta.

A block that is made, and attached to a bus, is called in every cycle: bus.attach(block). In a callback on virtual time a
program calls its blocks itself: block(Execute=True). Generated from fb/interface/; docs/blocks/ has a page of each.
"""
from __future__ import annotations

from datetime import timedelta
from enum import IntEnum
from typing import Optional, Sequence

from ._block import AXES_GROUP_REF, AXIS_REF, NOT_GIVEN, Block, Member, Struct
'''


class Types:
    def __init__(self, files):
        self.known = {item.name: item for file in files for item in file.declarations if item.name}

    def base(self, name):
        item = self.known.get(name)
        return self.base(item.base) if item and item.kind == "alias" else name

    def kind(self, variable):
        """How Member converts it."""
        name = self.base(variable.type)
        if variable.reference:
            return "reference"
        if variable.length:
            return "array"
        if name in st.ELEMENTARY:
            return PYTHON.get(name, "int")
        if name in ("AXIS_REF", "AXES_GROUP_REF"):
            return "axis" if name == "AXIS_REF" else "group"
        return self.known[name].kind

    def python(self, variable):
        name = self.base(variable.type)
        result = PYTHON.get(name) or ("int" if name in st.ELEMENTARY else class_name(name))
        # ref: one, or several that follow each other in memory
        return f"Sequence[{result}]" if variable.length else f"Optional[{result} | Sequence[{result}]]" \
            if variable.reference else result


def class_name(name):
    return {"cm1e_homing_config": "HomingConfig"}.get(name, name)


def text_of(item):
    return " ".join(item.doc.split()).replace("\\", "\\\\").replace('"', "'")


def docstring(text, clause=""):
    text = (f"{clause}. " if clause else "") + text
    lines = textwrap.wrap(text, 112) or [""]
    return '    """' + "\n    ".join(lines) + '"""\n'


def enum(item):
    rows = "".join(f"    {entry.name} = {entry.default}" + (f"  # {entry.text}" if entry.text else "") + "\n"
                   for entry in item.variables)
    return f"\n\nclass {item.name}(IntEnum):\n{docstring(text_of(item))}\n{rows}"


def default(variable, types):
    if not variable.default:
        return "NOT_GIVEN"
    item = types.known.get(types.base(variable.type))
    if item is not None and item.kind == "enum":
        return f"{item.name}.{variable.default}"
    return {"TRUE": "True", "FALSE": "False"}.get(variable.default, variable.default)


def member_rows(variables, types):
    rows = ""
    for variable in variables:
        name = types.base(variable.type)
        of = class_name(name) if types.kind(variable) in ("enum", "struct", "array", "reference") and \
            name not in st.ELEMENTARY and name not in PYTHON else ""
        rows += f'        Member("{variable.name}", "{variable.section}", "{types.kind(variable)}", ' \
                f'"{c_header.c_type(name)}", {of or "None"}),\n'
    return rows


def annotations(variables, types):
    rows = ""
    for variable in variables:
        note = c_header.note(variable).replace("\\", "\\\\")
        rows += f"    {variable.name}: {types.python(variable)}" + (f"  # {note}" if note else "") + "\n"
    return rows


def parameters(variables, types, defaults):
    return ", ".join(f"{variable.name}: {types.python(variable)} = "
                     f"{default(variable, types) if defaults else 'NOT_GIVEN'}" for variable in variables)


def wrapped(head, tail):
    """A line of a definition, in lines that are not too long."""
    if len(head) + len(tail) <= 116:
        return (head + tail).replace("\0", " ")
    parts = textwrap.wrap(tail, 108, break_long_words=False)
    return (head.rstrip() + "\n" + "\n".join("            " + part for part in parts)).replace("\0", " ")


def method(name, base, variables, types, defaults):
    given = "{" + ", ".join(f'"{variable.name}": {variable.name}' for variable in variables) + "}"
    return (wrapped(f"    def {name}(self, *, ", parameters(variables, types, defaults) + ")\0->\0None:") + "\n"
            + wrapped(f"        super().{base}(", given + ")") + "\n")


def struct(item, types):
    visible = item.variables
    return (f"\n\nclass {class_name(item.name)}(Struct):\n{docstring(text_of(item))}\n"
            f'    _c_type = "{c_header.c_type(item.name)}"\n'
            f"    _members = Struct._table(\n{member_rows(visible, types)}    )\n"
            f"{annotations(visible, types)}\n{method('__init__', '__init__', visible, types, False)}")


def block(item, types):
    visible = [variable for variable in item.variables if variable.section != "private"]
    inputs = [variable for variable in visible if variable.section != "output"]
    for variable in visible:
        if keyword.iskeyword(variable.name):
            raise st.Fault(f"{item.name}: {variable.name} is a keyword of Python")
    clause = " ".join(item.tags.get("clause", []))
    return (f"\n\nclass {item.name}(Block):\n{docstring(text_of(item), clause)}\n"
            f'    _type = "{item.name}"\n    _c_type = "{item.name}_t"\n'
            f"    _members = Block._table(\n{member_rows(visible, types)}    )\n"
            f"{annotations(visible, types)}\n{method('__init__', '__init__', inputs, types, True)}\n"
            f"{method('__call__', '_act', inputs, types, False)}")


def is_private(item):
    return "rivate" in item.doc or "rivate" in item.name


def module(files):
    types = Types(files)
    items = [item for file in files for item in file.declarations]
    result = HEAD
    for item in items:
        if item.kind == "enum":
            result += enum(item)
        elif item.kind == "alias" and types.known.get(types.base(item.name)) is not None:
            result += f"\n\n{item.name} = {types.base(item.name)}\n"
        elif item.kind == "struct" and item.name not in ("AXIS_REF", "AXES_GROUP_REF") and not is_private(item) and \
                not item.name.startswith("cm1e_cam") and not item.name.startswith("cm1e_iec"):
            result += struct(item, types)
        elif item.kind == "block":
            result += block(item, types)
    names = [item.name for item in items if item.kind == "block"]
    return result + "\n\nBLOCKS: dict[str, type[Block]] = {\n" + "".join(f'    "{name}": {name},\n' for name in names) + "}\n"
