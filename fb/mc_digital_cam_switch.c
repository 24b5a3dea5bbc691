#include <math.h>

#include "axis/axis_signals.h"
#include "edge.h"
#include "lease.h"

/* 3.32. Two points that move with the axis evaluate each switch: one switches on, the other switches off. A negative
 * compensation puts a point ahead by the distance of that time at the present velocity. A positive compensation delays
 * the switching by that time, which is exact even if the velocity changes. While the two points differ, the one that
 * enters switches on and the one that leaves switches off. When they agree, their state applies, so that an axis that
 * stops between them ends with the switch at the state of its position. */

/* Time for which the actual position may be unknown before the outputs go off: a single lost frame does not count. */
static const TIME unseen_ns = 20000000;
/* Fewer counts than this do not count as motion for the direction, because a motor at standstill trembles. */
static const double trembling_counts = 20.0;

/** The axis as one call sees it. */
typedef struct look {
    cm1e_axis_measures_t axis;
    TIME now;
    double position, velocity;
    bool first;      /* there was no earlier call, or none with this switch */
    int direction;   /* direction of the last motion: 1 positive, 2 negative, 0 none */
} look_t;

/* ---- positions --------------------------------------------------------------------------------------------------- */

/** The shortest distance from `a` to `b`. */
static double way_between(const look_t *look, double a, double b)
{
    const double range = look->axis.modulo_range;
    return range > 0.0 ? remainder(b - a, range) : b - a;
}

/** Distance from `a` to `b` in the positive direction; on a modulo axis below its range. */
static double way_up(const look_t *look, double a, double b)
{
    const double range = look->axis.modulo_range, way = b - a;
    return range > 0.0 ? way - floor(way / range) * range : way;
}

static bool inside(const look_t *look, const MC_CAMSWITCH *cam, double position)
{
    const double few = 0.01 * look->axis.resolution, range = look->axis.modulo_range;
    const double length = way_up(look, cam->FirstOnPosition, cam->LastOnPosition);
    const double way = way_up(look, cam->FirstOnPosition, position);
    return (way >= -few && way <= length + few) || (range > 0.0 && way >= range - few);
}

/** Moves the point to `position`. Returns its signed distance since the last call. */
static double move(const look_t *look, cm1e_cam_point_t *point, double position)
{
    const double way = look->first ? 0.0 : way_between(look, point->position, position);
    point->position = position;
    return way;
}

/** Whether a point that moved by `way` to `position` has passed `place`. */
static bool crossed(const look_t *look, double position, double way, double place)
{
    const double to_place = way_between(look, position - way, place);
    return way > 0.0 ? to_place > 0.0 && to_place <= way : to_place < 0.0 && to_place >= way;
}

/** Follows one point over a switch, with its hysteresis. */
static void follow(const look_t *look, const MC_CAMSWITCH *cam, double hysteresis, double position,
                   cm1e_cam_point_t *point)
{
    const double way = move(look, point, position);
    const double first = fabs(way_between(look, position, cam->FirstOnPosition));
    const double last = fabs(way_between(look, position, cam->LastOnPosition));
    if (!look->first && point->held && (point->held == 1 ? first : last) <= hysteresis)
        return;
    point->held = 0;
    bool now = inside(look, cam, position);
    if (!now && !point->inside && crossed(look, position, way, cam->FirstOnPosition) &&
        crossed(look, position, way, cam->LastOnPosition))
        now = true; /* a switch that is shorter than the distance of one call is on for one call */
    if (now != point->inside && !look->first && hysteresis > 0.0)
        point->held = first <= last ? 1 : 2;
    point->inside = now;
}

/* ---- one switch -------------------------------------------------------------------------------------------------- */

static double ahead(const look_t *look, TIME compensation)
{
    return compensation < 0 ? look->position - look->velocity * (double)compensation * 1e-9 : look->position;
}

