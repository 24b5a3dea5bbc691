"""Stands in for RuSTy, MATIEC and STruC++: reads declarations of blocks in Structured Text, and writes what each of
them makes of these in C or C++, as its sources and documents say. It was written for these versions: MATIEC 6bb2c339
(2024), STruC++ 0.6.1 (fb7980f5, 2026), RuSTy without tables of methods (4aa3aec4, 2024) and with them (50825be5, 2025)."""
import re

ELEMENTARY = {"BOOL", "SINT", "INT", "DINT", "UINT", "UDINT", "WORD", "DWORD", "LWORD", "LREAL", "TIME"}
RUSTY = {"BOOL": "bool", "SINT": "int8_t", "INT": "int16_t", "DINT": "int32_t", "UINT": "uint16_t", "UDINT": "uint32_t",
         "WORD": "uint16_t", "DWORD": "uint32_t", "LREAL": "double", "LTIME": "int64_t"}


class Source:
    """types: [(name, kind, rows)], blocks: [(name, [(section, name, type, initial)], statements)]"""

    def __init__(self, text):
        text = re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)
        self.types, self.blocks = [], []
        parts = r"TYPE (\w+) : (.*?)END_TYPE|FUNCTION_BLOCK (\w+)(.*?)END_FUNCTION_BLOCK"
        for name, body, block, inside in (part.groups() for part in re.finditer(parts, text, re.DOTALL)):
            if block:
                self.blocks.append(self.block(block, inside))
            else:
                self.types.append(self.type(name, body))
        self.enums = {name for name, kind, _ in self.types if kind == "enum"}
        if len(self.blocks) < 70:
            raise ValueError("the declarations cannot be read")
        for name, kind, rows in self.types:
            if kind == "enum" and rows[0][1] not in ("", "0"):
                raise ValueError(f"a {name} that is left out begins with {rows[0][1]}, and with 0 in C")

    @staticmethod
    def type(name, body):
        if body.startswith("("):
            return name, "enum", re.findall(r"(\w+)(?: := (\d+))?", body)
        if body.startswith("STRUCT"):
            return name, "struct", re.findall(r"(\w+) : ([^;:]+);", body)
        return name, "alias", body.split(";")[0].strip()

    @staticmethod
    def block(name, inside):
        variables = []
        for section, rows in re.findall(r"(VAR\w*)\n(.*?)END_VAR", inside, re.DOTALL):
            variables += [(section, *row) for row in re.findall(r"(\w+) : ([^;]+?)(?: := ([^;]+))?;", rows)]
        return name, variables, inside[inside.rindex("END_VAR") + 7:].strip()


def array(kind):
    """(count, type of an element) or None."""
    match = re.fullmatch(r"ARRAY \[1\.\.(\d+)\] OF (\S+)", kind)
    return (int(match.group(1)), match.group(2)) if match else None


# ---- MATIEC ----------------------------------------------------------------------------------------------------------

class Matiec:
    def __init__(self, source):
        self.arrays, self.text = set(), '#include "iec_std_lib.h"\n'
        for name, kind, rows in source.types:
            self.type(name.upper(), kind, rows)
        for name, variables, _ in source.blocks:
            rows = "".join(f"    __IEC_{self.named(kind)}_t {variable.upper()};\n"
                           for _, variable, kind, _ in variables)
            self.text += f"typedef struct {{\n    __IEC_BOOL_t EN, ENO;\n{rows}}} {name.upper()};\n"
        for name, _, statements in source.blocks:
            up = name.upper()
            self.text += f"static inline void {up}_body__({up} *data__) {{ {statements.strip('{}')} }}\n"

    def named(self, kind):
        """The name of a type; an array gets one when it is met first."""
        found = array(kind)
        if not found:
            return kind.upper()
        name = f"__ARRAY_OF_{found[1].upper()}_{found[0]}"
        if name not in self.arrays:
            self.arrays.add(name)
            self.text += f"typedef struct {{ {found[1].upper()} table[{found[0]}]; }} {name};\n" + self.variable(name)
        return name

    @staticmethod
    def variable(name):
        return f"typedef struct {{ {name} value; uint8_t flags; }} __IEC_{name}_t;\n"

    def type(self, name, kind, rows):
        if kind == "enum":
            self.text += f"typedef enum {{ {', '.join(f'{name}__{item.upper()}' for item, _ in rows)} }} {name};\n"
        elif kind == "alias":
            self.text += f"typedef {rows} {name};\n"
        else:
            members = "".join(f" {self.named(of)} {member.upper()};" for member, of in rows)
            self.text += f"typedef struct {{{members} }} {name};\n"
        self.text += self.variable(name)


# ---- STruC++ ---------------------------------------------------------------------------------------------------------

class Strucpp:
    def __init__(self, source):
        self.enums = {name.upper() for name in source.enums}
        self.text = '#pragma once\n#include "stand_in_runtime.hpp"\nnamespace strucpp {\n'
        for name, kind, rows in source.types:
            up = name.upper()
            if kind == "enum":
                items = ", ".join(f"{item.upper()} = {number}" for item, number in rows)
                self.text += f"enum class {up} {{ {items} }};\nusing IEC_{up} = IEC_ENUM<{up}>;\n"
            elif kind == "alias":
                self.text += f"using IEC_{up} = IEC_{rows};\n"
            else:
                members = "".join(f" {self.named(of)} {member.upper()}{{}};" for member, of in rows)
                self.text += f"struct {up} {{{members} }};\nusing IEC_{up} = {up};\n"
        for name, variables, statements in source.blocks:
            rows = "".join(f"    {self.named(kind)} {variable.upper()};\n" for _, variable, kind, _ in variables)
            code = re.match(r"\{external (.*)\}", statements).group(1)
            self.text += (f"class {name.upper()} {{\npublic:\n{rows}    IEC_BOOL ENO = true;\n"
                          f"    void operator()() {{ {code} }}\n    virtual ~{name.upper()}() = default;\n}};\n")
        self.text += "} // namespace strucpp\n"

    def named(self, kind):
        found = array(kind)
        if found:
            return f"Array1D<{self.named(found[1])}, 1, {found[0]}>"
        if kind.startswith("STRING"):
            return f"IECStringVar<{kind[7:-1]}>"
        return f"IEC_{kind.upper()}"


# ---- RuSTy -----------------------------------------------------------------------------------------------------------

class Rusty:
    def __init__(self, source, table_of_methods):
        self.text = "#include <stdbool.h>\n#include <stdint.h>\n"
        for name, kind, rows in source.types:
            if kind == "enum":
                self.text += f"typedef int32_t {name};\n"
            elif kind == "alias":
                self.text += f"typedef {RUSTY.get(rows, rows)} {name};\n"
            else:
                self.text += f"typedef struct {{{''.join(self.member(*row) for row in rows)} }} {name};\n"
        for name, variables, _ in source.blocks:
            members = "".join(self.member(variable, kind, section == "VAR_IN_OUT")
                              for section, variable, kind, _ in variables)
            first = " uint64_t *__vtable;" if table_of_methods else ""
            self.text += f"typedef struct {{{first}{members} }} {name}_type;\nvoid {name}({name}_type *self);\n"

    @staticmethod
    def member(name, kind, pointer=False):
        found = array(kind)
        if found:
            return f" {RUSTY.get(found[1], found[1])} {name}[{found[0]}];"
        if kind.startswith("STRING"):
            return f" char {name}[{int(kind[7:-1]) + 1}];"
        if kind.startswith("REF_TO"):
            kind, pointer = kind.split()[1], True
        return f" {RUSTY.get(kind, kind)} {'*' if pointer else ''}{name};"
