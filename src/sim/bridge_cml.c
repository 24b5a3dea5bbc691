#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/bridge_app.h"

enum { LINE_NS = 8000000 }; /* the lines of a list come one by one */
enum { K_FIRST = 21, K_RESOLUTION = 37, K_LAST = 99, QUERY_LIST = 90, QUERY_POSITION = 96, QUERY_STATUS = 99 };

static const char nothing[] = "Null\r\n";

/* ---- answers ---------------------------------------------------------------------------------------------------- */

/* An answer without a free place is lost. */
static void answer(cm1e_sim_bridge_axis_t *axis, int64_t due_ns, const char *name, int64_t value)
{
    cm1e_sim_cml_t *cml = &axis->cml;
    if (cml->count == CML_LINES)
        return;
    cml_line_t *line = &cml->lines[(cml->first + cml->count++) % CML_LINES];
    line->due_ns = due_ns;
    snprintf(line->text, sizeof line->text, "%s.%u=%lld\r\n", name, axis->number + 1u, (long long)value);
}

static bool has_k(const cm1e_sim_bridge_t *bridge, const cm1e_sim_bridge_axis_t *axis, long number)
{
    if (number < K_FIRST || number > K_LAST)
        return false;
    const uint16_t index = (uint16_t)(OBJ_60F6_K_PARAMETERS + CM1E_BRIDGE_INDEX_INCREMENT * axis->number);
    return cm1e_bridge_entry(bridge->model, index, (uint8_t)(number - K_FIRST + 1))->availability != CM1E_NO_PARAMETER;
}

static void answer_k(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, int64_t due_ns, unsigned number)
{
    char name[12];
    snprintf(name, sizeof name, "K%u", number);
    answer(axis, due_ns, name, *cm1e_sim_bridge_k(bridge, axis->number, number));
}

/* The next line of a list, as soon as what came before has been read. */
static void continue_list(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    cm1e_sim_cml_t *cml = &axis->cml;
    if (cml->count > 0 || cml->list_next == 0)
        return;
    answer_k(bridge, axis, cml->list_due_ns, cml->list_next);
    cml->list_due_ns += LINE_NS;
    do
        cml->list_next++;
    while (cml->list_next <= K_LAST && !has_k(bridge, axis, cml->list_next));
    if (cml->list_next > K_LAST)
        cml->list_next = 0;
}

const char *cm1e_sim_bridge_cml_read(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    cm1e_sim_cml_t *cml = &axis->cml;
    continue_list(bridge, axis);
    const cml_line_t *line = &cml->lines[cml->first];
    if (cml->count == 0 || bridge->now_ns < line->due_ns)
        return nothing;
    cml->first = (cml->first + 1) % CML_LINES;
    cml->count--;
    return line->text;
}

/* ---- commands --------------------------------------------------------------------------------------------------- */

static void query(cm1e_sim_bridge_axis_t *axis, int64_t due_ns, long number)
{
    if (number == QUERY_STATUS) {
        answer(axis, due_ns, "Ux", cm1e_sim_bridge_motor_status(axis));
    } else if (number == QUERY_POSITION) {
        answer(axis, due_ns, "Px", cm1e_sim_bridge_position(axis));
    } else if (number == QUERY_LIST) {
        axis->cml.list_next = K_FIRST;
        axis->cml.list_due_ns = due_ns;
    }
}

static void set_output(cm1e_sim_bridge_axis_t *axis, long number, bool on)
{
    const unsigned bit = number >= 1 && number <= 4 ? 1u << (number - 1) & cm1e_bridge_output_mask(axis->motor) : 0;
    axis->outputs = (uint8_t)(on ? axis->outputs | bit : axis->outputs & ~bit);
}

/* Without power there is no search, and the state is the answer. */
static void search(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, int64_t due_ns)
{
    if (axis->motor_free) {
        answer(axis, due_ns, "Ux", cm1e_sim_bridge_motor_status(axis));
        return;
    }
    cm1e_sim_bridge_search_begin(bridge, axis);
    axis->cml.searching = true;
}