static bool wanted_by_position(const look_t *look, const MC_CAMSWITCH *cam, const MC_TRACK *track,
                               cm1e_cam_switch_t *state)
{
    const bool on_before = state->on_point.inside, off_before = state->off_point.inside;
    follow(look, cam, track->Hysteresis, ahead(look, track->OnCompensation), &state->on_point);
    follow(look, cam, track->Hysteresis, ahead(look, track->OffCompensation), &state->off_point);
    const bool on = state->on_point.inside, off = state->off_point.inside;
    if (cam->AxisDirection != 0 && cam->AxisDirection != look->direction)
        return false;
    if (on == off)
        return on;
    if (on && !on_before)
        return true;
    if (!off && off_before)
        return false;
    return state->wanted;
}

static bool wanted_by_time(const look_t *look, const MC_CAMSWITCH *cam, const MC_TRACK *track,
                           cm1e_cam_switch_t *state)
{
    cm1e_cam_point_t *point = &state->on_point;
    const double position = ahead(look, track->OnCompensation), way = move(look, point, position);
    const bool fits = cam->AxisDirection == 0 || (cam->AxisDirection == 2) == (way < 0.0);
    if (point->held && fabs(way_between(look, position, cam->FirstOnPosition)) > track->Hysteresis)
        point->held = 0;
    if (!point->held && fits && crossed(look, position, way, cam->FirstOnPosition)) {
        state->wanted_until = cam->Duration < INT64_MAX - look->now ? look->now + cam->Duration : INT64_MAX;
        point->held = track->Hysteresis > 0.0;
    }
    return look->now < state->wanted_until;
}

static TIME delay(TIME compensation) { return compensation > 0 ? compensation : 0; }

/** Applies the delays of switching on and off. An earlier on-time lasts to its end; one that has not begun yet and the
 *  next one become one. */
static bool delayed(const look_t *look, const MC_TRACK *track, bool wanted, TIME off_delay, cm1e_cam_switch_t *state)
{
    if (wanted && !state->wanted) {
        const bool pending = state->on_from > look->now && state->on_from < state->off_at;
        if (!pending && state->on_from < state->off_at && state->off_at > state->still_until)
            state->still_until = state->off_at;
        if (!pending)
            state->on_from = look->now + delay(track->OnCompensation);
        state->off_at = INT64_MAX;
    } else if (!wanted && state->wanted) {
        state->off_at = look->now + off_delay;
    }
    state->wanted = wanted;
    return (look->now >= state->on_from && look->now < state->off_at) || look->now < state->still_until;
}

/** A switch that was not there in the last call has passed nothing. */
static bool is_new(const cm1e_cam_switch_t *state) { return isnan(state->on_point.position); }

static bool evaluate(const look_t *looked, const MC_CAMSWITCH *cam, const MC_TRACK *track, cm1e_cam_switch_t *state)
{
    look_t look = *looked;
    if (is_new(state)) {
        *state = (cm1e_cam_switch_t){0};
        look.first = true;
    }
    if (cam->CamSwitchMode == 1) /* Duration sets the length: both ends have the same delay */
        return delayed(&look, track, wanted_by_time(&look, cam, track, state), delay(track->OnCompensation), state);
    return delayed(&look, track, wanted_by_position(&look, cam, track, state), delay(track->OffCompensation), state);
}

/** Switches from number `count` on are not there. Behind the first of them that is forgotten already, all are. */
static void forget_from(cm1e_cam_private_t *p, int count)
{
    for (int i = count; i < CM1E_CAM_SWITCHES && !is_new(&p->switches[i]); i++)
        p->switches[i].on_point.position = NAN;
}

/* ---- the block --------------------------------------------------------------------------------------------------- */

/** An input, and whether it is out of its range. */
typedef struct checked {
    bool wrong;
    cm1e_cam_switch_input_t input;
    double value;
} checked_t;

/** The first of them that is wrong; NULL: none. */
static const checked_t *first_wrong(const checked_t inputs[], int count)
{
    for (int i = 0; i < count; i++)
        if (inputs[i].wrong)
            return &inputs[i];
    return NULL;
}

