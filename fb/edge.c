#include "core/in_task.h"
#include "edge.h"

static void set_state(cm1e_fb_private_t *fb, fb_state_t state, cm1e_error_t error)
{
    fb->state = (BOOL)state;
    fb->error_id = cm1e_error_id(error);
}

static void *axis_of_handle(UINT handle)
{
    const AXIS_REF_t reference = {.Handle = handle};
    return handle ? cm1e_axis_from_reference(&reference) : NULL;
}

static const fb_object_t an_axis = {.find = axis_of_handle, .none = CM1E_ERROR_FB_AXIS_REF};

cm1e_axis_t *cm1e_fb_axis(const cm1e_fb_private_t *fb) { return axis_of_handle(fb->axis_handle); }

void cm1e_fb_fail(cm1e_fb_private_t *fb, cm1e_error_t error) { set_state(fb, FB_ERROR, error); }

/** Whether this call has a rising edge of Execute or Enable. */
static bool rising_edge(cm1e_fb_private_t *fb, BOOL trigger)
{
    const bool edge = trigger && !fb->trigger_before;
    fb->trigger_before = trigger ? TRUE : FALSE;
    return edge;
}

static void *latch(cm1e_fb_private_t *fb, const fb_object_t *kind, const UINT *handle)
{
    cm1e_in_task_gate();
    fb->axis_handle = handle ? *handle : 0;
    void *object = kind->find(fb->axis_handle);
    if (!object)
        cm1e_fb_fail(fb, kind->none);
    return object;
}

/** The axis of a busy block; NULL and an error if it was changed or no longer exists. */
static void *check(cm1e_fb_private_t *fb, const fb_object_t *kind, const UINT *handle)
{
    cm1e_in_task_gate();
    if (!handle || *handle != fb->axis_handle) {
        cm1e_fb_fail(fb, CM1E_ERROR_FB_AXIS_CHANGED);
        return NULL;
    }
    void *object = kind->find(fb->axis_handle);
    if (!object)
        cm1e_fb_fail(fb, kind->none);
    return object;
}

/* ---- Execute --------------------------------------------------------------------------------------------------- */

fb_step_t cm1e_fb_execute_on(cm1e_fb_private_t *fb, const fb_object_t *kind, const UINT *handle, BOOL execute,
                             void **object)
{
    const bool edge = rising_edge(fb, execute);
    if (fb->state == FB_BUSY) {
        *object = check(fb, kind, handle);
        if (!*object)
            return FB_STEP_NONE;
        return edge ? FB_STEP_START : FB_STEP_POLL;
    }
    if (edge) {
        *object = latch(fb, kind, handle);
        return *object ? FB_STEP_START : FB_STEP_NONE;
    }
    /* 2.4.1: a result that came after Execute fell was shown in the call that found it, that is for one cycle. */
    if (!execute)
        set_state(fb, FB_IDLE, CM1E_OK);
    return FB_STEP_NONE;
}

fb_step_t cm1e_fb_execute(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute, cm1e_axis_t **axis)
{
    void *object = NULL;
    const fb_step_t step = cm1e_fb_execute_on(fb, &an_axis, reference ? &reference->Handle : NULL, execute, &object);
    *axis = object;
    return step;
}

void cm1e_fb_started(cm1e_fb_private_t *fb, cm1e_error_t error)
{
    fb->active = error == CM1E_OK;
    set_state(fb, error == CM1E_OK ? FB_BUSY : FB_ERROR, error);
}

void cm1e_fb_polled(cm1e_fb_private_t *fb, cm1e_command_state_t state, cm1e_error_t error)
{
    fb->active = state == CM1E_COMMAND_ACTIVE;
    switch (state) {
    case CM1E_COMMAND_BUFFERED:
    case CM1E_COMMAND_ACTIVE: break;
    case CM1E_COMMAND_DONE: set_state(fb, FB_DONE, CM1E_OK); break;
    case CM1E_COMMAND_ERROR: set_state(fb, FB_ERROR, error); break;
    case CM1E_COMMAND_ABORTED:
    case CM1E_COMMAND_UNKNOWN: /* the axis no longer remembers it because of the many commands after it */
    default: set_state(fb, FB_ABORTED, CM1E_OK); break;
    }
}

void cm1e_fb_polled_or_cancelled(cm1e_fb_private_t *fb, cm1e_command_state_t state, cm1e_error_t error)
{
    if (state == CM1E_COMMAND_ABORTED || state == CM1E_COMMAND_UNKNOWN)
        cm1e_fb_polled(fb, CM1E_COMMAND_ERROR, CM1E_ERROR_CANCELLED);
    else
        cm1e_fb_polled(fb, state, error);
}

