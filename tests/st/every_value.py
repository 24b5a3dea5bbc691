"""Writes C that gives every input of every block a value of its own in the instances of another compiler, and a library
whose blocks compare what comes and give every output a value of its own. BOOLs are told apart in several rounds."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../fb/interface"))
sys.dont_write_bytecode = True

import c_header  # noqa: E402
import dialects  # noqa: E402
import generate  # noqa: E402
import st  # noqa: E402

COMMON = """
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#ifdef __cplusplus
extern "C" {
#endif
extern int round_now, calls, wrong;
void compare(int same, const char *what);
#ifdef __cplusplus
}
#endif
#define V_BOOL(k) (((k) >> round_now) & 1)
#define V_NUMBER(k) ((k) % 100 + round_now)
#define V_COUNT(k) (7 + round_now)
#define V_TIME(k) (((k) - 20) * INT64_C(1500000001) + round_now)
#define V_TEXT(k) (texts[((k) + round_now) % 8])
enum { ROUNDS = 7 };
static const char *const texts[8] = {"", "a", "bc", "?99.1", "K53.1=100", "long 1 long 2 long 3", "x y",
    "12345678901234567890123456789012345678901234567890123456789012345678901234567890"};
static inline void use_texts(void) { (void)texts; }
"""


COMPARE = """void compare(int same, const char *what)
{
    if (!same && wrong++ < 10)
        printf("%s: round %d\\n", what, round_now);
}
"""
# The private part is clear at the first call of an instance, and is left alone between calls.
PRIVATE = """    static const char none[sizeof own->Private];
    if (round_now == 0)
        compare(memcmp(&own->Private, none, sizeof none) == 0, "NAME begins");
    else
        compare(memcmp(&own->Private, &own, sizeof own) == 0, "NAME stays");
    memcpy(&own->Private, &own, sizeof own);