static void take_k(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, int64_t due_ns, long number,
                   const char *value)
{
    if (!has_k(bridge, axis, number))
        return;
    if (*value != '=') {
        answer_k(bridge, axis, due_ns, (unsigned)number);
        return;
    }
    char *end;
    const long wanted = strtol(value + 1, &end, 10);
    const uint16_t index = (uint16_t)(OBJ_60F6_K_PARAMETERS + CM1E_BRIDGE_INDEX_INCREMENT * axis->number);
    const cm1e_entry_t *entry = cm1e_bridge_entry(bridge->model, index, (uint8_t)(number - K_FIRST + 1));
    const bool known = number != K_RESOLUTION || cm1e_bridge_position_limit(axis->motor, (int32_t)wanted) > 0;
    if (end != value + 1 && *end == '\0' && cm1e_sim_check_range(entry, wanted) == 0 && known)
        *cm1e_sim_bridge_k(bridge, axis->number, (unsigned)number) = wanted;
}

/* A command is a letter, optionally a number, ".ID" (BR 1.4: that of the connector) and "=value". A motor does not
 * answer what it does not understand, or what is for another motor. */
static void execute(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, int64_t due_ns, char *text)
{
    char *rest = text + 1;
    const long number = *rest >= '0' && *rest <= '9' ? strtol(rest, &rest, 10) : 0;
    if (*rest == '.' && strtol(rest + 1, &rest, 10) != axis->number + 1)
        return;
    if (*rest != '\0' && text[0] != 'K')
        return;
    switch (text[0]) {
    case 'K': take_k(bridge, axis, due_ns, number, rest); break;
    case '?': query(axis, due_ns, number); break;
    case 'O': set_output(axis, number, true); break;
    case 'F': set_output(axis, number, false); break;
    case '|': search(bridge, axis, due_ns); break;
    case '(':
        axis->error = 0;
        cm1e_sim_bridge_axis_power(axis, true);
        break;
    case ')':
        cm1e_sim_bridge_search_abort(axis);
        cm1e_sim_bridge_axis_power(axis, false);
        break;
    default: break;
    }
}

/* The serial line must not be busy: with controlwords (BR appendix 2: 0000h for five cycles first), or with the string
 * before. A string that comes then is lost, and so is one with CR or LF, which the bridge adds itself. */
uint32_t cm1e_sim_bridge_cml_write(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, const uint8_t *data,
                                   size_t size)
{
    char text[CM1E_CML_BYTES + 1] = "";
    if (size > CM1E_CML_BYTES)
        return SDO_ABORT_TOO_LONG;
    if (axis->mode != CM1E_BRIDGE_MODE_CML)
        return SDO_ABORT_STATE;
    const bool busy = bridge->now_ns < axis->cml.free_ns;
    /* Between two strings, which is also what the motor needs for one. */
    axis->cml.free_ns = bridge->now_ns + (size < CM1E_BRIDGE_CML_LONG_BYTES ? CM1E_BRIDGE_CML_SHORT_NS
                                                                            : CM1E_BRIDGE_CML_LONG_NS);
    memcpy(text, data, size);
    const unsigned broken = (busy ? CM1E_SIM_CML_TOO_SOON : 0u) |
                            (cm1e_sim_bridge_line_is_free(axis) ? 0u : CM1E_SIM_CML_LINE_BUSY) |
                            (strpbrk(text, "\r\n") ? CM1E_SIM_CML_LINE_END : 0u);
    axis->broken_rules |= broken;
    if (broken || axis->unplugged)
        return 0;
    for (char *next, *command = text; command; command = next) {
        next = strchr(command, ',');
        if (next)
            *next++ = '\0';
        if (*command)
            execute(bridge, axis, axis->cml.free_ns, command);
    }
    return 0;
}

/* *1 of BR appendix 2.4. */
void cm1e_sim_bridge_cml_step(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    if (!axis->cml.searching || cm1e_sim_search_running(&axis->search))
        return;
    axis->cml.searching = false;
    if (axis->search.phase == SEARCH_DONE)
        answer(axis, bridge->now_ns, "Origin", cm1e_sim_bridge_position(axis));
    else
        answer(axis, bridge->now_ns, "Ux", cm1e_sim_bridge_motor_status(axis));
}
