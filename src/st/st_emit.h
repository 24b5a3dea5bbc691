/**
 * @file st_emit.h
 * The parts of the emitter. All write to the file of the translation.
 */
#ifndef CM1E_ST_EMIT_H
#define CM1E_ST_EMIT_H

#include "st/st_parsing.h"
#include "st/st_standard.h"

/** Writes to the output. */
void cm1e_st_put(st_t *st, const char *format, ...) CM1E_PRINTF(2, 3);
/** Begins a line with the present indentation. */
void cm1e_st_line(st_t *st, const char *format, ...) CM1E_PRINTF(2, 3);
void cm1e_st_begin_line(st_t *st);
/** The C that follows comes from this line of a source. */
void cm1e_st_place(st_t *st, place_t place);
void cm1e_st_put_quoted(st_t *st, const char *text);

/* st_emit_shape.c */
/** It is a member of the struct of its block, or a variable of its own. */
bool cm1e_st_is_stored(const var_t *var);
bool cm1e_st_needs_initial(const type_t *type);
bool cm1e_st_begins_with_zero(const type_t *owner, const var_t *var);
/** The initial value of an enumeration or a subrange without another one: the first. */
int64_t cm1e_st_default_of(const type_t *type);
/** An input of a function whose initial value C cannot write within a call: a function of this name gives it. */
bool cm1e_st_has_default_function(const var_t *var);
const char *cm1e_st_default_function(st_t *st, const var_t *var);
/** The unit has inputs with R_EDGE or F_EDGE: edges_<type>() is called before it. */
bool cm1e_st_has_edges(const unit_t *unit);
/** The characters of a text in C, and the function that assigns one. */
const char *cm1e_st_text_unit(const type_t *type);
const char *cm1e_st_text_assign(const type_t *type);
void cm1e_st_emit_head(st_t *st, const unit_t *unit);
void cm1e_st_emit_prototype(st_t *st, const unit_t *unit);

/* st_emit_type.c */
/** The name of a type in C; its declaration must have been emitted. */
const char *cm1e_st_c_type(st_t *st, const type_t *type);
/** Emits the declaration of a type, and before it those that it needs. */
void cm1e_st_emit_type(st_t *st, type_t *type);
/** A number of 64 bits in C. */
const char *cm1e_st_int64(st_t *st, int64_t value);
/** The type of runtime functions that takes these values: enumerations and times are integers there. */
const char *cm1e_st_plain_type(const type_t *type);
/** The functions init_<type>(): each stands before all that uses a type, and refers to variables that stand behind
 *  it. */
void cm1e_st_emit_init_functions(st_t *st);
/** Gives something of this type, which is zeroed, its initial value: that of the variable or else that of its type. */
void cm1e_st_emit_initial(st_t *st, const char *target, type_t *type, const expr_t *initial);
/** The same for a variable, with its FB_Init. */
void cm1e_st_emit_var_initial(st_t *st, const char *target, const var_t *var);

/* st_emit_expression.c */
void cm1e_st_emit_expression(st_t *st, const expr_t *expr);
/** A VAR_IN_OUT of the block in a method, which may be called before the block got one: a fault then. */
void cm1e_st_emit_in_out(st_t *st, const var_t *var);
void cm1e_st_emit_constant(st_t *st, const type_t *type, const constant_t *value);
/** A text as a `const char *`. */
void cm1e_st_emit_text(st_t *st, const expr_t *expr);
/* st_emit_call.c */
void cm1e_st_emit_call(st_t *st, const expr_t *call);
/** It is a variable in C, too: a CONSTANT is its number there. */
bool cm1e_st_is_variable(const expr_t *expr);
/** The address of a variable; of a value for VAR_IN_OUT CONSTANT that of a copy, which ends with the call. */
void cm1e_st_emit_address(st_t *st, const expr_t *expr);
/** The same for a VAR_IN_OUT, which may be an array of any length. */
void cm1e_st_emit_given(st_t *st, const var_t *parameter, const expr_t *expr);
/* st_emit_object.c */
/** The name of the function that a call of a method calls, and the instance that it gets. */
void cm1e_st_emit_method(st_t *st, const expr_t *call);
/** The instance alone; NULL: a function has none. */
void cm1e_st_emit_instance(st_t *st, const expr_t *call);
/** Functions that choose between methods of one name by the class of the instance. */
void cm1e_st_emit_dispatchers(st_t *st, bool bodies);
void cm1e_st_emit_conversion(st_t *st, const expr_t *expr);
/* st_emit_statement.c */
void cm1e_st_emit_statements(st_t *st, const stmt_t *list);
/** target := value; with what texts and single bits need. */
void cm1e_st_emit_assignment(st_t *st, const expr_t *target, const expr_t *value);
/* st_emit_unit.c */
void cm1e_st_emit_unit(st_t *st, unit_t *unit);
/** The functions that give its inputs their initial values. */
void cm1e_st_emit_default_functions(st_t *st, unit_t *unit);
/* st_emit_tables.c */
void cm1e_st_emit_tables(st_t *st, const char *name);

#endif
