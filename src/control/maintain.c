#include "control/maintain.h"

#include <math.h>

/* ---- holds ------------------------------------------------------------------------------------------------------ */

static hold_t *hold_of(view_t *view, uint32_t axis) { return &view->maintained.holds[axis]; }

static void take(view_t *view, hold_t *hold, uint32_t client)
{
    view->maintained.count += !hold->held;
    if (!hold->held)
        *hold = (hold_t){.held = true, .client = client};
}

/** Motion first, so that it ends with its own deceleration; then the power, which goes off at rest. */
static void end_motion(cm1e_axis_t *axis, hold_t *hold)
{
    if (hold->motion != HOLD_JOG && hold->motion != HOLD_HOME)
        return;
    cm1e_axis_guest_end(axis, hold->deceleration, &hold->command);
    hold->motion = hold->command ? HOLD_END : HOLD_NONE;
}

static void leave(view_t *view, uint32_t axis)
{
    end_motion(view->axes[axis], hold_of(view, axis));
    cm1e_axis_guest_power(view->axes[axis], false);
}

/** One axis in one cycle. In ErrorStop the power is let go of, so that a reset does not bring it back. */
static void look(view_t *view, uint32_t index, int64_t now_ns)
{
    cm1e_axis_t *axis = view->axes[index];
    hold_t *hold = hold_of(view, index);
    cm1e_axis_news_t news;
    cm1e_axis_news(axis, &news);
    if (hold->motion != HOLD_NONE && !cm1e_axis_guest_runs(axis, hold->command))
        hold->motion = HOLD_NONE;
    if (now_ns >= hold->motion_until_ns)
        end_motion(axis, hold);
    if (cm1e_axis_guest_powers(axis) && (now_ns >= hold->power_until_ns || news.state == CM1E_AXIS_ERROR_STOP))
        leave(view, index);
    if (hold->motion == HOLD_NONE && !cm1e_axis_guest_powers(axis)) {
        hold->held = false;
        view->maintained.count--;
    }
}

void cm1e_maintain_cycle(view_t *view)
{
    maintained_t *m = &view->maintained;
    if (m->count == 0 && atomic_load_explicit(&m->gone, memory_order_relaxed) == 0)
        return;
    const uint32_t gone = atomic_exchange_explicit(&m->gone, 0, memory_order_acquire);
    const int64_t now_ns = cm1e_scheduler_time_ns(view->scheduler);
    for (uint32_t i = 0; i < view->axis_count; i++) {
        m->stopped[i].any &= !(gone & UINT32_C(1) << m->stopped[i].client);
        if (!m->holds[i].held)
            continue;
        if (gone & UINT32_C(1) << m->holds[i].client)
            leave(view, i);
        look(view, i, now_ns);
    }
}

void cm1e_maintain_leave(view_t *view, uint32_t client)
{
    atomic_fetch_or_explicit(&view->maintained.gone, UINT32_C(1) << client, memory_order_release);
}

/* ---- orders ----------------------------------------------------------------------------------------------------- */

static maintain_refusal_t enable(view_t *view, maintain_order_t *order, hold_t *hold, int64_t now_ns)
{
    order->guest = cm1e_axis_guest_power(view->axes[order->axis], true);
    if (order->guest)
        return MAINTAIN_BY_GUEST;
    take(view, hold, order->client);
    hold->power_keep_ns = order->keep_ns;
    hold->power_until_ns = now_ns + order->keep_ns;
    return MAINTAIN_DONE;
}

static maintain_refusal_t disable(view_t *view, maintain_order_t *order, hold_t *hold, int64_t now_ns)
{
    (void)hold, (void)now_ns;
    if (!cm1e_axis_guest_powers(view->axes[order->axis]))
        return MAINTAIN_NOT_HELD;
    leave(view, order->axis);
    return MAINTAIN_DONE;
}

/** What a motion is ended with: never less than a jog without pause was given before, or the end of one that goes on,
 *  so that nobody makes the way to standstill longer. 0 is the most that the axis has. */
static double braking(const hold_t *hold, const maintain_order_t *order)
{
    if ((hold->motion != HOLD_JOG && hold->motion != HOLD_END) || order->acceleration == 0.0)
        return order->acceleration;
    return hold->deceleration == 0.0 ? 0.0 : fmax(hold->deceleration, order->acceleration);
}

/** A motion of this client has begun, or goes on. */
static maintain_refusal_t moves(view_t *view, const maintain_order_t *order, hold_t *hold, int64_t now_ns,
                                hold_motion_t motion)
{
    take(view, hold, order->client);
    hold->velocity = order->velocity;
    hold->acceleration = order->acceleration;
    hold->deceleration = braking(hold, order);
    hold->motion = motion;
    hold->motion_keep_ns = order->keep_ns;
    hold->motion_until_ns = now_ns + order->keep_ns;
    return MAINTAIN_DONE;
}

/** Whether somebody else has stopped this jog, and its client has not let go of it since. */
static bool was_stopped(view_t *view, const maintain_order_t *order, int64_t now_ns)
{
    stopped_t *stopped = &view->maintained.stopped[order->axis];
    stopped->any &= now_ns < stopped->until_ns;
    if (!stopped->any || stopped->client != order->client)
        return false;
    stopped->until_ns = now_ns + order->keep_ns;
    return true;
}

