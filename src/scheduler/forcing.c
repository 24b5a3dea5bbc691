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

static forced_t *find_free(forcing_t *forcing)
{
    for (int i = 0; i < CM1E_FORCED; i++)
        if (!forcing->rows[i].held)
            return &forcing->rows[i];
    return NULL;
}

forcing_result_t cm1e_scheduler_force(cm1e_scheduler_t *scheduler, const forced_t *forced)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    forced_t *row = find(p.forcing, forced->variable);
    const bool renewed = row && memcmp(row->value.bytes, forced->value.bytes, sizeof row->value.bytes) == 0;
    if (p.ending)
        return FORCING_ENDING;
    if (row && (row->owner != forced->owner || row->client != forced->client))
        return FORCING_HELD;
    p.forcing->count += !row;
    row = row ? row : find_free(p.forcing);
    if (!row) {
        p.forcing->count--;
        return FORCING_FULL;
    }
    *row = *forced;
    row->held = true;
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

void cm1e_scheduler_release(cm1e_scheduler_t *scheduler, uint32_t variable)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    forced_t *row = find(p.forcing, variable);
    if (row)
        release(&p, row);
}

void cm1e_scheduler_release_all(cm1e_scheduler_t *scheduler, const void *owner, uint32_t client)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    for (int i = 0; p.forcing->count > 0 && i < CM1E_FORCED; i++) {
        forced_t *row = &p.forcing->rows[i];
        if (row->held && row->owner == owner && row->client == client)
            release(&p, row);
    }
}

forcing_result_t cm1e_scheduler_write(cm1e_scheduler_t *scheduler, uint32_t variable, const variable_value_t *value)
{
    const forcing_parts_t p = cm1e_scheduler_forcing_parts(scheduler);
    if (p.ending || find(p.forcing, variable))
        return p.ending ? FORCING_ENDING : FORCING_HELD;
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
