"""Writes a public header from the declarations of an ST file."""
import textwrap

WIDTH = 120


def c_type(name):
    """The standard's names stay; handles and what is ours follow the house's names."""
    if name == "STRING(80)":
        return "STRING80"
    return name + "_t" if name in ("AXIS_REF", "AXES_GROUP_REF") or name.startswith("cm1e_") else name


def comment(text, indent=""):
    """A doc comment, wrapped."""
    lines = []
    for paragraph in text.split("\n\n"):
        paragraph = " ".join(paragraph.split()).replace("@rt ", "@rt\0")  # the mark stays on one line
        lines += textwrap.wrap(paragraph, WIDTH - len(indent) - 8)
    body = ("\n" + indent + " *  ").join(lines).replace("\0", " ")
    return f"{indent}/** {body} */\n"


def note(variable):
    """"u/s, > 0 ... maximum; text" of a member."""
    limits = ", ".join(part for part in (variable.unit, variable.range) if part)
    return "; ".join(part for part in (limits, variable.text) if part)


def is_pointer(variable):
    return variable.section == "in_out" or variable.reference


def c_name(variable):
    """Of the one member that cannot have its name in ST, where PRIVATE is a keyword."""
    return "Private" if variable.section == "private" and variable.name == "Priv" else variable.name


def declarator(variable):
    kind = c_type(variable.type)
    if is_pointer(variable):
        const = "const " if variable.const or variable.reference else ""
        return f"{const}{kind} *", c_name(variable)
    return f"{kind} ", c_name(variable) + (f"[{variable.length}]" if variable.length else "")


def members(variables):
    """One member a line; neighbours of one type of which nothing is to be said share a line."""
    rows = []
    for variable in variables:
        kind, name = declarator(variable)
        text = note(variable)
        last = rows[-1] if rows else None
        if last and not text and not last[2] and last[0] == kind and last[3] == variable.section and kind[-1] != "*":
            last[1] += ", " + name
        else:
            rows.append([kind, name, text, variable.section])
    width = max((len(kind + name) for kind, name, text, _ in rows if text), default=0)
    result, before = "", ""
    for kind, name, text, section in rows:
        if section == "output" != before:
            result += "    /* outputs */\n"
        before = section
        line = f"    {kind}{name};"
        if text:
            start = f"    {(kind + name + ';').ljust(width + 1)} /**< "
            parts = textwrap.wrap(text, WIDTH - len(start) - 3)
            line = start + ("\n" + " " * len(start)).join(parts) + " */"
        result += line + "\n"
    return result


def enum(declaration):
    rows = [(f"{item.name} = {item.default},", item.text) for item in declaration.variables]
    width = max(len(row) for row, text in rows if text) if any(text for _, text in rows) else 0
    body = "".join(f"    {row.ljust(width)} /**< {text} */\n" if text else f"    {row}\n" for row, text in rows)
    return f"typedef enum {declaration.name} {{\n{body}}} {declaration.name};\n"


def defaults(block):
    """The initial values of a block that are not 0, for its initialiser."""
    values = [(variable.name, variable.default) for variable in block.variables if variable.default]
    if not values:
        return ""
    macro = f"{block.name.upper()}_DEFAULTS"
    first = block.variables[0].name
    text = f"Its initial values: `{block.name}_t fb = {{.{first} = &axis, {macro}}};`"
    pairs = textwrap.wrap(", ".join(f".{name}\0=\0{value}" for name, value in values),
                          WIDTH - len(f"#define {macro}  \\"))
    return comment(text) + f"#define {macro} " + " \\\n    ".join(pairs).replace("\0", " ") + "\n"


def block(declaration, symbol):
    clause = " ".join(declaration.tags.get("clause", []))
    label = f' CM1E_SYMBOL("{symbol}{declaration.name}")' if symbol else ""
    name = declaration.name
    return (comment(f"{clause}. {declaration.doc} @rt cycle")
            # In C++ a struct's name without _t would hide the function's.
            + f"typedef struct {name}_t {{\n{members(declaration.variables)}}} {name}_t;\n"
            + defaults(declaration)
            + f"CM1E_API void {name}({name}_t *fb){label};\n")


def declaration_text(declaration, symbol):
    if declaration.kind == "block":
        return block(declaration, symbol)
    doc = comment(declaration.doc) if declaration.doc else ""
    if declaration.kind == "enum":
        return doc + enum(declaration)
    if declaration.kind == "alias":
        return doc + f"typedef {c_type(declaration.base)} {c_type(declaration.name)};\n"
    if declaration.kind == "constants":
        return doc + "".join(f"#define {item.name} {item.default}\n" for item in declaration.variables)
    tag = declaration.name
    return doc + f"typedef struct {tag} {{\n{members(declaration.variables)}}} {c_type(tag)};\n"


def header(file):
    guard = "CM1E_" + file.header.replace(".", "_").upper()
    about = f"/**\n * @file {file.header}\n"
    for paragraph in (file.title + (" " + file.text if file.text else "")).split("\n\n"):
        about += "".join(f" * {line}\n" for line in textwrap.wrap(" ".join(paragraph.split()), WIDTH - 3))
    about += f" * Generated from {file.path} by fb/interface/generate.py; change it there.\n */\n"
    exports = any(item.kind == "block" for item in file.declarations)
    includes = "".join(f'#include "{name}"\n' for name in ["cm1e/api.h"] * exports + file.includes)
    body = "\n".join(declaration_text(item, file.symbol) for item in file.declarations if "external" not in item.tags)
    return (f"{about}#ifndef {guard}\n#define {guard}\n\n{includes}\n"
            f'#ifdef __cplusplus\nextern "C" {{\n#endif\n\n{body}\n#ifdef __cplusplus\n}}\n#endif\n#endif\n')
