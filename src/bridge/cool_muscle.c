/*
 * What a motor behind a bridge does beside motion: strings in CML, modes of operation, commands of CMD. They are
 * accepted only while the axis is Disabled and no torque is commanded. MC_Power switches from CML back to the axis's
 * own mode, CSP or CPIO. From CMD there is no way back to those modes (BR 6).
 *
 * A string or a command may move the motor without our set-points. So the motor is freed (its torque is taken away)
 * when CML is left, when the axis fails, when the slave was offline, and at the end of the run. The axis is no longer
 * homed if a command may have changed what the motor's counts mean.
 */
#include "bridge/cool_muscle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "axis/axis_commands.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "cm1e/cml.h"
#include "core/clock.h"
#include "device/cml_command.h"
#include "drive/drive_bridge.h"

/* The last request of one kind. The block that made it polls it by its ticket. */
typedef struct asked {
    uint32_t ticket;            /* 0: there was no request yet */
    cm1e_command_state_t state;
    cm1e_error_t error;
} asked_t;

/* The state of these functions for one axis. */
struct cool_muscle {
    int8_t mode, next;          /* the mode that is commanded while the axis is Disabled; the mode requested after it */
    bool insist;
    bool moved;                 /* a string since CML was entered may have moved the motor */
    bool must_free;             /* the motor has to lose its torque before anything else */
    bool failed;                /* the axis was in ErrorStop in the last cycle */
    bool away;                  /* the slave was offline, and its mode is not known yet */
    uint32_t freeing;           /* ticket of the string that frees the motor; 0: none is under way */
    uint32_t unsaid[CM1E_DRIVE_CML_QUEUE]; /* tickets of strings of blocks whose end is not reported yet; 0: none */
    int64_t release_ns;         /* when the wait for the shut-down began; 0: no wait */
    asked_t switching, command;
    const char *why;            /* the reason of the last refusal, as a sentence, or `said`; NULL: none */
    char said[CM1E_CML_BYTES + 1]; /* what the motor answered then */
    char text[CM1E_CML_BYTES + 1]; /* the string that was refused last */
};
typedef struct cool_muscle cool_muscle_t;

enum { K37 = 37 };
static const int64_t release_ns = 2000 * MS_IN_NS;

static const char abnormal[] = "From CMD and CPIO the way to CML and back ends in abnormal operation (BR 6 note 2): "
                               "CM_SetMode goes that way with Insist only";
static const char no_way_to_power[] = "No way leads from CMD to a mode of motion: switch the bridge off and on, or "
                                      "go by CML with CM_SetMode and Insist";
static const char not_in_cmd[] = "Commands need CMD mode: CM_SetMode leads there, and the only way back is to switch "
                                 "the bridge off and on";
static const char not_in_cpio[] = "Homing begins in CSP only: home first, then switch to CPIO";
static const char keeps_k37[] = "writes K37, which would change what the counts of a running axis mean. Write it "
                                "with cm1e cml while nothing runs, and state it in the bus file";

static cm1e_drive_cml_t *cml_of(const cm1e_axis_t *axis)
{
    return axis->drive.behind ? &axis->drive.behind->cml : NULL;
}

/* ---- what may be asked for --------------------------------------------------------------------------------------- */

static cm1e_error_t refuse(cm1e_axis_t *axis, cm1e_error_t error, const char *why, const char *text)
{
    cm1e_axis_set_refusal(axis, error);
    if (axis->muscle) {
        axis->muscle->why = why;
        const size_t size = text ? strnlen(text, sizeof axis->muscle->text - 1) : 0;
        if (text)
            memcpy(axis->muscle->text, text, size); /* the text of the error is made outside the cycle */
        axis->muscle->text[size] = '\0';
    }
    return error;
}

static bool is_quiet(const cm1e_axis_t *axis)
{
    return axis->state == CM1E_AXIS_DISABLED && axis_free(axis) && !axis->power.enable &&
           !axis->drive.torque.asked && !axis->power.shutting_down;
}

