/* What the motor does at each point, and what is compared afterwards. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "prove/motion.h"

#define STAND_NS INT64_C(300000000)
#define MEASURE_NS INT64_C(200000000)
#define RECOVER_NS INT64_C(300000000)
enum { PAUSE_NS = 200000000 };
/** A move is measured to this part of a revolution; a change in one cycle above the other is a new zero. */
#define TOLERANCE 0.02
#define NEW_ZERO 0.3

static void begin(motion_t *m, motion_step_t step)
{
    m->step = step;
    m->step_ns = cm1e_scheduler_time_ns(m->scheduler);
}

static int64_t elapsed_ns(const motion_t *m) { return cm1e_scheduler_time_ns(m->scheduler) - m->step_ns; }

static void give_up(motion_t *m, WORD error_id)
{
    m->failed = true;
    m->failed_device_error = m->now.device_error;
    m->error_id = error_id;
    begin(m, MOTION_OFF);
}

/* ---- the actions: true when one is complete ---------------------------------------------------------------------- */

static bool stand(motion_t *m) { return elapsed_ns(m) > STAND_NS; }

static bool move(motion_t *m)
{
    m->there.Execute = TRUE;
    MC_MoveRelative(&m->there);
    if (!m->there.Done && !m->there.Error)
        return false;
    if (!m->back.Execute)
        m->deviation_there = m->now.actual_position - m->begin.actual_position - m->distance;
    m->back.Execute = m->there.Done;
    MC_MoveRelative(&m->back);
    if (m->there.Error || m->back.Error)
        give_up(m, m->there.Error ? m->there.ErrorID : m->back.ErrorID);
    m->deviation_back = m->now.actual_position - m->begin.actual_position;
    return m->back.Done;
}

/** How long half of the change of the velocity takes, in its middle, where no start and no end disturbs. */
static void look_at_ramp(motion_t *m)
{
    const int64_t now_ns = cm1e_scheduler_time_ns(m->scheduler);
    if (m->quarter_ns == 0 && fabs(m->speed) >= m->velocity / 4)
        m->quarter_ns = now_ns;
    if (m->three_quarters_ns == 0 && fabs(m->speed) >= m->velocity * 3 / 4)
        m->three_quarters_ns = now_ns;
}

/** The velocity that the drive shows, and the one of its positions, at constant velocity. */
static bool run(motion_t *m)
{
    look_at_ramp(m);
    m->run.Execute = TRUE;
    MC_MoveVelocity(&m->run);
    if (m->run.Error) {
        give_up(m, m->run.ErrorID);
        return false;
    }
    if (m->run.InVelocity && m->from_ns == 0 && fabs(m->now.actual_velocity) > m->velocity / 2) {
        m->from_ns = cm1e_scheduler_time_ns(m->scheduler);
        m->from_position = m->travelled;
    }
    if (m->from_ns == 0)
        return elapsed_ns(m) > 10 * MEASURE_NS;
    m->shown_sum += m->now.actual_velocity;
    m->shown_count++;
    const int64_t ns = cm1e_scheduler_time_ns(m->scheduler) - m->from_ns;
    if (ns < MEASURE_NS)
        return false;
    m->measured = (m->travelled - m->from_position) / ((double)ns * 1e-9);
    m->shown = m->shown_sum / m->shown_count;
    return true;
}

static bool pause(motion_t *m)
{
    const struct timespec time = {.tv_nsec = PAUSE_NS};
    if (!m->paused) {
        m->paused = true;
        nanosleep(&time, NULL);
        return false;
    }
    m->al_code = cm1e_bus_slave(m->bus, m->prove->position)->al_status_code;
    return elapsed_ns(m) > PAUSE_NS + RECOVER_NS;
}

static bool home(motion_t *m)
{
    m->home.Execute = TRUE;
    MC_Home(&m->home);
    if (m->home.Error)
        give_up(m, m->home.ErrorID);
    return m->home.Done;
}

