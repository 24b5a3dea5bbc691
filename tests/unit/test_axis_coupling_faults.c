/*
 * Faults of axes that are coupled, swept: each kind of fault at every cycle of each kind of coupling, for each
 * `coupling_stop` of the slave, on axes without frames. Axis 0 is the master, axis 1 the slave that is looked at,
 * axis 2 follows the same master by a gear, axis 3 has nothing to do with them or is the second master of a
 * combination.
 *
 * Whatever fails and when: no set-point steps (the witness of axes_bench.h), each axis ends where its rule says, at
 * rest unless it was not concerned, with its command ended and its text said; and nothing moves after.
 *
 * Of the cycles a sample is run unless all are asked for (effort.h).
 */
#include "unity.h"

#include "../support/axes_bench.h"
#include "../support/effort.h"
#include "../support/ordinary_witness.h"

enum { MASTER = 0, SLAVE = 1, BESIDE = 2, OTHER = 3, AXES = 4, CYCLES = 420, CONCERNED_CYCLES = 4000 };

void setUp(void) {}
void tearDown(void) { axes_end(); }

/* ---- the couplings ----------------------------------------------------------------------------------------------- */

static struct run {
    int kind, fault, fault_cycle;
    cm1e_coupling_stop_t mode;
    cm1e_command_id_t slave, beside, other;
    bool coupled;               /**< the slave's command was taken */
    bool followed;              /**< it was in force when the fault came; MC_GearInPos may wait for its StartSync */
    int struck;                 /**< cycle of the run, or -1 */
    bool known;                 /**< it was in gear; and where both were then */
    position_t master_at, slave_at;
} run;

static cm1e_command_id_t couple(int n, const cm1e_axis_command_t *command, cm1e_axis_coupling_t coupling)
{
    cm1e_axis_command_t full = *command;
    cm1e_command_id_t id = 0;
    coupling.master[0].axis = axes_reference(MASTER);
    coupling.master[1].axis = axes_reference(OTHER);
    full.coupling = &coupling;
    (void)cm1e_axis_start(axes_axis(n), &full, &id); /* refused: an axis has failed already */
    return id;
}

static cm1e_command_id_t gear(int n)
{
    return couple(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .acceleration = 40, .deceleration = 40},
                  (cm1e_axis_coupling_t){.master = {{.numerator = n == SLAVE ? 3 : 1, .denominator = 2}}});
}

static cm1e_command_id_t begin_gear(void) { return gear(SLAVE); }

static cm1e_command_id_t begin_combination(void)
{
    return couple(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_COMBINE_AXES, .acceleration = 40,
                                                .deceleration = 40},
                  (cm1e_axis_coupling_t){.master = {{.numerator = 1, .denominator = 1},
                                                    {.numerator = -1, .denominator = 2}}});
}

/** To the point where the master is 4 u farther; a polynomial over its way. */
static cm1e_command_id_t begin_gear_in_pos(void)
{
    const double master = cm1e_axis_units(axes_axis(MASTER), axes_axis(MASTER)->setpoint.position);
    const double slave = cm1e_axis_units(axes_axis(SLAVE), axes_axis(SLAVE)->setpoint.position);
    return couple(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN_POS, .velocity = 40},
                  (cm1e_axis_coupling_t){.master = {{.numerator = 1, .denominator = 1}},
                                         .master_sync_position = master + 1.0, .slave_sync_position = slave + 0.5,
                                         .master_start_distance = 0.8});
}

static cm1e_command_id_t begin_cam(void)
{
    static const MC_CAM_POINT points[] = {{0, 0, 0, 0}, {1.5, 0.4, 0, 0}, {3, 0, 0, 0}};
    const MC_CAM_REF table = {.Points = points, .NumberOfPoints = 3};
    MC_CAM_ID cam = 0;
    (void)cm1e_axis_cam_select(axes_axis(SLAVE), &table, true, false, false, &cam);
    return couple(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN},
                  (cm1e_axis_coupling_t){.cam = cam, .start_mode = mcRampIn, .slave_offset = 0.1});
}

