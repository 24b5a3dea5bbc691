#include "axes_bench.h"

#include "quick_check.h"
#include "unity.h"
#include "ordinary_witness.h"

struct axes_bench axes_bench;

/* NULL in a program with Check. */
extern void UnityFail(const char *message, UNITY_LINE_TYPE line) __attribute__((weak));

void axes_fail(const char *format, ...)
{
    char said[600], words[800];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(said, sizeof said, format, arguments);
    va_end(arguments);
    snprintf(words, sizeof words, "%s cycle %llu: %s", axes_bench.run ? axes_bench.run : "", axes_bench.cycle, said);
    if (UnityFail)
        UnityFail(words, __LINE__);
    ck_abort_msg("%s", words);
}

/* ---- what there is ----------------------------------------------------------------------------------------------- */

cm1e_bus_t *axes_motor(int n) { return n == 0 ? &axes_bench.bus : &axes_bench.others[n - 1]; }

cm1e_axis_t *axes_axis(int n) { return axes_bench.axes[n]; }

AXIS_REF_t axes_reference(int n) { return cm1e_axis_reference(axes_bench.axes[n]); }

cm1e_axis_config_t *axes_config(int n) { return &axes_bench.bus.config.axes[n]; }

cm1e_axis_info_t axes_info(int n)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axes_bench.axes[n], &info);
    return info;
}

cm1e_axis_state_t axes_state(int n) { return axes_bench.axes[n]->state; }

const char *axes_text(int n)
{
    static char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(axes_reference(n), text, sizeof text);
    return text;
}

void axes_told(int n, const char *words)
{
    AXES_MUST(strstr(axes_text(n), words), "axis %d does not say \"%s\" but: %s", n, words, axes_text(n));
}

void axes_must_be(int n, cm1e_axis_state_t state)
{
    AXES_MUST(axes_state(n) == state, "axis %d is in %s instead of %s: %s", n, cm1e_axis_state_name(axes_state(n)),
              cm1e_axis_state_name(state), axes_text(n));
}

/* ---- the witness ------------------------------------------------------------------------------------------------- */

static bool axes_own(const cm1e_axis_t *axis)
{
    return !axis_free(axis) && !drive_homes(axis) && axis->setpoint.source != &cm1e_source_drive;
}

/** Of a ramp without limit of jerk, and of what has none by its nature. */
static void axes_judge_steep(int n, double t, double most_a)
{
    const cm1e_axis_t *axis = axes_bench.axes[n];
    const axes_witness_t *w = &axes_bench.witness[n];
    const double v = axis->setpoint.velocity;
    const double step = cm1e_position_minus(axis->setpoint.position, w->set) / axis->position.scale;
    const double off = fabs(step - t * (v + w->velocity) / 2.0), slack = 1.0 + 1e-6;
    AXES_MUST(fabs(v - w->velocity) <= most_a * t * slack + 1e-9 * fabs(v), "axis %d, %s: velocity %.12g -> %.12g", n,
              cm1e_axis_state_name(axis->state), w->velocity, v);
    AXES_MUST(off <= most_a * t * t / 2.0 * slack + 1e-3 / fabs(axis->position.scale) + 1e-9 * fabs(step),
              "axis %d, %s: the position moves by %.12g at %.12g ... %.12g u/s", n, cm1e_axis_state_name(axis->state),
              step, w->velocity, v);
}

static void axes_judge_smooth(int n, double t, double more_jerk)
{
    const cm1e_axis_t *axis = axes_bench.axes[n];
    const axes_witness_t *w = &axes_bench.witness[n];
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double v0 = w->velocity, a0 = w->acceleration, v = axis->setpoint.velocity, a = axis->setpoint.acceleration;
    /* Two jerks that add up to one within the limit over a cycle may change places in the middle of it. */
    const double corner = axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION ? 2.0 : 1.0;
    const double j = most->jerk + more_jerk, slack = 1.0 + 1e-6;
    const double step = cm1e_position_minus(axis->setpoint.position, w->set) / axis->position.scale;
    const double noise = 1e-9 * (fabs(step) + fabs(v0) * t) + 1e-4 / fabs(axis->position.scale);
    const char *state = cm1e_axis_state_name(axis->state);
    const double largest = fmax(most->acceleration, most->deceleration);
    AXES_MUST(fabs(a) <= largest * slack, "axis %d, %s: acceleration %.12g, limit %.12g", n, state, a, largest);
    AXES_MUST(fabs(a - a0) <= j * t * slack + 1e-9 * (fabs(a) + fabs(a0)),
              "axis %d, %s: jerk %.12g, limit %.12g: acceleration %.12g -> %.12g at %.12g u/s", n, state,
              fabs(a - a0) / t, j, a0, a, v);
    AXES_MUST(fabs(v - v0 - t * (a + a0) / 2) <= j * t * t / 4 * corner * slack + 1e-9 * (fabs(v) + fabs(v0)),
              "axis %d, %s: velocity %.12g -> %.12g with acceleration %.12g -> %.12g", n, state, v0, v, a0, a);
    AXES_MUST(fabs(step - t * v0 - t * t * a0 / 2) <= j * t * t * t / 6 * corner * slack + noise,
              "axis %d, %s: the position moves by %.12g at %.12g u/s, %.12g u/s2", n, state, step, v0, a0);
}