static bool act(motion_t *m)
{
    switch (m->point->row) {
    case MOVE_ENABLE: return stand(m);
    case MOVE_PV:
    case MOVE_UNIT: return run(m);
    case MOVE_WATCHDOG: return pause(m);
    case MOVE_CSP:
    case MOVE_CSV:
    case MOVE_PP: return move(m);
    default: return home(m);
    }
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static void follow(motion_t *m)
{
    const double step = m->now.actual_position - m->last_position;
    const int64_t now_ns = cm1e_scheduler_time_ns(m->scheduler);
    m->speed = m->last_ns && now_ns > m->last_ns ? step / ((double)(now_ns - m->last_ns) * 1e-9) : 0;
    m->last_ns = now_ns;
    if (m->enabled && fabs(step) < NEW_ZERO)
        m->travelled += step;
    m->last_position = m->now.actual_position;
    m->farthest = fmax(m->farthest, fabs(m->travelled));
    if (m->enabled && m->mode == 0 && fabs(m->now.actual_velocity) > m->velocity / 4)
        m->mode = m->now.mode;
}

static void act_within_travel(motion_t *m)
{
    const bool breaks = m->point->row == MOVE_WATCHDOG;
    if (fabs(m->travelled) > m->prove->options->max_travel) {
        m->beyond = true;
        begin(m, MOTION_STOP);
    } else if (m->now.state == CM1E_AXIS_ERROR_STOP && !breaks) {
        give_up(m, cm1e_error_id(m->now.error));
    } else if (act(m) && m->step == MOTION_ACT) {
        m->done = true;
        begin(m, breaks ? MOTION_OFF : MOTION_STOP);
    }
}

/** An error that an earlier point has left is reset first. */
static bool is_reset(motion_t *m)
{
    if (m->now.state != CM1E_AXIS_ERROR_STOP || m->reset.Done)
        return true;
    m->reset.Execute = TRUE;
    MC_Reset(&m->reset);
    return m->reset.Error;
}

void motion_program(void *context)
{
    motion_t *m = context;
    cm1e_axis_read(m->axis, &m->now);
    follow(m);
    m->power.Enable = m->step < MOTION_OFF && (m->enabled || m->now.state != CM1E_AXIS_ERROR_STOP);
    MC_Power(&m->power);
    switch (m->step) {
    case MOTION_POWER:
        if (!is_reset(m))
            break;
        if (m->power.Error || m->now.state == CM1E_AXIS_ERROR_STOP) {
            give_up(m, m->power.Error ? m->power.ErrorID : cm1e_error_id(m->now.error));
        } else if (m->power.Status) {
            m->enabled = true;
            m->begin = m->now;
            begin(m, MOTION_ACT);
        }
        break;
    case MOTION_ACT: act_within_travel(m); break;
    case MOTION_STOP:
        m->stop.Execute = TRUE;
        MC_Stop(&m->stop);
        if (m->stop.Done || m->stop.Error)
            begin(m, MOTION_OFF);
        break;
    case MOTION_OFF:
        if (!m->power.Status)
            begin(m, MOTION_END);
        break;
    case MOTION_END: cm1e_scheduler_stop(m->scheduler); break;
    }
}

/* ---- judging ----------------------------------------------------------------------------------------------------- */

static void judge_mode(motion_t *m, int8_t mode)
{
    prove_compare_number(m->prove, "mode while it moves (0x6061)", mode, m->mode, 0);
}

static void judge_velocity(motion_t *m)
{
    const double ratio = m->measured != 0 ? m->shown / m->measured : 0;
    char found[64];
    snprintf(found, sizeof found, "%.4g times that of its positions", ratio);
    prove_compare(m->prove, "velocity shown (0x606C)", "that of its positions",
                  fabs(ratio - 1) < 0.05 ? "that of its positions" : found);
    prove_note(m->prove, "shown %.4g, by its positions %.4g revolutions/s", m->shown, m->measured);
}

/** The guide has two units for 0x6083 (UG 6.2.2, 6.2.3): with the wrong one the ramp is a thousand times as short or long. */
static void judge_ramp(motion_t *m)
{
    const double ramp_s = (double)(m->three_quarters_ns - m->quarter_ns) * 1e-9;
    const double reached = m->velocity > 0 ? m->measured / m->velocity : 0;
    const double found = m->three_quarters_ns && ramp_s > 0 ? m->velocity / 2 / ramp_s : INFINITY;
    const double ratio = m->three_quarters_ns ? found / m->acceleration : 0;
    char velocity[64], acceleration[64];
    snprintf(velocity, sizeof velocity, "%.4g times the commanded one", reached);
    snprintf(acceleration, sizeof acceleration, "%.3g times the commanded one", ratio);
    prove_compare(m->prove, "velocity by positions (0x60FF)", "the commanded one",
                  fabs(reached - 1) < 0.05 ? "the commanded one" : velocity);
    prove_compare(m->prove, "acceleration by positions (0x6083)", "the commanded one",
                  ratio > 0.5 && ratio < 2 ? "the commanded one" : acceleration);
    prove_note(m->prove, "acceleration %.3g, commanded %.3g revolutions/s2", found, m->acceleration);
}

static void judge_move(motion_t *m, int8_t mode)
{
    judge_mode(m, mode);
    prove_compare_truth(m->prove, "position there", fabs(m->deviation_there) < TOLERANCE, "as commanded", "elsewhere");
    prove_compare_truth(m->prove, "position back", fabs(m->deviation_back) < TOLERANCE, "as before", "elsewhere");
    prove_note(m->prove, "%.3g revolutions there and back; deviations %.2g and %.2g", m->distance, m->deviation_there,
               m->deviation_back);
}

/** UG 10.1: before V1.3.0 the motor takes no notice. */
static void judge_pause(motion_t *m)
{
    enum { PROCESS_DATA_WATCHDOG = 0x001B };
    const bool watches = m->prove->firmware && m->prove->firmware->watchdog;
    prove_compare_code(m->prove, "al_status", "AL status code", watches ? PROCESS_DATA_WATCHDOG : 0, m->al_code);
}

/** The hard stop, or the switch, may be beyond the travel, or the switch in the other direction: no difference. */
static bool is_nowhere(motion_t *m)
{
    enum { POSITION_ERROR = 0x7320 };
    const cm1e_device_homing_t *homing = m->prove->device->drives[0]->homing;
    const int method = motion_method(m->point);
    const bool by_switch = method >= homing->first_by_switch && method <= homing->last_by_switch;
    const bool hit = by_switch && m->failed && (m->failed_device_error == POSITION_ERROR || m->prove->device->channels);
    if (m->point->row < MOVE_HOME || !(m->beyond || hit))
        return false;
    if (hit)
        prove_note(m->prove, "a stop came before the switch, after %.3g revolutions", m->farthest);
    else
        prove_note(m->prove, "neither stop nor switch within %g revolutions", m->prove->options->max_travel);
    return true;
}

static void judge_home(motion_t *m)
{
    judge_mode(m, CM1E_MODE_HM);
    prove_compare_truth(m->prove, "position at its end", fabs(m->now.actual_position) < TOLERANCE, "0", "another");
    prove_note(m->prove, "found within %.3g revolutions", m->farthest);
}

static void judge_done(motion_t *m)
{
    switch (m->point->row) {
    case MOVE_ENABLE:
        prove_compare_truth(m->prove, "position", m->farthest < TOLERANCE, "stays", "changes");
        prove_note(m->prove, "moved by %.2g revolutions", m->farthest);
        break;
    case MOVE_CSP: judge_move(m, CM1E_MODE_CSP); break;
    case MOVE_CSV: judge_move(m, CM1E_MODE_CSV); break;
    case MOVE_PP: judge_move(m, CM1E_MODE_PP); break;
    case MOVE_PV: judge_mode(m, CM1E_MODE_PV); judge_velocity(m); judge_ramp(m); break;
    case MOVE_UNIT: judge_velocity(m); break;
    case MOVE_WATCHDOG: judge_pause(m); break;
    default: judge_home(m); break;
    }
}

void motion_judge(motion_t *m)
{
    char found[sizeof m->error + 64];
    snprintf(found, sizeof found, "%s. %s", cm1e_strerror(cm1e_error_from_id(m->error_id)), m->error);
    if (m->step != MOTION_END) { /* the scheduler has disabled the motor instead */
        prove_note(m->prove, "the run was interrupted");
        return;
    }
    if (is_nowhere(m))
        return;
    if (m->failed)
        prove_compare(m->prove, "end", "done", found);
    else if (m->beyond)
        prove_compare(m->prove, "travel", "within its limit", "beyond it: the motor was stopped");
    else
        judge_done(m);
    prove_compare_truth(m->prove, "power at the end", !m->now.powered, "off", "on");
}