/** A gear, and while it runs its master's position is shifted. */
static cm1e_command_id_t begin_phased_gear(void) { return gear(SLAVE); }

static const struct coupling_kind {
    const char *name;
    cm1e_command_id_t (*begin)(void);
} kinds[] = {
    {"MC_GearIn", begin_gear},
    {"MC_CombineAxes", begin_combination},
    {"MC_GearInPos", begin_gear_in_pos},
    {"MC_CamIn", begin_cam},
    {"MC_PhasingRelative", begin_phased_gear},
};
enum { A_GEAR = 0, A_COMBINATION, A_GEAR_IN_POS, A_CAM, A_PHASED_GEAR };

/* ---- the faults -------------------------------------------------------------------------------------------------- */

typedef enum fault_id {
    FAULT_NONE = 0, MASTER_FAULT, SLAVE_FAULT, MASTER_POWER, SLAVE_POWER, MASTER_STOP, SLAVE_STOP, MASTER_HOME,
    MASTER_LOST, SLAVE_LOST, TOO_FAST, TOO_HARD, SLAVE_LAG, BUS_LOST, MASTER_RENAMED, SLAVE_RENAMED, SLAVE_DIRECTION,
    FAULTS,
} fault_id_t;

static const char *const fault_names[FAULTS] = {
    "nothing", "drive fault of the master", "drive fault of the slave", "MC_Power of the master off",
    "MC_Power of the slave off", "MC_Stop of the master", "MC_Stop of the slave", "MC_Home of the master",
    "slave controller of the master lost", "slave controller of the slave lost", "a master too fast for the slave",
    "a master that accelerates too hard for the slave", "a blocked shaft of the slave", "bus lost",
    "MC_SetPosition of the master", "MC_SetPosition of the slave", "a direction of the slave disabled",
};

/** A homing of the drive: some counts in its own way, then its position is another. */
static void homes(cm1e_bus_t *bus)
{
    static int cycle;
    if (bus->state != OPERATION_ENABLED || !(bus->controlword & CONTROLWORD_HOMING_START)) {
        cycle = 0;
        bus->mode_status = STATUSWORD_TARGET_REACHED;
        return;
    }
    if (++cycle < 30)
        bus->position -= 20;
    else if (cycle == 35)
        bus->position = 2;
    bus->mode_status = (uint16_t)(cycle < 30 ? 0 : STATUSWORD_HOMING_ATTAINED |
                                                       (cycle < 35 ? 0 : STATUSWORD_TARGET_REACHED));
}

static void stop(int n)
{
    cm1e_command_id_t id;
    if (cm1e_axis_start(axes_axis(n), &(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP, .deceleration = 40}, &id) ==
        CM1E_OK)
        cm1e_axis_hold_stop(axes_axis(n), id, true);
}

static void lose(int n)
{
    axes_motor(n)->watch.lost = true;
    axes_motor(n)->watch.al_state = 0;
    axes_bench.received = CM1E_ERROR_BUS_WORKING_COUNTER;
}