/** The axis keeps for its text what was wrong first, so that no later refusal of another kind is hidden in every
 *  call. */
static bool refuse(const MC_DigitalCamSwitch_t *fb, int number, const checked_t *wrong)
{
    if (wrong && fb->ErrorID != cm1e_error_id(CM1E_ERROR_FB_CAM_SWITCH))
        cm1e_axis_refuse_cam_switch(cm1e_fb_axis(&fb->Private.common), wrong->input, number, wrong->value);
    return wrong != NULL;
}

static bool refuses_switch(const MC_DigitalCamSwitch_t *fb, const look_t *look, const MC_CAMSWITCH *cam, int number)
{
    const bool by_time = cam->CamSwitchMode == 1;
    const double length = cam->LastOnPosition - cam->FirstOnPosition, range = look->axis.modulo_range;
    const bool too_long = range > 0.0 && !(length < range), negative = range <= 0.0 && length < 0.0;
    const checked_t inputs[] = {
        {cam->TrackNumber < 1 || cam->TrackNumber > CM1E_CAM_TRACKS, CM1E_CAM_SWITCH_TRACK, cam->TrackNumber},
        {cam->AxisDirection < 0 || cam->AxisDirection > 2, CM1E_CAM_SWITCH_DIRECTION, cam->AxisDirection},
        {cam->CamSwitchMode < 0 || cam->CamSwitchMode > 1, CM1E_CAM_SWITCH_MODE, cam->CamSwitchMode},
        {!isfinite(cam->FirstOnPosition), CM1E_CAM_SWITCH_FIRST_ON, cam->FirstOnPosition},
        {!by_time && (!isfinite(cam->LastOnPosition) || too_long), CM1E_CAM_SWITCH_LAST_ON, cam->LastOnPosition},
        {!by_time && negative, CM1E_CAM_SWITCH_FIRST_ON, cam->FirstOnPosition},
        {by_time && cam->Duration < 0, CM1E_CAM_SWITCH_DURATION, (double)cam->Duration},
    };
    return refuse(fb, number, first_wrong(inputs, sizeof inputs / sizeof inputs[0]));
}

static bool refuses_track(const MC_DigitalCamSwitch_t *fb, const MC_TRACK *track, int number)
{
    const TIME most = INT64_C(3600) * 1000000000;
    const checked_t inputs[] = {
        {track->OnCompensation > most || track->OnCompensation < -most, CM1E_CAM_SWITCH_ON_COMPENSATION,
         (double)track->OnCompensation},
        {track->OffCompensation > most || track->OffCompensation < -most, CM1E_CAM_SWITCH_OFF_COMPENSATION,
         (double)track->OffCompensation},
        {!(track->Hysteresis >= 0.0 && isfinite(track->Hysteresis)), CM1E_CAM_SWITCH_HYSTERESIS, track->Hysteresis},
    };
    return refuse(fb, number, first_wrong(inputs, sizeof inputs / sizeof inputs[0]));
}

static const MC_TRACK *track_of(const MC_DigitalCamSwitch_t *fb, const MC_CAMSWITCH *cam)
{
    static const MC_TRACK plain;
    return fb->TrackOptions ? &fb->TrackOptions->Tracks[cam->TrackNumber - 1] : &plain;
}

/** All switches; an error leaves the tracks off. */
static cm1e_error_t evaluate_all(MC_DigitalCamSwitch_t *fb, const look_t *look, DWORD *tracks)
{
    const MC_CAMSWITCH_REF *cams = fb->Switches;
    const int count = cams ? cams->NumberOfSwitches : 0;
    *tracks = 0;
    if (refuse(fb, 0, count < 1 || count > CM1E_CAM_SWITCHES ? &(checked_t){true, CM1E_CAM_SWITCH_COUNT, count} : NULL))
        return CM1E_ERROR_FB_CAM_SWITCH;
    DWORD on = 0;
    for (int i = 0; i < count; i++) {
        const MC_CAMSWITCH *cam = &cams->Switches[i];
        if (refuses_switch(fb, look, cam, i + 1) || refuses_track(fb, track_of(fb, cam), i + 1))
            return CM1E_ERROR_FB_CAM_SWITCH;
        if (evaluate(look, cam, track_of(fb, cam), &fb->Private.switches[i]))
            on |= (DWORD)1 << (cam->TrackNumber - 1);
    }
    forget_from(&fb->Private, count);
    *tracks = on & fb->EnableMask;
    if (fb->ErrorID == cm1e_error_id(CM1E_ERROR_FB_CAM_SWITCH))
        cm1e_axis_cam_switches_right(cm1e_fb_axis(&fb->Private.common));
    return CM1E_OK;
}

