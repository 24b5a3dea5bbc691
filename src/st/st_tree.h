/**
 * @file st_tree.h
 * The tree of a Structured Text program: what the parser makes of the sources, and what the checker finds out about it.
 * All parts live in one arena (st_memory.h) and end with it. Names keep the spelling of their declaration; they are
 * compared without regard to case.
 */
#ifndef CM1E_ST_TREE_H
#define CM1E_ST_TREE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct place {
    uint16_t file; /**< number of the source */
    uint32_t line, column;
} place_t;

/* ---- types ------------------------------------------------------------------------------------------------------- */

/** X(kind, name in ST, bits, class). LTIME, LDATE, LTOD and LDT are the same types as TIME, DATE, TOD and DT: all have
 *  64 bits of nanoseconds. */
#define ST_ELEMENTARY(X)                                                                                              \
    X(BOOL, 8, BITS) X(BYTE, 8, BITS) X(WORD, 16, BITS) X(DWORD, 32, BITS) X(LWORD, 64, BITS)                         \
    X(SINT, 8, SIGNED) X(INT, 16, SIGNED) X(DINT, 32, SIGNED) X(LINT, 64, SIGNED)                                     \
    X(USINT, 8, UNSIGNED) X(UINT, 16, UNSIGNED) X(UDINT, 32, UNSIGNED) X(ULINT, 64, UNSIGNED)                         \
    X(REAL, 32, FLOATING) X(LREAL, 64, FLOATING)                                                                      \
    X(TIME, 64, TIMES) X(DATE, 64, TIMES) X(TOD, 64, TIMES) X(DT, 64, TIMES)

typedef enum type_kind {
    T_NONE = 0, /**< no value: a call of a function without a result */
#define X(name, bits, class) T_##name,
    ST_ELEMENTARY(X)
#undef X
    T_ANY_INT,  /**< a literal without a type, or what is computed of them */
    T_ANY_REAL,
    T_NULL,
    T_STRING,
    T_ENUM,
    T_STRUCT,
    T_BLOCK,    /**< a function block or a program: a struct with a body */
    T_ARRAY,
    T_REF,
    T_INTERFACE, /**< refers to an instance of any block that implements it */
    T_WRONG,    /**< of an expression with an error that has been reported */
} type_kind_t;

/** Where a name is written: its namespace, those that USING names there, and what is around. */
typedef struct scope {
    const char *space;       /**< "": none */
    struct used {
        const char *space;
        place_t place;
        struct used *next;
    } *used;
    struct scope *outer;
} scope_t;

typedef struct expr expr_t;
typedef struct var var_t;
typedef struct stmt stmt_t;
typedef struct unit unit_t;
typedef struct type type_t;

enum { ST_DIMENSIONS = 4 };

typedef struct dimension {
    expr_t *low, *high;
    int64_t first, last;
} dimension_t;

/** The syntax of a type, and after cm1e_st_resolve() the type. An alias leads to the type itself by `same`. */
struct type {
    type_kind_t kind;
    const char *name;        /**< as declared; of an array or a string made from its parts */
    const char *shown;       /**< of a subrange, whose name is that of its base: "INT (0..100)"; of an enumeration
                                  without a name: "(Idle, ...)"; else NULL */
    const char *c_name;      /**< in the emitted C */
    place_t place;
    const scope_t *scope;    /**< where it is written */
    type_t *same;            /**< an alias, or a name that is used: the type meant */
    type_t *element;         /**< of an array, of a reference; of an ENUM its base */
    dimension_t dimensions[ST_DIMENSIONS];
    int dimension_count;
    bool open;               /**< ARRAY[*]: the bounds are those of the variable that a VAR_IN_OUT has in a call */
    expr_t *length_expr;     /**< of STRING */
    int64_t length;
    bool wide;               /**< WSTRING: a T_STRING whose characters have 16 bits */
    expr_t *low, *high;      /**< of a subrange as it is written */
    bool ranged;             /**< a subrange: `kind` is that of its base, its values are first ... last */
    int64_t first, last;
    var_t *members;          /**< of a STRUCT; enumerators of an ENUM; variables of a block */
    bool unnamed;            /**< an ENUM within a declaration of variables: its unit alone knows its enumerators */
    bool overlay;            /**< UNION: a STRUCT whose members all begin at its first byte */
    const char *base_name;   /**< of a STRUCT: EXTENDS; NULL once it has the members of its base */
    unit_t *unit;            /**< of a block */
    expr_t *initial;         /**< TYPE t : INT := 5 */
    bool external;           /**< from our interface: C of the library */
    bool automatic;          /**< REFERENCE TO: a name of this type is what it refers to */
    int state;               /**< 0 new, 1 being resolved, 2 resolved */
    bool emitted;
    type_t *next_initial;    /**< in the list of those that have an init_...() */
    uint64_t size, alignment;
    type_t *next;
};

/* ---- expressions ------------------------------------------------------------------------------------------------- */