"""


class Leaf:
    """One elementary value within a variable."""

    def __init__(self, number, path, kind, name):
        self.number, self.path, self.kind, self.name = number, path, kind, name

    def value(self, more=0):
        if self.name in dialects.COUNTS.values():
            return "V_COUNT(0)"
        kind = {"BOOL": "BOOL", "TIME": "TIME", "STRING(80)": "TEXT"}.get(self.kind, "NUMBER")
        return f"V_{kind}({self.number + more})"


def model():
    return dialects.Model([st.Reader(name, generate.read(f"fb/interface/{name}")).read() for name in generate.FILES])


def leaves(of, variable, number):
    """The leaves of a variable; of an array the first and the last element."""
    length = of.length(variable) or (str(dialects.POINTS) if variable.reference and variable.section == "" else "")
    places = [(0,), (int(length) - 1,)] if length else [()]
    result = []
    for place in places:
        if of.kind(variable.type) == "struct":
            for member in of.types[variable.type].variables:
                for leaf in leaves(of, member, number + len(result)):
                    result.append(Leaf(leaf.number, [(variable, place)] + leaf.path, leaf.kind, leaf.name))
        else:
            kind = of.kind(variable.type)
            result.append(Leaf(number + len(result), [(variable, place)],
                               "ENUM" if kind == "enum" else of.elementary(variable.type), variable.name))
    return result


def block_leaves(of, block):
    """[(variable, [leaves])] of all that is not private."""
    result, number = [], 1
    for variable in block.variables:
        if variable.section != "private":
            found = leaves(of, variable, number)
            number += len(found)
            result.append((variable, found))
    return result


def changed(of, variable):
    return variable.section == "in_out" and not variable.const and variable.type not in ("AXIS_REF", "AXES_GROUP_REF")


def plain_path(leaf):
    text, separator = "own", "->"
    for variable, place in leaf.path:
        text += separator + variable.name + "".join(f"[{i}]" for i in place)
        pointer = variable.section == "in_out" or variable.reference
        separator = "->" if pointer and not place else "."
    return text


def library(of):
    """The blocks as the adapters call them."""
    text = "#include <cm1e/plcopen.h>\n" + COMMON + "int round_now, calls, wrong;\n"
    text += COMPARE
    for block in of.blocks:
        lines, name = "", block.name
        for variable, found in block_leaves(of, block):
            for leaf in found:
                path = plain_path(leaf)
                what = f'"{name} {path}"'
                if variable.section != "output":
                    same = f"strcmp({path}, {leaf.value()}) == 0" if leaf.kind == "STRING(80)" else \
                        f"{path} == {leaf.value()}"
                    lines += f"    compare({same}, {what});\n"
                if variable.section == "output" or changed(of, variable):
                    more = 50 if changed(of, variable) else 0
                    lines += (f"    strcpy({path}, {leaf.value(more)});\n" if leaf.kind == "STRING(80)"
                              else f"    {path} = {leaf.value(more)};\n")
        lines += PRIVATE.replace("NAME", name)
        if any(variable.section == "private" for variable in block.variables):
            text += f"void {name}({name}_t *own)\n{{\n    calls++;\n{lines}}}\n"
        else:
            raise ValueError(f"{name} has no private part")
    return text


# ---- the programs of the compilers -----------------------------------------------------------------------------------

class Matiec:
    head = '#include "iec_std_lib.h"\n#include "POUS.h"\n' + COMMON

    @staticmethod
    def path(leaf):
        text = "fb"
        for i, (variable, place) in enumerate(leaf.path):
            text += f".{dialects.name_of(variable).upper()}" + ".value" * (i == 0)
            text += "".join(f".table[{n}]" for n in place)
        return text

    def set(self, leaf):
        path = self.path(leaf)
        if leaf.kind == "TIME":
            return f"{path} = (TIME){{{leaf.value()} / 1000000000, {leaf.value()} % 1000000000}};"
        if leaf.kind == "STRING(80)":
            return f"{path}.len = strlen({leaf.value()}); memcpy({path}.body, {leaf.value()}, {path}.len);"
        return f"{path} = {leaf.value()};"

    def same(self, leaf, more):
        path, value = self.path(leaf), leaf.value(more)
        if leaf.kind == "TIME":
            return f"{path}.tv_sec == {value} / 1000000000 && {path}.tv_nsec == {value} % 1000000000"
        if leaf.kind == "STRING(80)":
            return f"{path}.len == strlen({value}) && memcmp({path}.body, {value}, {path}.len) == 0"
        return f"{path} == {value}"

    @staticmethod
    def instance(block):
        return f"static {block.name.upper()} fb;"

    @staticmethod
    def call(block):
        return f"{block.name.upper()}_body__(&fb);"

    @staticmethod
    def use(variable):
        return f"fb.USE{variable.name.upper()}.value = 1;"

    # A forced output keeps its value.
    force = "fb.ERRORID.value = 9999; fb.ERRORID.flags = 2;"
    kept = "fb.ERRORID.value == 9999"


class Strucpp(Matiec):
    head = '#include "machine.hpp"\n#include <new>\n' + COMMON

    @staticmethod
    def path(leaf):
        return "fb" + "".join(f".{dialects.name_of(variable).upper()}" + "".join(f".at({n + 1})" for n in place)
                              for variable, place in leaf.path)

    def set(self, leaf):
        path = self.path(leaf)
        if leaf.kind == "ENUM":
            return f"set_enum({path}, {leaf.value()});"
        return f"{path} = {leaf.value()};"

    def same(self, leaf, more):
        if leaf.kind == "STRING(80)":
            return f"strcmp({self.path(leaf)}.get().c_str(), {leaf.value(more)}) == 0"
        return f"(long long){self.path(leaf)}.get() == {leaf.value(more)}"

    @staticmethod
    def instance(block):
        """In memory that is not clear."""
        up = f"strucpp::{block.name.upper()}"
        return (f"alignas({up}) static unsigned char room[sizeof({up})];\n    if (round_now == 0) {{\n"
                f"        memset(room, 0xA5, sizeof room);\n        new (room) {up};\n    }}\n"
                f"    {up} &fb = *reinterpret_cast<{up} *>(room);")

    @staticmethod
    def call(block):
        return "fb();"

    @staticmethod
    def use(variable):
        return f"fb.USE{variable.name.upper()} = true;"

    force = "fb.ERRORID.force(9999);"
    kept = "fb.ERRORID.get() == 9999"


class Rusty(Matiec):
    head = '#include "machine.h"\n' + COMMON

    @staticmethod
    def path(leaf):
        text, separator = "fb", "."
        for variable, place in leaf.path:
            text += separator + dialects.name_of(variable) + "".join(f"[{n}]" for n in place)
            pointer = variable.section == "in_out" or variable.reference
            separator = "->" if pointer and not place else "."
        return text

    def set(self, leaf):
        path = self.path(leaf)
        return f"strcpy({path}, {leaf.value()});" if leaf.kind == "STRING(80)" else f"{path} = {leaf.value()};"

    def same(self, leaf, more):
        path = self.path(leaf)
        value = leaf.value(more)
        return f"strcmp({path}, {value}) == 0" if leaf.kind == "STRING(80)" else f"{path} == {value}"

    @staticmethod
    def instance(block):
        """What the instance refers to is the program's."""
        text = f"static {block.name}_type fb;"
        for variable in block.variables:
            if variable.section == "in_out" or variable.reference:
                name = variable.name
                text += f"\n    static {variable.type} of_{name};\n    fb.{name} = &of_{name};"
                if variable.type == "MC_CAM_REF":
                    text += f"\n    static MC_CAM_POINT points[{dialects.POINTS}];\n    of_{name}.Points = points;"
        return text

    @staticmethod
    def call(block):
        return f"{block.name}(&fb);"

    @staticmethod
    def use(variable):
        return ""

    force = ""


