/* Statements in C, each with the line of ST that it comes from. */
#include "st/st_emit.h"

#include <stdlib.h>

static void emit_body(st_t *st, const stmt_t *list)
{
    st->indent++;
    cm1e_st_emit_statements(st, list);
    st->indent--;
}

static void emit_bit(st_t *st, const expr_t *target, const expr_t *value)
{
    const char *type = target->a->type->name;
    const unsigned n = ++st->temporaries;
    const long number = strtol(target->name, NULL, 10);
    cm1e_st_line(st, "{ const BOOL bit%u = (", n); /* first: a call may change what the bit is of */
    cm1e_st_emit_expression(st, value);
    cm1e_st_put(st, ") != 0; ");
    cm1e_st_emit_expression(st, target->a);
    cm1e_st_put(st, " = (%s)(((ULINT)", type);
    cm1e_st_emit_expression(st, target->a);
    cm1e_st_put(st, " & ~(1ULL << %ld)) | ((ULINT)bit%u << %ld)); }\n", number, n, number);
}

void cm1e_st_emit_assignment(st_t *st, const expr_t *target, const expr_t *value)
{
    if (target->kind == E_MEMBER && target->bit) {
        emit_bit(st, target, value);
        return;
    }
    if (target->type->kind == T_STRING) {
        cm1e_st_line(st, "%s(", cm1e_st_text_assign(target->type));
        cm1e_st_emit_text(st, target);
        cm1e_st_put(st, ", %llu, ", (unsigned long long)target->type->size);
        cm1e_st_emit_text(st, value);
        cm1e_st_put(st, ");\n");
        return;
    }
    const bool aggregate = target->type->kind == T_STRUCT || target->type->kind == T_ARRAY;
    const bool may_overlap = aggregate && cm1e_st_is_variable(value); /* in a UNION, or in %M: "=" of C must not */
    cm1e_st_begin_line(st);
    cm1e_st_put(st, may_overlap ? "memmove(&" : "");
    cm1e_st_emit_expression(st, target);
    cm1e_st_put(st, may_overlap ? ", &" : " = ");
    cm1e_st_emit_expression(st, value);
    if (may_overlap)
        cm1e_st_put(st, ", sizeof(%s))", cm1e_st_c_type(st, target->type));
    cm1e_st_put(st, ";\n");
}

/* ---- calls of blocks --------------------------------------------------------------------------------------------- */

static void emit_input(st_t *st, const arg_t *arg)
{
    const var_t *var = arg->parameter;
    cm1e_st_place(st, arg->place);
    if (var->section == V_IN_OUT) {
        cm1e_st_line(st, "fb->%s = ", var->c_name);
        cm1e_st_emit_given(st, var, arg->value);
    } else if (var->type->kind == T_STRING) {
        cm1e_st_line(st, "%s(fb->%s.text, %llu, ", cm1e_st_text_assign(var->type), var->c_name,
                     (unsigned long long)var->type->size);
        cm1e_st_emit_text(st, arg->value);
        cm1e_st_put(st, ")");
    } else {
        cm1e_st_line(st, "fb->%s = ", var->c_name);
        cm1e_st_emit_expression(st, arg->value);
    }
    cm1e_st_put(st, ";\n");
}

/** A value for VAR_IN_OUT CONSTANT, and the bounds of an array of any length, end with the call: methods that are
 *  called later do not see them. */
static void emit_ends(st_t *st, const expr_t *call)
{
    for (const arg_t *arg = call->args; arg; arg = arg->next)
        if (arg->value && arg->parameter && arg->parameter->section == V_IN_OUT &&
            (arg->parameter->type->open || !cm1e_st_is_variable(arg->value)))
            cm1e_st_line(st, "fb->%s = NULL;\n", arg->parameter->c_name);
}

static void emit_block_call(st_t *st, const expr_t *call)
{
    cm1e_st_line(st, "{ %s *const fb = &", call->unit->c_type);
    st->indent++;
    cm1e_st_emit_expression(st, call->a);
    cm1e_st_put(st, ";\n");
    for (const arg_t *arg = call->args; arg; arg = arg->next)
        if (arg->value && arg->parameter && arg->parameter->section != V_OUTPUT)
            emit_input(st, arg);
    if (call->override) {
        cm1e_st_line(st, "cm1e_tc2_override(fb->Axis_->Handle_, ");
        cm1e_st_emit_expression(st, call->override);
        cm1e_st_put(st, ");\n");
    }
    if (cm1e_st_has_edges(call->unit))
        cm1e_st_line(st, "edges_%s(fb);\n", call->unit->c_type);
    cm1e_st_line(st, "%s(fb);\n", call->unit->c_name);
    emit_ends(st, call);
    st->callee = call->a;
    for (const arg_t *arg = call->args; arg; arg = arg->next)
        if (arg->value && arg->parameter && arg->parameter->section == V_OUTPUT) {
            cm1e_st_place(st, arg->place);
            cm1e_st_emit_assignment(st, arg->value, arg->source);
        }
    st->callee = NULL;
    st->indent--;
    cm1e_st_line(st, "}\n");
}

