/**
 * @file st_state.h
 * One translation: its sources, its tree, its names and its errors. For the sources of this room.
 */
#ifndef CM1E_ST_STATE_H
#define CM1E_ST_STATE_H

#include "core/near.h"
#include "st/st.h"
#include "st/st_memory.h"
#include "st/st_tree.h"

enum { ST_ERRORS = 20, ST_DEPTH = 200, ST_SOURCES = 1000, ST_SOURCE_BYTES = 16 << 20, ST_STRING_BYTES = 255 };

typedef struct source {
    const char *name, *text;
    size_t size;
    bool external;      /**< of our interface */
    const char *symbol; /**< prefix of its symbols */
    bool library;       /**< in Structured Text, but ours: what is not used is not emitted */
    const char *list;   /**< name of the list of global variables that it is (TwinCAT); NULL: none */
    bool qualified;     /**< its variables need that name in front of theirs */
    const char *shown;  /**< text as it is in the file, where `text` is made of it; else NULL */
    size_t shown_size;
} source_t;

/** How far a type or the value of a constant is. */
enum { ST_NEW, ST_BUSY, ST_READY };

/** Expressions contain calls, and types contain expressions: the parts of the checker reach each other through this. */
typedef struct checker {
    void (*expression)(st_t *st, expr_t *expr);
    bool (*integer_constant)(st_t *st, expr_t *expr, int64_t *value, const char *what);
    bool (*call_method)(st_t *st, expr_t *call, bool statement);
    bool (*standard_call)(st_t *st, expr_t *call, const char *name);
} checker_t;

struct st {
    arena_t *arena;
    const checker_t *checker;
    source_t sources[ST_SOURCES];
    unsigned source_count;
    unsigned source;      /**< that is parsed */
    tree_t tree;
    scope_t *scope;       /**< of what is parsed */
    map_t *spaces, *used; /**< namespaces that there are, and those that USING names */
    map_t *types, *units, *globals, *enumerators;
    type_t *elementary[T_WRONG + 1];
    type_t *made;         /**< arrays, strings and references, each once */
    unit_t *unit;         /**< that is checked or emitted */
    int resolving;        /**< types that are being resolved */
    int loops;            /**< around the statement that is checked */
    bool before_all;      /**< the initial value of a VAR_STAT is checked: there is no instance */
    st_error_t errors[ST_ERRORS];
    unsigned error_count, suppressed;
    FILE *out;
    const expr_t *callee; /**< instance whose call is emitted: it is `fb` there */
    type_t *initials;     /**< emitted types that have an init_...() */
    bool leaves;          /**< the unit that is emitted has a RETURN */
    int indent;
    unsigned temporaries;
    uint64_t elements;    /**< of initial values */
    uint64_t memory;      /**< bytes AT %M */
    uint64_t listed_most; /**< variables that others see by their names */
};

/** Reports an error; at most one for each line, ST_ERRORS in all. */
void cm1e_st_report(st_t *st, place_t place, const char *format, ...) CM1E_PRINTF(3, 4);

/* st_report.c: for the end of an error, "; did you mean "x"?", or "" if no name is near. */
const char *cm1e_st_meant(st_t *st, const cm1e_near_t *near);
/** The variables of a list that are in one of these sections (bits 1 << section_t). */
const char *cm1e_st_meant_var(st_t *st, const char *word, const var_t *vars, unsigned sections);
/** The names of a map. */
const char *cm1e_st_meant_name(st_t *st, const char *word, const map_t *map);

/* st_parser.y */
void cm1e_st_parse(st_t *st);

/* st_literal.c: the constant of a literal's text. Report what is wrong with it. */
expr_t *cm1e_st_literal(st_t *st, place_t place, const char *text);
expr_t *cm1e_st_string_literal(st_t *st, place_t place, const char *text);
expr_t *cm1e_st_wide_literal(st_t *st, place_t place, const char *text);

