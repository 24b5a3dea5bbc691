"""The adapter for MATIEC: C that copies between the instances of iec2c, whose variables carry flags and whose names are
in capitals, and the C structs of the library, which live in the private part of those instances."""
import c_header
import dialects

DIALECT = dialects.DIALECTS["matiec"]
HEAD = """/* Between programs that iec2c has translated and the function blocks of cm1e. Made from fb/interface/ by
 * fb/interface/adapters.py: change nothing here. Compile it with the files that iec2c wrote (POUS.h) and its lib/C. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The types of the standard and of PLCopen have their names in both worlds: here those of cm1e get a prefix. */
"""
HELPERS = """
enum { FORCED = 2 }; /* a flag of a variable: it keeps its value */
#define PUT(variable, new_value) \\
    do { \\
        if (!((variable).flags & FORCED)) \\
            (variable).value = (new_value); \\
    } while (0)

static inline int64_t time_in(TIME from)
{
    return (int64_t)from.tv_sec * 1000000000 + from.tv_nsec;
}

/* STRING(80) of the library ends with a 0; what is longer is cut off. */
static inline void text_in(char *to, const STRING *from)
{
    const size_t length = from->len < 80 ? from->len : 80;
    memcpy(to, from->body, length);
    to[length] = '\\0';
}

static inline STRING text_out(const char *from)
{
    STRING to = {0};
    to.len = (__strlen_t)strlen(from);
    memcpy(to.body, from, to.len);
    return to;
}

"""
TIME_OUT = """static inline TIME time_out(int64_t from)
{
    const TIME to = {(long)(from / 1000000000), (long)(from % 1000000000)};
    return to;
}

"""
CHECKS = """
/* What all this relies on. */
_Static_assert(sizeof(BOOL) == 1 && sizeof(INT) == 2 && sizeof(DINT) == 4 && sizeof(LREAL) == 8 && sizeof(LWORD) == 8,
               "elementary types");
_Static_assert(offsetof(__IEC_BOOL_t, value) == 0 && offsetof(__IEC_LREAL_t, value) == 0, "a value precedes its flags");
_Static_assert(sizeof(((STRING *)0)->body) > 80, "STRING is too short for STRING(80)");
"""


def c_type(name):
    return name + "_t" if name in ("AXIS_REF", "AXES_GROUP_REF") or name.startswith("cm1e_") else f"cm1e_{name}"


def renamed(model):
    names = sorted(set(dialects.st.ELEMENTARY) - {"STRING(80)"}) + \
        [name for name in model.types if c_header.c_type(name) == name]
    text = "".join(f"#define {name} cm1e_{name}\n" for name in names)
    text += "#include <cm1e/plcopen.h>\n" + "".join(f"#undef {name}\n" for name in names)
    return text + '#undef TRUE\n#undef FALSE\n#include "iec_std_lib.h"\n#include "accessor.h"\n#include "POUS.h"\n'


def value_in(model, variable, to, source):
    """The statement that gives the library one value; an array by a loop."""
    if variable.length:
        return (f"for (size_t i = 0; i < {model.length(variable)}; i++)\n        " +
                one_in(model, variable, f"{to}[i]", f"{source}.table[i]"))
    return one_in(model, variable, to, source)


def one_in(model, variable, to, source):
    kind = model.elementary(variable.type)
    if kind == "TIME":
        return f"{to} = time_in({source});\n"
    if kind == "STRING(80)":
        return f"text_in({to}, &{source});\n"
    if model.kind(variable.type) == "struct":
        return f"in_{variable.type}(&{to}, &{source});\n"
    cast = f"({c_type(variable.type)})" if model.kind(variable.type) == "enum" else ""
    return f"{to} = {cast}{source};\n"


def one_out(model, variable, source):
    kind = model.elementary(variable.type)
    if kind == "TIME":
        return f"time_out({source})"
    if kind == "STRING(80)":
        return f"text_out({source})"
    if model.kind(variable.type) == "struct":
        return f"out_{variable.type}(&{source})"
    return source