/** SUPER^() in a method: the statements of the base use its VAR_IN_OUT. */
static void emit_in_outs(st_t *st, const unit_t *base)
{
    for (const var_t *var = st->unit->kind == U_METHOD ? base->vars : NULL; var; var = var->next)
        if (var->section == V_IN_OUT) {
            cm1e_st_begin_line(st);
            cm1e_st_put(st, "(void)&");
            cm1e_st_emit_in_out(st, var);
            cm1e_st_put(st, ";\n");
        }
}

static void emit_call(st_t *st, const stmt_t *stmt)
{
    if (stmt->value->super && stmt->value->unit->kind == U_BLOCK) {
        emit_in_outs(st, stmt->value->unit);
        cm1e_st_place(st, stmt->place);
        cm1e_st_line(st, "%s((%s *)self);\n", stmt->value->unit->c_name, stmt->value->unit->c_type);
        return;
    }
    if (stmt->value->unit->kind == U_BLOCK || stmt->value->unit->kind == U_PROGRAM) {
        emit_block_call(st, stmt->value);
        return;
    }
    cm1e_st_line(st, "%s", stmt->value->unit->result_type ? "(void)" : "");
    cm1e_st_emit_expression(st, stmt->value);
    cm1e_st_put(st, ";\n");
}

/* ---- branches ---------------------------------------------------------------------------------------------------- */

static void emit_label(st_t *st, const arg_t *arg, unsigned selector)
{
    const bool range = arg->value->kind == E_REPEAT;
    const expr_t *low = range ? arg->value->a : arg->value;
    cm1e_st_put(st, range ? "(selector%u >= " : "selector%u == ", selector);
    cm1e_st_emit_constant(st, st->elementary[T_LINT], &low->value);
    if (!range)
        return;
    cm1e_st_put(st, " && selector%u <= ", selector);
    cm1e_st_emit_constant(st, st->elementary[T_LINT], &arg->value->b->value);
    cm1e_st_put(st, ")");
}

static void emit_condition(st_t *st, const branch_t *branch, unsigned selector)
{
    if (branch->condition)
        cm1e_st_emit_expression(st, branch->condition);
    for (const arg_t *arg = branch->labels; arg; arg = arg->next) {
        emit_label(st, arg, selector);
        if (arg->next)
            cm1e_st_put(st, " || ");
    }
}

static void emit_branches(st_t *st, const stmt_t *stmt, unsigned selector)
{
    for (const branch_t *branch = stmt->branches; branch; branch = branch->next) {
        const bool is_else = !branch->condition && !branch->labels, first = branch == stmt->branches;
        cm1e_st_place(st, branch->place);
        if (is_else) {
            cm1e_st_line(st, first ? "{\n" : "} else {\n");
        } else {
            cm1e_st_line(st, first ? "if (" : "} else if (");
            emit_condition(st, branch, selector);
            cm1e_st_put(st, ") {\n");
        }
        emit_body(st, branch->body);
    }
    if (stmt->branches)
        cm1e_st_line(st, "}\n");
}

static void emit_case(st_t *st, const stmt_t *stmt)
{
    const unsigned selector = ++st->temporaries;
    cm1e_st_line(st, "{ ST_UNUSED const int64_t selector%u = (int64_t)", selector);
    st->indent++;
    cm1e_st_emit_expression(st, stmt->value);
    cm1e_st_put(st, ";\n");
    emit_branches(st, stmt, selector);
    st->indent--;
    cm1e_st_line(st, "}\n");
}

/* ---- loops ------------------------------------------------------------------------------------------------------- */

/** The body of a loop: each pass counts for the limit of passes. */
static void emit_passes(st_t *st, const stmt_t *stmt)
{
    st->indent++;
    cm1e_st_place(st, stmt->place);
    cm1e_st_line(st, "st_loop(ST_HERE);\n");
    cm1e_st_emit_statements(st, stmt->body);
    st->indent--;
}

/** The counter gets its value, also the first one that is too far; a subrange only those that are within it. */
static void emit_count(st_t *st, const expr_t *target, unsigned n)
{
    const type_t *type = target->type;
    if (!type->ranged) {
        cm1e_st_emit_expression(st, target);
        cm1e_st_put(st, " = (%s)for%u.now, st_goes(&for%u)", type->name, n, n);
        return;
    }
    cm1e_st_put(st, "st_goes(&for%u) && (", n);
    cm1e_st_emit_expression(st, target);
    cm1e_st_put(st, " = (%s)st_within(for%u.now, %s, %s, ST_HERE), 1)", type->name, n, cm1e_st_int64(st, type->first),
                cm1e_st_int64(st, type->last));
}

