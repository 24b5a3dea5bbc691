/*
 * One program on two networks: the first axis of the second network follows the first axis of the first one
 * (MC_GearIn). Both are exchanged in the same cycle. It turns for three seconds.
 *
 *     16_two_networks                     two simulated segments
 *     16_two_networks two_buses.yaml      the networks of a bus file with two of them (the motors turn!)
 */
#include <stdio.h>

#include <cm1e/plcopen.h>
#include <cm1e/scheduler.h>

enum { LEFT, RIGHT, NETWORKS };
#define TURN_NS INT64_C(3000000000)

static AXIS_REF_t axes[NETWORKS];
static MC_Power_t powers[NETWORKS];
static MC_GearIn_t gear = {.Master = &axes[LEFT], .Slave = &axes[RIGHT], .RatioNumerator = 2, .RatioDenominator = 1};
static MC_MoveVelocity_t turn = {.Axis = &axes[LEFT], .Velocity = 1, .Acceleration = 5, .Deceleration = 5, .Jerk = 50};
static int64_t turn_cycles;
static int cycles, in_step;
static double greatest_difference; /* of the velocities, while the gear is in step: not while a frame is lost */
static cm1e_scheduler_statistics_t statistics;

static void program(void *scheduler)
{
    cm1e_axis_info_t left, right;
    for (int i = 0; i < NETWORKS; i++) {
        powers[i] = (MC_Power_t){.Axis = &axes[i], .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE,
                                 .Status = powers[i].Status};
        MC_Power(&powers[i]);
    }
    gear.Execute = powers[LEFT].Status && powers[RIGHT].Status;
    MC_GearIn(&gear);
    turn.Execute = gear.InGear;
    MC_MoveVelocity(&turn);
    if (cm1e_axis_read(axes[LEFT], &left) == CM1E_OK && cm1e_axis_read(axes[RIGHT], &right) == CM1E_OK && turn.Busy &&
        gear.InGear) {
        const double difference = right.set_velocity - 2 * left.set_velocity;
        in_step++;
        if (difference > greatest_difference || -difference > greatest_difference)
            greatest_difference = difference < 0 ? -difference : difference;
    }
    cycles += turn.Busy;
    if (cycles == turn_cycles || gear.Error || turn.Error)
        cm1e_scheduler_stop(scheduler);
}

/** Two simulated networks, or those of the bus file. */
static cm1e_error_t configure(cm1e_bus_config_t configs[NETWORKS], const char *bus_file, cm1e_diag_t *why)
{
    static const char *const names[NETWORKS] = {"left", "right"};
    uint32_t count;
    if (!bus_file) {
        for (int i = 0; i < NETWORKS; i++) {
            cm1e_bus_config_init(&configs[i], "sim", 1);
            snprintf(configs[i].axes[0].name, sizeof configs[i].axes[0].name, "%s", names[i]);
            configs[i].axes[0].sim.no_stops = true;
        }
        return CM1E_OK;
    }
    const cm1e_error_t error = cm1e_bus_config_load_all(configs, NETWORKS, &count, bus_file, why);
    if (error != CM1E_OK || count == NETWORKS)
        return error;
    snprintf(why->text, sizeof why->text, "%s has one network; this program needs two (`buses`).", bus_file);
    return CM1E_ERROR_CONFIG;
}

static cm1e_error_t open_network(cm1e_bus_t **bus, const cm1e_bus_config_t *config, cm1e_diag_t *why)
{
    const cm1e_error_t error = cm1e_bus_open(bus, config, why);
    return error == CM1E_OK ? cm1e_bus_start(*bus, why) : error; /* the first one is kept while the second starts */
}

static cm1e_error_t run(cm1e_bus_t *buses[NETWORKS], cm1e_diag_t *why)
{
    cm1e_scheduler_t *scheduler = NULL;
    cm1e_error_t error = cm1e_scheduler_create(&scheduler, buses[LEFT], NULL, why);
    turn_cycles = TURN_NS / cm1e_bus_configuration(buses[LEFT])->cycle_time_ns;
    const uint32_t first_right = cm1e_bus_configuration(buses[LEFT])->axis_count;
    if (error == CM1E_OK)
        error = cm1e_scheduler_add_bus(scheduler, buses[RIGHT], why);
    if (error == CM1E_OK)
        error = cm1e_scheduler_add_task(scheduler, &(cm1e_task_config_t){.program = program, .context = scheduler},
                                        why);
    if (error == CM1E_OK) {
        axes[LEFT] = cm1e_scheduler_axis(scheduler, 0);
        axes[RIGHT] = cm1e_scheduler_axis(scheduler, first_right);
        cm1e_scheduler_stop_on_signals(scheduler);
        error = cm1e_scheduler_run(scheduler, 0, why);
    }
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    for (int i = 0; i < NETWORKS && cycles < turn_cycles; i++) {
        cm1e_axis_error_text(axes[i], text, sizeof text);
        fprintf(stderr, "%s%s", text, text[0] ? "\n" : "");
    }
    cm1e_scheduler_statistics(scheduler, &statistics);
    cm1e_scheduler_destroy(scheduler);
    return error;
}

int main(int argc, char **argv)
{
    cm1e_bus_t *buses[NETWORKS] = {NULL};
    cm1e_diag_t why = {0};
    if (argc > 2) {
        fprintf(stderr, "usage: %s [BUS-FILE]\n", argv[0]);
        return 2;
    }
    static cm1e_bus_config_t configs[NETWORKS];
    cm1e_error_t error = configure(configs, argc > 1 ? argv[1] : NULL, &why);
    for (int i = 0; i < NETWORKS && error == CM1E_OK; i++)
        error = open_network(&buses[i], &configs[i], &why);
    if (error == CM1E_OK)
        error = run(buses, &why);
    if (error != CM1E_OK)
        fprintf(stderr, "%s\n", why.text);
    else
        printf("%d cycles on two networks, %d of them in step; there the velocities differed by at most %.3g u/s; "
               "%llu frames lost, %llu overruns\n", cycles, in_step, greatest_difference,
               (unsigned long long)statistics.bus.lost_frames, (unsigned long long)statistics.overruns);
    for (int i = 0; i < NETWORKS; i++) {
        cm1e_bus_close(buses[i]);
        cm1e_bus_config_free(&configs[i]);
    }
    return error == CM1E_OK && cycles == turn_cycles ? 0 : 1;
}
