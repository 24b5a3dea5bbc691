/* The masters of a follower: the links, the order in which axes advance, and the view of a master. */
#include <string.h>

#include "axis/axis_commands.h"
#include "axis/axis_extras.h"
#include "axis/axis_pause.h"
#include "axis/axis_setpoint.h"
#include "core/extreme.h"
#include "core/rare.h"
#include "coupling/coupling_private.h"

/* Tolerance in counts between the way of a master and what its velocities explain. A ramp without a limit of jerk has
 * its corner between two set-points. */
static const double same_way_counts = 1.0;

static bool have_advanced(const follow_t *follow)
{
    for (int i = 0; i < follow->count; i++)
        if (follow->links[i].master && !follow->links[i].master->advanced)
            return false;
    return true;
}

/* A function of its own, so that a slave whose masters have advanced saves no registers. */
CM1E_RARE static void advance_masters(follow_t *follow)
{
    for (int i = 0; i < follow->count; i++)
        if (follow->links[i].master && !follow->links[i].master->advanced)
            cm1e_axis_advance(follow->links[i].master);
}

void cm1e_coupling_advance_masters(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    if (axis_follows(axis) && !have_advanced(c->now))
        advance_masters(c->now);
    if (c->awaited)
        advance_masters(c->awaited);
}

static void resume(cm1e_axis_t *master, int64_t pause_ns)
{
    if (pause_ns > 0)
        cm1e_axis_after_pause(master, pause_ns);
    else
        cm1e_axis_after_silence(master);
}

static void resume_masters(follow_t *follow, int64_t pause_ns)
{
    for (int i = 0; follow && i < follow->count; i++)
        if (follow->links[i].master)
            resume(follow->links[i].master, pause_ns);
}

void cm1e_coupling_resume_masters(cm1e_axis_t *axis, int64_t pause_ns)
{
    resume_masters(axis->coupling->now, pause_ns);
    resume_masters(axis->coupling->awaited, pause_ns);
}

static bool master_began_anew(const follow_t *follow)
{
    for (int i = 0; i < follow->count; i++)
        if (follow->links[i].master && follow->links[i].master->silence.began_anew)
            return true;
    return false;
}

/* ---- masters on another bus -------------------------------------------------------------------------------------- */

/* Time stands still for the axes of a silent bus only. While the bus of the master is silent, the slave assumes that
 * the motor of the master runs on at first, and stops when it has got no new target for longer. While the bus of the
 * slave is silent, the master goes on without it. After the silence the slave goes on from its own set-point, and makes
 * up the distance as after any other loss. */
static assumption_t assumption(const link_t *link)
{
    if (!link->apart || link->source != mcSetValue || !link->master || !link->master->silence.frozen)
        return SEEN;
    return cm1e_axis_stops_unheard(link->master) ? STOPS : RUNS_ON;
}

static bool assumes_otherwise(const follow_t *follow)
{
    for (int i = 0; i < follow->count; i++)
        if (assumption(&follow->links[i]) != (assumption_t)follow->links[i].assumed)
            return true;
    return false;
}

bool cm1e_coupling_settle(cm1e_axis_t *axis)
{
    follow_t *now = axis->coupling->now;
    const bool changed = assumes_otherwise(now) || axis->coupling->left_behind;
    axis->coupling->left_behind = false;
    for (int i = 0; i < now->count && changed; i++) {
        link_t *link = &now->links[i];
        link->assumed = (uint8_t)assumption(link);
        link->ran_on = link->assumed == SEEN ? 0.0 : link->ran_on;
    }
    return changed;
}

static bool is_left_behind(const follow_t *follow)
{
    for (int i = 0; i < follow->count; i++)
        if (follow->links[i].apart && assumption(&follow->links[i]) == SEEN)
            return true;
    return false;
}

void cm1e_coupling_fall_behind(cm1e_axis_t *axis)
{
    axis->coupling->left_behind |= is_left_behind(axis->coupling->now);
}

bool cm1e_coupling_begins_anew(const cm1e_axis_t *axis)
{
    const follow_t *now = axis->coupling->now;
    return now->by_actual || axis->coupling->left_behind || master_began_anew(now) || assumes_otherwise(now);
}

