#include "block_machine.h"

#include "fuzz.h"
#include "ordinary_witness.h"

enum { ENABLE_CYCLES = 20, CALLED_EVERY = 16 };
enum { LIMITS = 1, ROTARY = 2, CONTINUE = 4, STOP = 8, FEW_POINTS = 16, ENCODER = 32, TABLES = 64, INVERTED = 128 };

machine_t machine;
static void (*power_call)(void *fb);

/* block_judge.c says by Check what is wrong; this takes the place of Check. */
void _ck_assert_failed(const char *file, int line, const char *expression, const char *format, ...)
{
    va_list arguments;
    (void)file, (void)line, (void)expression;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    fuzz_fail("a rule of block_judge.h is broken");
}

/* ---- the axes ---------------------------------------------------------------------------------------------------- */

static cm1e_bus_t *slave(int n) { return n == 0 ? &machine.bus : &machine.others[n - 1]; }

static void describe_axis(int n, unsigned kind)
{
    cm1e_axis_config_t axis = {
        .counts_per_unit = 1000, .invert = kind & INVERTED, .max_velocity = 50, .max_acceleration = 200,
        .max_deceleration = n == 1 ? 300 : 200, .max_jerk = n == 2 ? 20000 : 5000, .homing = {.method = -1},
        .type = n == 0 ? CM1E_AXIS_MOTOR : n == 2 && kind & ENCODER ? CM1E_AXIS_ENCODER : CM1E_AXIS_VIRTUAL,
        .coupling_stop = kind & CONTINUE ? (cm1e_coupling_stop_t)1 : kind & STOP ? (cm1e_coupling_stop_t)2
                                                                                : (cm1e_coupling_stop_t)0,
        .cam_points = kind & FEW_POINTS ? 4 : 0, .table_profiles = kind & TABLES,
        .inputs = {.limit_positive = 1, .limit_negative = 2, .home = 3}};
    if (kind & ROTARY && n != 1) {
        axis.counts_per_unit = 0;
        axis.units_per_revolution = axis.modulo_range = 360;
        axis.max_velocity = 720;
    } else if (kind & LIMITS) {
        axis.software_limit_negative = -20;
        axis.software_limit_positive = 30;
    }
    snprintf(axis.name, sizeof axis.name, "axis%d", n);
    fake_bus_init(slave(n), CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, (cm1e_firmware_t)0);
    slave(n)->config.axes[0] = axis;
    slave(n)->mode_status = STATUSWORD_TARGET_REACHED;
    if (n > 0)
        fake_bus_add(&machine.bus, slave(n));
}

static void make_axis(int n)
{
    cm1e_diag_t diag = {0};
    judged_at = n;
    if (cm1e_axis_create(&judged.axis, &machine.bus, (uint32_t)n, &diag) != CM1E_OK)
        fuzz_fail("no axis: %s", diag.text);
    judged.reference = machine.named[n] = cm1e_axis_reference(judged.axis);
    judged.state = CM1E_AXIS_DISABLED;
    judged.cycle_ns = machine.bus.config.cycle_time_ns;
    machine.powers[n] = (MC_Power_t){.Axis = &judged.reference, .Enable = TRUE, .EnablePositive = TRUE,
                                     .EnableNegative = TRUE};
}

void machine_begin(unsigned kind)
{
    memset(&machine, 0, sizeof machine);
    memset(judged_axes, 0, sizeof judged_axes);
    memset(watched_axes, 0, sizeof watched_axes);
    for (int n = 0; n < MACHINE_AXES; n++)
        describe_axis(n, kind);
    machine.bus.config.cycle_time_ns = 1000000;
    for (int n = 0; n < MACHINE_AXES; n++)
        make_axis(n);
    for (int n = 0; n < MACHINE_AXES; n++)
        judged_axes[n].master = machine.named[(n + 1) % MACHINE_AXES];
    machine.named[MACHINE_AXES + 1].Handle = machine.no_group.Handle = 0xFFF7;
    if (cm1e_group_create(&machine.group, NULL, NULL) != CM1E_OK)
        fuzz_fail("no group");
    judged_at = 0;
    begin_blocks();
    power_call = view_of("MC_Power")->type->call;
    fake_bus_show(&machine.bus);
    machine_cycles(ENABLE_CYCLES);
    for (int n = 0; n < MACHINE_AXES; n++)
        if (judged_axes[n].axis->state != CM1E_AXIS_STANDSTILL &&
            cm1e_axis_configuration(judged_axes[n].axis)->type != CM1E_AXIS_ENCODER)
            fuzz_fail("axis %d is in %s", n, cm1e_axis_state_name(judged_axes[n].axis->state));
}

void machine_end(void)
{
    for (int n = 0; n < MACHINE_AXES; n++)
        cm1e_axis_destroy(judged_axes[n].axis);
    if (cm1e_group_destroy(machine.group) != CM1E_OK)
        fuzz_fail("a group without axes cannot be destroyed");
}

/* ---- the blocks -------------------------------------------------------------------------------------------------- */

instance_t *machine_make(const char *name, int axis)
{
    if (machine.count == MACHINE_BLOCKS)
        return NULL;
    instance_t *fb = &machine.blocks[machine.count++];
    judged_at = axis;
    make(fb, name);
    point_at(fb, "AxesGroup", &machine.group);
    return fb;
}

