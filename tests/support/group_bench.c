#include "group_bench.h"

AXES_GROUP_REF_t group_reference;
cm1e_group_t *group;

void group_end(void)
{
    axes_end();
    (void)cm1e_group_destroy(group_reference);
    group_reference = (AXES_GROUP_REF_t){0};
    group = NULL;
}

void group_create(void)
{
    cm1e_diag_t diag = {0};
    const cm1e_group_config_t config = {.name = "table"};
    AXES_MUST(cm1e_group_create(&group_reference, &config, &diag) == CM1E_OK, "%s", diag.text);
    group = cm1e_group_from_reference(&group_reference);
}

const char *group_text(void)
{
    static char text[CM1E_GROUP_ERROR_TEXT_BYTES];
    cm1e_group_error_text(group_reference, text, sizeof text);
    return text;
}

void group_told(const char *words)
{
    AXES_MUST(strstr(group_text(), words), "the group does not say \"%s\" but: %s", words, group_text());
}

cm1e_group_info_t group_info(void)
{
    cm1e_group_info_t info;
    cm1e_group_get(group, &info);
    return info;
}

void group_must_be(cm1e_group_state_t state)
{
    AXES_MUST(group_info().state == state, "the group is in %s instead of %s: %s",
              cm1e_group_state_name(group_info().state), cm1e_group_state_name(state), group_text());
}

void group_form(void)
{
    group_create();
    for (int n = 0; n < axes_bench.count; n++)
        AXES_MUST(cm1e_group_add(group, axes_reference(n), 0) == CM1E_OK, "%s", group_text());
}

void group_begin(int count)
{
    group_end();
    axes_begin(count);
    group_form();
    AXES_MUST(cm1e_group_enable(group) == CM1E_OK, "%s", group_text());
}

cm1e_command_id_t group_command(const cm1e_group_command_t *command)
{
    cm1e_command_id_t id = 0;
    const cm1e_error_t error = cm1e_group_start(group, command, &id);
    AXES_MUST(error == CM1E_OK && id != 0, "kind %d: %s: %s", (int)command->kind, cm1e_strerror(error), group_text());
    return id;
}

void group_refused(const cm1e_group_command_t *command, cm1e_error_t expected)
{
    cm1e_command_id_t id = 7;
    const cm1e_error_t error = cm1e_group_start(group, command, &id);
    AXES_MUST(error == expected && id == 0, "kind %d: \"%s\" instead of \"%s\"", (int)command->kind,
              cm1e_strerror(error), cm1e_strerror(expected));
    AXES_MUST(group_text()[0], "kind %d: nothing is said of \"%s\"", (int)command->kind, cm1e_strerror(error));
}

cm1e_command_id_t group_line(double x, double y, double velocity, MC_BUFFER_MODE mode)
{
    return group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {x, y},
                                                 .velocity = velocity, .buffer_mode = mode});
}

cm1e_command_id_t group_stop(void)
{
    return group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_STOP});
}

cm1e_command_state_t group_state_of(cm1e_command_id_t id)
{
    return cm1e_group_command_status(group, id).state;
}

/** Cycles until the command has ended; how many it took. */
static int group_wait(cm1e_command_id_t id)
{
    int waited = 0;
    while ((group_state_of(id) == CM1E_COMMAND_ACTIVE || group_state_of(id) == CM1E_COMMAND_BUFFERED) &&
           waited++ < 60000)
        axes_cycles(1);
    return waited;
}

void group_done(cm1e_command_id_t id)
{
    group_wait(id);
    AXES_MUST(group_state_of(id) == CM1E_COMMAND_DONE, "command state %d: %s", (int)group_state_of(id), group_text());
}

double group_at(int n) { return cm1e_axis_place(axes_axis(n), false); }

double group_off_line(double ax, double ay, double bx, double by)
{
    const double dx = bx - ax, dy = by - ay, x = group_at(0) - ax, y = group_at(1) - ay;
    return fabs(dx * y - dy * x) / hypot(dx, dy);
}

double group_off_circle(double cx, double cy, double radius)
{
    return fabs(hypot(group_at(0) - cx, group_at(1) - cy) - radius);
}