typedef enum expr_kind {
    E_LITERAL, E_NAME, E_MEMBER, E_INDEX, E_DEREF, E_CALL, E_UNARY, E_BINARY, E_QUALIFIED, E_ADDRESS, E_CONVERT,
    E_VIEW, E_THIS, E_STRUCT_INIT, E_ARRAY_INIT, E_REPEAT,
} expr_kind_t;

typedef enum operation {
    OP_OR, OP_OR_ELSE, OP_XOR, OP_AND, OP_AND_THEN, OP_EQ, OP_NE, OP_LT, OP_GT, OP_LE, OP_GE, OP_ADD, OP_SUB, OP_MUL,
    OP_DIV, OP_MOD, OP_POWER, OP_NEGATE, OP_NOT,
} operation_t;

/** A value that is known when the program is translated. */
typedef struct constant {
    bool known;
    bool huge;          /**< integer is a number above the largest LINT, in 64 bits without a sign */
    int64_t integer;    /**< also BOOL, bits, times, enumerators */
    double real;
    const char *text;   /**< of a STRING; its bytes may be any but 0. Of a WSTRING in UTF-8 */
} constant_t;

typedef struct arg {
    const char *name;   /**< NULL: by position */
    bool output;        /**< name => value */
    bool inverted;      /**< NOT name => value */
    expr_t *value;      /**< NULL: left out */
    var_t *parameter;   /**< found by the checker */
    expr_t *source;     /**< of an output: what is given to `value` */
    place_t place;
    struct arg *next;
} arg_t;

struct expr {
    expr_kind_t kind;
    operation_t op;
    place_t place;
    int depth;
    const char *name;    /**< E_NAME, E_MEMBER, E_QUALIFIED: what is behind the #, E_ADDRESS */
    const scope_t *scope; /**< of a name: where it is written */
    const char *prefix;  /**< E_QUALIFIED: the type in front of the #; E_LITERAL: its explicit type */
    expr_t *a, *b;       /**< operands; what is called, indexed, or has the member */
    arg_t *args;         /**< of a call, an index, an initialiser */
    type_t *type;
    constant_t value;
    var_t *var;          /**< E_NAME, E_MEMBER: the variable */
    unit_t *unit;        /**< E_CALL: the function */
    const struct standard *standard; /**< E_CALL: the standard function */
    bool impure;         /**< has a call that may change something */
    bool explicitly;     /**< E_CONVERT: the program says so */
    arg_t *typed_args;   /**< E_CALL of a standard function: its arguments from here on have the type of the result */
    bool untyped;        /**< E_CALL of a standard function with literals without a type only: it can take another */
    bool bit;            /**< E_MEMBER: bit access of `integer` */
    int view;            /**< E_VIEW: the row of core/tc2_axis.h; its axis is `a` */
    expr_t *enable, *enabled; /**< E_CALL: EN, and what ENO is given to */
    unit_t *seen_as;     /**< E_CALL of a method: the block or interface that `a` is; `a` NULL: the one itself */
    bool may_be_skipped; /**< E_CALL: a statement of its own, or all that is assigned: it may have EN */
    bool super;          /**< E_CALL: of the base, whatever overrides it */
    expr_t *override;    /**< E_CALL of MC_Power: its Override, which TwinCAT has */
};

/* ---- statements -------------------------------------------------------------------------------------------------- */

typedef enum stmt_kind {
    S_ASSIGN, S_CALL, S_IF, S_CASE, S_FOR, S_WHILE, S_REPEAT, S_EXIT, S_CONTINUE, S_RETURN, S_EMPTY,
    S_LABEL, /**< within S_CASE, before the checker groups it */
} stmt_kind_t;

/** A branch of IF (condition) or CASE (labels); without both it is ELSE. */
typedef struct branch {
    expr_t *condition;
    arg_t *labels;      /**< value; a range has its end in value->b as E_REPEAT */
    stmt_t *body;
    place_t place;
    struct branch *next;
} branch_t;

struct stmt {
    stmt_kind_t kind;
    place_t place;
    int depth;
    bool reference;     /**< target REF= value */
    bool latch;         /**< S_IF: it is S= or R= */
    expr_t *target, *value; /**< S_ASSIGN; S_CALL, S_CASE, S_WHILE, S_REPEAT, S_FOR: value */
    expr_t *to, *by;    /**< S_FOR */
    branch_t *branches;
    stmt_t *body;
    stmt_t *next;
};

/* ---- declarations ------------------------------------------------------------------------------------------------ */

typedef enum section {
    V_LOCAL, V_INPUT, V_OUTPUT, V_IN_OUT, V_GLOBAL, V_EXTERNAL, V_TEMP, V_RESULT, V_MEMBER, V_ENUMERATOR,
    V_STATIC, V_INSTANCE, /**< VAR_STAT and VAR_INST until their unit is complete: then they are V_EXTERNAL */
} section_t;

enum { Q_CONSTANT = 1, Q_RETAIN = 2, Q_NON_RETAIN = 4, Q_R_EDGE = 8, Q_F_EDGE = 16, Q_PUBLIC = 32,
       Q_EDGE = Q_R_EDGE | Q_F_EDGE };