/** Strikes in its cycle, and what lasts does in every one after it. */
static void strike(int since)
{
    cm1e_command_id_t id;
    const bool now = since == 0;
    const cm1e_homing_config_t homing = {.method = -1};
    switch (run.fault) {
    case MASTER_FAULT: if (now) fake_bus_fault(axes_motor(MASTER), 0x2310); break;
    case SLAVE_FAULT: if (now) fake_bus_fault(axes_motor(SLAVE), 0x2310); break;
    case MASTER_POWER: if (now) axes_power(MASTER, false); break;
    case SLAVE_POWER: if (now) axes_power(SLAVE, false); break;
    case MASTER_STOP: if (now) stop(MASTER); break;
    case SLAVE_STOP: if (now) stop(SLAVE); break;
    case MASTER_HOME:
        if (now)
            (void)cm1e_axis_start(axes_axis(MASTER), &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT,
                                                                            .deceleration = 40}, &id);
        if (axes_state(MASTER) == CM1E_AXIS_STANDSTILL && since < 400)
            (void)cm1e_axis_start(axes_axis(MASTER), &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME,
                                                                            .homing = &homing}, &id);
        break;
    case MASTER_LOST:
    case SLAVE_LOST:
    case BUS_LOST:
        if (now && run.fault != BUS_LOST)
            lose(run.fault == MASTER_LOST ? MASTER : SLAVE);
        axes_bench.received = run.fault == BUS_LOST ? CM1E_ERROR_TIMEOUT : axes_bench.received;
        axes_bench.health = since >= 3 ? CM1E_ERROR_BUS_LOST : CM1E_OK;
        break;
    case TOO_FAST: if (now) (void)cm1e_axis_start(axes_axis(MASTER), &(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 48, .acceleration = 75}, &id); break;
    case TOO_HARD: if (now) (void)cm1e_axis_start(axes_axis(MASTER), &(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 20, .acceleration = 100}, &id); break;
    case SLAVE_LAG:
        axes_motor(SLAVE)->blocked = true;
        axes_bench.witness[SLAVE].strictness = AXES_UNWATCHED; /* braking begins anew where the motor is */
        break;
    case MASTER_RENAMED: if (now) (void)cm1e_axis_set_position(axes_axis(MASTER), 1000, false); break;
    case SLAVE_RENAMED: if (now) (void)cm1e_axis_set_position(axes_axis(SLAVE), -1000, true); break;
    case SLAVE_DIRECTION: axes_bench.positive[SLAVE] = axes_bench.negative[SLAVE] = false; break;
    default: break;
    }
}

/* ---- one run ----------------------------------------------------------------------------------------------------- */

/** What the program does in a cycle of the run, whatever has failed. */
static void program(int cycle)
{
    cm1e_command_id_t id;
    if (cycle == 0) {
        run.beside = gear(BESIDE);
        (void)cm1e_axis_start(axes_axis(OTHER), &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                                       .velocity = 3, .acceleration = 20}, &run.other);
        (void)cm1e_axis_start(axes_axis(MASTER), &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                                        .velocity = 6, .acceleration = 30}, &id);
    } else if (cycle == 60) {
        run.slave = kinds[run.kind].begin();
        run.coupled = run.slave != 0;
    } else if (cycle == 200 && run.kind == A_PHASED_GEAR) {
        const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER)}}};
        (void)cm1e_axis_start(axes_axis(SLAVE),
                              &(cm1e_axis_command_t){.kind = CM1E_COMMAND_PHASING_RELATIVE, .position = -0.4,
                                                     .velocity = 3, .acceleration = 20, .deceleration = 20,
                                                     .jerk = 400, .coupling = &coupling}, &id);
    } else if (cycle == 280 && run.struck < 0) {
        (void)cm1e_axis_start(axes_axis(MASTER),
                              &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 4,
                                                     .direction = mcNegativeDirection, .acceleration = 30,
                                                     .deceleration = 30, .jerk = 800}, &id);
    }
}

static void begin_run(int kind, int fault, int fault_cycle, cm1e_coupling_stop_t mode)
{
    static char scene[160];
    static const char *const modes[] = {"this_axis", "coupled_axes", "keep_ratio"};
    run = (struct run){.kind = kind, .fault = fault, .fault_cycle = fault_cycle, .mode = mode, .struck = -1};
    axes_describe(AXES);
    for (int n = 0; n < AXES; n++) {
        axes_config(n)->homing.method = -1;
        axes_motor(n)->homing = homes;
    }
    axes_config(SLAVE)->coupling_stop = mode;
    axes_config(SLAVE)->invert = true;
    axes_config(SLAVE)->counts_per_unit = 21098.7;
    axes_config(SLAVE)->max_velocity = 50;
    axes_config(SLAVE)->max_acceleration = 120;
    axes_config(SLAVE)->max_deceleration = 230; /* it can follow the master's ramps */
    axes_config(SLAVE)->max_position_lag = 0.2;
    for (int n = 0; n < AXES; n++) /* the last one asks first */
        axes_bench.order[n] = fault_cycle % 2 ? n : AXES - 1 - n;
    axes_bench.run = NULL;
    axes_make();
    axes_enable_all();
    snprintf(scene, sizeof scene, "%s, %s, %s at %d:", kinds[kind].name, modes[mode], fault_names[fault], fault_cycle);
    axes_bench.run = scene;
}

