/* The standard functions (IEC 61131-3, 6.6.2.5): which arguments they take, and the type of their result. */
#include "st/st_standard.h"

#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"

enum { MANY = 32 };

/* How the types of arguments and result follow from each other. */
typedef enum rule {
    R_REAL,      /* all arguments REAL or all LREAL, so is the result */
    R_NUMBER,    /* all of one type of numbers, so is the result */
    R_ORDERED,   /* as R_NUMBER; also bits, times and BOOL */
    R_SELECT,    /* BOOL, then two of one type */
    R_MUX,       /* an integer, then values of one type */
    R_SHIFT,     /* bits and a number of places */
    R_OPERATION, /* what an operator does with all */
    R_COMPARE,
    R_TRUNC,
    R_MOVE,
    R_NOW,
    R_REF,
    R_VALID,
    R_SIZE,
    R_BOUND,     /* an array and the number of a dimension */
    R_STRING,    /* the letters of `types` say which: S string, I integer; the first one is the result */
} rule_t;

struct standard {
    const char *name;
    rule_t rule;
    int fewest, most;
    operation_t op;
    const char *types, *parameters; /* the inputs in their order; "IN1+": IN1, IN2 and so on; "": they have no names */
};

static const standard_t standards[] = {
    {"ABS", R_NUMBER, 1, 1, 0, "", "IN"}, {"SQRT", R_REAL, 1, 1, 0, "", "IN"}, {"LN", R_REAL, 1, 1, 0, "", "IN"},
    {"LOG", R_REAL, 1, 1, 0, "", "IN"}, {"EXP", R_REAL, 1, 1, 0, "", "IN"}, {"SIN", R_REAL, 1, 1, 0, "", "IN"},
    {"COS", R_REAL, 1, 1, 0, "", "IN"}, {"TAN", R_REAL, 1, 1, 0, "", "IN"}, {"ASIN", R_REAL, 1, 1, 0, "", "IN"},
    {"ACOS", R_REAL, 1, 1, 0, "", "IN"}, {"ATAN", R_REAL, 1, 1, 0, "", "IN"},
    {"ATAN2", R_REAL, 2, 2, 0, "", "Y X"}, {"MIN", R_ORDERED, 2, MANY, 0, "", "IN1+"},
    {"MAX", R_ORDERED, 2, MANY, 0, "", "IN1+"}, {"LIMIT", R_ORDERED, 3, 3, 0, "", "MN IN MX"},
    {"SEL", R_SELECT, 3, 3, 0, "", "G IN0 IN1"}, {"MUX", R_MUX, 3, MANY, 0, "", "K IN0+"},
    {"SHL", R_SHIFT, 2, 2, 0, "", "IN N"}, {"SHR", R_SHIFT, 2, 2, 0, "", "IN N"}, {"ROL", R_SHIFT, 2, 2, 0, "", "IN N"},
    {"ROR", R_SHIFT, 2, 2, 0, "", "IN N"}, {"ADD", R_OPERATION, 2, MANY, OP_ADD, "", "IN1+"},
    {"MUL", R_OPERATION, 2, MANY, OP_MUL, "", "IN1+"}, {"SUB", R_OPERATION, 2, 2, OP_SUB, "", "IN1 IN2"},
    {"DIV", R_OPERATION, 2, 2, OP_DIV, "", "IN1 IN2"}, {"EXPT", R_OPERATION, 2, 2, OP_POWER, "", "IN1 IN2"},
    {"GT", R_COMPARE, 2, 2, OP_GT, "", "IN1 IN2"}, {"GE", R_COMPARE, 2, 2, OP_GE, "", "IN1 IN2"},
    {"EQ", R_COMPARE, 2, 2, OP_EQ, "", "IN1 IN2"}, {"NE", R_COMPARE, 2, 2, OP_NE, "", "IN1 IN2"},
    {"LE", R_COMPARE, 2, 2, OP_LE, "", "IN1 IN2"}, {"LT", R_COMPARE, 2, 2, OP_LT, "", "IN1 IN2"},
    {"TRUNC", R_TRUNC, 1, 1, 0, "", "IN"}, {"MOVE", R_MOVE, 1, 1, 0, "", "IN"}, {"TIME", R_NOW, 0, 0, 0, "", ""},
    {"REF", R_REF, 1, 1, 0, "", ""}, {"ADR", R_REF, 1, 1, 0, "", ""},
    {"LOWER_BOUND", R_BOUND, 2, 2, 0, "", "ARR DIM"}, {"UPPER_BOUND", R_BOUND, 2, 2, 0, "", "ARR DIM"},
    {"__ISVALIDREF", R_VALID, 1, 1, 0, "", ""}, {"SIZEOF", R_SIZE, 1, 1, 0, "", ""},
    {"LEN", R_STRING, 1, 1, 0, "IS", "IN"}, {"LEFT", R_STRING, 2, 2, 0, "SSI", "IN L"},
    {"RIGHT", R_STRING, 2, 2, 0, "SSI", "IN L"}, {"MID", R_STRING, 3, 3, 0, "SSII", "IN L P"},
    {"CONCAT", R_STRING, 2, MANY, 0, "SSS", "IN1+"}, {"INSERT", R_STRING, 3, 3, 0, "SSSI", "IN1 IN2 P"},
    {"DELETE", R_STRING, 3, 3, 0, "SSII", "IN L P"}, {"REPLACE", R_STRING, 4, 4, 0, "SSSII", "IN1 IN2 L P"},
    {"FIND", R_STRING, 2, 2, 0, "ISS", "IN1 IN2"},
};
enum { STANDARDS = sizeof standards / sizeof standards[0] };

