"""Writes tests/support/block_table.c: every block with its function, its members and what it does in which state, and
the layout that the ST declarations ask for, asserted."""
import re

import c_header
import st
from tables import STATES

POINTER = 8
ASSERT = """#define AT(TYPE, NAME, OFFSET) _Static_assert(offsetof(TYPE##_t, NAME) == OFFSET, #TYPE "." #NAME)
"""
MACROS = """#define MEMBER(TYPE, NAME, SECTION, KIND) \\
    {#NAME, BLOCK_##SECTION, BLOCK_##KIND, offsetof(TYPE##_t, NAME), sizeof(((TYPE##_t *)0)->NAME)}
#define BLOCK(TYPE, RULES) \\
    {#TYPE, sizeof(TYPE##_t), call_##TYPE, members_of_##TYPE, sizeof members_of_##TYPE / sizeof *members_of_##TYPE, \\
     RULES, errors_of_##TYPE}
"""


def layout(variables, sizes):
    """[(variable, offset, size)] and (size, alignment) of a struct: order of declaration, natural alignment."""
    offset, result, strictest = 0, [], 1
    for variable in variables:
        size, alignment = (POINTER, POINTER) if c_header.is_pointer(variable) else sizes[variable.type]
        offset = (offset + alignment - 1) // alignment * alignment
        count = int(sizes.get(variable.length, variable.length)) if variable.length else 1
        result.append((variable, offset, size * count))
        offset += size * count
        strictest = max(strictest, alignment)
    return result, ((offset + strictest - 1) // strictest * strictest, strictest)


def sizes_of(files):
    sizes = {name: (size, size) for name, size in st.ELEMENTARY.items()}
    sizes["STRING(80)"] = (st.ELEMENTARY["STRING(80)"], 1)
    for declaration in (item for file in files for item in file.declarations):
        if declaration.kind == "enum":
            sizes[declaration.name] = (4, 4)
        elif declaration.kind == "alias":
            sizes[declaration.name] = sizes[declaration.base]
        elif declaration.kind == "constants":
            sizes.update({item.name: item.default for item in declaration.variables})
        elif declaration.kind == "struct":
            sizes[declaration.name] = layout(declaration.variables, sizes)[1]
    return sizes


def member_type(variable, files):
    if c_header.is_pointer(variable):
        return "POINTER"
    if variable.type in st.ELEMENTARY:
        return variable.type.removesuffix("(80)")
    types = {item.name: item for file in files for item in file.declarations}
    of = types.get(variable.type)
    if of and of.kind == "alias" and of.base in st.ELEMENTARY:
        return of.base
    return "STRUCT" if of and of.kind == "struct" else "ENUM"


def c_state(name):
    return "CM1E_AXIS_" + re.sub(r"(?<!^)(?=[A-Z])", "_", name).upper()


def state_rules(name, cells):
    """block_rule_t of every state."""
    result = f"static const block_rule_t rules_{name}[CM1E_AXIS_STATE_COUNT] = {{\n"
    for state, cell in zip(STATES, cells):
        if cell == "-":
            rule = ".unchanged = true"
        elif cell in STATES:
            rule = f".next = {c_state(cell)}"
        else:
            rule = f".refusal = CM1E_ERROR_{cell}"
        result += f"    [{c_state(state)}] = {{{rule}}},\n"
    return result + "};\n"


def block_text(block, sizes, files, tables):
    name, members = block.name, ""
    rows, (size, _) = layout(block.variables, sizes)
    asserts = f'_Static_assert(sizeof({name}_t) == {size}, "{name}");\n'
    for variable, offset, _ in rows:
        asserts += f"AT({name}, {c_header.c_name(variable)}, {offset});\n"
        if variable.section != "private":
            kind = member_type(variable, files)
            members += f"    MEMBER({name}, {variable.name}, {variable.section.upper()}, {kind}),\n"
    table = (f"static const block_member_t members_of_{name}[] = {{\n{members}}};\n"
             f"static void call_{name}(void *fb) {{ {name}(fb); }}\n")
    cells = tables.states_of(block)
    errors = sorted({error for error, _ in tables.errors_of(block)} | set(cells) & set(tables.errors),
                    key=lambda error: -tables.errors[error][0])
    table += f"static const cm1e_error_t errors_of_{name}[] = {{\n"
    table += "".join(f"    CM1E_ERROR_{error},\n" for error in errors) + "    CM1E_OK,\n};\n"
    entry = f"    BLOCK({name}, {'rules_' + block.tags['states'][0] if cells else 'NULL'}),\n"
    return asserts, table, entry


def source(files, tables):
    sizes = sizes_of(files)
    parts = [block_text(block, sizes, files, tables) for file in files for block in file.blocks()]
    asserts, members, entries = ("".join(column) for column in zip(*parts))
    structs = ""
    for declaration in (item for file in files for item in file.declarations if item.kind == "struct"):
        name = c_header.c_type(declaration.name)
        structs += f'_Static_assert(sizeof({name}) == {sizes[declaration.name][0]}, "{name}");\n'
    rules = "".join(state_rules(name, cells) for name, cells in tables.states.items())
    return ("/* Generated from fb/interface/ by fb/interface/generate.py; change it there. */\n"
            '#include "block_table.h"\n\n#include <stddef.h>\n#include <stdint.h>\n\n'
            "/* The layout that an ST compiler gives the declarations: order of declaration, natural alignment. */\n"
            f"{ASSERT}#if UINTPTR_MAX == UINT64_MAX\n{structs}{asserts}#endif\n\n{MACROS}\n{rules}\n{members}\n"
            f"const block_t block_table[] = {{\n{entries}}};\n"
            "const size_t block_count = sizeof block_table / sizeof *block_table;\n")
