/* A run for each point at which the motor moves: a configuration within the limits, a bus, a scheduler. */
#include "prove/motion.h"
#include "which_slave.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- the configuration ------------------------------------------------------------------------------------------- */

/** The unit is a revolution of the motor, whatever the bus file says; its limits are those of the options. */
static void limit_axis(const motion_t *m, cm1e_axis_config_t *axis, double position)
{
    const prove_options_t *options = m->prove->options;
    const cm1e_axis_config_t before = *axis;
    const double fastest = m->prove->device->peak_velocity(&before) / m->prove->device->counts_per_revolution(&before);
    *axis = (cm1e_axis_config_t){.address_kind = before.address_kind, .address = before.address,
                                 .channel = before.channel, .k37 = before.k37, .k37_stated = before.k37_stated,
                                 .sim = before.sim, .acceleration_in_kpulses = before.acceleration_in_kpulses};
    memcpy(axis->name, before.name, sizeof axis->name);
    memcpy(axis->motor, before.motor, sizeof axis->motor);
    memcpy(axis->device, before.device, sizeof axis->device);
    memcpy(axis->firmware, before.firmware, sizeof axis->firmware);
    axis->max_velocity = fmin(options->max_velocity, fastest);
    axis->max_acceleration = fmin(fmax(20 * axis->max_velocity, 1), 100);
    if (m->point->row < MOVE_HOME) {
        axis->software_limit_positive = position + options->max_travel;
        axis->software_limit_negative = position - options->max_travel;
    } else {
        axis->homing.method = (int8_t)motion_method(m->point);
        axis->homing.velocity = fmax(0.02, fmin(axis->max_velocity, 1));
        axis->homing.timeout_s = options->max_travel / axis->homing.velocity + 10;
    }
    if (m->point->row == MOVE_CSV)
        axis->mapping = CM1E_MAPPING_CSV;
    if (m->point->row == MOVE_PP || m->point->row == MOVE_PV)
        axis->motion = CM1E_MOTION_DRIVE;
}

static bool copy_configuration(cm1e_bus_config_t *to, const cm1e_bus_config_t *from)
{
    *to = *from;
    to->axes = NULL;
    to->axis_count = 0;
    for (uint32_t i = 0; i < from->axis_count; i++) {
        cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(to, NULL);
        if (!axis)
            return false;
        *axis = from->axes[i];
    }
    return true;
}

/** Every motor of the network becomes an axis where no bus file says which there are: an extra motor is an error. */
static bool add_axes(const prove_t *prove, cm1e_bus_config_t *config)
{
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(prove->bus); position++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(prove->bus, position);
        if (!slave->device)
            continue;
        if (slave->device->channels > 0 || slave->device->motor_stated)
            return false;
        cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(config, NULL);
        if (axis)
            *axis = (cm1e_axis_config_t){.address = (uint16_t)position};
    }
    return true;
}

/** The axis of the device, behind a bridge its first one; -1: none. */
static int axis_of(const prove_t *prove, const cm1e_bus_config_t *config)
{
    for (uint8_t channel = 0; channel <= prove->device->channels; channel++) {
        const int axis = find_axis_at(prove->bus, config, prove->slave, channel);
        if (axis >= 0)
            return axis;
    }
    return -1;
}

/** The position before the motor is enabled, in revolutions. */
static bool read_position(const prove_t *prove, const cm1e_axis_config_t *axis, double *revolutions)
{
    enum { CHANNEL_STEP = 0x800 };
    uint8_t data[4];
    size_t size = sizeof data;
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): axis_of() has found it */
    const uint16_t index = (uint16_t)(0x6064 + (axis->channel > 0 ? axis->channel - 1 : 0) * CHANNEL_STEP);
    const bool read = cm1e_sdo_read(prove->bus, prove->position, index, 0, data, &size, NULL) == CM1E_OK && size == 4;
    if (read)
        *revolutions = (double)prove_number_of(data, size, true) / prove->device->counts_per_revolution(axis);
    return read;
}

