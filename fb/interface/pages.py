"""Writes docs/blocks/: a page for each block, and the index with the table of states."""
import textwrap

from st import ELEMENTARY
from tables import STATES

SECTIONS = (("in_out", "VAR_IN_OUT"), ("input", "VAR_INPUT"), ("output", "VAR_OUTPUT"))
CHAPTERS = {
    "mc_motion.h": "Motion",
    "mc_multi_axis.h": "Slaves and masters",
    "mc_group.h": "Axes groups",
    "mc_administrative.h": "Parameters, signals, what the axis shows",
    "mc_homing.h": "Homing in steps",
    "cm_bridge.h": "Motors behind a Cool MUSCLE bridge",
    "iec.h": "Standard blocks of IEC 61131-3",
}


def wrap(text, first="", rest=""):
    """Wrapped to 119 columns; a link, a name or a number is not broken."""
    return textwrap.fill(" ".join(text.split()), 119, initial_indent=first, subsequent_indent=rest,
                         break_long_words=False, break_on_hyphens=False)


def in_sections(variables):
    """[("VAR_INPUT", [variables])] in the order of declaration; the private part left out."""
    result = []
    for variable in variables:
        keyword = dict(SECTIONS).get(variable.section)
        if not keyword:
            continue
        if not result or result[-1][0] != keyword:
            result.append((keyword, []))
        result[-1][1].append(variable)
    return result


def st_type(variable):
    kind = f"ARRAY [1..{variable.length}] OF {variable.type}" if variable.length else variable.type
    kind = f"REF_TO {kind}" if variable.reference else kind
    return f"{kind} := {variable.default}" if variable.default else kind


def st_text(block):
    lines = [f"FUNCTION_BLOCK {block.name}"]
    for keyword, variables in in_sections(block.variables):
        width = max(len(variable.name) for variable in variables)
        lines += [keyword, *(f"    {variable.name.ljust(width)} : {st_type(variable)};" for variable in variables),
                  "END_VAR"]
    return "\n".join(lines + ["END_FUNCTION_BLOCK"])


def type_link(name):
    return name if name in ELEMENTARY else f"[{name}](TYPES.md#{name.lower()})"


def meaning(variable, block, tables):
    """The text of this block takes precedence over the text for all blocks."""
    is_enabled = any(other.name == "Enable" for other in block.variables)
    common = is_enabled and tables.meanings.get(f"{variable.name} (Enable)") or tables.meanings.get(variable.name, "")
    if variable.text and variable.text[0] != "(":
        return variable.text
    return " ".join(part for part in (common, variable.text) if part)


def variable_row(variable, block, tables):
    unit = ", ".join(part for part in (variable.unit, variable.range) if part)
    default = variable.default or ("" if variable.section != "input" else zero(variable))
    kind, text = type_link(variable.type), meaning(variable, block, tables)
    return f"| `{variable.name}` | {kind} | {unit} | {default} | {text} |\n"


def zero(variable):
    if variable.reference:
        return "NULL"
    return {"BOOL": "FALSE", "TIME": "0", "STRING(80)": "''"}.get(variable.type, "0")


def variables_text(block, tables):
    result = ""
    for title, sections in (("Inputs", ("in_out", "input")), ("Outputs", ("output",))):
        variables = [variable for variable in block.variables if variable.section in sections]
        if sections == ("output",):
            head, line = "| name | type | unit, range | meaning |\n|---|---|---|---|\n", lambda row: drop_default(row)
        else:
            head, line = "| name | type | unit, range | default | meaning |\n|---|---|---|---|---|\n", lambda row: row
        rows = "".join(line(variable_row(item, block, tables)) for item in variables)
        result += f"## {title}\n\n{head}{rows}\n"
    return result


def drop_default(row):
    cells = row.split(" | ")
    return " | ".join(cells[:3] + cells[4:])


def error_id(error, tables):
    number, text = tables.errors[error]
    return f"`0x{number:04X}`", text


def state_cell(cell, tables):
    if cell == "-":
        return "no change"
    return cell if cell in STATES else error_id(cell, tables)[0]


def states_text(block, tables):
    cells = tables.states_of(block)
    if block.tags.get("when"):
        return "## In which state\n\n" + wrap(" ".join(block.tags["when"])) + "\n\n"
    if not cells:
        return ""
    if set(cells) == {"-"}:
        return "## In which state\n\nThe block may be called in every state, and never changes the state.\n\n"
    if len(set(cells)) == 1 and cells[0] in tables.errors:
        error = ": ".join(error_id(cells[0], tables))
        return "## In which state\n\n" + wrap(f"Refused in every state: {error}.") + "\n\n"
    rows = ""
    for state, cell in zip(STATES, cells):
        told = ": ".join(error_id(cell, tables)) if cell in tables.errors else state_cell(cell, tables)
        rows += f"| {state} | {told} |\n"
    return ("## In which state\n\n| state of the axis | new state, or the ErrorID of the refusal, which changes nothing |\n"
            f"|---|---|\n{rows}\n")