/* In ErrorStop the mode is not switched, but a motor that is in CML already accepts strings: they can ask for the
 * cause. */
static cm1e_error_t check(const cm1e_axis_t *axis, bool string)
{
    if (!axis->muscle)
        return cm1e_drive_is_virtual(&axis->drive) ? CM1E_ERROR_AXIS_VIRTUAL : CM1E_ERROR_CM_NO_BRIDGE;
    const bool shown = axis->drive.feedback.mode == CM1E_BRIDGE_MODE_CML && axis->muscle->mode == axis->muscle->next;
    if (axis->state == CM1E_AXIS_ERROR_STOP && !(string && shown && axis_free(axis)))
        return CM1E_ERROR_AXIS_ERROR_STOP;
    if (axis->state != CM1E_AXIS_ERROR_STOP && !is_quiet(axis))
        return CM1E_ERROR_CM_NOT_DISABLED;
    return cm1e_drive_operational(&axis->drive) ? CM1E_OK : CM1E_ERROR_AXIS_OFFLINE;
}

static cm1e_error_t check_mode(const cm1e_axis_t *axis, cm1e_bridge_mode_t mode, bool insist, const char **why)
{
    const cm1e_error_t error = cm1e_drive_mode_check(&axis->drive, (cm1e_mode_t)mode, insist, why);
    return error == CM1E_ERROR_STATE ? CM1E_ERROR_CM_MODE : error;
}

static bool writes_k37(const char *text)
{
    do {
        const cm1e_cml_command_t command = cm1e_cml_next(&text);
        if (command.sign == 'K' && command.valued && command.number == K37)
            return true;
    } while (text);
    return false;
}

static cm1e_error_t check_string(const cm1e_axis_t *axis, const char *text, bool allow_motion, const char **why)
{
    *why = cm1e_cml_check(text, axis->config->channel);
    if (!*why && writes_k37(text))
        *why = keeps_k37;
    if (*why)
        return CM1E_ERROR_CML_STRING;
    if (cm1e_cml_kind(text) == CM1E_CML_MOTION && !allow_motion)
        return CM1E_ERROR_CML_MOTION;
    if (axis->muscle->next == CM1E_BRIDGE_MODE_CML)
        return CM1E_OK;
    const bool dead_end = axis->muscle->next == CM1E_BRIDGE_MODE_CMD || axis->muscle->next == CM1E_BRIDGE_MODE_CPIO;
    *why = abnormal;
    return dead_end ? CM1E_ERROR_CM_MODE : check_mode(axis, CM1E_BRIDGE_MODE_CML, false, why);
}

/* ---- CML --------------------------------------------------------------------------------------------------------- */

/* In ErrorStop the axis tells of its error. */
static void end_switching(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    asked_t *switching = &axis->muscle->switching;
    if (switching->state != CM1E_COMMAND_ACTIVE)
        return;
    switching->state = state;
    switching->error = error;
    if (error != CM1E_OK && axis->state != CM1E_AXIS_ERROR_STOP)
        refuse(axis, error, NULL, "CM_SetMode");
}

static uint32_t *place_of(cool_muscle_t *muscle, uint32_t ticket)
{
    return &muscle->unsaid[ticket % CM1E_DRIVE_CML_QUEUE];
}

/* Whether the string at the place of this ticket has failed, and the axis has not said why yet: it does in its step. */
static bool is_unsaid(const cm1e_axis_t *axis, uint32_t ticket)
{
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(cml_of(axis), *place_of(axis->muscle, ticket));
    return request && request->state == CM1E_DRIVE_CML_ERROR;
}