def struct_in(model, declaration):
    """The function that makes the library's struct of iec2c's."""
    name, lines = declaration.name, ""
    for variable in declaration.variables:
        up = dialects.name_of(variable).upper()
        if variable.reference:
            fits = f"from->{dialects.COUNTS[variable.name].upper()} <= {dialects.POINTS}"
            lines += (f"    static _Thread_local {c_type(variable.type)} {variable.name}[{dialects.POINTS}];\n"
                      f"    for (size_t i = 0; i < {dialects.POINTS}; i++)\n"
                      f"        in_{variable.type}(&{variable.name}[i], &from->{up}.table[i]);\n"
                      f"    to->{variable.name} = {fits} ? {variable.name} : NULL;\n")
        else:
            lines += "    " + value_in(model, variable, f"to->{variable.name}", f"from->{up}")
    return f"static inline void in_{name}({c_type(name)} *to, const {name.upper()} *from)\n{{\n{lines}}}\n\n"


def struct_out(model, declaration):
    name, up, lines = declaration.name, declaration.name.upper(), ""
    for variable in declaration.variables:
        value = one_out(model, variable, f"from->{variable.name}")
        lines += f"    to.{dialects.name_of(variable).upper()} = {value};\n"
    return (f"static inline {up} out_{name}(const {c_type(name)} *from)\n{{\n    {up} to;\n{lines}"
            "    return to;\n}\n\n")


def is_handle(variable):
    return variable.type in ("AXIS_REF", "AXES_GROUP_REF")


def written(model, block):
    """Variables that the library changes: outputs, and the in-outs that are more than a handle."""
    return [variable for variable in block.variables
            if variable.section == "output" or (variable.section == "in_out" and not variable.const
                                                and not is_handle(variable))]


def structs_out(model):
    names = {variable.type for block in model.blocks for variable in written(model, block)
             if model.kind(variable.type) == "struct"}
    for name in list(names):
        names |= {variable.type for variable in model.types[name].variables if model.kind(variable.type) == "struct"}
    return names


def call(model, block):
    """The function that the statements of a block call."""
    inputs, outputs, locals_ = "", "", ""
    for variable in block.variables:
        name, source = variable.name, f"fb->{variable.name.upper()}.value"
        if variable.section == "in_out" or variable.reference:
            locals_ += f"    {c_type(variable.type)} {name} = {{0}};\n"
            inputs += f"    in_{variable.type}(&{name}, &{source});\n"
            given = f"fb->USE{name.upper()}.value ? &{name} : NULL" if variable.reference else f"&{name}"
            inputs += f"    own->{name} = {given};\n"
        elif variable.section == "input":
            inputs += "    " + value_in(model, variable, f"own->{name}", source)
    for variable in written(model, block):
        target = f"fb->{variable.name.upper()}"
        if variable.length:
            outputs += (f"    for (size_t i = 0; i < {model.length(variable)} && !({target}.flags & FORCED); i++)\n"
                        f"        {target}.value.table[i] = own->{variable.name}[i];\n")
        else:
            source = f"own->{variable.name}" if variable.section == "output" else variable.name
            outputs += f"    PUT({target}, {one_out(model, variable, source)});\n"
    name, up = block.name, block.name.upper()
    return (f"void cm1e_matiec_{name}({up} *fb);\nvoid cm1e_matiec_{name}({up} *fb)\n{{\n"
            f"    _Static_assert(sizeof({name}_t) <= sizeof fb->PRIV.value, \"{name}: no room\");\n"
            f"    _Static_assert(offsetof({up}, PRIV) % _Alignof({name}_t) == 0, \"{name}: alignment\");\n"
            f"    {name}_t *own = (void *)fb->PRIV.value.table;\n{locals_}"
            f"{inputs}    {name}(own);\n{outputs}}}\n\n")


def checks(model):
    """The numbers of the enumerators."""
    text = CHECKS
    for declaration in model.types.values():
        if declaration.kind == "enum":
            st_name = model.type_name(declaration.name).upper()
            text += "".join(f'_Static_assert((int){st_name}__{item.name.upper()} == {item.default}, "{item.name}");\n'
                            for item in declaration.variables)
    return text


def files(model):
    out = structs_out(model)
    text = ""
    for declaration in model.types.values():
        if declaration.kind == "struct" and not model.is_private(declaration.name):
            text += struct_in(model, declaration)
            text += struct_out(model, declaration) if declaration.name in out else ""
    text += "".join(call(model, block) for block in model.blocks)
    helpers = HELPERS + (TIME_OUT if "time_out(" in text else "")
    return {"matiec/cm1e_matiec.c": HEAD + renamed(model) + helpers + text + checks(model)}