/** The limits are evaluated one after the other, as they are written: a call in one may change the next one. All stands
 *  in one line, which is that of the FOR in a fault. */
static void emit_for(st_t *st, const stmt_t *stmt)
{
    const unsigned n = ++st->temporaries;
    cm1e_st_line(st, "{ const int64_t from%u = ", n);
    cm1e_st_emit_expression(st, stmt->value);
    cm1e_st_put(st, ", to%u = ", n);
    cm1e_st_emit_expression(st, stmt->to);
    cm1e_st_put(st, ", by%u = ", n);
    if (stmt->by)
        cm1e_st_emit_expression(st, stmt->by);
    else
        cm1e_st_put(st, "1");
    cm1e_st_put(st, "; for (st_for_t for%u = st_for(from%u, to%u, by%u, ST_HERE); ", n, n, n, n);
    emit_count(st, stmt->target, n);
    cm1e_st_put(st, "; st_next(&for%u)) {\n", n);
    emit_passes(st, stmt);
    cm1e_st_line(st, "} }\n");
}

static void emit_while(st_t *st, const stmt_t *stmt)
{
    cm1e_st_line(st, "while (");
    cm1e_st_emit_expression(st, stmt->value);
    cm1e_st_put(st, ") {\n");
    emit_passes(st, stmt);
    cm1e_st_line(st, "}\n");
}

static void emit_repeat(st_t *st, const stmt_t *stmt)
{
    cm1e_st_line(st, "do {\n");
    emit_passes(st, stmt);
    cm1e_st_place(st, stmt->value->place);
    cm1e_st_line(st, "} while (!(");
    cm1e_st_emit_expression(st, stmt->value);
    cm1e_st_put(st, "));\n");
}

/** The call whose EN decides on a statement; NULL: none. */
static const expr_t *skipped_by(const stmt_t *stmt)
{
    const expr_t *call = stmt->kind == S_ASSIGN || stmt->kind == S_CALL ? stmt->value : NULL;
    while (call && call->kind == E_CONVERT)
        call = call->a;
    return call && call->kind == E_CALL && (call->enable || call->enabled) ? call : NULL;
}

/** if (EN) { statement }, and ENO is what EN was. */
static void emit_skipped(st_t *st, const stmt_t *stmt, const expr_t *call, void (*emit)(st_t *st, const stmt_t *stmt))
{
    const unsigned n = ++st->temporaries;
    cm1e_st_line(st, "{\n");
    st->indent++;
    cm1e_st_line(st, "const BOOL enable%u = ", n);
    if (call->enable)
        cm1e_st_emit_expression(st, call->enable);
    else
        cm1e_st_put(st, "TRUE");
    cm1e_st_put(st, ";\n");
    cm1e_st_line(st, "if (enable%u) {\n", n);
    st->indent++;
    emit(st, stmt);
    st->indent--;
    cm1e_st_line(st, "}\n");
    if (call->enabled) {
        cm1e_st_begin_line(st);
        cm1e_st_emit_expression(st, call->enabled);
        cm1e_st_put(st, " = enable%u;\n", n);
    }
    st->indent--;
    cm1e_st_line(st, "}\n");
}

static void emit_simple(st_t *st, const stmt_t *stmt)
{
    if (stmt->kind == S_ASSIGN)
        cm1e_st_emit_assignment(st, stmt->target, stmt->value);
    else
        emit_call(st, stmt);
}

static void emit_statement(st_t *st, const stmt_t *stmt)
{
    const expr_t *skipped = skipped_by(stmt);
    if (stmt->kind != S_IF)
        cm1e_st_place(st, stmt->place);
    switch (stmt->kind) {
    case S_ASSIGN:
    case S_CALL:
        if (skipped)
            emit_skipped(st, stmt, skipped, emit_simple);
        else
            emit_simple(st, stmt);
        break;
    case S_IF: emit_branches(st, stmt, 0); break;
    case S_CASE: emit_case(st, stmt); break;
    case S_FOR: emit_for(st, stmt); break;
    case S_WHILE: emit_while(st, stmt); break;
    case S_REPEAT: emit_repeat(st, stmt); break;
    case S_EXIT: cm1e_st_line(st, "break;\n"); break;
    case S_CONTINUE: cm1e_st_line(st, "continue;\n"); break;
    case S_RETURN:
        st->leaves = true;
        cm1e_st_line(st, "goto leave;\n");
        break;
    default: break;
    }
}

void cm1e_st_emit_statements(st_t *st, const stmt_t *list)
{
    for (; list; list = list->next)
        emit_statement(st, list);
}