static bool all_rest(void)
{
    for (int n = 0; n < AXES; n++)
        if (axes_axis(n)->setpoint.velocity != 0 && axes_state(n) == CM1E_AXIS_ERROR_STOP)
            return false;
    return true;
}

/** An axis that has failed says why, and does nothing any more. */
static void judge_failed(int n)
{
    const cm1e_axis_info_t info = axes_info(n);
    if (info.state != CM1E_AXIS_ERROR_STOP)
        return;
    AXES_MUST(info.error != CM1E_OK && strlen(axes_text(n)) > 20, "axis %d: error %d, \"%s\"", n, info.error,
              axes_text(n));
    AXES_MUST(info.set_velocity == 0 && !info.powered, "axis %d: in ErrorStop at %g u/s, torque %d", n,
              info.set_velocity, info.powered);
}

static bool active(int n, cm1e_command_id_t id)
{
    return id && axes_status(n, id).state == CM1E_COMMAND_ACTIVE;
}

/** Which errors end an axis whose master failed. */
static bool is_of_master(int n)
{
    const cm1e_error_t error = axes_info(n).error;
    return axes_state(n) == CM1E_AXIS_ERROR_STOP &&
           (error == CM1E_ERROR_AXIS_MASTER_LOST || error == CM1E_ERROR_AXIS_COUPLED);
}

/** In ErrorStop because of its master; because of the way that it braked, beside what the slave had to do; or, before it
 *  began to get in step, at rest with its command ended. */
static bool slave_lost_master(void)
{
    const bool limit = run.kind >= A_GEAR_IN_POS && axes_info(SLAVE).error == CM1E_ERROR_AXIS_COUPLING_LIMIT;
    const bool ended = axes_state(SLAVE) == CM1E_AXIS_STANDSTILL && run.kind == A_GEAR_IN_POS &&
                       axes_status(SLAVE, run.slave).error == CM1E_ERROR_AXIS_MASTER_LOST;
    return is_of_master(SLAVE) || limit || ended;
}

/** As long as the slave follows, in ErrorStop too, it keeps the ratio. */
static void judge_ratio(void)
{
    const cm1e_axis_t *master = axes_axis(MASTER), *slave = axes_axis(SLAVE);
    const bool follows = run.kind == A_GEAR && axis_follows(slave);
    if (slave->silence.frozen) /* its target stays, whatever has become of its master */
        return;
    if (follows && !run.known && axes_status(SLAVE, run.slave).reached) {
        run.known = true;
        run.master_at = master->setpoint.position;
        run.slave_at = slave->setpoint.position;
    }
    run.known = run.known && follows;
    if (!run.known)
        return;
    const double way = cm1e_position_minus(master->setpoint.position, run.master_at) / master->position.scale * 1.5 *
                       slave->position.scale;
    const double off = cm1e_position_minus(slave->setpoint.position, run.slave_at) - way;
    AXES_MUST(fabs(off) <= 0.1, "the slave is %g counts beside its gear, %s", off,
              cm1e_axis_state_name(slave->state));
}