/** The direction changes when the axis comes back by more than its tremble; a set-point does not tremble. */
static void follow_direction(cm1e_cam_private_t *p, look_t *look, double trembling)
{
    const double away = look->first ? 0.0 : way_between(look, p->turn, look->position);
    const bool on = p->moved && (p->negative ? away < 0.0 : away > 0.0);
    if (!p->running)
        p->moved = FALSE;
    if (!on && fabs(away) > trembling) {
        p->moved = TRUE;
        p->negative = away < 0.0;
    }
    if (look->first || on || fabs(away) > trembling)
        p->turn = look->position;
    look->direction = !p->moved ? 0 : p->negative ? 2 : 1;
}

static void forget(cm1e_cam_private_t *p)
{
    p->running = FALSE;
    for (int i = 0; i < CM1E_CAM_SWITCHES; i++)
        p->switches[i] = (cm1e_cam_switch_t){0};
}

/** Returns false if the position is not known. */
static bool look_at(MC_DigitalCamSwitch_t *fb, const cm1e_axis_t *axis, look_t *look)
{
    cm1e_cam_private_t *p = &fb->Private;
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    const bool actual = fb->ValueSource == mcActualValue;
    *look = (look_t){.axis = cm1e_axis_measures(axis), .now = cm1e_axis_time(axis),
                     .position = actual ? info.actual_position : info.set_position,
                     .velocity = actual ? info.actual_velocity : info.set_velocity};
    if (actual && !info.online)
        return false;
    const double since_s = (double)(look->now - p->seen) * 1e-9, trembling = trembling_counts * look->axis.resolution;
    /* The change is larger than the axis can have moved: the coordinates were changed, and no switch was passed. */
    const double most = 2.0 * look->axis.max_velocity * since_s + trembling;
    look->first = !p->running || fabs(way_between(look, p->position, look->position)) > most;
    follow_direction(p, look, actual ? trembling : 0.0);
    p->running = TRUE;
    p->position = look->position;
    p->seen = look->now;
    return true;
}

/** The tracks that have an output: the first one, and on other slaves all that a switch uses. */
static DWORD tracks_with_output(const MC_DigitalCamSwitch_t *fb, int number)
{
    DWORD tracks = 1;
    for (int i = 0; number >= CM1E_WIRED_FIRST && i < fb->Switches->NumberOfSwitches; i++)
        tracks |= (DWORD)1 << (fb->Switches->Switches[i].TrackNumber - 1);
    return tracks;
}

/** A bit of `written`; 0: there is no such output. */
static WORD bit_of_output(int number)
{
    const int n = number - CM1E_WIRED_FIRST;
    if (n >= 0 && n < CM1E_WIRED_SIGNALS)
        return (WORD)(1u << n);
    return number >= 1 && number <= CM1E_AXIS_OUTPUTS ? (WORD)(0x80u << number) : 0;
}

