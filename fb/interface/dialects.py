"""The declarations of the blocks as the Structured Text of other compilers. What differs between compilers is a row of
DIALECTS: which types they have, and how a block without statements gets to the function of its adapter."""
from dataclasses import dataclass

import c_header
import c_table
import st

POINTS = 64  # of a cam, where a struct cannot refer to its points
COUNTS = {"Points": "NumberOfPoints"}  # what says how many elements a reference in a struct is for
RESERVED = {"METHOD": "homing_method"}  # words of the 3rd edition that are names of members in C


@dataclass
class Dialect:
    name: str
    title: str
    text: str  # type of STRING(80)
    time: str
    numbered: bool    # an enumerator can be given its number
    references: bool  # REF_TO may be anywhere; without it a value stands in its place
    semicolon: str = ";"  # behind END_STRUCT
    before: str = ""  # the line above a block
    body: str = ""    # the statements of a block; %s is its name, in the second place in capitals


DIALECTS = {
    "rusty": Dialect("rusty", "RuSTy (plc)", "STRING[80]", "LTIME", True, True, semicolon="", before="{external}\n"),
    "matiec": Dialect("matiec", "MATIEC (iec2c; Beremiz, OpenPLC 3)", "STRING", "TIME", False, False,
                      body="{{ extern void cm1e_matiec_%s(%s *); cm1e_matiec_%s(data__); }}\n"),
    "strucpp": Dialect("strucpp", "STruC++ (OpenPLC 4)", "STRING(80)", "TIME", True, False,
                       body="{external cm1e_strucpp_%s(this); }\n"),
}


class Model:
    """What all dialects and adapters look up: types by name, blocks, sizes."""

    def __init__(self, files):
        declarations = [item for file in files if not file.symbol for item in file.declarations]
        self.files = [file for file in files if not file.symbol]  # each compiler has the blocks of the standard itself
        self.types = {item.name: item for item in declarations if item.kind in ("enum", "alias", "struct")}
        self.constants = {item.name: item.default for group in declarations if group.kind == "constants"
                          for item in group.variables}
        self.blocks = [item for item in declarations if item.kind == "block"]
        self.sizes = c_table.sizes_of(files)
        self.taken = {block.name.upper() for block in self.blocks}

    def room(self, block):
        """The number of LWORDs that hold the C struct of a block."""
        return (c_table.layout(block.variables, self.sizes)[1][0] + 7) // 8

    def is_private(self, name):
        return name.startswith("cm1e_") and name != "cm1e_homing_config"

    def kind(self, name):
        """"elementary", "enum" or "struct", behind all aliases."""
        while name in self.types and self.types[name].kind == "alias":
            name = self.types[name].base
        return self.types[name].kind if name in self.types else "elementary"

    def elementary(self, name):
        while name in self.types and self.types[name].kind == "alias":
            name = self.types[name].base
        return name

    def type_name(self, name):
        """The name of a type in ST, where capitals are as good as small letters; an alias of an enumeration is that
        enumeration, because iec2c and STruC++ write no good C for it."""
        if name in self.types and self.is_alias_of_enum(self.types[name]):
            name = self.types[name].base
        return name + "_TYPE" if name.upper() in self.taken else name

    def is_alias_of_enum(self, declaration):
        return declaration.kind == "alias" and self.kind(declaration.name) == "enum"

    def length(self, variable):
        return self.constants.get(variable.length, variable.length)


def name_of(variable):
    return RESERVED.get(variable.name.upper(), variable.name)


def variables_of(block, dialect):
    """[(section, name, variable, by_reference)] of a block as the dialect has it, without the private part."""
    result = []
    for variable in block.variables:
        if variable.section == "private":
            continue
        if variable.reference and not dialect.references:
            result.append((variable.section, "Use" + variable.name, None, False))
        result.append((variable.section, variable.name, variable, variable.reference and dialect.references))
    return result


def type_text(model, dialect, variable, in_struct=False):
    name = {"STRING(80)": dialect.text, "TIME": dialect.time}.get(variable.type) or model.type_name(variable.type)
    if variable.reference and dialect.references:
        return f"REF_TO {name}"
    if variable.reference and in_struct:
        return f"ARRAY [1..{POINTS}] OF {name}"
    return f"ARRAY [1..{model.length(variable)}] OF {name}" if variable.length else name


