/* The soonest stop in bends. The slower the path, the more of the limits of its axes a bend leaves for braking, and
 * behind a bend there is all of it. So it brakes in stages: one begins where an element, or a lower level of its brake
 * (path.h), allows so much more that the rest of the stop is clearly shorter. What an element allows must be kept as
 * soon as the stop enters it. Where the deceleration is too large by then, the stages before get at most what that
 * element allows, and all is planned again. */
#include <math.h>

#include "core/extreme.h"
#include "motion/path_private.h"

/** A stage is of at most two pieces, the last one of three. */
enum { BEFORE_LAST = CM1E_PIECES_MAX - 3 - 2, TRIES_MOST = 8, FIND_STEPS = 60 };

/** A stage begins where what is left would last this much longer without it. */
static const double WORTH = 1.08;

/** A way of a stop is found to this fraction of it. */
static const double AS_NEAR = 1e-13;

/** What is allowed, to within rounding. */
static const double ROUNDING = 1e-9;

/* Newton's method between two times of which the way is between. */
double cm1e_path_time_of(const cm1e_motion_state_t *start, double jerk, double most_s, double way)
{
    double low = 0, high = most_s, t = most_s / 2;
    for (int i = 0; i < FIND_STEPS && high > low; i++) {
        const double a = start->acceleration, v = start->velocity;
        const double missing = t * (v + t * (a / 2 + t * (jerk / 6))) - way, speed = v + t * (a + t * (jerk / 2));
        if (fabs(missing) <= AS_NEAR * way)
            break;
        if (missing < 0)
            low = t;
        else
            high = t;
        const double next = t - missing / speed;
        t = next > low && next < high ? next : (low + high) / 2;
    }
    return t;
}

typedef struct {
    double deceleration, jerk;
} brake_t;

typedef struct {
    cm1e_path_t *path;
    brake_t told, most;        /**< of the command; what later elements allow those before `until` */
    int until;
    int index;                 /**< the element that it is on */
    double end;                /**< where that ends */
    cm1e_motion_state_t at;    /**< where the present stage has begun */
    brake_t brake;             /**< the present one */
    cm1e_pieces_t pieces, stage; /**< up to there; from there to standstill, if there is no other one */
} braking_t;

/** Result of a part of the plan. */
typedef enum { GOES_ON, NEXT_STAGE, AGAIN, NO_STOP } outcome_t;

/** About how long it takes to come to rest. */
static double time_with(const brake_t *brake, const cm1e_motion_state_t *at)
{
    const double d = brake->deceleration, j = brake->jerk, a = smaller(d, larger(0, -at->acceleration));
    const double held = at->velocity - (2 * d * d - a * a) / (2 * j);
    if (held > 0)
        return (2 * d - a) / j + held / d;
    const double peak = sqrt(j * at->velocity + a * a / 2);
    return (2 * peak - a) / j;
}

/** What of the brake of an element is left at most by the command and by later elements. */
static brake_t lowered(const braking_t *braking, double deceleration, double jerk)
{
    brake_t brake = {smaller(braking->told.deceleration, deceleration), smaller(braking->told.jerk, jerk)};
    if (braking->index < braking->until) {
        brake.deceleration = smaller(brake.deceleration, braking->most.deceleration);
        brake.jerk = smaller(brake.jerk, braking->most.jerk);
    }
    return brake;
}

static brake_t brake_of_level(const braking_t *braking, const cm1e_path_element_t *element, int level, int which)
{
    const cm1e_path_brake_t *brake = &element->brake;
    return lowered(braking, cm1e_path_part(which) * brake->share[level] * brake->deceleration,
                   brake->jerk_share[which][level] * brake->jerk);
}

/** Whether the motion keeps what the axes allow up to a velocity, until its acceleration has come to 0. */
static bool suits(double acceleration, double jerk, const cm1e_motion_state_t *at, double velocity)
{
    const double a = at->acceleration, fastest = a > 0 ? cm1e_path_eased(at, jerk) : at->velocity;
    return jerk > 0 && fabs(a) <= acceleration * (1 + ROUNDING) && fastest <= velocity * (1 + ROUNDING);
}