cm1e_error_t cm1e_axis_cml_send(cm1e_axis_t *axis, const char *text, size_t size, int64_t timeout_ns, bool allow_motion,
                                uint32_t *ticket)
{
    char copy[CM1E_CML_BYTES + 2] = ""; /* one more than may be, so that too long a one is seen to be so */
    const char *why = NULL;
    *ticket = 0;
    memcpy(copy, text, strnlen(text, size < sizeof copy - 1 ? size : sizeof copy - 1));
    cm1e_error_t error = check(axis, true);
    if (error == CM1E_OK)
        error = check_string(axis, copy, allow_motion, &why);
    if (error == CM1E_OK && is_unsaid(axis, cml_of(axis)->next))
        error = CM1E_ERROR_FULL;
    if (error == CM1E_OK)
        error = cm1e_drive_cml_send(cml_of(axis), copy, timeout_ns, ticket);
    if (error != CM1E_OK)
        return refuse(axis, error, why, copy);
    cool_muscle_t *muscle = axis->muscle;
    cm1e_axis_set_refusal(axis, CM1E_OK);
    *place_of(muscle, *ticket) = *ticket;
    if (muscle->next != CM1E_BRIDGE_MODE_CML)
        end_switching(axis, CM1E_COMMAND_ABORTED, CM1E_ERROR_CANCELLED);
    muscle->next = CM1E_BRIDGE_MODE_CML;
    if (cm1e_cml_kind(copy) == CM1E_CML_MOTION) {
        muscle->moved = true;
        cm1e_axis_set_homed(axis, false);
    }
    return CM1E_OK;
}

cm1e_axis_cml_t cm1e_axis_cml_state(const cm1e_axis_t *axis, uint32_t ticket)
{
    static const cm1e_command_state_t states[] = {
        [CM1E_DRIVE_CML_FORGOTTEN] = CM1E_COMMAND_UNKNOWN, [CM1E_DRIVE_CML_WAITING] = CM1E_COMMAND_BUFFERED,
        [CM1E_DRIVE_CML_ACTIVE] = CM1E_COMMAND_ACTIVE, [CM1E_DRIVE_CML_DONE] = CM1E_COMMAND_DONE,
        [CM1E_DRIVE_CML_ERROR] = CM1E_COMMAND_ERROR,
    };
    const cm1e_drive_cml_t *cml = cml_of(axis);
    const cm1e_drive_cml_request_t *request = cml ? cm1e_drive_cml_request(cml, ticket) : NULL;
    if (!request)
        return (cm1e_axis_cml_t){.state = CM1E_COMMAND_UNKNOWN};
    /* The answer has come in this cycle: the block shows the error when the axis says why. */
    const bool unsaid = ticket == *place_of(axis->muscle, ticket) && is_unsaid(axis, ticket);
    return (cm1e_axis_cml_t){unsaid ? CM1E_COMMAND_ACTIVE : states[request->state], request->error, request->lines,
                             request->strays};
}

const char *cm1e_axis_cml_line(const cm1e_axis_t *axis, uint32_t ticket, unsigned line)
{
    const cm1e_drive_cml_t *cml = cml_of(axis);
    const cm1e_drive_cml_request_t *request = cml ? cm1e_drive_cml_request(cml, ticket) : NULL;
    if (request && request->error == CM1E_ERROR_CML_ANSWER && line == 0)
        return request->first;
    return request ? cm1e_drive_cml_line(cml, ticket, line) : NULL;
}

/* ---- modes ------------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_axis_set_mode(cm1e_axis_t *axis, cm1e_bridge_mode_t mode, bool insist, uint32_t *ticket)
{
    const char *why = NULL;
    *ticket = 0;
    cm1e_error_t error = check(axis, false);
    if (error == CM1E_OK)
        error = check_mode(axis, mode, insist, &why);
    if (error != CM1E_OK)
        return refuse(axis, error, why, NULL);
    cool_muscle_t *muscle = axis->muscle;
    cm1e_axis_set_refusal(axis, CM1E_OK);
    end_switching(axis, CM1E_COMMAND_ABORTED, CM1E_ERROR_CANCELLED); /* that of another block */
    muscle->next = (int8_t)mode;
    muscle->insist = insist;
    *ticket = ++muscle->switching.ticket;
    muscle->switching.state = CM1E_COMMAND_ACTIVE;
    return CM1E_OK;
}