def commented(text, note):
    return text + (f" (* {note} *)" if note else "") + "\n"


def enumerators(declaration, dialect):
    """[(name, number, note)]; where numbers cannot be given, names fill the gaps, so that the order gives them. There is always
    one that is 0: a variable begins with it, as in C, and not with the first one."""
    known = {int(item.default): item for item in declaration.variables}
    if dialect.numbered:
        zero = [] if 0 in known else [(f"{declaration.name}_0", 0, "not set")]
        return zero + [(item.name, number, item.text) for number, item in sorted(known.items())]
    return [(known[number].name, number, known[number].text) if number in known
            else (f"{declaration.name}_{number}", number, "none") for number in range(max(known) + 1)]


def enum_text(model, dialect, declaration):
    rows = enumerators(declaration, dialect)
    text = f"TYPE {model.type_name(declaration.name)} : (\n"
    for place, (name, number, note) in enumerate(rows):
        value = f" := {number}" if dialect.numbered else ""
        text += commented(f"    {name}{value}" + "," * (place + 1 < len(rows)), note)
    return text + ");\nEND_TYPE\n"


def struct_text(model, dialect, declaration):
    text = f"TYPE {declaration.name} : STRUCT\n"
    for variable in declaration.variables:
        kind = type_text(model, dialect, variable, True)
        text += commented(f"    {name_of(variable)} : {kind};", c_header.note(variable))
    return text + f"END_STRUCT{dialect.semicolon}\nEND_TYPE\n"


def type_declaration(model, dialect, declaration):
    if declaration.kind == "enum":
        return enum_text(model, dialect, declaration)
    if declaration.kind == "struct":
        return struct_text(model, dialect, declaration)
    if declaration.kind == "alias" and not model.is_alias_of_enum(declaration):
        return f"TYPE {declaration.name} : {model.type_name(declaration.base)}; END_TYPE\n"
    return ""


KEYWORD = {"in_out": "VAR_IN_OUT", "input": "VAR_INPUT", "output": "VAR_OUTPUT"}


def private_part(model, dialect, block):
    if dialect.references:  # the same layout as in C
        own = [variable for variable in block.variables if variable.section == "private"]
        lines = "".join(f"    {variable.name} : {type_text(model, dialect, variable)};\n" for variable in own)
        return f"VAR\n{lines}END_VAR\n" if own else ""
    return f"VAR\n    PrivReady : BOOL;\n    Priv : ARRAY [1..{model.room(block)}] OF LWORD;\nEND_VAR\n"


def block_declaration(model, dialect, block):
    text, before = f"{dialect.before}FUNCTION_BLOCK {block.name}\n", ""
    for section, name, variable, _ in variables_of(block, dialect):
        if section != before:
            text += ("END_VAR\n" if before else "") + KEYWORD[section] + "\n"
            before = section
        if variable is None:
            text += commented(f"    {name} : BOOL;", "TRUE: the next input is used")
            continue
        default = f" := {variable.default}" if variable.default else ""
        text += commented(f"    {name} : {type_text(model, dialect, variable)}{default};", c_header.note(variable))
    text += "END_VAR\n" + private_part(model, dialect, block)
    fill = (block.name, block.name.upper(), block.name)[:dialect.body.count("%s")]
    return text + dialect.body % fill + "END_FUNCTION_BLOCK\n"


def doc(declaration):
    return f"(* {' '.join(declaration.doc.split())} *)\n" if declaration.doc else ""


def declarations(model, dialect):
    """The whole file of a dialect."""
    text = (f"(* The function blocks of cm1e for {dialect.title}. Made from fb/interface/ by\n"
            "   fb/interface/adapters.py: change nothing here. docs/STRUCTURED-TEXT.md says how it is used. *)\n")
    for file in model.files:
        for item in file.declarations:
            if item.kind == "block":
                text += "\n" + doc(item) + block_declaration(model, dialect, item)
            elif not (model.is_private(item.name) and not dialect.references):
                body = type_declaration(model, dialect, item)
                text += "\n" + doc(item) + body if body else ""
    return text
