/* A program for network interfaces only: it links function blocks and scheduler, makes its configuration in C, and has
 * no simulator. wire_only INTERFACE
 * REGISTER_SIM: it is linked by hand with everything, and registers the simulator. */
#include <stdio.h>

#include <cm1e/plcopen.h>
#include <cm1e/scheduler.h>
#ifdef REGISTER_SIM
#include <cm1e/sim.h>
#endif

static cm1e_scheduler_t *scheduler;
static AXIS_REF_t axis;
static MC_Power_t power = {.Axis = &axis, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_MoveVelocity_t move = {.Axis = &axis, .Velocity = 1};

static void program(void *context)
{
    (void)context;
    MC_Power(&power);
    move.Execute = power.Status;
    MC_MoveVelocity(&move);
}

int main(int argc, char **argv)
{
    static cm1e_bus_config_t config;
    const cm1e_task_config_t task = {.name = "motion", .program = program};
    cm1e_diag_t why = {0};
    cm1e_bus_t *bus = NULL;
#ifdef REGISTER_SIM
    cm1e_sim_register();
#endif
    if (cm1e_bus_config_init(&config, argc > 1 ? argv[1] : NULL, 1) != CM1E_OK) {
        fprintf(stderr, "No memory for the configuration.\n");
        return 1;
    }
    if (cm1e_bus_open(&bus, &config, &why) != CM1E_OK || cm1e_bus_start(bus, &why) != CM1E_OK ||
        cm1e_scheduler_create(&scheduler, bus, NULL, &why) != CM1E_OK ||
        cm1e_scheduler_add_task(scheduler, &task, &why) != CM1E_OK ||
        (axis = cm1e_scheduler_axis(scheduler, 0), cm1e_scheduler_run(scheduler, 100000000, &why) != CM1E_OK))
        fprintf(stderr, "%s\n", why.text);
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
    return why.error != CM1E_OK ? 1 : 0;
}