static maintain_refusal_t jog(view_t *view, maintain_order_t *order, hold_t *hold, int64_t now_ns)
{
    cm1e_axis_t *axis = view->axes[order->axis];
    cm1e_command_id_t command;
    const bool same = order->velocity == hold->velocity && order->acceleration == hold->acceleration;
    if (was_stopped(view, order, now_ns))
        return MAINTAIN_STOPPED;
    if (hold->held && hold->motion == HOLD_HOME)
        return MAINTAIN_MOVES;
    if (hold->held && hold->motion == HOLD_JOG && same)
        return moves(view, order, hold, now_ns, HOLD_JOG);
    order->error = cm1e_axis_guest_jog(axis, order->velocity, order->acceleration, &command);
    if (order->error != CM1E_OK)
        return MAINTAIN_BY_AXIS;
    moves(view, order, hold, now_ns, HOLD_JOG);
    hold->command = command;
    return MAINTAIN_DONE;
}

static maintain_refusal_t home(view_t *view, maintain_order_t *order, hold_t *hold, int64_t now_ns)
{
    cm1e_command_id_t command;
    if (hold->held && hold->motion != HOLD_NONE)
        return MAINTAIN_MOVES;
    order->error = cm1e_axis_guest_home(view->axes[order->axis], &command);
    if (order->error != CM1E_OK)
        return MAINTAIN_BY_AXIS;
    moves(view, order, hold, now_ns, HOLD_HOME);
    hold->command = command;
    return MAINTAIN_DONE;
}

/** Of anybody's motion through this socket. */
static maintain_refusal_t stop(view_t *view, maintain_order_t *order, hold_t *hold, int64_t now_ns)
{
    stopped_t *stopped = &view->maintained.stopped[order->axis];
    stopped->any &= stopped->client != order->client; /* who stops it itself has let go of it */
    if (!hold->held || hold->motion == HOLD_NONE)
        return MAINTAIN_NOT_HELD;
    /* Also while a jog ends that was renewed too late. */
    if (hold->motion != HOLD_HOME && hold->client != order->client)
        *stopped = (stopped_t){true, hold->client, now_ns + hold->motion_keep_ns};
    end_motion(view->axes[order->axis], hold);
    return MAINTAIN_DONE;
}

static maintain_refusal_t reset(view_t *view, maintain_order_t *order, hold_t *hold, int64_t now_ns)
{
    (void)hold, (void)now_ns;
    cm1e_axis_guest_reset(view->axes[order->axis]);
    return MAINTAIN_DONE;
}

static maintain_refusal_t keep(view_t *view, maintain_order_t *order, hold_t *unused, int64_t now_ns)
{
    (void)unused;
    for (uint32_t i = 0; i < view->axis_count; i++) {
        hold_t *hold = hold_of(view, i);
        if (!hold->held || hold->client != order->client)
            continue;
        hold->power_until_ns = now_ns + hold->power_keep_ns;
        if (hold->motion == HOLD_HOME)
            hold->motion_until_ns = now_ns + hold->motion_keep_ns;
        order->kept++;
    }
    return MAINTAIN_DONE;
}

static const struct {
    maintain_refusal_t (*act)(view_t *view, maintain_order_t *order, hold_t *hold, int64_t now_ns);
    bool begins; /**< it needs an axis that the program does not command */
} actions[MAINTAIN_COUNT] = {
    [MAINTAIN_ENABLE] = {enable, true}, [MAINTAIN_DISABLE] = {disable, false}, [MAINTAIN_JOG] = {jog, true},
    [MAINTAIN_HOME] = {home, true},     [MAINTAIN_STOP] = {stop, false},       [MAINTAIN_RESET] = {reset, true},
    [MAINTAIN_KEEP] = {keep, false},
};

static maintain_refusal_t decide(view_t *view, maintain_order_t *order)
{
    const cm1e_axis_t *axis = view->axes[order->axis];
    hold_t *hold = hold_of(view, order->axis);
    cm1e_axis_news_t news;
    cm1e_axis_news(axis, &news);
    order->state = news.state;
    order->command = news.command;
    order->kind = news.kind;
    if (cm1e_scheduler_is_ending(view->scheduler))
        return MAINTAIN_ENDING;
    if (hold->held && hold->client != order->client && order->what != MAINTAIN_STOP && order->what != MAINTAIN_KEEP)
        return MAINTAIN_HELD;
    order->guest = actions[order->what].begins ? cm1e_axis_guest_may(axis, hold->held ? hold->command : 0)
                                               : CM1E_GUEST_MAY;
    if (order->guest)
        return MAINTAIN_BY_GUEST;
    return actions[order->what].act(view, order, hold, cm1e_scheduler_time_ns(view->scheduler));
}

void cm1e_maintain_decide(view_t *view, view_order_t *order)
{
    maintain_order_t *asked = (maintain_order_t *)order;
    asked->guest = CM1E_GUEST_MAY;
    asked->error = CM1E_OK;
    asked->kept = 0;
    asked->refusal = decide(view, asked);
}