const char *cm1e_st_standard_name(const standard_t *standard) { return standard->name; }

void cm1e_st_standard_names(void (*visit)(const char *name, void *context), void *context)
{
    for (int i = 0; i < STANDARDS; i++)
        visit(standards[i].name, context);
}

/* ---- arguments --------------------------------------------------------------------------------------------------- */

static bool refuse(st_t *st, const expr_t *call, const expr_t *arg, const char *wanted)
{
    if (arg->type->kind != T_WRONG)
        cm1e_st_report(st, arg->place, "%s takes %s here, not %s", call->standard->name, wanted,
                       cm1e_st_type_name(arg->type));
    return false;
}

/** An integer, also an enumeration: a number of places, or which of several. */
static bool whole(st_t *st, expr_t *call, arg_t *arg)
{
    arg->value = cm1e_st_as_integer(st, cm1e_st_settle(st, arg->value));
    const type_kind_t kind = arg->value->type->kind;
    return (cm1e_st_is_integer(kind) && kind != T_ULINT) || refuse(st, call, arg->value, "an integer");
}

/** Gives the arguments from `first` on one type, the smallest that has all their values. */
static bool one_type(st_t *st, expr_t *call, arg_t *first, bool (*good)(type_kind_t kind), const char *wanted)
{
    for (arg_t *arg = first; arg; arg = arg->next) {
        if (!good(cm1e_st_plain_kind(arg->value->type)))
            return refuse(st, call, arg->value, wanted);
        arg->value = cm1e_st_as_integer(st, arg->value);
    }
    expr_t *sum = first->value;
    for (arg_t *arg = first->next; arg; arg = arg->next) {
        const type_kind_t both = cm1e_st_type_for_both(sum, arg->value);
        if (both == T_NONE) {
            cm1e_st_report(st, arg->value->place, "%s needs values of one type; no type has all values of %s and %s",
                           call->standard->name, cm1e_st_type_name(sum->type), cm1e_st_type_name(arg->value->type));
            return false;
        }
        sum = both == sum->type->kind ? sum : cm1e_st_coerce(st, sum, st->elementary[both], "the argument");
    }
    call->untyped = sum->type->kind == T_ANY_INT || sum->type->kind == T_ANY_REAL;
    sum = cm1e_st_settle(st, sum);
    call->type = sum->type->ranged ? st->elementary[sum->type->kind] : sum->type;
    for (arg_t *arg = first; arg && !call->untyped; arg = arg->next)
        arg->value = cm1e_st_coerce(st, arg->value, call->type, "the argument");
    call->typed_args = first;
    return true;
}