/** While no answer comes, no target moves; after it the motion is no faster than before, but for what its jerk makes of
 *  the motion without acceleration, or of rest, in a cycle. TRUE: nothing else is to be said of this cycle. */
static bool axes_judge_silence(int n)
{
    const cm1e_axis_t *axis = axes_bench.axes[n];
    const axes_witness_t *w = &axes_bench.witness[n];
    const bool silent = axis->silence.frozen || (axis->silence.silent > 0 && axis->mode == CM1E_MODE_CSP &&
                                                 !cm1e_drive_is_virtual(&axis->drive));
    const double v = axis->setpoint.velocity, t = axis->cycle_s, jerk = axis->limits.maximum.jerk * (1 + 1e-9);
    const double step = cm1e_position_minus(axis->setpoint.position, w->set) / axis->position.scale;
    if (silent)
        AXES_MUST(step == 0, "axis %d: its target moves by %.12g while no frame comes back", n, step);
    else if (axis->silence.began_anew)
        AXES_MUST((v * w->velocity >= 0 || fabs(v) <= jerk * t * t / 2) &&
                      fabs(v) <= fabs(w->velocity) + jerk * t * t / 2 &&
                      fabs(step) <= fabs(w->velocity) * t * (1 + 1e-9) + jerk * t * t * t / 6 +
                                        1e-6 / fabs(axis->position.scale),
                  "axis %d: after silence %.12g u/s and a step of %.12g u, before %.12g u/s", n, v, step, w->velocity);
    return silent || axis->silence.began_anew;
}