/** `number` is that of the last output that it has tried to write; 0: none. */
static cm1e_error_t write_output(MC_DigitalCamSwitch_t *fb, DWORD tracks, TIME lease, int *number)
{
    fb->Outputs->Values = tracks;
    if (fb->Outputs->Axis.Handle == 0)
        return CM1E_OK;
    cm1e_axis_t *axis = cm1e_axis_from_reference(&fb->Outputs->Axis);
    if (!axis)
        return CM1E_ERROR_FB_AXIS_REF;
    const int first = fb->Outputs->Number ? fb->Outputs->Number : 1;
    const DWORD with_output = tracks_with_output(fb, first);
    cm1e_error_t error = CM1E_OK;
    for (int i = 0; i < CM1E_CAM_TRACKS; i++) {
        if (!(with_output >> i & 1))
            continue;
        *number = first + i;
        error = cm1e_axis_hold_output(axis, *number, tracks >> i & 1, lease);
        if (error != CM1E_OK)
            break;
        if (fb->Private.output != fb->Outputs->Axis.Handle)
            fb->Private.written = 0; /* what it held on another axis goes off by itself */
        fb->Private.output = fb->Outputs->Axis.Handle;
        fb->Private.written |= bit_of_output(*number);
    }
    return error;
}

static void outputs_off(MC_DigitalCamSwitch_t *fb)
{
    const AXIS_REF_t reference = {.Handle = fb->Private.output};
    cm1e_axis_t *axis = reference.Handle ? cm1e_axis_from_reference(&reference) : NULL;
    if (fb->Outputs)
        fb->Outputs->Values = 0;
    for (int number = 1; axis && number < CM1E_WIRED_FIRST + CM1E_WIRED_SIGNALS; number++)
        if (fb->Private.written & bit_of_output(number))
            cm1e_axis_output_off(axis, number);
    fb->Private.output = fb->Private.written = 0;
}

static cm1e_error_t refuse_input(const MC_DigitalCamSwitch_t *fb, const char *input, int value, const char *right)
{
    const cm1e_error_t error = CM1E_ERROR_INVALID_ARGUMENT;
    return cm1e_axis_refuse_level(cm1e_fb_axis(&fb->Private.common), error, input, value, right,
                                  fb->ErrorID != cm1e_error_id(error));
}

static cm1e_error_t operate(MC_DigitalCamSwitch_t *fb, const cm1e_axis_t *axis, TIME called, int *number)
{
    look_t look;
    DWORD tracks;
    if (!fb->Outputs)
        return refuse_input(fb, "MC_DigitalCamSwitch: Outputs", 0, "a variable of the type MC_OUTPUT_REF");
    if (fb->ValueSource != mcSetValue && fb->ValueSource != mcActualValue)
        return refuse_input(fb, "MC_DigitalCamSwitch: ValueSource", (int)fb->ValueSource,
                            "0 (mcSetValue) or 1 (mcActualValue)");
    if (!look_at(fb, axis, &look)) {
        if (fb->Private.running && look.now - fb->Private.seen <= unseen_ns)
            return write_output(fb, fb->Outputs->Values, fb_lease_ns(look.now, called), number);
        return CM1E_ERROR_AXIS_OFFLINE;
    }
    const cm1e_error_t error = evaluate_all(fb, &look, &tracks);
    return error != CM1E_OK ? error : write_output(fb, tracks, fb_lease_ns(look.now, called), number);
}

void MC_DigitalCamSwitch(MC_DigitalCamSwitch_t *fb)
{
    cm1e_cam_private_t *p = &fb->Private;
    const cm1e_axis_t *axis = cm1e_fb_enable(&p->common, fb->Axis, fb->Enable);
    const TIME called = p->called;
    cm1e_error_t error = CM1E_OK;
    int number = 0;
    if (axis) {
        p->called = cm1e_axis_time(axis);
        error = operate(fb, axis, called, &number);
    }
    const fb_reading_t out = cm1e_fb_reading(&p->common, axis, error);
    if (!out.valid && (p->running || p->output || error != CM1E_OK)) {
        outputs_off(fb);
        forget(p);
    }
    fb_reads_right(&p->common, fb->ErrorID, out.error);
    cm1e_axis_t *written = number != 0 ? cm1e_axis_from_reference(&fb->Outputs->Axis) : NULL;
    if (written && fb->ErrorID != out.error_id)
        cm1e_axis_tell_output(written, error, number);
    fb->InOperation = out.valid;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