/** What it points at beside axes and groups stays, or is NULL. */
static void put_pointer(instance_t *fb, const block_member_t *m, unsigned choice)
{
    static const char *const axes[] = {"Axis", "Slave", "Master", "Master1", "Master2"};
    if (choice == 0)
        point_at(fb, m->name, NULL);
    else if (strcmp(m->name, "AxesGroup") == 0)
        point_at(fb, m->name, choice % 4 == 0 ? &machine.no_group : &machine.group);
    for (size_t i = 0; choice && i < sizeof axes / sizeof *axes; i++)
        if (strcmp(m->name, axes[i]) == 0) {
            const int n = (int)(choice % (MACHINE_AXES + 2));
            point_at(fb, m->name, &machine.named[n]);
            /* The judge looks at the axis of a block; one of a group has none. */
            if (i < 2 && n < MACHINE_AXES && fb->view->group == NOWHERE)
                fb->of = n;
        }
}

void machine_put(instance_t *fb, const block_member_t *m, const uint8_t **at, const uint8_t *end)
{
    unsigned char *place = fb->memory + m->offset;
    LREAL real;
    unsigned number;
    switch (m->type) {
    case BLOCK_LREAL:
        for (size_t i = 0; i < m->size / sizeof real; i++) {
            real = fuzz_take_real(at, end);
            memcpy(place + i * sizeof real, &real, sizeof real);
        }
        break;
    case BLOCK_BOOL:
        *place = fuzz_take(at, end, 1) & 1;
        break;
    case BLOCK_ENUM: /* mostly those that exist */
        number = fuzz_take(at, end, 1);
        number = number < 0xF0 ? number % 8 : fuzz_take(at, end, 4);
        memcpy(place, &number, m->size);
        break;
    case BLOCK_POINTER:
        put_pointer(fb, m, fuzz_take(at, end, 1));
        break;
    default:
        for (size_t i = 0; i < m->size; i++)
            place[i] = (unsigned char)fuzz_take(at, end, 1);
    }
}

static void judge_error(const instance_t *fb)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    if (!fb->now.error || fb->before.error)
        return;
    fuzz_use_text(cm1e_strerror(cm1e_error_from_id(fb->now.error_id)));
    cm1e_axis_error_text(judged_axes[fb->of].reference, text, sizeof text);
    if (text[0])
        fuzz_use_text(text);
}

/** An idle block needs no call; now and then it gets one. */
static bool is_awake(const instance_t *fb, int n)
{
    const uint16_t place = fb->view->execute != NOWHERE ? fb->view->execute : fb->view->enable;
    const shown_t *now = &fb->now;
    return place == NOWHERE || fb->memory[place] || now->trigger || now->busy || now->done || now->error ||
           now->aborted || n % CALLED_EVERY == judged_axes[0].number % CALLED_EVERY;
}

/** What MC_Power may do, the tests of it judge. */
static void call_block(instance_t *fb)
{
    if (fb->view->type->call == power_call) {
        fb->view->type->call(fb->memory);
        for (int n = 0; n < MACHINE_AXES; n++)
            judged_axes[n].state = judged_axes[n].axis->state;
        return;
    }
    call(fb);
    judge_error(fb);
}

static void call_blocks(void)
{
    for (int i = 0; i < machine.count; i++) {
        const int n = (i + machine.first) % machine.count;
        if (is_awake(&machine.blocks[n], n))
            call_block(&machine.blocks[n]);
    }
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

static void judge_values(int n, cm1e_axis_state_t before)
{
    cm1e_axis_info_t info;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    cm1e_axis_get(judged_axes[n].axis, &info);
    const double shown[] = {info.set_position, info.set_velocity, info.set_acceleration, info.actual_position,
                            info.actual_velocity, info.actual_torque, info.position_lag};
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++)
        if (!isfinite(shown[i]))
            fuzz_fail("value %zu of axis %d is %g", i, n, shown[i]);
    if (info.state != CM1E_AXIS_ERROR_STOP || before == CM1E_AXIS_ERROR_STOP)
        return;
    cm1e_axis_error_text(judged_axes[n].reference, text, sizeof text);
    fuzz_use_text(text);
    if (info.error == CM1E_OK)
        fuzz_fail("axis %d is in ErrorStop without an error", n);
}

static void inputs(void)
{
    const cm1e_error_t received = machine.lost > 0 ? CM1E_ERROR_BUS_LOST : CM1E_OK;
    machine.lost -= machine.lost > 0;
    machine.encoder += (uint32_t)machine.encoder_step;
    if (cm1e_axis_configuration(judged_axes[2].axis)->type == CM1E_AXIS_ENCODER)
        (void)cm1e_axis_write_encoder(machine.named[2], machine.encoder, true);
    fake_bus_cycle(&machine.bus, judged_axes[0].cycle_ns);
    for (int n = 0; n < MACHINE_AXES; n++)
        ordinary_inputs(judged_axes[n].axis, received, CM1E_OK, machine.bus.clock.virtual_now_ns);
    for (judged_at = 0; judged_at < MACHINE_AXES; judged_at++)
        judge_cycle();
    for (int n = 0; n < MACHINE_AXES; n++)
        MC_Power(&machine.powers[n]);
    for (int n = 0; n < MACHINE_AXES; n++)
        judged_axes[n].state = judged_axes[n].axis->state;
}

void machine_cycles(int count)
{
    while (count-- > 0) {
        cm1e_axis_state_t before[MACHINE_AXES];
        for (int n = 0; n < MACHINE_AXES; n++)
            before[n] = judged_axes[n].axis->state;
        inputs();
        call_blocks();
        for (int n = MACHINE_AXES - 1; n >= 0; n--)
            ordinary_outputs(judged_axes[n].axis);
        for (judged_at = 0; judged_at < MACHINE_AXES; judged_at++) {
            judge_cycle();
            watch_set_point();
            judged.number++;
            judge_values(judged_at, before[judged_at]);
        }
        judged_at = 0;
    }
}