static bool is_any(type_kind_t kind) { return kind != T_NONE && kind <= T_ANY_REAL; }

/** SQRT(2) is SQRT(2.0), and SQRT(MAX(1, 2)) is SQRT(MAX(1.0, 2.0)). */
static void literals_are_real(st_t *st, expr_t *call)
{
    for (arg_t *arg = call->args; arg; arg = arg->next)
        if (arg->value->type->kind == T_ANY_INT)
            arg->value = cm1e_st_coerce(st, arg->value, st->elementary[T_ANY_REAL], "the argument");
        else if (arg->value->untyped && !cm1e_st_is_floating(arg->value->type->kind))
            arg->value = cm1e_st_coerce(st, arg->value, st->elementary[T_LREAL], "the argument");
}

/** Of texts the result is the longest one that there is. */
static bool selects_text(st_t *st, expr_t *call)
{
    const type_t *type = call->args->next->value->type;
    if (type->kind != T_STRING)
        return false;
    for (const arg_t *arg = call->args->next; arg; arg = arg->next)
        if (arg->value->type->kind != T_STRING || arg->value->type->wide != type->wide)
            return false;
    call->type = cm1e_st_text_type(st, ST_STRING_BYTES, type->wide);
    return true;
}

static bool select_one(st_t *st, expr_t *call)
{
    const expr_t *selector = call->args->value;
    if (call->standard->rule == R_MUX && !whole(st, call, call->args))
        return false;
    if (call->standard->rule == R_SELECT && selector->type->kind != T_BOOL)
        return refuse(st, call, selector, "a BOOL");
    const type_t *type = call->args->next->value->type;
    bool same = type->kind == T_ENUM;
    for (const arg_t *arg = call->args->next; arg; arg = arg->next)
        same = same && arg->value->type == type;
    if (same) {
        call->type = call->args->next->value->type;
        return true;
    }
    return selects_text(st, call) || one_type(st, call, call->args->next, is_any, "values of one elementary type");
}

static bool shift(st_t *st, expr_t *call)
{
    const type_kind_t kind = call->args->value->type->kind;
    if (!cm1e_st_is_bits(kind) || kind == T_BOOL)
        return refuse(st, call, call->args->value, "BYTE, WORD, DWORD or LWORD");
    call->type = call->args->value->type;
    return whole(st, call, call->args->next);
}

/** ADD(a, b, c) is a + b + c. */
static bool operation(st_t *st, expr_t *call)
{
    expr_t *sum = call->args->value;
    for (arg_t *arg = call->args->next; arg; arg = arg->next)
        sum = cm1e_st_operation(st, call->standard->op, call->place, sum, arg->value);
    cm1e_st_expression(st, sum);
    *call = *sum;
    return true;
}

static bool strings(st_t *st, expr_t *call)
{
    const char *types = call->standard->types;
    const char *at = types + 1;
    const bool wide = call->args->value->type->wide;
    for (arg_t *arg = call->args; arg; arg = arg->next) {
        if (*at == 'S' && (arg->value->type->kind != T_STRING || arg->value->type->wide != wide))
            return refuse(st, call, arg->value, wide ? "a WSTRING" : "a STRING");
        if (*at == 'I' && !whole(st, call, arg))
            return false;
        at += at[1] != '\0';
    }
    call->type = types[0] == 'S' ? cm1e_st_text_type(st, ST_STRING_BYTES, wide) : st->elementary[T_INT];
    return true;
}

