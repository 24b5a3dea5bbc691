/**
 * @file st_parsing.h
 * What lexer and parser share while they read one source. The parser's actions build the tree with the functions below.
 */
#ifndef CM1E_ST_PARSING_H
#define CM1E_ST_PARSING_H

#include "st/st_state.h"

typedef struct parsing {
    st_t *st;
    void *scanner;
    uint32_t line, column; /**< behind the last word */
    place_t comment;       /**< beginning of the comment that is read */
    unsigned depth;        /**< of nested comments */
    place_t last_place;    /**< of the last word, which an error is about */
    char last[48], before[48]; /**< the last word, and the one before it */
    int qualifiers;        /**< of the section of variables that is read */
    section_t section;
    bool heading;          /**< between the word that begins a block, a method ... and its first ";" or variable */
    bool in_configuration; /**< where RESOURCE, TASK and WITH are no names */
    bool in_property;      /**< where GET and SET begin, and are no names */
    unit_t *methods;       /**< of the block that is read */
    object_t object;       /**< of its heading */
    const char *property;
    type_t *property_type;
    int property_modifiers; /**< M_... */
} parsing_t;

/* Lists, which grow at their ends. */
typedef struct args { arg_t *first, *last; } args_t;
typedef struct stmts { stmt_t *first, *last; } stmts_t;
typedef struct branches { branch_t *first, *last; } branches_t;
typedef struct vars { var_t *first, *last; } vars_t;
#define ST_APPEND(list, item)                       \
    do {                                            \
        if ((list).last)                            \
            (list).last->next = (item);             \
        else                                        \
            (list).first = (item);                  \
        (list).last = (item);                       \
    } while (0)
#define ST_JOIN(list, other)                        \
    do {                                            \
        if ((list).last)                            \
            (list).last->next = (other).first;      \
        else                                        \
            (list).first = (other).first;           \
        if ((other).last)                           \
            (list).last = (other).last;             \
    } while (0)

/* of the lexer */
void cm1e_st_step(parsing_t *parsing, const char *text, size_t length, bool skipped, place_t *place);
/** A word of the standard that this translator does not have explains the error at the last word: reports that. */
bool cm1e_st_unsupported(parsing_t *parsing, place_t place);
void cm1e_st_bad_character(parsing_t *parsing, place_t place, char character);

/* of the parser: st_scope.c */
void cm1e_st_begin_namespace(st_t *st, place_t place, const char *name);
void cm1e_st_end_namespace(st_t *st);
void cm1e_st_use_namespace(st_t *st, place_t place, const char *name);
/** The name with that of its namespace. */
const char *cm1e_st_full_name(st_t *st, const char *name);
/** namespace.TYPE#NAME */
expr_t *cm1e_st_qualified_in(st_t *st, place_t place, const expr_t *space, const char *text);

/* of the parser: st_build.c */
expr_t *cm1e_st_node(st_t *st, expr_kind_t kind, place_t place, expr_t *a, expr_t *b);
expr_t *cm1e_st_operation(st_t *st, operation_t op, place_t place, expr_t *a, expr_t *b);
expr_t *cm1e_st_named(st_t *st, expr_kind_t kind, place_t place, expr_t *a, const char *name);
expr_t *cm1e_st_with_args(st_t *st, expr_kind_t kind, place_t place, expr_t *a, args_t args);
expr_t *cm1e_st_qualified(st_t *st, place_t place, const char *text);
arg_t *cm1e_st_arg(st_t *st, place_t place, const char *name, expr_t *value);
stmt_t *cm1e_st_stmt(st_t *st, stmt_kind_t kind, place_t place, expr_t *value, stmts_t body);
branch_t *cm1e_st_branch(st_t *st, place_t place, expr_t *condition, stmt_t *body);
/** What x S= condition and x R= condition (TwinCAT, CODESYS) assign to x where the condition holds. */
stmt_t *cm1e_st_latch(st_t *st, place_t place, expr_t *target, const char *word);
/** Statements between labels become the branches of a CASE. */
void cm1e_st_group_case(st_t *st, stmt_t *stmt, stmts_t items, stmts_t otherwise, bool has_else, place_t place);
type_t *cm1e_st_type_node(st_t *st, type_kind_t kind, place_t place, const char *name);
vars_t cm1e_st_vars(parsing_t *parsing, vars_t names, expr_t *address, type_t *type, expr_t *initial);
/** BOOL R_EDGE or F_EDGE. */
void cm1e_st_edge(parsing_t *parsing, place_t place, const char *word, vars_t vars);
/** After its branches are known: how deep a statement is nested. */
void cm1e_st_deepen(st_t *st, stmt_t *stmt);
var_t *cm1e_st_var_name(parsing_t *parsing, place_t place, const char *name);
/** The type of "state : (Idle, Run)". */
type_t *cm1e_st_unnamed_enum(parsing_t *parsing, place_t place, vars_t enumerators, type_t *base);
void cm1e_st_add_type(parsing_t *parsing, place_t place, const char *name, type_t *type, expr_t *initial);
void cm1e_st_add_unit(parsing_t *parsing, unit_kind_t kind, place_t place, const char *name, type_t *result,
                      vars_t vars, stmts_t body);
/** A method of the block that is read. */
void cm1e_st_add_method(parsing_t *parsing, place_t place, const char *name, int modifiers, type_t *result, vars_t vars,
                        stmts_t body);
void cm1e_st_add_getter(parsing_t *parsing, place_t place, vars_t vars, stmts_t body);
void cm1e_st_add_setter(parsing_t *parsing, place_t place, vars_t vars, stmts_t body);
/** of the lexer: whether a word like METHOD can begin a part here, and what a word does to the heading. */
bool cm1e_st_begins_part(const parsing_t *parsing);
bool cm1e_st_in_heading(const parsing_t *parsing);
bool cm1e_st_is_modifier(const parsing_t *parsing);
/** The modifiers with another one, by its word; two that contradict each other are reported. */
int cm1e_st_with_modifier(parsing_t *parsing, place_t place, int modifiers, const char *word);
/** What they say of a block, a method or a property. */
void cm1e_st_modify(object_t *object, int modifiers);
void cm1e_st_add_globals(st_t *st, vars_t vars);
void cm1e_st_add_task(st_t *st, place_t place, const char *name, args_t settings);
void cm1e_st_add_instance(st_t *st, place_t place, const char *name, const char *task, const char *program,
                          args_t args);

#endif