static void axes_judge(int n)
{
    const cm1e_axis_t *axis = axes_bench.axes[n];
    axes_witness_t *w = &axes_bench.witness[n];
    const double t = axis->cycle_s, line = cm1e_axis_line(axis, axis->setpoint.position);
    const bool ours = axes_own(axis);
    const bool hard = axis->state == CM1E_AXIS_ERROR_STOP || w->state == CM1E_AXIS_ERROR_STOP;
    const double most_a = fmax(axis->limits.system.acceleration, axis->limits.system.deceleration);
    const double more_jerk = jerk_on_coupling(axis, &w->on_coupling);
    AXES_MUST(keeps_velocity_diff(axis, &w->on_coupling), "axis %d: a superimposed motion of %.12g u/s, right is %.12g", n,
              axis->superimposed.now.velocity, axis->superimposed.plan.limits.velocity);
    if (ours && w->ours && w->strictness != AXES_UNWATCHED && !axes_judge_silence(n)) {
        AXES_MUST(fabs(axis->setpoint.velocity) <= axis->limits.maximum.velocity * (1.0 + 1e-9) || hard,
                  "axis %d, %s: velocity %.12g, limit %.12g", n, cm1e_axis_state_name(axis->state),
                  axis->setpoint.velocity, axis->limits.maximum.velocity);
        if (hard || w->strictness == AXES_STEEP)
            axes_judge_steep(n, t, most_a);
        else
            axes_judge_smooth(n, t, more_jerk);
        w->worst_step = fmax(w->worst_step,
                             fabs(cm1e_position_minus(axis->setpoint.position, w->set) / axis->position.scale));
        w->worst_gain = fmax(w->worst_gain, fabs(axis->setpoint.velocity - w->velocity) / t);
        w->worst_jerk = fmax(w->worst_jerk, fabs(axis->setpoint.acceleration - w->acceleration) / t);
    }
    w->lowest = fmin(w->lowest, line);
    w->highest = fmax(w->highest, line);
    w->ours = ours;
    w->state = axis->state;
    w->set = axis->setpoint.position;
    w->velocity = axis->setpoint.velocity;
    w->acceleration = axis->setpoint.acceleration;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

void axes_inputs(void)
{
    fake_bus_cycle(&axes_bench.bus, axes_bench.cycle_ns);
    for (int n = 0; n < axes_bench.count; n++)
        ordinary_inputs(axes_bench.axes[n], axes_bench.received, axes_bench.health,
                        axes_bench.bus.clock.virtual_now_ns);
    for (int n = 0; n < axes_bench.count; n++)
        (void)cm1e_axis_power(axes_bench.axes[n], &axes_bench.owners[n], axes_bench.on[n], axes_bench.positive[n],
                              axes_bench.negative[n]);
}

void axes_outputs(void)
{
    for (int i = 0; i < axes_bench.count; i++)
        ordinary_outputs(axes_bench.axes[axes_bench.order[i]]);
    for (int n = 0; n < axes_bench.count; n++)
        axes_judge(n);
    axes_bench.cycle++;
}

void axes_cycles(int count)
{
    while (count-- > 0) {
        axes_inputs();
        if (axes_bench.program)
            axes_bench.program();
        axes_outputs();
    }
}

/* ---- beginnings -------------------------------------------------------------------------------------------------- */

void axes_end(void)
{
    for (int n = 0; n < AXES_MOST; n++) {
        cm1e_axis_destroy(axes_bench.axes[n]);
        axes_bench.axes[n] = NULL;
    }
}

void axes_describe(int count)
{
    axes_end();
    memset(&axes_bench, 0, sizeof axes_bench);
    axes_bench.count = count;
    axes_bench.cycle_ns = 1000000;
    for (int n = 0; n < count; n++) {
        fake_bus_init(axes_motor(n), CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        axes_bench.order[n] = n;
        if (n > 0)
            fake_bus_add(&axes_bench.bus, axes_motor(n));
        snprintf(axes_config(n)->name, sizeof axes_config(n)->name, "axis%d", n);
    }
}

void axes_make(void)
{
    cm1e_diag_t diag = {0};
    axes_bench.bus.config.cycle_time_ns = axes_bench.cycle_ns;
    for (int n = 0; n < axes_bench.count; n++) {
        axes_bench.positive[n] = axes_bench.negative[n] = true;
        AXES_MUST(cm1e_axis_create(&axes_bench.axes[n], &axes_bench.bus, (uint32_t)n, &diag) == CM1E_OK, "%s",
                  diag.text);
    }
    fake_bus_show(&axes_bench.bus);
    axes_cycles(3);
    for (int n = 0; n < axes_bench.count; n++)
        axes_bench.witness[n].lowest = axes_bench.witness[n].highest =
            cm1e_axis_line(axes_bench.axes[n], axes_bench.axes[n]->setpoint.position);
}

void axes_start_far(int n, int64_t wraps)
{
    axes_bench.axes[n]->position.actual_counts += wraps * (INT64_C(1) << 32);
    axes_cycles(1);
}

void axes_power(int n, bool enable) { axes_bench.on[n] = enable; }

void axes_enable(int n)
{
    axes_power(n, true);
    axes_cycles(20);
    axes_must_be(n, CM1E_AXIS_STANDSTILL);
}

void axes_enable_all(void)
{
    for (int n = 0; n < axes_bench.count; n++)
        axes_power(n, true);
    axes_cycles(20);
    for (int n = 0; n < axes_bench.count; n++)
        axes_must_be(n, CM1E_AXIS_STANDSTILL);
}

void axes_begin(int count)
{
    axes_describe(count);
    axes_make();
    axes_enable_all();
}

/* ---- commands ---------------------------------------------------------------------------------------------------- */

cm1e_command_id_t axes_command(int n, const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id = 0;
    const cm1e_error_t error = cm1e_axis_start(axes_bench.axes[n], command, &id);
    AXES_MUST(error == CM1E_OK && id != 0, "axis %d refuses command kind %d: %s: %s", n, (int)command->kind,
              cm1e_strerror(error), axes_text(n));
    return id;
}

void axes_refused(int n, const cm1e_axis_command_t *command, cm1e_error_t expected)
{
    cm1e_command_id_t id = 0;
    const cm1e_error_t error = cm1e_axis_start(axes_bench.axes[n], command, &id);
    AXES_MUST(error == expected && id == 0, "axis %d, command kind %d: \"%s\" instead of \"%s\"", n,
              (int)command->kind, cm1e_strerror(error), cm1e_strerror(expected));
}

cm1e_command_id_t axes_move_velocity(int n, double velocity)
{
    return axes_command(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity});
}

cm1e_command_id_t axes_move_to(int n, double position, double velocity)
{
    return axes_command(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = position,
                                                  .velocity = velocity});
}

cm1e_command_status_t axes_status(int n, cm1e_command_id_t id)
{
    return cm1e_axis_command_status(axes_bench.axes[n], id);
}

cm1e_command_id_t axes_gear_in(int n, int master, int32_t numerator, uint32_t denominator)
{
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(master), .source = mcSetValue, .numerator = numerator,
                    .denominator = denominator}}};
    return axes_command(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling});
}

int axes_wait(int n, cm1e_command_id_t id, int at_most)
{
    int waited = 0;
    while (axes_status(n, id).state == CM1E_COMMAND_ACTIVE && waited++ < at_most)
        axes_cycles(1);
    return waited;
}

void axes_wait_reached(int n, cm1e_command_id_t id, int at_most)
{
    while (!axes_status(n, id).reached && at_most-- > 0)
        axes_cycles(1);
    AXES_MUST(axes_status(n, id).reached, "axis %d never reaches what it is to: %s", n, axes_text(n));
}