void cm1e_coupling_resume_slaves(cm1e_axis_t *axis)
{
    for (link_t *link = axis->followed->slaves; link; link = link->next)
        cm1e_axis_after_silence(link->slave);
}

void cm1e_coupling_begin_slaves_anew(cm1e_axis_t *axis)
{
    for (link_t *link = axis->followed->slaves; link; link = link->next)
        if (axis_follows(link->slave) && !link->slave->setpoint.pursuit.under_way)
            cm1e_axis_begin_anew(link->slave, link->slave->setpoint.velocity);
}

/* ---- who follows whom -------------------------------------------------------------------------------------------- */

static bool search(cm1e_axis_t *from, const cm1e_axis_t *goal, uint64_t mark);

static bool search_masters(const follow_t *follow, const cm1e_axis_t *goal, uint64_t mark)
{
    for (int i = 0; follow && i < follow->count; i++)
        if (follow->links[i].master && search(follow->links[i].master, goal, mark))
            return true;
    return false;
}

/* Whether `goal` is `from` or one of its direct or indirect masters. Each axis is visited once. */
static bool search(cm1e_axis_t *from, const cm1e_axis_t *goal, uint64_t mark)
{
    const coupling_t *c = from->coupling;
    if (from == goal)
        return true;
    if (!c || from->followed->mark == mark)
        return false;
    from->followed->mark = mark;
    return search_masters(axis_follows(from) ? c->now : NULL, goal, mark) || search_masters(c->awaited, goal, mark);
}

static bool would_follow_itself(cm1e_axis_t *slave, cm1e_axis_t *master)
{
    const uint64_t mark = (uint64_t)slave->handle << 32 | ++slave->coupling->searches;
    return search(master, slave, mark);
}

void cm1e_coupling_list_links(follow_t *follow)
{
    for (int i = 0; i < follow->count; i++) {
        link_t *link = &follow->links[i];
        link->next = link->master->followed->slaves;
        link->master->followed->slaves = link;
        link->listed = true;
    }
}

static void unlist(link_t *link)
{
    link_t **place = link->listed && link->master ? &link->master->followed->slaves : NULL;
    while (place && *place != link)
        place = &(*place)->next;
    if (place)
        *place = link->next;
    link->listed = false;
}

void cm1e_coupling_unlist_links(follow_t *follow)
{
    for (int i = 0; i < follow->count; i++)
        unlist(&follow->links[i]);
}

void cm1e_coupling_unlink(cm1e_axis_t *axis)
{
    for (int i = 0; axis->coupling && i < FOLLOWS; i++)
        cm1e_coupling_unlist_links(&axis->coupling->follows[i]);
    while (axis->followed->slaves) {
        link_t *link = axis->followed->slaves;
        axis->followed->slaves = link->next;
        link->master = NULL;
        link->listed = false;
        cm1e_axis_look_anew(link->slave);
    }
}

/* ---- which coupling is prepared, and which waits ----------------------------------------------------------------- */

follow_t *cm1e_coupling_spare(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    follow_t *spare = c->follows;
    while (spare == c->now || spare == axis->coupling->awaited)
        spare++;
    return spare;
}

void cm1e_coupling_await(cm1e_axis_t *axis, follow_t *follow)
{
    axis->coupling->awaited = follow;
    cm1e_axis_set_extra(axis, EXTRA_AWAITS, true);
    axis->coupling->due = false;
    cm1e_coupling_list_links(follow);
}

void cm1e_coupling_await_nothing(cm1e_axis_t *axis)
{
    if (axis->coupling->awaited)
        cm1e_coupling_unlist_links(axis->coupling->awaited);
    axis->coupling->awaited = NULL;
    cm1e_axis_set_extra(axis, EXTRA_AWAITS, false);
}

/* ---- what is seen of them ---------------------------------------------------------------------------------------- */

static master_trouble_t trouble_of_set_value(const cm1e_axis_t *master)
{
    const bool stopped = master->state == CM1E_AXIS_ERROR_STOP;
    if (set_points_move(master) && !stopped)
        return MASTER_GOOD;
    if (drive_homes(master))
        return stopped ? MASTER_ERROR_STOP : MASTER_HOMING;
    if (axis_free(master))
        return stopped ? MASTER_ERROR_STOP : MASTER_FREE;
    return stopped ? MASTER_STOPPING : MASTER_GOOD;
}