fb_outputs_t cm1e_fb_outputs(const cm1e_fb_private_t *fb)
{
    return (fb_outputs_t){
        .done = fb->state == FB_DONE,
        .busy = fb->state == FB_BUSY,
        .active = fb->state == FB_BUSY && fb->active,
        .aborted = fb->state == FB_ABORTED,
        .error = fb->state == FB_ERROR,
        .error_id = fb->error_id,
    };
}

/** Hands on new inputs of an active or waiting command. Returns false if they were refused. */
static bool update(cm1e_fb_private_t *fb, cm1e_axis_t *axis, BOOL continuous_update,
                   const cm1e_axis_command_t *command)
{
    fb->continuous_update = fb->continuous_update && continuous_update;
    const cm1e_error_t error = fb->continuous_update ? cm1e_axis_update(axis, fb->command, command) : CM1E_OK;
    if (error != CM1E_OK)
        cm1e_fb_fail(fb, error);
    return error == CM1E_OK;
}

/** `refusal`: a reason of the block not to start, CM1E_OK: there is none. */
static fb_outputs_t motion_unless(cm1e_error_t refusal, cm1e_fb_private_t *fb, const AXIS_REF_t *reference,
                                  BOOL execute, BOOL continuous_update, const cm1e_axis_command_t *command)
{
    cm1e_command_status_t status = {.state = CM1E_COMMAND_UNKNOWN};
    cm1e_axis_t *axis = NULL;
    switch (cm1e_fb_execute(fb, reference, execute, &axis)) {
    case FB_STEP_START:
        fb->command = 0;
        fb->continuous_update = continuous_update ? TRUE : FALSE;
        cm1e_fb_started(fb, refusal != CM1E_OK ? cm1e_axis_refuse(axis, command, refusal)
                                               : cm1e_axis_start(axis, command, &fb->command));
        status = cm1e_axis_command_status(axis, fb->command);
        fb->active = status.state == CM1E_COMMAND_ACTIVE;
        break;
    case FB_STEP_POLL:
        if (update(fb, axis, continuous_update, command)) {
            status = cm1e_axis_command_status(axis, fb->command);
            cm1e_fb_polled(fb, status.state, status.error);
        }
        break;
    case FB_STEP_NONE: break;
    }
    fb_outputs_t out = cm1e_fb_outputs(fb);
    out.reached = out.active && status.reached;
    out.synchronizing = out.active && status.synchronizing;
    out.ends = status.ends;
    out.covered = status.covered;
    return out;
}

fb_outputs_t cm1e_fb_motion(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute, BOOL continuous_update,
                            const cm1e_axis_command_t *command)
{
    return motion_unless(CM1E_OK, fb, reference, execute, continuous_update, command);
}

fb_outputs_t cm1e_fb_table_motion(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute,
                                  BOOL continuous_update, cm1e_command_kind_t kind, MC_BUFFER_MODE buffer_mode,
                                  const cm1e_axis_table_t *table)
{
    const cm1e_axis_command_t command = {.kind = kind, .buffer_mode = buffer_mode, .table = table};
    const cm1e_error_t refusal = continuous_update ? CM1E_ERROR_UNSUPPORTED : CM1E_OK;
    return motion_unless(refusal, fb, reference, execute, FALSE, &command);
}

fb_outputs_t cm1e_fb_refused_step(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute,
                                  cm1e_error_t refusal)
{
    return motion_unless(refusal, fb, reference, execute, FALSE,
                         &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP});
}

/* ---- Enable ---------------------------------------------------------------------------------------------------- */

void *cm1e_fb_enable_on(cm1e_fb_private_t *fb, const fb_object_t *kind, const UINT *handle, BOOL enable)
{
    if (rising_edge(fb, enable)) {
        set_state(fb, FB_BUSY, CM1E_OK);
        return latch(fb, kind, handle);
    }
    if (!enable)
        set_state(fb, FB_IDLE, CM1E_OK);
    return fb->state == FB_BUSY ? check(fb, kind, handle) : NULL;
}

const cm1e_axis_t *cm1e_fb_enable(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL enable)
{
    return cm1e_fb_enable_on(fb, &an_axis, reference ? &reference->Handle : NULL, enable);
}

BOOL cm1e_fb_read(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL enable, cm1e_axis_info_t *info)
{
    const cm1e_axis_t *axis = cm1e_fb_enable(fb, reference, enable);
    if (axis)
        cm1e_axis_get(axis, info);
    return axis != NULL;
}

fb_reading_t cm1e_fb_reading(const cm1e_fb_private_t *fb, const void *axis, cm1e_error_t passing)
{
    const bool passes = axis && passing != CM1E_OK;
    return (fb_reading_t){
        .valid = axis && passing == CM1E_OK,
        .busy = fb->state == FB_BUSY,
        .error = fb->state == FB_ERROR || passes,
        .error_id = passes ? cm1e_error_id(passing) : fb->error_id,
    };
}