static bool reference(st_t *st, expr_t *call)
{
    expr_t *of = call->args->value;
    if (!cm1e_st_assignable(st, of))
        return false;
    const expr_t *root = of;
    while ((root->kind == E_MEMBER || root->kind == E_INDEX) && root->a)
        root = root->a;
    const var_t *var = root->kind == E_NAME && root->var && root->var->section != V_EXTERNAL ? root->var : NULL;
    if (of->type->open)
        return refuse(st, call, of, "a variable whose size is known");
    if (of->bit || (var && (var->section == V_TEMP || (var->unit && cm1e_st_is_function(var->unit))))) {
        cm1e_st_report(st, of->place, of->bit ? "there is no reference to a single bit"
                                              : "this variable ends with the call: a reference to it would outlive it");
        return false;
    }
    cm1e_st_note_change(st, of);
    call->type = cm1e_st_ref_type(st, of->type);
    return true;
}

/** Of an array of any length it is known when the program runs. */
static bool bound(st_t *st, expr_t *call)
{
    const type_t *array = call->args->value->type;
    expr_t *number = call->args->next->value = cm1e_st_settle(st, call->args->next->value);
    if (array->kind != T_ARRAY)
        return refuse(st, call, call->args->value, "an array");
    const int64_t n = number->value.integer;
    if (!cm1e_st_is_integer(number->type->kind) || !number->value.known || n < 1 || n > array->dimension_count) {
        cm1e_st_report(st, number->place, "the number of a dimension of %s is known before the program runs: 1%s",
                       array->name, array->dimension_count > 1 ? ", 2 and so on" : "");
        return false;
    }
    const dimension_t *dimension = &array->dimensions[n - 1];
    call->type = st->elementary[T_DINT];
    if (!array->open)
        call->value = (constant_t){.known = true, .integer = call->standard->name[0] == 'L' ? dimension->first
                                                                                          : dimension->last};
    return true;
}

static bool give_type(st_t *st, expr_t *call)
{
    if (call->standard->rule == R_NOW) { /* has no argument */
        call->type = st->elementary[T_TIME];
        return true;
    }
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): check_args() has counted them */
    expr_t *first = call->args->value;
    switch (call->standard->rule) {
    case R_REAL:
        literals_are_real(st, call);
        return one_type(st, call, call->args, cm1e_st_is_floating, "REAL or LREAL");
    case R_NUMBER: return one_type(st, call, call->args, cm1e_st_is_number, "a number");
    case R_ORDERED: return one_type(st, call, call->args, is_any, "values of an elementary type");
    case R_SELECT:
    case R_MUX: return select_one(st, call);
    case R_SHIFT: return shift(st, call);
    case R_OPERATION:
    case R_COMPARE: return operation(st, call);
    case R_TRUNC:
        call->args->value = first = cm1e_st_settle(st, first);
        if (!cm1e_st_is_floating(first->type->kind))
            return refuse(st, call, first, "REAL or LREAL");
        call->type = st->elementary[T_DINT];
        return true;
    case R_MOVE: *call = *cm1e_st_settle(st, first); return true;
    case R_NOW: break;
    case R_REF: return reference(st, call);
    case R_VALID:
        if (first->kind != E_DEREF)
            return refuse(st, call, first, "a REFERENCE TO");
        call->args->value = first->a;
        call->type = st->elementary[T_BOOL];
        return true;
    case R_BOUND: return bound(st, call);
    case R_SIZE:
        if (first->type->open)
            return refuse(st, call, first, "a variable whose size is known");
        call->type = st->elementary[T_UDINT];
        call->value = (constant_t){.known = true, .integer = (int64_t)cm1e_st_settle(st, first)->type->size};
        return true;
    case R_STRING: return strings(st, call);
    }
    return false;
}

/** The name of an input, 0 = the first. */
static const char *input_name(st_t *st, const standard_t *standard, int number)
{
    const char *at = standard->parameters;
    for (; number > 0 && strchr(at, ' '); number--)
        at = strchr(at, ' ') + 1;
    const int length = (int)strcspn(at, " +");
    if (at[length] != '+')
        return cm1e_st_format(st->arena, "%.*s", length, at);
    return cm1e_st_format(st->arena, "%.*s%d", length - 1, at, at[length - 1] - '0' + number);
}