/* st_type.c */
void cm1e_st_begin_types(st_t *st);
/** The type itself, behind names and aliases; reports what does not exist. Never NULL. */
type_t *cm1e_st_resolve(st_t *st, type_t *type);
/** The type of an elementary name; NULL: it is none. */
type_t *cm1e_st_elementary(const st_t *st, const char *name);
/** STRING or WSTRING. */
type_t *cm1e_st_text_type(st_t *st, int64_t length, bool wide);
/** Integers of a base that are first ... last. */
type_t *cm1e_st_range_type(st_t *st, const type_t *base, int64_t first, int64_t last);
type_t *cm1e_st_ref_type(st_t *st, type_t *to);
/** `automatic`: REFERENCE TO. */
type_t *cm1e_st_any_ref_type(st_t *st, type_t *to, bool automatic);
int cm1e_st_bits(type_kind_t kind);
bool cm1e_st_is_signed(type_kind_t kind);
bool cm1e_st_is_unsigned(type_kind_t kind);
bool cm1e_st_is_bits(type_kind_t kind);    /* BOOL too */
bool cm1e_st_is_integer(type_kind_t kind); /* T_ANY_INT too */
bool cm1e_st_is_floating(type_kind_t kind); /* T_ANY_REAL too */
/** Of an enumeration that of its base. */
type_kind_t cm1e_st_plain_kind(const type_t *type);
bool cm1e_st_is_number(type_kind_t kind);
bool cm1e_st_is_time(type_kind_t kind);    /* TIME, DATE, TOD, DT */
bool cm1e_st_fits(type_kind_t kind, const constant_t *value);
/** Whether every value of `from` is a value of `to`. */
bool cm1e_st_widens(type_kind_t from, type_kind_t to);
/** The smallest type to which both widen; T_NONE: there is none. */
type_kind_t cm1e_st_common(type_kind_t a, type_kind_t b);
int64_t cm1e_st_wrap(type_kind_t kind, int64_t value);

/* st_scope.c */
/** What a name means where it is written: in its namespace and those around it, in one that is used there, or outside
 *  of all; NULL: nothing. Reports a name that several used namespaces have. */
/** Whether a place is in a namespace, or in one within it. */
bool cm1e_st_same_namespace(const scope_t *scope, const scope_t *of);
void *cm1e_st_lookup(st_t *st, const map_t *map, const scope_t *scope, place_t place, const char *name);
/** That the namespaces which USING names exist. */
void cm1e_st_check_used(st_t *st);
/** a.b.c as it is written; NULL: the expression is no such name. */
const char *cm1e_st_dotted(st_t *st, const expr_t *expr);
/** A name for C. */
const char *cm1e_st_c_name(st_t *st, const char *name);

/* st_declare.c */
/** Enters all declarations and resolves their types. */
void cm1e_st_declare(st_t *st);
/** A variable of a block, structure or unit by its name; NULL: there is none. */
var_t *cm1e_st_member(const type_t *type, const char *name);
/** What a name means in the present unit; NULL: nothing. */
var_t *cm1e_st_find_var(st_t *st, const char *name);
/** The value of a constant variable, computed now if it was not yet. */
const constant_t *cm1e_st_constant_of(st_t *st, var_t *var);
/** A variable without an initial value takes that of its type. */
void cm1e_st_inherit_initial(st_t *st, var_t *var);
/** Checks the initial value of a variable. */
void cm1e_st_check_initial(st_t *st, var_t *var);

/* st_expression.c */
void cm1e_st_check_expression(st_t *st, expr_t *expr);
static inline void cm1e_st_expression(st_t *st, expr_t *expr) { st->checker->expression(st, expr); }
/** The expression as a value of this type: converted, if that is lossless; else reported. */
expr_t *cm1e_st_coerce(st_t *st, expr_t *expr, type_t *type, const char *what);
/** Says that an expression is a variable, and how the enumerator of the same name is written, where it has the name of
 *  an enumerator of the type; else "". Names have no case. */
const char *cm1e_st_hidden_enumerator(const type_t *type, const expr_t *expr, char *text, size_t size);
/** A literal without a type gets the one it has if nothing else says so. */
expr_t *cm1e_st_settle(st_t *st, expr_t *expr);
expr_t *cm1e_st_convert_node(st_t *st, expr_t *expr, type_t *type);
/** An enumeration is an integer within an expression (TwinCAT, CODESYS); anything else stays what it is. */
expr_t *cm1e_st_as_integer(st_t *st, expr_t *expr);
/** Checks that something can be assigned to; reports why not. */
/** Something that has an address. */
bool cm1e_st_is_place(const expr_t *expr);
bool cm1e_st_assignable(st_t *st, const expr_t *expr);
/** A function may change nothing but its result, its locals and what it was given as VAR_IN_OUT. */
void cm1e_st_note_change(st_t *st, const expr_t *expr);
const char *cm1e_st_type_name(const type_t *type);
/** An integer that is known now; reports if it is not. */
bool cm1e_st_check_integer(st_t *st, expr_t *expr, int64_t *value, const char *what);
static inline bool cm1e_st_integer_constant(st_t *st, expr_t *expr, int64_t *value, const char *what)
{
    return st->checker->integer_constant(st, expr, value, what);
}
void cm1e_st_fold(st_t *st, expr_t *expr);
/** The value of a comparison of two numbers, times or enumerators that are known. */
void cm1e_st_fold_comparison(expr_t *expr);

