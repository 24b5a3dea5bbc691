/* The state diagram of PLCopen Part 4: state x trigger. GroupHoming has no command in this version. */
#include "group/group_private.h"

#define REFUSED(why) {.refusal = CM1E_ERROR_GROUP_##why}
#define TO(state) {.refusal = CM1E_OK, .next = CM1E_GROUP_##state}

/* MC_GroupDisable and MC_UngroupAllAxes are accepted in every state. GroupStopping accepts another MC_GroupStop only
 * when no MC_GroupStop holds it (group_command.c). MC_GroupReset outside GroupErrorStop changes nothing, like
 * MC_Reset. */
static const group_rule_t rules[CM1E_GROUP_STATE_COUNT][TRIGGER_COUNT] = {
    [CM1E_GROUP_DISABLED] = {
        [TRIGGER_CONFIGURE] = TO(DISABLED),
        [TRIGGER_ENABLE] = TO(STANDBY),
        [TRIGGER_DISABLE] = TO(DISABLED),
        [TRIGGER_RESET] = TO(DISABLED),
        [TRIGGER_MOVE] = REFUSED(DISABLED),
        [TRIGGER_HALT] = REFUSED(DISABLED),
        [TRIGGER_INTERRUPT] = REFUSED(DISABLED),
        [TRIGGER_STOP] = REFUSED(DISABLED),
        [TRIGGER_AT_REST] = TO(DISABLED),
        [TRIGGER_FAIL] = TO(DISABLED),
    },
    [CM1E_GROUP_STANDBY] = {
        [TRIGGER_CONFIGURE] = REFUSED(STATE),
        [TRIGGER_ENABLE] = TO(STANDBY),
        [TRIGGER_DISABLE] = TO(DISABLED),
        [TRIGGER_RESET] = TO(STANDBY),
        [TRIGGER_MOVE] = TO(MOVING),
        [TRIGGER_HALT] = TO(STANDBY),
        [TRIGGER_INTERRUPT] = REFUSED(STATE),
        [TRIGGER_STOP] = TO(STOPPING),
        [TRIGGER_AT_REST] = TO(STANDBY),
        [TRIGGER_FAIL] = TO(ERROR_STOP),
    },
    [CM1E_GROUP_MOVING] = {
        [TRIGGER_CONFIGURE] = REFUSED(STATE),
        [TRIGGER_ENABLE] = REFUSED(STATE),
        [TRIGGER_DISABLE] = TO(DISABLED),
        [TRIGGER_RESET] = TO(MOVING),
        [TRIGGER_MOVE] = TO(MOVING),
        [TRIGGER_HALT] = TO(MOVING),
        [TRIGGER_INTERRUPT] = TO(MOVING),
        [TRIGGER_STOP] = TO(STOPPING),
        [TRIGGER_AT_REST] = TO(STANDBY),
        [TRIGGER_FAIL] = TO(ERROR_STOP),
    },
    [CM1E_GROUP_STOPPING] = {
        [TRIGGER_CONFIGURE] = REFUSED(STOPPING),
        [TRIGGER_ENABLE] = REFUSED(STOPPING),
        [TRIGGER_DISABLE] = TO(DISABLED),
        [TRIGGER_RESET] = TO(STOPPING),
        [TRIGGER_MOVE] = REFUSED(STOPPING),
        [TRIGGER_HALT] = REFUSED(STOPPING),
        [TRIGGER_INTERRUPT] = REFUSED(STOPPING),
        [TRIGGER_STOP] = TO(STOPPING),
        [TRIGGER_AT_REST] = TO(STANDBY),
        [TRIGGER_FAIL] = TO(ERROR_STOP),
    },
    [CM1E_GROUP_ERROR_STOP] = {
        [TRIGGER_CONFIGURE] = REFUSED(ERROR_STOP),
        [TRIGGER_ENABLE] = REFUSED(ERROR_STOP),
        [TRIGGER_DISABLE] = TO(DISABLED),
        [TRIGGER_RESET] = TO(STANDBY),
        [TRIGGER_MOVE] = REFUSED(ERROR_STOP),
        [TRIGGER_HALT] = REFUSED(ERROR_STOP),
        [TRIGGER_INTERRUPT] = REFUSED(ERROR_STOP),
        [TRIGGER_STOP] = REFUSED(ERROR_STOP),
        [TRIGGER_AT_REST] = TO(ERROR_STOP),
        [TRIGGER_FAIL] = TO(ERROR_STOP),
    },
};

static const char *const names[CM1E_GROUP_STATE_COUNT] = {
    [CM1E_GROUP_DISABLED] = "GroupDisabled",
    [CM1E_GROUP_STANDBY] = "GroupStandby",
    [CM1E_GROUP_MOVING] = "GroupMoving",
    [CM1E_GROUP_STOPPING] = "GroupStopping",
    [CM1E_GROUP_ERROR_STOP] = "GroupErrorStop",
};

const group_rule_t *cm1e_group_rule(cm1e_group_state_t state, group_trigger_t trigger)
{
    return &rules[state][trigger];
}

const char *cm1e_group_state_name(cm1e_group_state_t state)
{
    return (unsigned)state < CM1E_GROUP_STATE_COUNT ? names[state] : "unknown";
}