/** The name is that of an input; reports another one. */
static bool is_input(st_t *st, const expr_t *call, const arg_t *arg)
{
    cm1e_near_t near = {.word = arg->name};
    for (int i = 0; i < call->standard->most; i++) {
        const char *name = input_name(st, call->standard, i);
        if (strcasecmp(arg->name, name) == 0)
            return true;
        cm1e_near_look(&near, name);
    }
    cm1e_st_report(st, arg->place, "%s has no input \"%s\"%s", call->standard->name, arg->name,
                   cm1e_st_meant(st, &near));
    return false;
}

/** Named arguments of a standard function come into the order of its inputs. There are as many as it takes. */
static bool order_args(st_t *st, expr_t *call, int count)
{
    args_t ordered = {0};
    if (!*call->standard->parameters) {
        cm1e_st_report(st, call->place, "%s takes its argument without a name: %s(x)", call->standard->name,
                       call->standard->name);
        return false;
    }
    for (arg_t *arg = call->args; arg; arg = arg->next) {
        const char *hint, *ours = arg->name ? cm1e_st_alias(call->standard->name, arg->name, &hint) : NULL;
        arg->name = ours ? ours : arg->name;
        if (arg->name && !is_input(st, call, arg))
            return false;
    }
    for (int i = 0; i < count; i++) {
        const char *name = input_name(st, call->standard, i);
        arg_t *found = NULL;
        for (arg_t *arg = call->args; arg; arg = arg->next)
            if (arg->name && strcasecmp(arg->name, name) == 0)
                found = arg;
        if (!found || found->output || !found->value) {
            cm1e_st_report(st, call->place, "%s needs a value for the input \"%s\"", call->standard->name, name);
            return false;
        }
        arg_t *copy = cm1e_st_arg(st, found->place, NULL, found->value);
        ST_APPEND(ordered, copy);
    }
    call->args = ordered.first;
    return true;
}

/** SIZEOF(ST_Recipe), SIZEOF(INT): the name of a type instead of a variable. */
static void take_type(st_t *st, expr_t *expr)
{
    const char *name = cm1e_st_dotted(st, expr);
    const expr_t *root = expr;
    while (root->kind == E_MEMBER)
        root = root->a;
    if (!name || cm1e_st_find_var(st, root->name))
        return;
    type_t *type = cm1e_st_elementary(st, name);
    type = type ? type : cm1e_st_lookup(st, st->types, root->scope, root->place, name);
    expr->type = type ? cm1e_st_resolve(st, type) : NULL;
}

static bool check_args(st_t *st, expr_t *call)
{
    int count = 0;
    bool named = false;
    for (const arg_t *arg = call->args; arg; arg = arg->next, count++)
        named |= arg->name != NULL;
    if (count < call->standard->fewest || count > call->standard->most) {
        cm1e_st_report(st, call->place, "%s takes %d%s argument%s; found %d", call->standard->name,
                       call->standard->fewest, call->standard->most > call->standard->fewest ? " or more" : "",
                       call->standard->most == 1 ? "" : "s", count);
        return false;
    }
    if (named && !order_args(st, call, count))
        return false;
    if (call->standard->rule == R_SIZE)
        take_type(st, call->args->value);
    for (arg_t *arg = call->args; arg; arg = arg->next) {
        cm1e_st_expression(st, arg->value);
        call->impure |= arg->value->impure;
        if (arg->value->type->kind == T_WRONG)
            return false;
        for (const arg_t *other = call->args; other != arg; other = other->next)
            if (!cm1e_st_alone(st, other->value, arg->value))
                return false;
    }
    return true;
}

bool cm1e_st_standard_call(st_t *st, expr_t *call, const char *name)
{
    for (int i = 0; i < STANDARDS; i++) {
        if (strcasecmp(standards[i].name, name) != 0)
            continue;
        call->standard = &standards[i];
        if (!check_args(st, call) || !give_type(st, call))
            call->type = st->elementary[T_WRONG];
        return true;
    }
    return cm1e_st_conversion_call(st, call, name);
}