/* The actual position of the master: of this cycle if the slave has advanced, else of the previous cycle. */
static inline master_trouble_t see_actual(const link_t *link, position_t *position, master_view_t *view)
{
    from_t seen;
    const master_trouble_t trouble = cm1e_coupling_see_actual(link->master, link->slave->advanced, &seen);
    if (trouble)
        return trouble;
    *position = seen.position;
    view->velocity = seen.velocity;
    view->acceleration = seen.acceleration;
    view->jumps = link->seen.jumps; /* the guard of the slave judges jumps of an actual value */
    return MASTER_GOOD;
}

/* Where the motor of a master is assumed to be while its bus is silent. */
static void run_on(link_t *link, bool on_the_way, position_t *position, master_view_t *view)
{
    if (link->assumed == STOPS)
        view->velocity = 0.0;
    if (on_the_way)
        link->ran_on += 2.0 * link->half_cycle * view->velocity;
    *position = cm1e_position_plus(*position, link->ran_on);
    view->acceleration = 0.0;
}

/* Gives the position of the master in this cycle, and its view without the counts. */
static inline master_trouble_t see(link_t *link, bool on_the_way, position_t *position, master_view_t *view)
{
    const cm1e_axis_t *master = link->master;
    if (!master)
        return MASTER_DESTROYED;
    if (link->source == mcActualValue)
        return see_actual(link, position, view);
    const master_trouble_t trouble = trouble_of_set_value(master);
    if (trouble && trouble != MASTER_STOPPING)
        return trouble;
    *position = master->setpoint.position;
    view->velocity = master->setpoint.velocity;
    view->acceleration = master->setpoint.acceleration;
    view->jumps = master->setpoint.jumps;
    if (link->assumed != SEEN)
        run_on(link, on_the_way, position, view);
    return trouble;
}

/* Whether the slave follows that master already, with its phase shift. */
static bool keeps_phase(const cm1e_axis_t *slave, const link_t *link)
{
    return axis_follows(slave) && slave->coupling->now->links[0].master == link->master;
}

/* Adds the phase shift of the slave against its first master (4.8). */
static inline void add_phase(const cm1e_axis_t *slave, const link_t *link, master_view_t *view)
{
    const cm1e_motion_state_t *phase = &slave->coupling->phase;
    view->counts += phase->position * link->master->position.scale;
    /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): who calls has seen the master */
    view->velocity += phase->velocity;
    view->acceleration += phase->acceleration;
}

/* Computes how far the way of a master in a cycle may differ from what its velocities explain: its acceleration may
 * reach both limits within the cycle. An actual value has no such bound; the guard of the slave judges it. */
static void know_ways(link_t *link, double cycle_s)
{
    const cm1e_axis_t *master = link->master;
    const cm1e_motion_limits_t *system = &master->limits.system;
    const double corner = larger(system->acceleration, system->deceleration) * cycle_s * cycle_s / 2.0;
    link->half_cycle = master->position.scale * cycle_s / 2.0;
    link->most_unexplained = link->source == mcActualValue ? INFINITY
                                                           : same_way_counts + corner * fabs(master->position.scale);
}

/* Whether the set-point of the master jumped: even a short jump breaks its limits. */
static inline bool jumped(const link_t *link, const master_view_t *view)
{
    const master_view_t *before = &link->seen;
    /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): who calls has seen the master */
    if (view->jumps != before->jumps)
        return true;
    const double way = (view->velocity + before->velocity) * link->half_cycle;
    return fabs(view->counts - before->counts - way) > link->most_unexplained;
}

/* Whether the master has gone on in this cycle, and the slave, which begins anew, has not: another master of it has
 * begun anew meanwhile. The slave still sees that way when it advances. */
static bool is_ahead(const cm1e_axis_t *slave, const link_t *link, const master_view_t *view)
{
    const cm1e_axis_t *master = link->master;
    return master->advanced && !slave->advanced && !master->silence.began_anew && !jumped(link, view);
}

