/* Statements: the types of their parts, and what may stand where. */
#include "st/st_parsing.h"

static void condition(st_t *st, expr_t *expr, const char *what)
{
    cm1e_st_expression(st, expr);
    if (expr->type->kind != T_BOOL && expr->type->kind != T_WRONG)
        cm1e_st_report(st, expr->place, "%s is a BOOL; this is %s", what, cm1e_st_type_name(expr->type));
}

/** target REF= variable: the reference itself is assigned. */
static bool refer(st_t *st, stmt_t *stmt)
{
    expr_t *target = stmt->target;
    const bool automatic = target->kind == E_DEREF && target->a->type && target->a->type->kind == T_REF &&
                           target->a->type->automatic;
    if (!automatic && target->type->kind != T_WRONG)
        cm1e_st_report(st, stmt->place, "REF= is for a REFERENCE TO; this is %s", cm1e_st_type_name(target->type));
    if (automatic)
        stmt->target = target->a;
    return automatic;
}

/** How an error names what is assigned: x, list[...], pointer^. */
static const char *shown(st_t *st, const expr_t *target)
{
    if (target->var || target->name)
        return target->var ? target->var->name : target->name;
    if (!target->a)
        return "the variable";
    return cm1e_st_format(st->arena, "%s%s", shown(st, target->a), target->kind == E_INDEX ? "[...]" : "^");
}

static void assign(st_t *st, stmt_t *stmt)
{
    stmt->value->may_be_skipped = true;
    if (!stmt->reference && cm1e_st_write_property(st, stmt))
        return;
    cm1e_st_expression(st, stmt->target);
    cm1e_st_expression(st, stmt->value);
    if (stmt->reference && !refer(st, stmt))
        return;
    const expr_t *target = stmt->target;
    if (target->type->kind == T_WRONG || !cm1e_st_assignable(st, target))
        return;
    cm1e_st_note_change(st, target);
    if (target->type->kind == T_BLOCK)
        cm1e_st_report(st, stmt->place, "an instance of a function block cannot be assigned");
    if (target->type->open)
        cm1e_st_report(st, stmt->place, "an array of any length is assigned element by element");
    stmt->value = cm1e_st_coerce(st, stmt->value, target->type, shown(st, target));
    if (stmt->value->impure && (target->kind == E_INDEX || target->kind == E_DEREF || target->kind == E_MEMBER))
        for (const expr_t *at = target; at; at = at->a)
            if (at->kind == E_DEREF || (at->kind == E_INDEX && !cm1e_st_is_fixed(at->args->value)))
                cm1e_st_report(st, stmt->place, "this call can change which variable is meant on the left: give its "
                               "result to a variable first");
}

static void call(st_t *st, stmt_t *stmt)
{
    stmt->value->may_be_skipped = true;
    if (cm1e_st_only_updates(st, stmt->value)) {
        stmt->kind = S_EMPTY;
        return;
    }
    cm1e_st_call(st, stmt->value, true);
    expr_t *value = stmt->value;
    if (value->type->kind == T_WRONG || value->unit)
        return;
    cm1e_st_report(st, stmt->place, "the result of this function is not used");
}

/** A label of CASE takes the type of the selector; an integer beside an enumeration that of its base. */
static void label(st_t *st, arg_t *arg, type_t *selector)
{
    expr_t **ends[2] = {&arg->value, NULL};
    if (arg->value->kind == E_REPEAT) {
        ends[0] = &arg->value->a;
        ends[1] = &arg->value->b;
    }
    for (int i = 0; i < 2 && ends[i]; i++) {
        cm1e_st_expression(st, *ends[i]);
        const bool by_base = selector->kind == T_ENUM && cm1e_st_is_integer((*ends[i])->type->kind);
        *ends[i] = cm1e_st_coerce(st, *ends[i], by_base ? selector->element : selector, "the selector");
        if ((*ends[i])->type->kind != T_WRONG && !(*ends[i])->value.known)
            cm1e_st_report(st, (*ends[i])->place, "a label of CASE is known before the program runs: a number, a "
                           "CONSTANT or an enumerator");
    }
    if (ends[1] && (*ends[0])->value.known && (*ends[1])->value.known &&
        (*ends[0])->value.integer > (*ends[1])->value.integer)
        cm1e_st_report(st, arg->value->place, "the range %lld..%lld is empty", (long long)(*ends[0])->value.integer,
                       (long long)(*ends[1])->value.integer);
}

typedef struct range {
    int64_t first, last;
} range_t;

static range_t range_of(const arg_t *arg)
{
    const expr_t *low = arg->value->kind == E_REPEAT ? arg->value->a : arg->value;
    const expr_t *high = arg->value->kind == E_REPEAT ? arg->value->b : arg->value;
    return (range_t){low->value.integer, high->value.integer};
}