/** The best brake of the present element. false: with none of them the motion keeps what the axes allow. */
static bool find_brake(braking_t *braking, const cm1e_motion_state_t *at, brake_t *best)
{
    const cm1e_path_element_t *element = cm1e_path_element(braking->path, braking->index);
    const cm1e_motion_limits_t *limits = &element->limits;
    const double v = at->velocity;
    *best = lowered(braking, limits->deceleration, limits->jerk);
    bool found = suits(larger(limits->acceleration, limits->deceleration), best->jerk, at, element->highest);
    int level = 0;
    while (level + 1 < CM1E_PATH_LEVELS && cm1e_path_level(&element->brake, level + 1) >= v * (1 - ROUNDING))
        level++;
    for (bool any = false; !any && level >= 0 && element->brake.share[level] > 0; level--) {
        const double velocity = cm1e_path_level(&element->brake, level);
        const double whole = element->brake.share[level] * element->brake.deceleration;
        for (int which = 0; which < CM1E_PATH_BRAKES; which++) {
            const brake_t brake = brake_of_level(braking, element, level, which);
            if (!suits(cm1e_path_part(which) * whole, brake.jerk, at, velocity))
                continue;
            if (!found || time_with(&brake, at) < time_with(best, at))
                *best = brake;
            found = any = true;
        }
    }
    return found;
}

static bool is_worth(const brake_t *more, const brake_t *than, const cm1e_motion_state_t *at)
{
    return time_with(more, at) * WORTH < time_with(than, at);
}

/** Whether there are pieces left for another stage. */
static bool may_change(const braking_t *braking) { return braking->pieces.count <= BEFORE_LAST; }

/** Below which velocity the present element allows clearly more than the present brake; 0: nowhere. */
static double more_below(const braking_t *braking, const cm1e_motion_state_t *at)
{
    const cm1e_path_element_t *element = cm1e_path_element(braking->path, braking->index);
    const double hardest = brake_of_level(braking, element, CM1E_PATH_LEVELS - 1, 0).deceleration;
    const double quickest = brake_of_level(braking, element, CM1E_PATH_LEVELS - 1, CM1E_PATH_BRAKES - 1).jerk;
    if (!may_change(braking) || (hardest <= braking->brake.deceleration && quickest <= braking->brake.jerk))
        return 0;
    for (int level = 0; level < CM1E_PATH_LEVELS; level++) {
        const cm1e_motion_state_t then = {0, cm1e_path_level(&element->brake, level), -braking->brake.deceleration};
        for (int which = 0; then.velocity < at->velocity && which < CM1E_PATH_BRAKES; which++) {
            const brake_t brake = brake_of_level(braking, element, level, which);
            if (brake.deceleration >= braking->brake.deceleration && is_worth(&brake, &braking->brake, &then))
                return then.velocity;
        }
    }
    return 0;
}

/** The next element begins. */
static outcome_t enter_next(braking_t *braking, const cm1e_motion_state_t *at, bool eases)
{
    cm1e_path_t *path = braking->path;
    if (braking->index + 1 >= path->element_count)
        return NO_STOP;
    const cm1e_path_element_t *element = cm1e_path_element(path, ++braking->index);
    const brake_t *present = &braking->brake;
    const double fastest = at->acceleration > 0 ? cm1e_path_eased(at, present->jerk) : at->velocity;
    if (fastest > smaller(element->highest, element->passed) * (1 + ROUNDING))
        return NO_STOP;
    braking->end += element->length;
    brake_t brake;
    const bool found = find_brake(braking, at, &brake);
    const bool keeps = found && present->jerk <= brake.jerk && (eases || present->deceleration <= brake.deceleration);
    const bool other = found && !eases && may_change(braking);
    if (keeps && !(other && is_worth(&brake, present, at)))
        return GOES_ON;
    if (other) {
        braking->brake = brake;
        return NEXT_STAGE;
    }
    /* Too much: less from the beginning. */
    cm1e_motion_state_t slower = *at;
    slower.acceleration = 0;
    if (!find_brake(braking, &slower, &brake))
        return NO_STOP;
    braking->most.deceleration = smaller(braking->most.deceleration, brake.deceleration);
    if (found)
        braking->most.jerk = smaller(braking->most.jerk, brake.jerk);
    braking->until = braking->index > braking->until ? braking->index : braking->until;
    return AGAIN;
}