static bool stands(link_t *link)
{
    position_t unused;
    master_view_t view = {0};
    return !see(link, false, &unused, &view) && view.velocity == 0.0 && view.acceleration == 0.0;
}

void cm1e_coupling_held(cm1e_axis_t *axis)
{
    follow_t *now = axis->coupling->now;
    for (int i = 0; i < now->count; i++)
        if (now->links[i].apart && assumption(&now->links[i]) == SEEN && !stands(&now->links[i]))
            cm1e_axis_set_reached(axis, false);
}

static void set_other_name(cm1e_axis_t *axis, const cm1e_axis_t *other)
{
    memcpy(axis->followed->other_name, other ? other->config->name : "", other ? CM1E_NAME_LENGTH : 1);
}

static master_trouble_t trouble_with(cm1e_axis_t *slave, const link_t *link, master_trouble_t trouble)
{
    coupling_t *c = slave->coupling;
    if (c->stopping)
        return trouble; /* the first cause is reported */
    c->trouble = trouble;
    c->master_error = link->master ? link->master->fault.error : CM1E_OK;
    set_other_name(slave, link->master);
    return trouble;
}

/* Makes the view of every master. The positions count from the place where the slave began to follow. So a shift of
 * the coordinates of a master is no motion, and no count is lost however far the master goes. */
static inline master_trouble_t look(cm1e_axis_t *slave, follow_t *follow, bool on_the_way, bool anew)
{
    master_trouble_t worst = MASTER_GOOD;
    for (int i = 0; i < follow->count; i++) {
        link_t *link = &follow->links[i];
        position_t position = {0};
        master_view_t view;
        const master_trouble_t trouble = see(link, on_the_way, &position, &view);
        if (trouble)
            worst = trouble_with(slave, link, trouble);
        if (trouble && trouble != MASTER_STOPPING)
            return trouble;
        view.counts = cm1e_position_minus(position, link->origin);
        if (i == 0 && (follow == slave->coupling->now || keeps_phase(slave, link)))
            add_phase(slave, link, &view);
        if (anew && is_ahead(slave, link, &view))
            continue;
        const bool jump = on_the_way && jumped(link, &view);
        link->seen = view;
        if (jump)
            return trouble_with(slave, link, MASTER_JUMPED);
    }
    return worst;
}

master_trouble_t cm1e_coupling_look(cm1e_axis_t *slave, follow_t *follow) { return look(slave, follow, false, false); }
master_trouble_t cm1e_coupling_see(cm1e_axis_t *slave, follow_t *follow) { return look(slave, follow, true, false); }
master_trouble_t cm1e_coupling_look_anew(cm1e_axis_t *slave) { return look(slave, slave->coupling->now, false, true); }

cm1e_error_t cm1e_coupling_link(cm1e_axis_t *slave, follow_t *follow, const cm1e_coupling_master_t *asked)
{
    cm1e_axis_t *master = cm1e_axis_from_reference(&asked->axis);
    if (!master || !cm1e_axis_shares_cycle(slave, master))
        return CM1E_ERROR_AXIS_MASTER;
    if (would_follow_itself(slave, master)) {
        set_other_name(slave, master);
        return CM1E_ERROR_AXIS_COUPLING_CYCLE;
    }
    if (asked->source != mcSetValue && asked->source != mcActualValue)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (slave->advanced && !master->advanced) /* a waiting command begins in this cycle */
        cm1e_axis_advance(master);
    link_t *link = &follow->links[follow->count];
    *link = (link_t){.master = master, .slave = slave, .source = asked->source,
                     .apart = !cm1e_axis_is_heard_with(master, slave)};
    if (master->config->type == CM1E_AXIS_ENCODER || drive_profiles(master)) /* it has only an actual value */
        link->source = mcActualValue;
    follow->by_actual |= link->source == mcActualValue;
    link->assumed = (uint8_t)assumption(link);
    know_ways(link, slave->cycle_s);
    const master_trouble_t trouble = see(link, false, &link->origin, &link->seen);
    if (trouble) {
        trouble_with(slave, link, trouble);
        return CM1E_ERROR_AXIS_MASTER_LOST;
    }
    if (follow->count++ == 0 && keeps_phase(slave, link))
        add_phase(slave, link, &link->seen);
    return CM1E_OK;
}