/* The state of a request. A request that a later one has replaced is aborted. */
static cm1e_command_state_t state_of(const asked_t *asked, uint32_t ticket, cm1e_error_t *error)
{
    const bool mine = ticket != 0 && asked->ticket == ticket;
    *error = mine ? asked->error : CM1E_OK;
    return mine ? asked->state : CM1E_COMMAND_ABORTED;
}

cm1e_command_state_t cm1e_axis_set_mode_state(const cm1e_axis_t *axis, uint32_t ticket, cm1e_error_t *error)
{
    return state_of(&axis->muscle->switching, ticket, error);
}

static bool is_mode(int8_t mode)
{
    return mode == CM1E_BRIDGE_MODE_CSP || mode == CM1E_BRIDGE_MODE_CML || mode == CM1E_BRIDGE_MODE_CMD ||
           mode == CM1E_BRIDGE_MODE_CPIO;
}

/* Ends a switch of the mode when the bridge shows the new mode. In ErrorStop the switch is given up, and the mode that
 * the bridge shows is taken over. */
static void follow_switch(cm1e_axis_t *axis)
{
    cool_muscle_t *muscle = axis->muscle;
    const int8_t shown = axis->drive.feedback.mode;
    if (axis->state == CM1E_AXIS_ERROR_STOP && muscle->switching.state == CM1E_COMMAND_ACTIVE)
        end_switching(axis, CM1E_COMMAND_ERROR, axis->fault.error);
    if (axis->state == CM1E_AXIS_ERROR_STOP && is_mode(shown))
        muscle->next = muscle->mode = shown;
    if (shown != muscle->next || muscle->mode != muscle->next)
        return;
    if (shown == CM1E_BRIDGE_MODE_CSP || shown == CM1E_BRIDGE_MODE_CPIO)
        axis->mode = (cm1e_mode_t)shown;
    end_switching(axis, CM1E_COMMAND_DONE, CM1E_OK);
}

/* A bridge that was offline may come back in another mode: after power-on it is in CSP (BR 6). The mode that it shows
 * is taken over, so that it is not led into CMD again without a new request. No mode is commanded until it shows one.
 * If it shows the mode of a homing that was broken off, the switch to the requested mode goes on. */
static void follow_return(cm1e_axis_t *axis)
{
    cool_muscle_t *muscle = axis->muscle;
    const int8_t shown = axis->drive.feedback.mode;
    muscle->away = muscle->away || !cm1e_drive_operational(&axis->drive);
    /* Its mode comes by its mailbox, also while other slaves are missing in the frames: `shown` may be older then. */
    const bool known = axis->drive.change.known && axis->drive.feedback.fresh && shown != CM1E_MODE_NONE;
    if (!muscle->away || !cm1e_drive_operational(&axis->drive) || !known)
        return;
    muscle->away = false;
    if (!is_mode(shown))
        return;
    if (shown != muscle->next)
        end_switching(axis, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_OFFLINE);
    muscle->next = muscle->mode = shown; /* also where a string that would free the motor waits for CML */
}