/* st_call.c */
/** The name of a program becomes its instance. */
void cm1e_st_take_program(st_t *st, expr_t *expr, unit_t *program);
/** The value is known, and evaluating it changes nothing. */
bool cm1e_st_is_fixed(const expr_t *expr);
/** Two operands of which C does not say which one comes first: reports if that could matter. */
bool cm1e_st_alone(st_t *st, const expr_t *a, const expr_t *b);
void cm1e_st_call(st_t *st, expr_t *call, bool statement);
/** st_standard.c: true: the name is that of a standard function. */
bool cm1e_st_standard_call(st_t *st, expr_t *call, const char *name);
void cm1e_st_standard_names(void (*visit)(const char *name, void *context), void *context);

/* st_statement.c */
void cm1e_st_statements(st_t *st, stmt_t *list);

/** st_alias.c: our name of an input or member that TwinCAT or CODESYS call `name`, of a block or a standard function;
 *  NULL: there is none, `hint` may say what to do. */
const char *cm1e_st_alias(const char *block, const char *name, const char **hint);

/** st_view.c: axis.NcToPlc.ActPos and the like: false: it is none. */
bool cm1e_st_view(st_t *st, expr_t *expr);
/** LIST.name of a global variable: which it is; NULL: none. */
var_t *cm1e_st_in_list(const st_t *st, const expr_t *expr);
/** A call that only updates an AXIS_REF in TwinCAT: here it is always up to date. */
bool cm1e_st_only_updates(st_t *st, const expr_t *call);

/* st_link.c */
/** Bases and interfaces by their names; a block has the variables of its base before its own ones. */
void cm1e_st_link_objects(st_t *st);
/** That methods are overridden with the same parameters, and interfaces are implemented. */
void cm1e_st_check_objects(st_t *st);
/** Name of a method in C. */
const char *cm1e_st_method_name(st_t *st, const char *prefix, const unit_t *owner, const char *name);
/** A method by its name, also that of a base; NULL: there is none. */
unit_t *cm1e_st_find_method(const unit_t *unit, const char *name);
/** Whether `unit` is `other`, extends it, or implements it. */
bool cm1e_st_is_a(const st_t *st, const unit_t *unit, const unit_t *other);
/** As others see it: that of a method with its block, of a property "Block.Name.get". */
const char *cm1e_st_shown_name(st_t *st, const unit_t *unit);
/** Its name as it is written; that of a property is "get name" or "set name". */
const char *cm1e_st_plain_name(const unit_t *method);
/** A method of an interface or of those that it extends; NULL: there is none. */
unit_t *cm1e_st_interface_method(const st_t *st, const unit_t *interface, const char *name);

/* st_object.c */
/** The method that a call means: true, the call has been checked. */
bool cm1e_st_call_method(st_t *st, expr_t *call, bool statement);
/** A property that is read: the call of its GET; false: the name is none. */
bool cm1e_st_read_property(st_t *st, expr_t *expr);
/** A property that is written: the statement becomes the call of its SET. */
bool cm1e_st_write_property(st_t *st, stmt_t *stmt);
/** A name or member of a type REFERENCE TO becomes what it refers to. */
void cm1e_st_follow_reference(st_t *st, expr_t *expr);
/** st_pure.c: whether a method of this name changes more than its own variables. */
bool cm1e_st_changes(st_t *st, const char *name);
/** Whether the statements of a method or a function change more than its own variables. */
bool cm1e_st_body_changes(st_t *st, unit_t *unit);
/** The block of the statements that are checked; NULL: there is none. */
unit_t *cm1e_st_this(const st_t *st);
/** Notes that the present unit calls another one. */
void cm1e_st_note_call(st_t *st, unit_t *callee);
void cm1e_st_check_arguments(st_t *st, unit_t *unit, expr_t *call);

/* st_init.c */
/** FB_Init of a block itself; NULL: it has none. */
unit_t *cm1e_st_init_method(const unit_t *unit);
/** Of it or a base. */
bool cm1e_st_has_init(const unit_t *unit);
/** It takes more than the inputs that every FB_Init has. */
bool cm1e_st_init_takes(const unit_t *unit);
/** The inputs of FB_Init in the declaration of an instance. */
void cm1e_st_check_init_args(st_t *st, var_t *var);
/** An element of an array, with its inputs of `init_elements`. */
var_t cm1e_st_init_element(const var_t *array, const arg_t *inputs);
/** The value of an input; NULL: the declaration gives none. */
const expr_t *cm1e_st_init_arg(const var_t *instance, const var_t *parameter);

/* st_address.c */
void cm1e_st_check_address(st_t *st, var_t *var);
/** A name AT %MX becomes a bit of its byte. */
void cm1e_st_take_from_memory(st_t *st, expr_t *expr);
bool cm1e_st_can_be_kept(const type_t *type);

/* st_initial.c */
/** The initial value of something of this type as the checker wants it. */
expr_t *cm1e_st_initialiser(st_t *st, expr_t *initial, type_t *type, const char *what);

#endif