static void judge_others_of_slave(bool slave_followed)
{
    const bool together = slave_followed && run.mode != CM1E_COUPLING_STOP_THIS;
    if (slave_followed && run.followed && run.mode == CM1E_COUPLING_STOP_COUPLED && axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP) {
        AXES_MUST(axes_info(MASTER).error == CM1E_ERROR_AXIS_COUPLED, "the master: %s", axes_text(MASTER));
        AXES_MUST(is_of_master(BESIDE), "axis 2: %s", axes_text(BESIDE));
    } else if (slave_followed && run.mode == CM1E_COUPLING_STOP_KEEP_RATIO && run.fault == TOO_FAST && run.kind == A_GEAR) {
        AXES_MUST(axes_info(MASTER).error == CM1E_ERROR_AXIS_COUPLED, "the master does not brake with its slave: %s",
                  axes_text(MASTER));
    } else if (!together) {
        AXES_MUST(axes_state(MASTER) == CM1E_AXIS_CONTINUOUS_MOTION, "the master is in %s: %s",
                  cm1e_axis_state_name(axes_state(MASTER)), axes_text(MASTER));
        AXES_MUST(active(BESIDE, run.beside), "the other slave is in %s: %s",
                  cm1e_axis_state_name(axes_state(BESIDE)), axes_text(BESIDE));
    }
}

static void judge_end(void)
{
    const bool slave_followed = run.coupled && run.struck >= 60;
    const cm1e_error_t slave_error = axes_info(SLAVE).error;
    for (int n = 0; n < AXES; n++)
        judge_failed(n);
    switch (run.fault) {
    case FAULT_NONE:
    case MASTER_RENAMED:
    case SLAVE_RENAMED:
        AXES_MUST(active(SLAVE, run.slave) && active(BESIDE, run.beside) && axes_status(SLAVE, run.slave).reached,
                  "the slave is in %s: %s", cm1e_axis_state_name(axes_state(SLAVE)), axes_text(SLAVE));
        break;
    case MASTER_FAULT:
        axes_must_be(MASTER, CM1E_AXIS_ERROR_STOP);
        AXES_MUST(is_of_master(BESIDE), "axis 2: %s, %s", cm1e_axis_state_name(axes_state(BESIDE)), axes_text(BESIDE));
        AXES_MUST(!slave_followed || slave_lost_master(), "the slave: %s, %s", cm1e_axis_state_name(axes_state(SLAVE)),
                  axes_text(SLAVE));
        break;
    case MASTER_POWER:
    case MASTER_HOME:
        AXES_MUST(is_of_master(BESIDE), "axis 2: %s, %s", cm1e_axis_state_name(axes_state(BESIDE)), axes_text(BESIDE));
        AXES_MUST(!slave_followed || slave_lost_master(), "the slave: %s, %s", cm1e_axis_state_name(axes_state(SLAVE)),
                  axes_text(SLAVE));
        break;
    case SLAVE_FAULT:
        axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
        judge_others_of_slave(slave_followed);
        break;
    case SLAVE_POWER:
        axes_must_be(SLAVE, CM1E_AXIS_DISABLED);
        judge_others_of_slave(slave_followed);
        break;
    case SLAVE_STOP:
        AXES_MUST(!run.coupled || axes_state(SLAVE) == CM1E_AXIS_STOPPING || run.struck < 60, "the slave is in %s",
                  cm1e_axis_state_name(axes_state(SLAVE)));
        AXES_MUST(active(BESIDE, run.beside) && axes_state(MASTER) == CM1E_AXIS_CONTINUOUS_MOTION,
                  "MC_Stop of the slave stopped others: %s, %s", axes_text(MASTER), axes_text(BESIDE));
        break;
    case MASTER_STOP: /* they follow it to its standstill */
        axes_must_be(MASTER, CM1E_AXIS_STOPPING);
        AXES_MUST(active(BESIDE, run.beside) && axes_axis(BESIDE)->setpoint.velocity == 0, "axis 2: %s",
                  axes_text(BESIDE));
        const bool still = axes_axis(SLAVE)->setpoint.velocity == 0;
        AXES_MUST(!run.coupled || (active(SLAVE, run.slave) && run.kind != A_COMBINATION ? still : true),
                  "the slave: %s", axes_text(SLAVE));
        break;
    case SLAVE_LAG:
    case TOO_FAST:
    case TOO_HARD:
        if (axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP) {
            AXES_MUST(slave_error == (run.fault == SLAVE_LAG ? CM1E_ERROR_AXIS_LAG : CM1E_ERROR_AXIS_COUPLING_LIMIT) ||
                          slave_error == CM1E_ERROR_AXIS_COUPLED, "the slave: %s", axes_text(SLAVE));
            judge_others_of_slave(true);
        }
        break;
    case MASTER_LOST:
    case SLAVE_LOST:
    case BUS_LOST:
        for (int n = 0; n < AXES; n++)
            axes_must_be(n, CM1E_AXIS_ERROR_STOP);
        break;
    default: break;
    }
    if (axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP && run.coupled)
        AXES_MUST(axes_status(SLAVE, run.slave).state == CM1E_COMMAND_ERROR, "the slave failed, its command is %d",
                  axes_status(SLAVE, run.slave).state);
}