/* ---- CMD --------------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_axis_motor_command(cm1e_axis_t *axis, cm1e_drive_cmd_t command, int64_t timeout_ns, uint32_t *ticket)
{
    *ticket = 0;
    cm1e_error_t error = !axis->muscle       ? CM1E_ERROR_CM_NO_BRIDGE
                         : timeout_ns > CM1E_DRIVE_LONGEST_NS ? CM1E_ERROR_INVALID_ARGUMENT
                                                   : cm1e_drive_cmd_start(&axis->drive, command, timeout_ns);
    if (error == CM1E_ERROR_STATE)
        error = CM1E_ERROR_CM_MODE;
    if (error != CM1E_OK)
        return refuse(axis, error, error == CM1E_ERROR_CM_MODE ? not_in_cmd : NULL, NULL);
    cm1e_axis_set_refusal(axis, CM1E_OK);
    if (command == CM1E_DRIVE_CMD_ORIGIN_SEARCH || command == CM1E_DRIVE_CMD_RESET_COUNTER)
        cm1e_axis_set_homed(axis, false);
    *ticket = ++axis->muscle->command.ticket;
    axis->muscle->command.state = CM1E_COMMAND_ACTIVE;
    return CM1E_OK;
}

cm1e_command_state_t cm1e_axis_motor_command_state(const cm1e_axis_t *axis, uint32_t ticket, cm1e_error_t *error)
{
    return state_of(&axis->muscle->command, ticket, error);
}

static void follow_command(cm1e_axis_t *axis)
{
    asked_t *command = &axis->muscle->command;
    const cm1e_drive_cmd_state_t state = cm1e_drive_cmd_state(&axis->drive);
    if (command->state != CM1E_COMMAND_ACTIVE || cm1e_drive_cmd_busy(state))
        return;
    command->error = state == CM1E_DRIVE_CMD_DONE              ? CM1E_OK
                     : state == CM1E_DRIVE_CMD_NOT_SENT        ? CM1E_ERROR_CM_COMMAND
                     : state == CM1E_DRIVE_CMD_SEARCH_TIME_OUT ? CM1E_ERROR_CM_SEARCH
                     : state == CM1E_DRIVE_CMD_GIVEN_UP        ? CM1E_ERROR_CM_SEARCH_TIMEOUT
                                                               : CM1E_ERROR_AXIS_OFFLINE;
    command->state = command->error != CM1E_OK ? CM1E_COMMAND_ERROR : CM1E_COMMAND_DONE;
    if (command->error != CM1E_OK)
        refuse(axis, command->error, NULL, NULL);
}

/* ---- every cycle ------------------------------------------------------------------------------------------------- */

static void end_strings(cm1e_axis_t *axis, cm1e_error_t error)
{
    cool_muscle_t *muscle = axis->muscle;
    cm1e_drive_cml_cancel_all(cml_of(axis), error);
    muscle->must_free = muscle->moved;
    muscle->freeing = 0;
}

/* Whether a string that may move the motor waits. */
static bool motion_waits(const cm1e_axis_t *axis)
{
    for (int i = 0; i < CM1E_DRIVE_CML_QUEUE; i++) {
        const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(cml_of(axis), axis->muscle->unsaid[i]);
        if (request && cm1e_cml_kind(request->text) == CM1E_CML_MOTION)
            return true;
    }
    return false;
}

/* Sends the string that frees the motor, until it was answered. In a mode other than CML no motion by CML goes on, so
 * the motor need not be freed there. */
static void free_step(cm1e_axis_t *axis)
{
    cool_muscle_t *muscle = axis->muscle;
    char text[8];
    const int8_t shown = axis->drive.feedback.mode;
    if (!muscle->must_free)
        return;
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(cml_of(axis), muscle->freeing);
    if (muscle->freeing == 0) {
        if (cm1e_drive_operational(&axis->drive))
            cm1e_drive_cml_send(cml_of(axis), cm1e_drive_cml_motor_free(cml_of(axis), text), 0, &muscle->freeing);
    } else if (!request || request->state == CM1E_DRIVE_CML_ERROR) {
        muscle->freeing = 0; /* it is sent again in the next cycle */
    } else if (request->state == CM1E_DRIVE_CML_DONE) {
        muscle->must_free = false;
        muscle->moved = motion_waits(axis);
    }
    if (shown != CM1E_BRIDGE_MODE_CML && is_mode(shown))
        muscle->must_free = muscle->moved = false;
}

/* Reports the end of a string. If it may have moved the motor and failed, the motor is freed, and the strings that wait
 * behind it end too: the axis has its reason. */
