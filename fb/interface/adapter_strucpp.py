"""The adapter for STruC++: C++ templates that copy between the instances of a translated program, whose variables are
objects and whose names are in capitals, and the C structs of the library, which live in the private part of those."""
import adapter_matiec
import c_header
import dialects

HEAD = """// Between programs that STruC++ has translated and the function blocks of cm1e. Made from fb/interface/ by
// fb/interface/adapters.py: change nothing here. Have it included before the program: g++ -include cm1e_strucpp.hpp
#pragma once

#include <cm1e/plcopen.h>
#undef TRUE
#undef FALSE

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace cm1e_strucpp {

// The plain value of a variable, however many objects are around it.
template <class T> auto get(const T &from)
{
    if constexpr (std::is_class_v<T>)
        return get(from.get());
    else
        return from;
}

template <class T, class F> void in(T &to, const F &from)
{
    to = static_cast<T>(get(from));
}

template <class F> void text_in(STRING80 &to, const F &from)
{
    const auto text = from.get();
    const std::size_t length = text.length() < sizeof to - 1 ? text.length() : sizeof to - 1;
    std::memcpy(to, text.c_str(), length);
    to[length] = '\\0';
}

template <class V, class T> void out(V &to, T from)
{
    if constexpr (std::is_class_v<V>)
        to = static_cast<typename V::value_type>(from);
    else
        to = static_cast<V>(from);
}

// The C struct of the library, in the private part of an instance. The first call of an instance clears it.
template <class T, class FB> T *own(FB *fb)
{
    static_assert(sizeof fb->PRIV >= sizeof(T), "no room");
    static_assert(alignof(decltype(fb->PRIV)) >= alignof(T), "alignment");
    void *room = &fb->PRIV;
    if (!get(fb->PRIVREADY)) {
        std::memset(room, 0, sizeof(T));
        fb->PRIVREADY = true;
    }
    return static_cast<T *>(room);
}

"""
CHECK_HEAD = """// What the adapter relies on in a translated program. Made from fb/interface/ by
// fb/interface/adapters.py: change nothing here. cm1e_strucpp_host.cpp includes it behind the program.
static_assert(sizeof(strucpp::BOOL_t) == 1 && sizeof(strucpp::TIME_t) == 8 && sizeof(strucpp::LREAL_t) == 8);
static_assert(std::is_signed<strucpp::TIME_t>::value && sizeof(strucpp::LWORD_t) == 8);
"""


def one_in(model, variable, to, source):
    if variable.type == "STRING(80)":
        return f"text_in({to}, {source});\n"
    if model.kind(variable.type) == "struct":
        return f"in_{variable.type}({to}, {source});\n"
    return f"in({to}, {source});\n"


def value_in(model, variable, to, source):
    if variable.length:
        return (f"for (int i = 0; i < {model.length(variable)}; i++)\n        " +
                one_in(model, variable, f"{to}[i]", f"{source}.at(i + 1)"))
    return one_in(model, variable, to, source)


def one_out(model, variable, target, source):
    if variable.type == "STRING(80)":
        return f"{target} = {source};\n"
    if model.kind(variable.type) == "struct":
        return f"out_{variable.type}({target}, {source});\n"
    return f"out({target}, {source});\n"


def struct_in(model, declaration):
    name, lines = declaration.name, ""
    for variable in declaration.variables:
        up = dialects.name_of(variable).upper()
        if variable.reference:
            count = dialects.COUNTS[variable.name]
            lines += (f"    static thread_local {c_header.c_type(variable.type)} {variable.name}[{dialects.POINTS}];\n"
                      f"    for (int i = 0; i < {dialects.POINTS}; i++)\n"
                      f"        in_{variable.type}({variable.name}[i], from.{up}.at(i + 1));\n"
                      f"    const bool fits = get(from.{count.upper()}) <= {dialects.POINTS};\n"
                      f"    to.{variable.name} = fits ? {variable.name} : nullptr;\n")
        else:
            lines += "    " + value_in(model, variable, f"to.{variable.name}", f"from.{up}")
    return f"template <class F> void in_{name}({c_header.c_type(name)} &to, const F &from)\n{{\n{lines}}}\n\n"


def struct_out(model, declaration):
    name, lines = declaration.name, ""
    for variable in declaration.variables:
        lines += "    " + one_out(model, variable, f"to.{dialects.name_of(variable).upper()}", f"from.{variable.name}")
    return f"template <class V> void out_{name}(V &to, const {c_header.c_type(name)} &from)\n{{\n{lines}}}\n\n"


def call(model, block):
    inputs, outputs, locals_ = "", "", ""
    for variable in block.variables:
        name, source = variable.name, f"fb->{variable.name.upper()}"
        if variable.section == "in_out" or variable.reference:
            locals_ += f"    {c_header.c_type(variable.type)} {name}{{}};\n"
            inputs += f"    in_{variable.type}({name}, {source});\n"
            given = f"get(fb->USE{name.upper()}) ? &{name} : nullptr" if variable.reference else f"&{name}"
            inputs += f"    own->{name} = {given};\n"
        elif variable.section == "input":
            inputs += "    " + value_in(model, variable, f"own->{name}", source)
    for variable in adapter_matiec.written(model, block):
        target = f"fb->{variable.name.upper()}"
        if variable.length:
            outputs += (f"    for (int i = 0; i < {model.length(variable)}; i++)\n"
                        f"        out({target}.at(i + 1), own->{variable.name}[i]);\n")
        else:
            source = f"own->{variable.name}" if variable.section == "output" else variable.name
            outputs += "    " + one_out(model, variable, target, source)
    name = block.name
    return (f"template <class FB> void call_{name}(FB *fb)\n{{\n    {name}_t *own = cm1e_strucpp::own<{name}_t>(fb);\n"
            f"{locals_}{inputs}    {name}(own);\n{outputs}}}\n\n")


def checks(model):
    text = CHECK_HEAD
    for declaration in model.types.values():
        if declaration.kind == "enum":
            name = model.type_name(declaration.name).upper()
            text += "".join(f"static_assert(int(strucpp::{name}::{item.name.upper()}) == {item.default});\n"
                            for item in declaration.variables)
    return text


def files(model):
    out = adapter_matiec.structs_out(model)
    text = HEAD
    for declaration in model.types.values():
        if declaration.kind == "struct" and not model.is_private(declaration.name):
            text += struct_in(model, declaration)
            text += struct_out(model, declaration) if declaration.name in out else ""
    text += "".join(call(model, block) for block in model.blocks) + "} // namespace cm1e_strucpp\n\n"
    text += "// What the statement of a block calls.\n"
    for name in (block.name for block in model.blocks):
        text += f"template <class FB> void cm1e_strucpp_{name}(FB *fb) {{ cm1e_strucpp::call_{name}(fb); }}\n"
    return {"strucpp/cm1e_strucpp.hpp": text, "strucpp/cm1e_strucpp_checks.hpp": checks(model)}
