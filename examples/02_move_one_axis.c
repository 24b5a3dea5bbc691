/*
 * Enables one motor, moves it one revolution there and back, disables it.
 *
 *     02_move_one_axis          the simulated segment
 *     02_move_one_axis eth1     the first slave on that network interface; the motor turns!
 */
#include <stdio.h>

#include <cm1e/plcopen.h>
#include <cm1e/scheduler.h>

static cm1e_scheduler_t *scheduler;
static AXIS_REF_t axis;

/* Function blocks are plain structs; members that are not named here are 0. Units: revolutions, revolutions per
 * second. */
static MC_Power_t power = {.Axis = &axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_MoveRelative_t there = {.Axis = &axis, .Distance = 1, .Velocity = 2, .Acceleration = 20};
static MC_MoveRelative_t back = {.Axis = &axis, .Distance = -1, .Velocity = 2, .Acceleration = 20};

static WORD first_error(void)
{
    return power.Error ? power.ErrorID : there.Error ? there.ErrorID : back.Error ? back.ErrorID : 0;
}

/* Called once a cycle. Every block is called every time; its Execute says when it acts. */
static void program(void *context)
{
    (void)context;
    power.Enable = !back.Done && first_error() == 0;
    MC_Power(&power);
    there.Execute = there.Execute || power.Status;
    MC_MoveRelative(&there);
    back.Execute = there.Done;
    MC_MoveRelative(&back);
    if (!power.Enable && !power.Status)
        cm1e_scheduler_stop(scheduler);
}

static cm1e_error_t run(const char *interface_name, cm1e_bus_t **bus, cm1e_diag_t *why)
{
    cm1e_bus_config_t config;
    const cm1e_task_config_t task = {.name = "motion", .program = program};
    cm1e_error_t error = cm1e_bus_config_init(&config, interface_name, 1);
    if (error != CM1E_OK)
        return cm1e_diag_set(why, error, 0, "%s", cm1e_strerror(error));
    config.axes[0].in_position_done_waits = true; /* Done waits until the motor is in position, not only its
                                                   * set-point */
    error = cm1e_bus_open(bus, &config, why);
    cm1e_bus_config_free(&config); /* the bus has a copy */
    if (error == CM1E_OK)
        error = cm1e_bus_start(*bus, why);
    if (error == CM1E_OK)
        error = cm1e_scheduler_create(&scheduler, *bus, NULL, why);
    if (error != CM1E_OK)
        return error;
    axis = cm1e_scheduler_axis(scheduler, 0);
    cm1e_scheduler_stop_on_signals(scheduler); /* Ctrl-C, or a closed terminal, ramps down and disables */
    error = cm1e_scheduler_add_task(scheduler, &task, why);
    return error == CM1E_OK ? cm1e_scheduler_run(scheduler, 0, why) : error;
}

/* The errors, in sentences. */
static void tell_error(void)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(axis, text, sizeof text);
    fprintf(stderr, "%s\n", text[0] ? text : cm1e_strerror(cm1e_error_from_id(first_error())));
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    cm1e_bus_t *bus = NULL;
    const cm1e_error_t error = run(argc > 1 ? argv[1] : "sim", &bus, &why);
    if (error != CM1E_OK)
        fprintf(stderr, "%s\n", why.text);
    else if (first_error() != 0)
        tell_error();
    const BOOL moved = back.Done && error == CM1E_OK;
    printf("%s\n", moved ? "moved there and back" : "not moved");
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    return moved ? 0 : 1;
}
