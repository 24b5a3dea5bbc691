#include "group_edge.h"

static void *group_of_handle(UINT handle)
{
    const AXES_GROUP_REF_t reference = {.Handle = handle};
    return cm1e_group_from_reference(&reference);
}

static const fb_object_t a_group = {.find = group_of_handle, .none = CM1E_ERROR_GROUP_REF};

cm1e_group_t *cm1e_fb_group(const cm1e_fb_private_t *fb) { return group_of_handle(fb->axis_handle); }

fb_step_t cm1e_fb_group_execute(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL execute,
                                cm1e_group_t **group)
{
    void *object = NULL;
    const fb_step_t step = cm1e_fb_execute_on(fb, &a_group, reference ? &reference->Handle : NULL, execute, &object);
    *group = object;
    return step;
}

fb_outputs_t cm1e_fb_group_act(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL execute,
                               cm1e_error_t (*act)(cm1e_group_t *group))
{
    cm1e_group_t *group = NULL;
    if (cm1e_fb_group_execute(fb, reference, execute, &group) == FB_STEP_START) {
        const cm1e_error_t error = act(group);
        cm1e_fb_polled(fb, error != CM1E_OK ? CM1E_COMMAND_ERROR : CM1E_COMMAND_DONE, error);
    }
    return cm1e_fb_outputs(fb);
}

fb_outputs_t cm1e_fb_group_motion(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL execute,
                                  const cm1e_group_command_t *command)
{
    cm1e_command_status_t status;
    cm1e_group_t *group = NULL;
    switch (cm1e_fb_group_execute(fb, reference, execute, &group)) {
    case FB_STEP_START:
        fb->command = 0;
        cm1e_fb_started(fb, cm1e_group_start(group, command, &fb->command));
        fb->active = cm1e_group_command_status(group, fb->command).state == CM1E_COMMAND_ACTIVE;
        break;
    case FB_STEP_POLL:
        status = cm1e_group_command_status(group, fb->command);
        cm1e_fb_polled(fb, status.state, status.error);
        break;
    case FB_STEP_NONE: break;
    }
    return cm1e_fb_outputs(fb);
}

cm1e_group_t *cm1e_fb_group_enable(cm1e_fb_private_t *fb, const AXES_GROUP_REF_t *reference, BOOL enable)
{
    return cm1e_fb_enable_on(fb, &a_group, reference ? &reference->Handle : NULL, enable);
}
