#include "sim/bridge_app.h"

enum { SWITCH_NS = 2000000 }; /* how long a switch takes is not stated */

static bool is_mode(int8_t mode)
{
    return mode == CM1E_BRIDGE_MODE_HM || mode == CM1E_BRIDGE_MODE_CSP || mode == CM1E_BRIDGE_MODE_CML ||
           mode == CM1E_BRIDGE_MODE_CMD || mode == CM1E_BRIDGE_MODE_CPIO;
}

/* The drawing of BR 6: hm from csp only, csp from hm and CML only, the other three from csp and from each other. */
static bool leads_to(int8_t from, int8_t to)
{
    switch (to) {
    case CM1E_BRIDGE_MODE_HM: return from == CM1E_BRIDGE_MODE_CSP || from == to;
    case CM1E_BRIDGE_MODE_CSP: return from == CM1E_BRIDGE_MODE_HM || from == CM1E_BRIDGE_MODE_CML || from == to;
    default: return from != CM1E_BRIDGE_MODE_HM;
    }
}

static bool moves(const cm1e_sim_bridge_axis_t *axis)
{
    return !cm1e_sim_bridge_axis_stands(axis) || cm1e_sim_search_running(&axis->search);
}

/* Appendix 3: in position, and no error, which the flow to CMD does not ask for. */
static unsigned obstacles(const cm1e_sim_bridge_axis_t *axis, int8_t to)
{
    const unsigned way = leads_to(axis->mode, to) ? 0 : CM1E_SIM_MODE_NO_WAY;
    if (to == CM1E_BRIDGE_MODE_CMD)
        return way;
    return way | (axis->error ? CM1E_SIM_MODE_IN_ERROR : 0u) | (moves(axis) ? CM1E_SIM_MODE_IN_MOTION : 0u);
}

void cm1e_sim_bridge_request_mode(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, int8_t value)
{
    const int8_t to = is_mode(value) ? value : CM1E_BRIDGE_MODE_CSP; /* BR 6.2.2 note 3 */
    const bool too_soon = bridge->now_ns < axis->mode_request_ns + CM1E_BRIDGE_MODE_INTERVAL_NS;
    const unsigned broken = obstacles(axis, to) | (too_soon ? CM1E_SIM_MODE_TOO_SOON : 0u);
    axis->mode_request_ns = bridge->now_ns;
    axis->broken_rules |= broken;
    if (broken)
        return;
    axis->next_mode = to;
    axis->mode_due_ns = bridge->now_ns + SWITCH_NS;
}

void cm1e_sim_bridge_mode_due(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    const int8_t from = axis->mode;
    if (bridge->now_ns < axis->mode_due_ns)
        return;
    axis->mode_due_ns = INT64_MAX;
    axis->mode = axis->next_mode;
    if (axis->mode == from)
        return;
    if (axis->mode != CM1E_BRIDGE_MODE_CPIO)
        axis->servo.reference_velocity = 0; /* in this mode no target moves the reference */
    if (axis->mode == CM1E_BRIDGE_MODE_HM)
        cm1e_sim_bridge_search_reset(axis);
    if (axis->mode == CM1E_BRIDGE_MODE_CMD || axis->mode == CM1E_BRIDGE_MODE_CPIO)
        axis->abnormal = true;
    if (axis->mode == CM1E_BRIDGE_MODE_CSP && axis->state == OPERATION_ENABLED)
        cm1e_sim_bridge_axis_begin_csp(axis);
}

void cm1e_sim_bridge_mode_reset(cm1e_sim_bridge_axis_t *axis)
{
    axis->mode = axis->next_mode = CM1E_BRIDGE_MODE_CSP;
    axis->abnormal = false;
    axis->mode_request_ns = INT64_MIN / 2;
    axis->mode_due_ns = INT64_MAX;
}