/** What stands by its state stays where it is. */
static void judge_stillness(void)
{
    int32_t before[AXES];
    for (int n = 0; n < AXES; n++)
        before[n] = axes_motor(n)->position;
    axes_cycles(60);
    for (int n = 0; n < AXES; n++) {
        const bool dead = axes_state(n) == CM1E_AXIS_ERROR_STOP || axes_state(n) == CM1E_AXIS_DISABLED ||
                          axes_state(n) == CM1E_AXIS_STANDSTILL;
        AXES_MUST(!dead || axes_motor(n)->position == before[n], "axis %d moves on in %s", n,
                  cm1e_axis_state_name(axes_state(n)));
    }
}

static void one_run(int kind, int fault, int fault_cycle, cm1e_coupling_stop_t mode)
{
    begin_run(kind, fault, fault_cycle, mode);
    int after = 0;
    for (int cycle = 0; after < 500 || !all_rest(); cycle++) {
        axes_inputs();
        program(cycle);
        if (cycle >= fault_cycle && cycle >= 1) {
            if (run.struck < 0) {
                run.struck = cycle;
                run.followed = axis_follows(axes_axis(SLAVE));
            }
            strike(cycle - run.struck);
        }
        axes_outputs();
        judge_ratio();
        after = cycle > fault_cycle && cycle > 300 ? after + 1 : 0;
        AXES_MUST(after < CONCERNED_CYCLES, "it does not come to rest");
    }
    for (int n = 0; n < 100 + 300 * (run.fault == SLAVE_LAG); n++) /* the torque goes, a lag becomes too large */
        axes_cycles(1);
    judge_end();
    judge_stillness();
}

static void sweep(int kind)
{
    const int stride = sweep_stride(11, 130);
    for (int mode = 0; mode < 3; mode++)
        for (int fault = 0; fault < FAULTS; fault++)
            for (int cycle = 1 + sweep_first((fault * 7 + mode) % stride, stride); cycle < CYCLES; cycle += stride)
                one_run(kind, fault, cycle, (cm1e_coupling_stop_t)mode);
}

static void test_faults_at_every_cycle_of_a_gear(void) { sweep(A_GEAR); }
static void test_faults_at_every_cycle_of_a_combination(void) { sweep(A_COMBINATION); }
static void test_faults_at_every_cycle_of_a_gear_from_a_position(void) { sweep(A_GEAR_IN_POS); }
static void test_faults_at_every_cycle_of_a_cam(void) { sweep(A_CAM); }
static void test_faults_at_every_cycle_of_a_phase_shift(void) { sweep(A_PHASED_GEAR); }

int main(void)
{
    axes_compared_every = 23; /* most of the time went there */
    UNITY_BEGIN();
    RUN_TEST(test_faults_at_every_cycle_of_a_gear);
    RUN_TEST(test_faults_at_every_cycle_of_a_combination);
    RUN_TEST(test_faults_at_every_cycle_of_a_gear_from_a_position);
    RUN_TEST(test_faults_at_every_cycle_of_a_cam);
    RUN_TEST(test_faults_at_every_cycle_of_a_phase_shift);
    return UNITY_END();
}
