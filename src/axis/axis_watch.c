#include "axis/axis_watch.h"

#include <string.h>

#include "axis/axis_kind.h"
#include "axis/axis_setpoint.h"
#include "core/cache_line.h"

void cm1e_axis_news(const cm1e_axis_t *axis, cm1e_axis_news_t *news)
{
    const commands_t *commands = &axis->commands;
    *news = (cm1e_axis_news_t){
        .state = axis->state,
        .error = axis->fault.error,
        .device_error = axis->fault.device_error,
        .value = axis->fault.value,
        .bound = axis->fault.bound,
        .command = commands->active,
        .kind = commands->kind,
    };
    if (commands->active && commands->active == commands->move.id) {
        news->position = kind_row(commands->kind)->target != TARGET_NONE ? commands->move.position : 0.0;
        news->velocity = kind_row(commands->kind)->has_velocity ? commands->move.velocity : 0.0;
    }
}

const char *cm1e_command_name(cm1e_command_kind_t kind)
{
    return (unsigned)kind < CM1E_COMMAND_KIND_COUNT ? kind_row(kind)->name : "an unknown command";
}

const cm1e_device_error_t *cm1e_axis_device_error(const cm1e_axis_t *axis, uint16_t code)
{
    return axis->drive.kind ? axis->drive.kind->error(code) : NULL;
}

bool cm1e_axis_has_text(const cm1e_axis_t *axis)
{
    const bool gets_in_step = axis_follows(axis) && !axis->setpoint.reached;
    return axis->fault.error || axis->commands.refusal || axis->not_set.error || gets_in_step;
}

/** What rooms above the axis keep of it. */
static int own_copies(const cm1e_axis_t *axis, const own_copy_t *own[3])
{
    int count = 0;
    if (axis->coupling_hooks)
        own[count++] = &axis->coupling_hooks->own;
    if (axis->homing_hooks)
        own[count++] = &axis->homing_hooks->own;
    if (axis->motor_hooks)
        own[count++] = &axis->motor_hooks->own;
    return count;
}

size_t cm1e_axis_copy_bytes(const cm1e_axis_t *axis)
{
    const own_copy_t *own[3];
    size_t bytes = cm1e_whole_cache_lines(sizeof *axis);
    for (int i = own_copies(axis, own) - 1; i >= 0; i--)
        bytes += cm1e_whole_cache_lines(own[i]->bytes);
    return bytes;
}

void cm1e_axis_copy(const cm1e_axis_t *axis, void *copy)
{
    const own_copy_t *own[3];
    unsigned char *place = (unsigned char *)copy + cm1e_whole_cache_lines(sizeof *axis);
    memcpy(copy, axis, sizeof *axis);
    for (int i = own_copies(axis, own) - 1; i >= 0; i--) {
        own[i]->make(axis, copy, place);
        place += cm1e_whole_cache_lines(own[i]->bytes);
    }
}