struct var {
    const char *name;
    const char *c_name;
    const char *list;    /**< of a global one: name of its list (TwinCAT); NULL: none */
    section_t section;
    int qualifiers;
    type_t *type;
    expr_t *initial;
    expr_t *address;     /**< AT %... */
    bool in_memory;      /**< AT %M...: `c_name` is its place in the memory of the program */
    int memory_bit;      /**< of a BOOL AT %MX: 1 = bit 0; else 0 */
    var_t *memory_byte;  /**< the byte that has this bit */
    arg_t *init_args;    /**< fb : FB_X(a := 1): for its FB_Init */
    arg_t *init_elements; /**< fbs : ARRAY[1..2] OF FB_X[(a := 1), (a := 2)]: a list for each element */
    place_t place;
    constant_t value;    /**< of a constant */
    int state;           /**< of its value: 0 new, 1 being computed, 2 known */
    unit_t *unit;        /**< whose variable it is; NULL: global, member */
    type_t *owner;       /**< of an enumerator: its type */
    var_t *global;       /**< of VAR_EXTERNAL; of VAR_STAT and VAR_INST where its value is */
    unit_t *keeper;      /**< the value of a VAR_STAT or VAR_INST: the unit that alone knows it */
    bool init_checked;   /**< what FB_Init needs has been looked at */
    bool controls;       /**< a FOR counts with it at the moment */
    var_t *next;
};

/** A call may give it a value, or take one from it. */
static inline bool cm1e_st_is_parameter(const var_t *var)
{
    return var->section == V_INPUT || var->section == V_OUTPUT || var->section == V_IN_OUT;
}

/** By it a call changes a variable of its caller. */
static inline bool cm1e_st_gives_back(const var_t *var)
{
    return var->section == V_OUTPUT || (var->section == V_IN_OUT && !(var->qualifiers & Q_CONSTANT));
}

/** The words in front of the name of a method, a property or a block; at most one of the first four. */
enum { M_PUBLIC = 1, M_PRIVATE = 2, M_PROTECTED = 4, M_INTERNAL = 8, M_ACCESS = 15, M_ABSTRACT = 16, M_FINAL = 32 };

typedef enum unit_kind { U_FUNCTION, U_BLOCK, U_PROGRAM, U_METHOD, U_INTERFACE } unit_kind_t;

/** What object orientation adds to a unit. */
typedef struct object {
    unit_t *owner;       /**< of a method: its block, program or interface */
    unit_t *methods;     /**< of a block: its own, by `next_method`; those of a property are "get name" and
                              "set name" */
    unit_t *next_method;
    struct map *names;   /**< of these methods */
    const char *base_name;
    unit_t *base;        /**< EXTENDS */
    arg_t *interfaces;   /**< IMPLEMENTS, of an interface EXTENDS: names */
    bool abstract, final;
    int access;          /**< of a method: M_PUBLIC ... M_INTERNAL; 0 is as M_PUBLIC */
    bool is_class;       /**< CLASS: without inputs, outputs and statements */
    bool has_class;      /**< its instances say which class they are */
    int class_id;
    int linked;          /**< 0 new, 1 on the way, 2 done */
    int purity;          /**< of a method: st_pure.c */
} object_t;

struct unit {
    unit_kind_t kind;
    const char *name, *c_name, *c_type;
    place_t place;
    const scope_t *scope;
    var_t *vars;         /**< in order of declaration; of a function the result last */
    var_t *result;
    type_t *result_type;
    type_t *type;        /**< of a block or a program */
    stmt_t *body;
    bool external;
    place_t reached;     /**< of a program: where another one uses its variables; line 0: nowhere */
    bool called;         /**< of a program: by another one, so that no task runs it */
    bool runs;           /**< without a CONFIGURATION: a program that runs calls it, or is it */
    bool impure;         /**< a function that can change more than its result */
    uint64_t stack;      /**< bytes of its locals and of what it calls */
    int mark;            /**< while the calls are followed: 0 new, 1 on the way, 2 done */
    unit_t **calls;
    size_t call_count, call_capacity;
    struct map *names;
    object_t object;
    unit_t *next;
};

/** Its variables begin anew in every call. */
static inline bool cm1e_st_is_function(const unit_t *unit)
{
    return unit->kind == U_FUNCTION || unit->kind == U_METHOD;
}

typedef struct task {
    const char *name;
    place_t place;
    arg_t *settings;
    int64_t interval_ns;
    int64_t priority;
    expr_t *single;      /**< SINGLE: the variable whose rising edge runs it; NULL: none */
    struct task *next;
} task_t;

/** PROGRAM instance WITH task : type (...); */
typedef struct instance {
    const char *name, *task_name, *program_name;
    place_t place;
    arg_t *args;
    unit_t *unit;
    task_t *task;
    var_t *var;
    struct instance *next;
} instance_t;

/** All that was read. */
typedef struct tree {
    type_t *types;
    unit_t *units;
    var_t *globals;
    task_t *tasks;
    instance_t *instances;
    const char *configuration;
    place_t configuration_place;
} tree_t;

#endif
