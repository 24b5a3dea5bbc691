#include "device/bridge_status.h"

#include <stdio.h>

enum { ERRORS = BRIDGE_STATUS_POSITION_OVERFLOW | BRIDGE_STATUS_OVER_SPEED | BRIDGE_STATUS_OVERLOAD };

/* BR 7.4. A status is taken apart from the top: a row with several bits is one thing when all of them are there, and
 * explains them. The cures are ours. */
static const struct {
    uint8_t bits;
    const char *name[2]; /* CM1, CM2; NULL: not in its table */
    const char *cure;    /* NULL: no error */
} rows[] = {
    {BRIDGE_STATUS_SERIAL_ERROR, {"serial communication error", "serial communication error"},
     "check the cable between bridge and motor, its connectors and length, and the supply; then reset the fault"},
    {BRIDGE_STATUS_POSITION_OVERFLOW, {"counter overflow", "position error overflow"},
     "look for a blocked axis, reduce load or acceleration, or retune the motor; then reset the fault"},
    {BRIDGE_STATUS_OVER_SPEED, {"over speed or regenerative current", "over speed or regenerative voltage"},
     "command less speed and less deceleration, and check for a load that drives the motor; then reset the fault"},
    {BRIDGE_STATUS_OVERLOAD, {"overload", "overload"},
     "reduce load, friction or acceleration, or use a larger motor; then reset the fault"},
    {BRIDGE_STATUS_PUSH | BRIDGE_STATUS_IN_POSITION, {"end of push mode", "push motion completed"}, NULL},
    {BRIDGE_STATUS_IN_POSITION, {"in position", "in position"}, NULL},
    {BRIDGE_STATUS_MOTOR_FREE, {"motor free", "motor free"}, NULL},
    {BRIDGE_STATUS_PUSH, {"in push mode", "in push motion"}, NULL},
    {BRIDGE_STATUS_OVER_CURRENT, {NULL, "power module over-current"},
     "switch the motor's power off and look for a short circuit; if it comes back, replace the motor"},
    {BRIDGE_STATUS_TEMPERATURE, {"temperature alarm", "temperature alarm"},
     "let the motor cool down, improve the cooling or reduce the load; then reset the fault"},
};
enum { ROWS = sizeof rows / sizeof *rows };

static const char *name_of(int row, cm1e_bridge_motor_t motor) { return rows[row].name[motor == CM1E_BRIDGE_CM2]; }

/* Whether the row is part of what is still unexplained, which it explains then. */
static bool takes(int row, cm1e_bridge_motor_t motor, uint32_t *rest)
{
    const uint32_t bits = rows[row].bits;
    if (!name_of(row, motor) || (*rest & bits) != bits)
        return false;
    *rest &= ~bits;
    return true;
}

/* "x" in the guide's patterns: the three errors of the lowest bits can be there together, and nothing else can. */
bool cm1e_bridge_status_is_listed(cm1e_bridge_motor_t motor, uint32_t status)
{
    for (int i = 0; i < ROWS; i++)
        if (name_of(i, motor) && status == rows[i].bits)
            return true;
    return status <= ERRORS;
}

static size_t append(char *text, size_t size, size_t length, const char *word)
{
    if (length < size)
        length += (size_t)snprintf(text + length, size - length, "%s%s", length ? ", " : "", word);
    return length;
}

const char *cm1e_bridge_status_text(cm1e_bridge_motor_t motor, uint32_t status, char *text, size_t size)
{
    if (!text)
        size = 0;
    size_t length = status ? 0 : append(text, size, 0, "running");
    uint32_t rest = status;
    for (int i = 0; i < ROWS; i++)
        if (takes(i, motor, &rest))
            length = append(text, size, length, name_of(i, motor));
    if (rest) {
        char unknown[32];
        snprintf(unknown, sizeof unknown, "unknown bits 0x%02X", (unsigned)rest);
        length = append(text, size, length, unknown);
    }
    if (!cm1e_bridge_status_is_listed(motor, status) && length < size)
        snprintf(text + length, size - length, " (0x%02X is not listed in the guide)", (unsigned)status);
    return text;
}

const char *cm1e_bridge_status_cure(cm1e_bridge_motor_t motor, uint32_t status)
{
    uint32_t rest = status;
    for (int i = 0; i < ROWS; i++)
        if (takes(i, motor, &rest) && rows[i].cure)
            return rows[i].cure;
    return rest ? "look it up in the motor's guide, and reset the fault" : "";
}

const char *cm1e_bridge_mode_name(int8_t mode)
{
    switch (mode) {
    case CM1E_BRIDGE_MODE_CSP: return "csp";
    case CM1E_BRIDGE_MODE_HM: return "hm";
    case CM1E_BRIDGE_MODE_CML: return "CML";
    case CM1E_BRIDGE_MODE_CMD: return "CMD";
    case CM1E_BRIDGE_MODE_CPIO: return "CPIO";
    default: return NULL;
    }
}

uint32_t cm1e_bridge_bits_per_second(uint32_t baud_rate) { return baud_rate == 6 ? 176800 : 0; }

bool cm1e_bridge_status_is_error(cm1e_bridge_motor_t motor, uint32_t status)
{
    return cm1e_bridge_status_cure(motor, status)[0] != 0;
}

bool cm1e_bridge_status_is_moving(cm1e_bridge_motor_t motor, uint32_t status)
{
    return !cm1e_bridge_status_is_error(motor, status) &&
           (status & (BRIDGE_STATUS_IN_POSITION | BRIDGE_STATUS_MOTOR_FREE)) == 0;
}