static bool configure(motion_t *m, cm1e_bus_config_t *config, uint32_t *number)
{
    prove_t *prove = m->prove;
    double position;
    if (!copy_configuration(config, prove->config)) {
        prove_note(prove, "out of memory");
        return false;
    }
    if (config->axis_count == 0 && !add_axes(prove, config)) {
        prove_note(prove, "it needs a bus file (-b): the network has motors whose resolution it does not tell");
        return false;
    }
    const int axis = axis_of(prove, config);
    if (axis < 0 || !read_position(prove, &config->axes[axis], &position)) {
        prove_note(prove, axis < 0 ? "the bus file has no axis for it" : "its position cannot be read");
        return false;
    }
    *number = (uint32_t)axis;
    limit_axis(m, &config->axes[axis], position);
    m->velocity = fmin(config->axes[axis].max_velocity, prove->options->max_travel);
    m->distance = fmin(1, prove->options->max_travel / 2);
    m->acceleration = config->axes[axis].max_acceleration;
    return true;
}

/* ---- cycle times: nothing is enabled ------------------------------------------------------------------------------ */

typedef struct cycle {
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    cm1e_sdo_t question;
    uint8_t answer[4];
    unsigned cycles;
} cycle_t;

static void cycle_program(void *context)
{
    enum { CYCLES_BEFORE = 500 };
    cycle_t *cycle = context;
    if (++cycle->cycles == CYCLES_BEFORE && cm1e_sdo_submit(cycle->bus, &cycle->question) != CM1E_OK)
        cm1e_scheduler_stop(cycle->scheduler);
    const cm1e_sdo_state_t state = cm1e_sdo_state(&cycle->question);
    if (cycle->cycles > CYCLES_BEFORE && (state == CM1E_SDO_DONE || state == CM1E_SDO_ERROR))
        cm1e_scheduler_stop(cycle->scheduler);
}

static bool run_cycle(cycle_t *cycle, cm1e_diag_t *diag)
{
    const cm1e_scheduler_config_t settings = {0};
    const cm1e_task_config_t task = {.name = "prove", .program = cycle_program, .context = cycle};
    if (cm1e_scheduler_create(&cycle->scheduler, cycle->bus, &settings, diag) != CM1E_OK)
        return false;
    cm1e_scheduler_stop_on_signals(cycle->scheduler);
    const bool good = cm1e_scheduler_add_task(cycle->scheduler, &task, diag) == CM1E_OK
                      && cm1e_scheduler_run(cycle->scheduler, 0, diag) == CM1E_OK;
    cm1e_scheduler_destroy(cycle->scheduler);
    return good;
}

static void look_at_cycle(prove_t *prove, int us, const cm1e_bus_config_t *config)
{
    cm1e_diag_t diag = {0};
    cycle_t cycle = {.question = {.position = prove->position, .index = OBJ_FE00_PDO_TIMING, .subindex = 1}};
    cycle.question.data = cycle.answer;
    cycle.question.size = sizeof cycle.answer;
    const bool good = cm1e_bus_open(&cycle.bus, config, &diag) == CM1E_OK && prove_play(prove->options, cycle.bus)
                      && cm1e_bus_start(cycle.bus, &diag) == CM1E_OK && run_cycle(&cycle, &diag);
    const bool read = good && cm1e_sdo_state(&cycle.question) == CM1E_SDO_DONE;
    cm1e_bus_close(cycle.bus);
    if (read)
        prove_compare_number(prove, "0xFE00:01", us, prove_number_of(cycle.answer, cycle.question.size, false), 0);
    else if (good)
        prove_note(prove, "0xFE00:01 cannot be read");
    else
        prove_compare(prove, "run", "done", diag.text[0] ? diag.text : "broken off");
}

