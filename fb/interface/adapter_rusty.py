"""The adapter for RuSTy, which calls C itself: its instances have the layout of our structs. Since it has methods, a
pointer to the table of them comes first."""
import textwrap
from dataclasses import replace

import c_header

HEAD = """/* Between programs that RuSTy (plc) has compiled and the function blocks of cm1e. Made from fb/interface/ by
 * fb/interface/adapters.py: change nothing here.
 *
 * CM1E_RUSTY_VTABLE 0: instances are as our structs, and programs call our functions.
 * CM1E_RUSTY_VTABLE 1: instances begin with a pointer to a table of methods. The linker gives the calls of the program
 * to the functions here (@wrap.txt), which leave that pointer out.
 * Before it wrote constructors, plc wanted the initial value of each external block as a constant; they are here. */
#include <cm1e/plcopen.h>
#include <stddef.h>

#ifndef CM1E_RUSTY_VTABLE
#define CM1E_RUSTY_VTABLE 1
#endif

#if UINTPTR_MAX != UINT64_MAX
#error "pointers of RuSTy have 64 bits"
#endif

#if CM1E_RUSTY_VTABLE
#define VTABLE void *vtable;
enum { BEFORE = sizeof(void *) };
#define CALL(NAME) \\
    void __real_##NAME(void *block); \\
    void __wrap_##NAME(NAME##_type *fb); \\
    void __wrap_##NAME(NAME##_type *fb) { __real_##NAME((char *)fb + BEFORE); }
#else
#define VTABLE
enum { BEFORE = 0 };
#define CALL(NAME)
#endif
#define INITIAL(NAME, ...) \\
    extern const NAME##_type __##NAME##__init; \\
    __attribute__((weak)) const NAME##_type __##NAME##__init = {__VA_ARGS__};
#define AT(NAME, MEMBER) \\
    _Static_assert(offsetof(NAME##_type, MEMBER) == BEFORE + offsetof(NAME##_t, MEMBER), #NAME "." #MEMBER);

/* The instances as RuSTy has them: variables in the order of declaration, with the alignment of C. */
"""


def block_text(block):
    name = block.name
    members = "\n".join(c_header.members([plain(variable) for variable in block.variables]).splitlines())
    text = f"typedef struct {name}_type {{\n    VTABLE\n{members}\n}} {name}_type;\n"
    asserts = " ".join(f"AT({name}, {c_header.c_name(variable)})" for variable in block.variables)
    text += "\n".join(textwrap.wrap(asserts, 118, break_on_hyphens=False)) + "\n"
    defaults = f"{name.upper()}_DEFAULTS" if any(variable.default for variable in block.variables) else "0"
    return f"{text}CALL({name})\nINITIAL({name}, {defaults})\n\n"


def plain(variable):
    """Without what is said of it."""
    return replace(variable, unit="", range="", text="")


def files(model):
    text = HEAD + "".join(block_text(block) for block in model.blocks)
    wraps = "".join(f"-Wl,--wrap={block.name}\n" for block in model.blocks)
    return {"rusty/cm1e_rusty.c": text, "rusty/wrap.txt": wraps}