static void follow_string(cm1e_axis_t *axis, uint32_t *ticket)
{
    cool_muscle_t *muscle = axis->muscle;
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(cml_of(axis), *ticket);
    if (*ticket == 0 || (request && request->state < CM1E_DRIVE_CML_DONE))
        return;
    *ticket = 0;
    if (!request || request->state != CM1E_DRIVE_CML_ERROR)
        return;
    const bool said = request->error == CM1E_ERROR_CML_ANSWER || request->error == CM1E_ERROR_CM_SEARCH;
    memcpy(muscle->said, request->first, sizeof muscle->said);
    refuse(axis, request->error, said ? muscle->said : NULL, request->text);
    if (!request->sent || cm1e_cml_kind(request->text) != CM1E_CML_MOTION)
        return;
    end_strings(axis, CM1E_ERROR_CANCELLED);
    memset(muscle->unsaid, 0, sizeof muscle->unsaid);
}

static void follow_strings(cm1e_axis_t *axis)
{
    for (int i = 0; i < CM1E_DRIVE_CML_QUEUE; i++)
        follow_string(axis, &axis->muscle->unsaid[i]);
}

/* Whether the motor is in the axis's own mode, or on the way to it, so that it may be enabled. */
static bool is_home(const cm1e_axis_t *axis)
{
    const cool_muscle_t *muscle = axis->muscle;
    return muscle->mode == (int8_t)axis->mode && muscle->next == (int8_t)axis->mode;
}

static bool leads_home(const cm1e_axis_t *axis)
{
    return cm1e_drive_mode_check(&axis->drive, axis->mode, axis->muscle->insist, NULL) == CM1E_OK;
}

static void step(cm1e_axis_t *axis)
{
    cool_muscle_t *muscle = axis->muscle;
    const int8_t cml = CM1E_BRIDGE_MODE_CML;
    const bool failed = axis->state == CM1E_AXIS_ERROR_STOP;
    follow_command(axis);
    follow_return(axis);
    muscle->release_ns = axis->power.shutting_down ? muscle->release_ns : 0;
    if ((axis->power.enable || axis->power.shutting_down) && !failed && muscle->next == cml && leads_home(axis)) {
        end_switching(axis, CM1E_COMMAND_ABORTED, CM1E_ERROR_CANCELLED);
        muscle->next = (int8_t)axis->mode;
    }
    const bool away = muscle->moved && !muscle->must_free && !cm1e_drive_operational(&axis->drive);
    const bool leaves = muscle->next != cml && !muscle->must_free; /* also if CML was not reached yet */
    if ((failed && !muscle->failed) || away || (leaves && (muscle->moved || !cm1e_drive_cml_idle(cml_of(axis)))))
        end_strings(axis, failed ? axis->fault.error : away ? CM1E_ERROR_BUS_LOST : CM1E_ERROR_CANCELLED);
    follow_strings(axis); /* a string that has just been ended too: the block shows it in the next cycle */
    muscle->failed = failed;
    free_step(axis);
    if (muscle->mode != cml || (!muscle->must_free && cm1e_drive_cml_idle(cml_of(axis))))
        muscle->mode = muscle->next;
    follow_switch(axis);
    if (axis_free(axis) && !drive_moves(axis)) {
        axis->drive.command.mode = muscle->away ? CM1E_MODE_NONE : (cm1e_mode_t)muscle->mode;
        axis->drive.command.mode_insist = muscle->insist;
    }
}

static cm1e_error_t refuses_power(cm1e_axis_t *axis)
{
    if (axis->state != CM1E_AXIS_DISABLED || is_home(axis) || axis->muscle->away)
        return CM1E_OK;
    const int8_t next = axis->muscle->next;
    if (next == CM1E_BRIDGE_MODE_CMD || (next == CM1E_BRIDGE_MODE_CML && !leads_home(axis)))
        return refuse(axis, CM1E_ERROR_CM_MODE, no_way_to_power, NULL);
    return CM1E_OK;
}

static cm1e_error_t refuses_homing(cm1e_axis_t *axis)
{
    if ((int8_t)axis->mode != CM1E_BRIDGE_MODE_CPIO)
        return CM1E_OK;
    axis->muscle->why = not_in_cpio;
    return CM1E_ERROR_CM_MODE;
}