void look_cycle(prove_t *prove, const point_t *point)
{
    enum { ANY_FIRMWARE = 1000, NS = 1000 };
    cm1e_bus_config_t config;
    if (point->row != ANY_FIRMWARE && !prove->firmware->all_cycle_times) {
        prove_note(prove, "before V1.3.2 there are only 1000 us");
        return;
    }
    if (!copy_configuration(&config, prove->config) || (config.axis_count == 0 && !add_axes(prove, &config))) {
        prove_note(prove, "it needs a bus file (-b): the network has motors whose resolution it does not tell");
    } else {
        config.cycle_time_ns = (int64_t)point->row * NS;
        cm1e_bus_close(prove->bus);
        prove->bus = NULL;
        look_at_cycle(prove, point->row, &config);
        prove->interrupted |= !prove_open(prove);
    }
    cm1e_bus_config_free(&config);
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

static bool run_program(motion_t *m, uint32_t number, cm1e_diag_t *diag)
{
    const cm1e_scheduler_config_t settings = {0};
    /* One point pauses in its task, so that the motor misses its frames. */
    const cm1e_task_config_t task = {.name = "prove", .program = motion_program, .context = m, .watchdog_cycles = -1};
    if (cm1e_scheduler_create(&m->scheduler, m->bus, &settings, diag) != CM1E_OK)
        return false;
    m->axis = cm1e_scheduler_axis(m->scheduler, number);
    m->power = (MC_Power_t){.Axis = &m->axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    m->there = (MC_MoveRelative_t){.Axis = &m->axis, .Distance = m->distance, .Velocity = m->velocity};
    m->back = (MC_MoveRelative_t){.Axis = &m->axis, .Distance = -m->distance, .Velocity = m->velocity};
    m->run = (MC_MoveVelocity_t){.Axis = &m->axis, .Velocity = m->velocity, .Direction = mcPositiveDirection};
    m->stop = (MC_Stop_t){.Axis = &m->axis};
    m->reset = (MC_Reset_t){.Axis = &m->axis};
    m->home = (MC_Home_t){.Axis = &m->axis};
    cm1e_scheduler_stop_on_signals(m->scheduler);
    /* A signal from before this line ends no scheduler. */
    const bool good = cm1e_scheduler_add_task(m->scheduler, &task, diag) == CM1E_OK
                      && (prove_is_told_to_end(m->prove) || cm1e_scheduler_run(m->scheduler, 0, diag) == CM1E_OK);
    if (m->failed)
        cm1e_axis_error_text(m->axis, m->error, sizeof m->error);
    cm1e_scheduler_destroy(m->scheduler);
    return good;
}

static void run(motion_t *m, const cm1e_bus_config_t *config, uint32_t number)
{
    cm1e_diag_t diag = {0};
    const bool good = cm1e_bus_open(&m->bus, config, &diag) == CM1E_OK
                      && prove_play(m->prove->options, m->bus)
                      && cm1e_bus_start(m->bus, &diag) == CM1E_OK && run_program(m, number, &diag);
    cm1e_bus_close(m->bus);
    if (!good)
        prove_compare(m->prove, "run", "done", diag.text[0] ? diag.text : "broken off");
    else
        motion_judge(m);
    m->prove->interrupted |= good && m->step != MOTION_END;
}

/** The bus is opened anew for the run, because its configuration is another one, and once more behind it. */
void look_motion(prove_t *prove, const point_t *point)
{
    motion_t motion = {.prove = prove, .point = point};
    cm1e_bus_config_t config = {0};
    uint32_t number;
    if (prove->cannot_move) {
        prove_note(prove, "move.enable has to agree first");
        return;
    }
    if (point->row == MOVE_WATCHDOG && prove->config->virtual_time) {
        prove_note(prove, "the simulated segment runs on virtual time");
        return;
    }
    if (configure(&motion, &config, &number)) {
        cm1e_bus_close(prove->bus);
        prove->bus = NULL;
        run(&motion, &config, number);
        prove->cannot_move |= point->row == MOVE_ENABLE && json_array_size(prove->differences) > 0;
        if (!prove_open(prove))
            prove->interrupted = true;
    } else {
        prove->cannot_move |= point->row == MOVE_ENABLE;
    }
    cm1e_bus_config_free(&config);
}
