#include "scheduler/forcing.h"

#include <string.h>

#include "scheduler/event_log.h"

enum { RELEASED = 0, FORCED, WRITTEN };

static void write_value(const forcing_parts_t *p, uint32_t variable, const variable_value_t *value)
{
    cm1e_variable_write(&p->forcing->variables.rows[variable], value);
}

void cm1e_scheduler_set_variables(cm1e_scheduler_t *scheduler, const variable_t *rows, uint32_t count)
{
    cm1e_scheduler_forcing(scheduler)->variables = (variables_t){rows, count};
}

const variables_t *cm1e_scheduler_variables(const cm1e_scheduler_t *scheduler)
{
    return &cm1e_scheduler_forcing((cm1e_scheduler_t *)(uintptr_t)scheduler)->variables;
}

void cm1e_scheduler_apply_forced(cm1e_scheduler_t *scheduler)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    for (int i = 0; p.forcing->count > 0 && i < CM1E_FORCED; i++)
        if (p.forcing->rows[i].held)
            write_value(&p, p.forcing->rows[i].variable, &p.forcing->rows[i].value);
}

static void note(const forcing_parts_t *p, int what, uint32_t variable, const variable_value_t *value)
{
    double rest;
    const double number = cm1e_variable_number_of(&p->forcing->variables.rows[variable], value, &rest);
    cm1e_log_variable(p->log, what, variable, number, rest, p->run_ns);
}

static forced_t *find(forcing_t *forcing, uint32_t variable)
{
    for (int i = 0; forcing->count > 0 && i < CM1E_FORCED; i++)
        if (forcing->rows[i].held && forcing->rows[i].variable == variable)
            return &forcing->rows[i];
    return NULL;
}

static bool is_of(const forced_t *row, const forced_t *who)
{
    return row->owner == who->owner && row->client == who->client;
}

/** The place of what another one has released, and which this owner has not let go of; NULL: there is none. */
static forced_t *find_taken(const forcing_parts_t *p, const forced_t *who)
{
    for (int i = 0; i < CM1E_FORCED; i++) {
        forced_t *row = &p->forcing->rows[i];
        if (row->taken && p->run_ns < row->until_ns && row->variable == who->variable && is_of(row, who))
            return row;
    }
    return NULL;
}

/** A place that is not held; the last ones that are used are those of `taken`. */
static forced_t *find_free(const forcing_parts_t *p)
{
    forced_t *free = NULL;
    for (int i = 0; i < CM1E_FORCED; i++) {
        forced_t *row = &p->forcing->rows[i];
        if (!row->held && !(row->taken && p->run_ns < row->until_ns))
            return row;
        if (!row->held)
            free = row;
    }
    return free;
}

forcing_result_t cm1e_scheduler_would_take(cm1e_scheduler_t *scheduler, const forced_t *forced, bool force)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    const forced_t *row = find(p.forcing, forced->variable);
    if (p.ending)
        return FORCING_ENDING;
    if (force && find_taken(&p, forced))
        return FORCING_TAKEN;
    if (row)
        return force && is_of(row, forced) ? FORCING_DONE : FORCING_HELD;
    return force && !find_free(&p) ? FORCING_FULL : FORCING_DONE;
}

forcing_result_t cm1e_scheduler_force(cm1e_scheduler_t *scheduler, const forced_t *forced)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    const forcing_result_t result = cm1e_scheduler_would_take(scheduler, forced, true);
    if (result == FORCING_TAKEN)
        find_taken(&p, forced)->until_ns = forced->until_ns;
    if (result != FORCING_DONE)
        return result;
    forced_t *row = find(p.forcing, forced->variable);
    const bool renewed = row && memcmp(row->value.bytes, forced->value.bytes, sizeof row->value.bytes) == 0;
    p.forcing->count += !row;
    row = row ? row : find_free(&p);
    *row = *forced;
    row->held = true;
    row->taken = false;
    write_value(&p, row->variable, &row->value);
    if (!renewed)
        note(&p, FORCED, row->variable, &row->value);
    return FORCING_DONE;
}

static void release(const forcing_parts_t *p, forced_t *row)
{
    row->held = false;
    p->forcing->count--;
    note(p, RELEASED, row->variable, &row->value);
}

void cm1e_scheduler_release(cm1e_scheduler_t *scheduler, const forced_t *who)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    forced_t *row = find(p.forcing, who->variable), *taken = find_taken(&p, who);
    if (taken)
        taken->taken = false; /* its owner has let go of it, and does not mean what somebody else forces meanwhile */
    if (!row || taken)
        return;
    release(&p, row);
    row->taken = !is_of(row, who);
}

void cm1e_scheduler_release_all(cm1e_scheduler_t *scheduler, const void *owner, uint32_t client)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    const forced_t who = {.owner = owner, .client = client};
    for (int i = 0; i < CM1E_FORCED; i++) {
        forced_t *row = &p.forcing->rows[i];
        if (row->held && is_of(row, &who))
            release(&p, row);
        if (is_of(row, &who))
            row->taken = false;
    }
}

forcing_result_t cm1e_scheduler_write(cm1e_scheduler_t *scheduler, uint32_t variable, const variable_value_t *value)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    const forcing_result_t result = cm1e_scheduler_would_take(scheduler, &(forced_t){.variable = variable}, false);
    if (result != FORCING_DONE)
        return result;
    write_value(&p, variable, value);
    note(&p, WRITTEN, variable, value);
    return FORCING_DONE;
}

bool cm1e_scheduler_is_forced(const cm1e_scheduler_t *scheduler, uint32_t variable)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts((cm1e_scheduler_t *)(uintptr_t)scheduler);
    return find(p.forcing, variable) != NULL;
}

uint32_t cm1e_scheduler_list_forced(const cm1e_scheduler_t *scheduler, uint32_t rows[CM1E_FORCED])
{
    const forcing_t *forcing = cm1e_scheduler_forcing((cm1e_scheduler_t *)(uintptr_t)scheduler);
    uint32_t count = 0;
    for (int i = 0; i < CM1E_FORCED; i++)
        if (forcing->rows[i].held)
            rows[count++] = forcing->rows[i].variable;
    return count;
}

void cm1e_scheduler_forcing_cycle(cm1e_scheduler_t *scheduler)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    for (int i = 0; p.forcing->count > 0 && i < CM1E_FORCED; i++) {
        forced_t *row = &p.forcing->rows[i];
        if (row->held && (p.ending || p.run_ns >= row->until_ns))
            release(&p, row);
    }
}