static bool released(cm1e_axis_t *axis)
{
    cool_muscle_t *muscle = axis->muscle;
    if (muscle->release_ns == 0)
        muscle->release_ns = axis->now_ns;
    const bool commands = cm1e_drive_cmd_release(&axis->drive);
    const bool strings = !muscle->must_free && !muscle->moved && cm1e_drive_cml_idle(cml_of(axis));
    return (commands && strings) || axis->now_ns - muscle->release_ns >= release_ns ||
           !cm1e_drive_operational(&axis->drive);
}

/* ---- words ------------------------------------------------------------------------------------------------------- */

static bool text_of(const cm1e_axis_t *axis, cm1e_error_t error, char *text, size_t size)
{
    const cool_muscle_t *muscle = axis->muscle;
    const char *const name = axis->config->name, *const why = muscle->why ? muscle->why : "";
    const char *const mode = cm1e_drive_mode_name(&axis->drive, axis->drive.feedback.mode);
    switch (error) {
    case CM1E_ERROR_CML_STRING:
        snprintf(text, size, "Axis \"%s\": the CML string \"%s\" %s.", name, muscle->text, why);
        return true;
    case CM1E_ERROR_CML_MOTION:
        snprintf(text, size, "Axis \"%s\": the CML string \"%s\" may move the motor, change its power or what its "
                 "positions mean, or is not known: it is sent only if AllowMotion is TRUE.", name, muscle->text);
        return true;
    case CM1E_ERROR_CANCELLED:
        snprintf(text, size, "Axis \"%s\": \"%s\" was cancelled by MC_Power, by CM_SetMode, by CM_SendCML or by "
                 "the end of the run.", name, muscle->text);
        return muscle->text[0] != '\0';
    case CM1E_ERROR_CML_TIMEOUT:
    case CM1E_ERROR_CM_SEARCH_TIMEOUT:
        snprintf(text, size, "Axis \"%s\": %s%s%s%s.", name, cm1e_strerror(error), muscle->text[0] ? ": \"" : "",
                 muscle->text, muscle->text[0] ? "\"" : "");
        return true;
    case CM1E_ERROR_CML_ANSWER:
    case CM1E_ERROR_CM_SEARCH:
        snprintf(text, size, "Axis \"%s\": %s%s%s%s.", name, cm1e_strerror(error), why[0] ? "; it said \"" : "", why,
                 why[0] ? "\"" : "");
        return true;
    case CM1E_ERROR_CM_MODE:
        snprintf(text, size, "Axis \"%s\": the motor is in %s. %s.", name, mode ? mode : "another mode", why);
        return true;
    case CM1E_ERROR_CM_NOT_DISABLED:
        snprintf(text, size, "Axis \"%s\", %s: %s. Set MC_Power.Enable to FALSE first.", name,
                 cm1e_axis_state_name(axis->state), cm1e_strerror(error));
        return true;
    default: return false;
    }
}

/* ---- at the axis ------------------------------------------------------------------------------------------------- */

static void forget(cm1e_axis_t *axis) { free(axis->muscle); }

typedef union muscle_copy {
    cool_muscle_t muscle;
    uint64_t words[1]; /* what comes behind it is aligned */
} muscle_copy_t;

static void copy_own(const cm1e_axis_t *axis, cm1e_axis_t *copy, void *place)
{
    cool_muscle_t *muscle = place;
    *muscle = *axis->muscle;
    if (axis->muscle->why == axis->muscle->said)
        muscle->why = muscle->said;
    copy->muscle = muscle;
}

static const motor_hooks_t hooks = {forget, step, is_home, refuses_power, refuses_homing, released, text_of,
                                    {sizeof(muscle_copy_t), copy_own}};

cm1e_error_t cm1e_cool_muscle_add(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    if (!axis->drive.behind)
        return CM1E_OK;
    axis->muscle = calloc(1, sizeof *axis->muscle);
    if (!axis->muscle)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for axis \"%s\".", axis->config->name);
    axis->muscle->mode = axis->muscle->next = (int8_t)axis->mode;
    axis->motor_hooks = &hooks;
    return CM1E_OK;
}