def errors_text(block, tables):
    errors = tables.errors_of(block)
    if not errors:
        return ""
    rows = "".join("| {} | {} | {} |\n".format(*error_id(error, tables), when) for error, when in errors)
    return f"## Errors\n\n| ErrorID | error | when |\n|---|---|---|\n{rows}\n"


def notes_text(block, notes):
    own = "\n".join(wrap(text, "- ", "  ") for text in block.tags.get("note", []))
    parts = [own] * bool(own) + [text for names, text in notes if block.name in names]
    return "## Notes\n\n" + "\n\n".join(parts) + "\n\n" if parts else ""


def clause_text(block):
    clause = " ".join(block.tags.get("clause", []))
    return f"PLCopen Part 1 v2.0, {clause}" if clause[:1].isdigit() else clause


def first_sentence(text):
    return " ".join(text.split()).partition(". ")[0].rstrip(".") + "."


def page(block, file, tables, notes, has_diagram):
    name = block.name
    include = "iec.h" if file.header == "iec.h" else "plcopen.h"
    diagram = f"## Timing\n\n![timing of {name}]({name}.svg)\n\n" if has_diagram else ""
    defaults = ""
    if any(variable.default for variable in block.variables):
        defaults = (f"A zeroed struct has 0 in place of the defaults below; `{name.upper()}_DEFAULTS` in its "
                    "initialiser sets them.\n\n")
    return (f"# {name}\n\n" + wrap(f"{block.doc} ({clause_text(block)})") + "\n\n"
            + f"`#include <cm1e/{include}>`, `{name}_t`, `{name}(&fb)`.\n"
            + "Rules of all blocks: [the function blocks](../FUNCTION-BLOCKS.md).\n\n"
            + f"```iecst\n{st_text(block)}\n```\n\n{defaults}{variables_text(block, tables)}"
            + states_text(block, tables) + errors_text(block, tables) + notes_text(block, notes)
            + diagram).rstrip() + "\n"


def index(files, tables):
    text = "# The blocks\n\n"
    text += wrap("Each block has a page: its purpose, its declaration, its inputs and outputs with units, the states in "
                 "which it may be called, its errors, and a timing diagram of a run on the simulated motor. "
                 "[The function blocks](../FUNCTION-BLOCKS.md) has the rules of all blocks, [the types](TYPES.md) "
                 "their types. The pages are generated from `fb/interface/`, the diagrams by `tests/traces/`.") + "\n\n"
    for file in files:
        if not file.blocks():
            continue
        text += f"## {CHAPTERS[file.header]}\n\n| block | |\n|---|---|\n"
        for block in file.blocks():
            text += f"| [{block.name}]({block.name}.md) | {first_sentence(block.doc)} |\n"
        text += "\n"
    text += "## Which command in which state\n\n"
    text += wrap("A cell has the new state, or the ErrorID of the refusal, which changes nothing. Blocks that are not in "
                 "this table may be called in every state and never change it.") + "\n\n"
    text += "| block | " + " | ".join(STATES) + " |\n|" + "---|" * (len(STATES) + 1) + "\n"
    by_class = {}
    for block in (block for file in files for block in file.blocks()):
        by_class.setdefault(" ".join(block.tags.get("states", [])), []).append(block.name)
    for name, cells in tables.states.items():
        if name in by_class and set(cells) != {"-"}:
            text += (f"| {', '.join(by_class[name])} | "
                     + " | ".join("no change" if cell == "-" else state_cell(cell, tables) for cell in cells) + " |\n")
    return text


def type_text(declaration):
    doc = " ".join(declaration.doc.split())
    if declaration.kind == "enum":
        rows = "".join(f"| {item.default} | `{item.name}` | {item.text} |\n" for item in declaration.variables)
        return f"{doc}\n\n| number | name | |\n|---|---|---|\n{rows}"
    if declaration.kind == "alias":
        return f"{doc}\n\nThis type is another name of {type_link(declaration.base)}.\n"
    rows = ""
    for item in declaration.variables:
        unit = ", ".join(part for part in (item.unit, item.range) if part)
        kind = f"{type_link(item.type)}[{item.length}]" if item.length else type_link(item.type)
        rows += f"| `{item.name}` | {kind} | {unit} | {item.text} |\n"
    return f"{doc}\n\n| member | type | unit, range | |\n|---|---|---|---|\n{rows}"


def types(files):
    """The page of all types that an application sees."""
    text = "# The types of the blocks\n\n"
    for declaration in (item for file in files for item in file.declarations):
        if declaration.kind in ("enum", "alias", "struct") and not declaration.name.endswith(("_private", "_timer",
                                                                                             "_edges")):
            text += f"## {declaration.name}\n\n{type_text(declaration)}\n"
        elif declaration.kind == "constants":
            constants = ", ".join(f"`{item.name}` {item.default}" for item in declaration.variables)
            text += f"## Sizes\n\n{' '.join(declaration.doc.split())} {constants}.\n\n"
    return text.rstrip() + "\n"


def all_pages(files, tables, notes, has_diagram):
    result = {"docs/blocks/README.md": index(files, tables), "docs/blocks/TYPES.md": types(files)}
    for file in files:
        for block in file.blocks():
            result[f"docs/blocks/{block.name}.md"] = page(block, file, tables, notes, has_diagram(block.name))
    return result