/** The stage ends within one of its pieces. */
static void end_stage(braking_t *braking, int piece, double time_s, const cm1e_motion_state_t *at)
{
    for (int i = 0; i <= piece; i++) {
        const cm1e_piece_t *part = &braking->stage.piece[i];
        cm1e_pieces_append(&braking->pieces, part->jerk, part->acceleration, i < piece ? part->duration_s : time_s);
    }
    braking->at = *at;
}

/** When the velocity of a piece that brakes harder or goes on braking has come down to that. */
static double time_down_to(const cm1e_motion_state_t *start, double jerk, double velocity)
{
    const double a = start->acceleration, less = velocity - start->velocity;
    return jerk == 0 ? less / a : (-a - sqrt(larger(0, a * a + 2 * jerk * less))) / jerk;
}

/** Follows the stage through the elements. */
static outcome_t follow_stage(braking_t *braking)
{
    cm1e_motion_state_t begin = braking->at;
    double below = more_below(braking, &begin);
    for (int i = 0; i < braking->stage.count; i++) {
        const cm1e_piece_t *piece = &braking->stage.piece[i];
        begin.acceleration = piece->acceleration;
        const cm1e_motion_state_t end = cm1e_piece_state(piece, begin.position, begin.velocity, piece->duration_s);
        const bool eases = piece->jerk > 0;
        for (;;) {
            const double down_s = !eases && end.velocity < below && below < begin.velocity
                                      ? time_down_to(&begin, piece->jerk, below) : INFINITY;
            const bool leaves = end.position > braking->end;
            const double leave_s = leaves ? cm1e_path_time_of(&begin, piece->jerk, piece->duration_s,
                                                              braking->end - begin.position) : INFINITY;
            const double time_s = smaller(down_s, leave_s);
            if (!(time_s < piece->duration_s))
                break;
            const cm1e_motion_state_t at = cm1e_piece_state(piece, begin.position, begin.velocity, time_s);
            outcome_t outcome = NEXT_STAGE;
            if (leave_s <= down_s)
                outcome = enter_next(braking, &at, eases);
            else if (!find_brake(braking, &at, &braking->brake))
                outcome = NO_STOP;
            if (outcome == NEXT_STAGE)
                end_stage(braking, i, time_s, &at);
            if (outcome != GOES_ON)
                return outcome;
            below = more_below(braking, &at);
        }
        begin = end;
    }
    return begin.position <= braking->end ? GOES_ON : NO_STOP;
}

static outcome_t brake_from(braking_t *braking, const cm1e_motion_state_t *start)
{
    braking->index = 0;
    braking->end = cm1e_path_element(braking->path, 0)->length;
    braking->at = *start;
    braking->pieces.count = 0;
    if (!find_brake(braking, start, &braking->brake))
        return NO_STOP;
    outcome_t outcome;
    do {
        const cm1e_motion_limits_t limits = {braking->at.velocity, braking->brake.deceleration,
                                             braking->brake.deceleration, braking->brake.jerk};
        braking->stage.count = 0;
        cm1e_pieces_append_velocity_change(&braking->stage, braking->at.velocity, braking->at.acceleration, 0, &limits);
        outcome = follow_stage(braking);
    } while (outcome == NEXT_STAGE);
    return outcome;
}

bool cm1e_path_brake_in_stages(cm1e_path_t *path, double deceleration, double jerk, const cm1e_motion_state_t *start,
                               cm1e_profile_t *stop, double *end)
{
    braking_t braking = {.path = path, .told = {deceleration, jerk}, .most = {INFINITY, INFINITY}, .until = 0};
    outcome_t outcome = AGAIN;
    for (int i = 0; i < TRIES_MOST && outcome == AGAIN; i++)
        outcome = brake_from(&braking, start);
    const int last = braking.stage.count - 1;
    if (outcome != GOES_ON || last < 0 || braking.pieces.count + last >= CM1E_PIECES_MAX)
        return false;
    end_stage(&braking, last, braking.stage.piece[last].duration_s, &braking.at);
    *end = braking.end;
    const cm1e_motion_limits_t limits = {start->velocity, 1, 1, 1};
    return cm1e_pieces_to_standstill(stop, start, &braking.pieces, &limits) == CM1E_OK;
}