COMPILERS = {"matiec": Matiec(), "strucpp": Strucpp(), "rusty": Rusty()}
SET_ENUM = """
template <class T> void set_enum(strucpp::IEC_ENUM<T> &to, int number)
{
    to = strucpp::IEC_ENUM_Value<T>(static_cast<T>(number));
}
"""


def program(of, compiler):
    text = compiler.head + (SET_ENUM if compiler is COMPILERS["strucpp"] else "")
    for block in of.blocks:
        lines = ""
        for variable, found in block_leaves(of, block):
            if variable.reference:
                lines += f"    {compiler.use(variable)}\n"
            if variable.section != "output":
                lines += "".join(f"    {compiler.set(leaf)}\n" for leaf in found)
        lines += f"    {compiler.call(block)}\n"
        for variable, found in block_leaves(of, block):
            if variable.section == "output" or changed(of, variable):
                more = 50 if changed(of, variable) else 0
                lines += "".join(f'    compare({compiler.same(leaf, more)}, "{block.name} {variable.name} out");\n'
                                 for leaf in found)
        if compiler.force and block.name == "MC_Power":
            lines += (f"    if (round_now == ROUNDS - 1) {{\n        {compiler.force}\n        {compiler.call(block)}\n"
                      f'        compare({compiler.kept}, "a forced output");\n        calls--;\n    }}\n')
        text += f"static void try_{block.name}(void)\n{{\n    {compiler.instance(block)}\n{lines}}}\n"
    tries = "".join(f"        try_{block.name}();\n" for block in of.blocks)
    return (f"{text}int main(void)\n{{\n    use_texts();\n    for (round_now = 0; round_now < ROUNDS; round_now++) {{\n"
            f"{tries}    }}\n    printf(\"%d calls, %d values are wrong\\n\", calls, wrong);\n"
            f"    return wrong != 0 || calls != {len(of.blocks)} * ROUNDS;\n}}\n")
