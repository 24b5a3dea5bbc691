/* Moves one motor there and back, and writes what it did to trace.csv. Made by `cm1e new`: change it as you like.
 *
 *     ./motion                 the network of bus.yaml, which is the simulated one at first
 *     ./motion eth1            the same bus file on a network interface; the motor turns!
 */
#include <stdio.h>

#include <cm1e/plcopen.h>
#include <cm1e/scheduler.h>

static cm1e_scheduler_t *scheduler;
static AXIS_REF_t lift;

/* Function blocks are plain structs; members that are not named are 0. Units are those of bus.yaml. */
static MC_Power_t power = {.Axis = &lift, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_MoveRelative_t there = {.Axis = &lift, .Distance = 20, .Velocity = 40};
static MC_MoveRelative_t back = {.Axis = &lift, .Distance = -20, .Velocity = 40};

static WORD first_error(void)
{
    return power.Error ? power.ErrorID : there.Error ? there.ErrorID : back.Error ? back.ErrorID : 0;
}

/* Called once a cycle. Every block is called every time; its Execute or Enable says when it acts. */
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

static int failed(const cm1e_diag_t *why)
{
    fprintf(stderr, "%s\n", why->text);
    return 1;
}

static int run(cm1e_bus_t *bus)
{
    cm1e_diag_t why = {0};
    const cm1e_scheduler_config_t settings = {.trace_capacity = 60000};
    const cm1e_task_config_t task = {.name = "motion", .program = program};
    if (cm1e_bus_start(bus, &why) != CM1E_OK || cm1e_scheduler_create(&scheduler, bus, &settings, &why) != CM1E_OK)
        return failed(&why);
    lift = cm1e_scheduler_axis(scheduler, 0);
    cm1e_scheduler_stop_on_signals(scheduler); /* Ctrl-C ramps down and disables */
    int status = 0;
    if (cm1e_scheduler_add_task(scheduler, &task, &why) != CM1E_OK
        || cm1e_scheduler_run(scheduler, 0, &why) != CM1E_OK
        || cm1e_scheduler_write_csv(scheduler, "trace.csv", &why) != CM1E_OK)
        status = failed(&why);
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    cm1e_axis_error_text(lift, text, sizeof text);
    if (first_error() != 0) {
        fprintf(stderr, "%s\n", text[0] ? text : cm1e_strerror(cm1e_error_from_id(first_error())));
        status = 1;
    }
    printf("%s\n", back.Done && status == 0 ? "there and back" : "not done");
    cm1e_scheduler_destroy(scheduler);
    return back.Done ? status : 1;
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    cm1e_bus_config_t config;
    cm1e_bus_t *bus = NULL;
    if (cm1e_bus_config_load(&config, "bus.yaml", &why) != CM1E_OK)
        return failed(&why);
    if (argc > 1)
        snprintf(config.interface_name, sizeof config.interface_name, "%s", argv[1]);
    if (cm1e_bus_open(&bus, &config, &why) != CM1E_OK)
        return failed(&why);
    const int status = run(bus);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
    return status;
}