/** A value belongs to one label. The labels of large CASEs are compared with their neighbours only. */
static void unique_labels(st_t *st, const stmt_t *stmt)
{
    enum { COMPARED = 1000 };
    const arg_t *seen[COMPARED];
    int count = 0;
    for (const branch_t *branch = stmt->branches; branch; branch = branch->next)
        for (const arg_t *arg = branch->labels; arg; arg = arg->next) {
            const range_t mine = range_of(arg);
            for (int i = 0; i < count; i++) {
                const range_t other = range_of(seen[i]);
                if (mine.first > other.last || other.first > mine.last)
                    continue;
                cm1e_st_report(st, arg->value->place, "the value %lld has a label already",
                               (long long)(mine.first > other.first ? mine.first : other.first));
                return;
            }
            if (count < COMPARED)
                seen[count++] = arg;
        }
}

static void choose(st_t *st, stmt_t *stmt)
{
    cm1e_st_expression(st, stmt->value);
    stmt->value = cm1e_st_settle(st, stmt->value);
    type_t *type = stmt->value->type;
    const bool bits = cm1e_st_is_bits(type->kind) && type->kind != T_BOOL && type->kind != T_LWORD;
    if (type->kind != T_WRONG && type->kind != T_ENUM && !bits &&
        !(cm1e_st_is_integer(type->kind) && type->kind != T_ULINT)) {
        cm1e_st_report(st, stmt->value->place, "CASE selects by an integer or an enumeration, not by %s",
                       cm1e_st_type_name(type));
        type = st->elementary[T_WRONG];
    }
    for (branch_t *branch = stmt->branches; branch; branch = branch->next) {
        for (arg_t *arg = branch->labels; arg; arg = arg->next)
            label(st, arg, type);
        cm1e_st_statements(st, branch->body);
    }
    if (type->kind != T_WRONG)
        unique_labels(st, stmt);
}

static void wrong_counter(st_t *st, const expr_t *counter)
{
    if (counter->type->kind == T_ENUM)
        cm1e_st_report(st, counter->place, "FOR counts with an integer, not with %s, whose values need not follow each "
                       "other: declare an INT or DINT for it, which can count from one enumerator to another",
                       cm1e_st_type_name(counter->type));
    else
        cm1e_st_report(st, counter->place, "FOR counts with a variable of a type of integers (not ULINT), without "
                       "point or index");
}

static void count(st_t *st, stmt_t *stmt)
{
    cm1e_st_expression(st, stmt->target);
    expr_t **parts[] = {&stmt->value, &stmt->to, &stmt->by};
    type_t *type = stmt->target->type;
    const bool integer = cm1e_st_is_integer(type->kind) && type->kind != T_ULINT;
    if (stmt->target->kind != E_NAME || !stmt->target->var || (!integer && type->kind != T_WRONG)) {
        wrong_counter(st, stmt->target);
        type = st->elementary[T_WRONG];
    }
    if (type->kind != T_WRONG && cm1e_st_assignable(st, stmt->target))
        cm1e_st_note_change(st, stmt->target);
    type_t *const counted = type->ranged ? st->elementary[type->kind] : type;
    const char *const counter = stmt->target->name ? stmt->target->name : "the counter";
    for (int i = 0; i < 3; i++) {
        if (!*parts[i])
            continue;
        cm1e_st_expression(st, *parts[i]);
        *parts[i] = cm1e_st_coerce(st, *parts[i], counted, counter);
    }
    if (stmt->by && stmt->by->value.known && stmt->by->value.integer == 0)
        cm1e_st_report(st, stmt->by->place, "a FOR in steps of 0 would not end");
    var_t *var = stmt->target->var;
    const bool before = var && var->controls;
    if (var)
        var->controls = true;
    st->loops++;
    cm1e_st_statements(st, stmt->body);
    st->loops--;
    if (var)
        var->controls = before;
}

static void repeat(st_t *st, stmt_t *stmt)
{
    condition(st, stmt->value, stmt->kind == S_WHILE ? "the condition of WHILE" : "the condition of UNTIL");
    st->loops++;
    cm1e_st_statements(st, stmt->body);
    st->loops--;
}

static void statement(st_t *st, stmt_t *stmt)
{
    switch (stmt->kind) {
    case S_ASSIGN: assign(st, stmt); break;
    case S_CALL: call(st, stmt); break;
    case S_IF:
        for (branch_t *branch = stmt->branches; branch; branch = branch->next) {
            if (branch->condition)
                condition(st, branch->condition, stmt->latch ? "what is behind S= and R=" : "the condition of IF");
            cm1e_st_statements(st, branch->body);
        }
        break;
    case S_CASE: choose(st, stmt); break;
    case S_FOR: count(st, stmt); break;
    case S_WHILE:
    case S_REPEAT: repeat(st, stmt); break;
    case S_EXIT:
    case S_CONTINUE:
        if (st->loops == 0)
            cm1e_st_report(st, stmt->place, "%s stands within FOR, WHILE or REPEAT only",
                           stmt->kind == S_EXIT ? "EXIT" : "CONTINUE");
        break;
    default: break;
    }
}

void cm1e_st_statements(st_t *st, stmt_t *list)
{
    for (; list; list = list->next)
        statement(st, list);
}
