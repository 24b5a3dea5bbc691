#include "sim/bridge_app.h"

/* "Wait for 5 Cycles of PDO Sending" (BR appendix 1): a controlword counts when it has come this often, and it is a
 * cycle on the way. */
enum { SENT_CYCLES = 3 };

/* The high byte of the controlword, and of the statusword (BR 7.1.2, 7.1.3). */
enum {
    MOTOR_FREE = 0xF1, MOTOR_ENABLE = 0xF2, ORIGIN_SEARCH = 0xF3, RESET_COUNTER = 0xF4, SEARCH_ABORT = 0xF6,
    SEARCH_COMPLETED = 0xF8, SEARCH_TIME_OUT = 0xF9,
};
enum { READY = 0x0007, CPIO = 0xC, CPIO_POSITION_CONTROL = 0x0F };

/* "Wait for 5 cycles of PDO sending" (BR appendix 1, 2): the controlword is there long enough. */
static bool word_is_sent(const cm1e_sim_bridge_axis_t *axis) { return axis->same_words >= SENT_CYCLES; }

bool cm1e_sim_bridge_line_is_free(const cm1e_sim_bridge_axis_t *axis)
{
    return axis->controlword == 0 && word_is_sent(axis);
}

/* ---- CMD -------------------------------------------------------------------------------------------------------- */

static void execute(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, uint8_t command)
{
    axis->answer = command;
    switch (command) {
    case MOTOR_FREE:
        cm1e_sim_bridge_search_abort(axis);
        cm1e_sim_bridge_axis_power(axis, false);
        break;
    case MOTOR_ENABLE: /* it also ends an error of the motor, as "(" of CML does */
        axis->error = 0;
        cm1e_sim_bridge_axis_power(axis, true);
        break;
    case ORIGIN_SEARCH:
        if (axis->motor_free)
            axis->answer = 0; /* no search is possible, so no answer comes */
        else
            cm1e_sim_bridge_search_begin(bridge, axis);
        break;
    case RESET_COUNTER:
        cm1e_sim_bridge_axis_zero(axis);
        break;
    case SEARCH_ABORT:
        cm1e_sim_bridge_search_abort(axis);
        break;
    default:
        axis->answer = 0;
        break;
    }
}

/* 0007h for long enough, then the command for long enough: then it is carried out, once. */
void cm1e_sim_bridge_command_outputs(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    const uint16_t word = axis->controlword;
    const bool is_free = word == (MOTOR_FREE << 8 | READY) || word == MOTOR_FREE << 8; /* the guide has both */
    if (axis->same_words != SENT_CYCLES)
        return;
    if (word == READY) {
        axis->armed = true;
        if (!cm1e_sim_search_running(&axis->search))
            axis->answer = 0;
    } else if (axis->armed && (is_free || (word & 0xFF) == READY)) {
        axis->armed = false;
        if (!axis->unplugged)
            execute(bridge, axis, (uint8_t)(word >> 8));
    }
}

void cm1e_sim_bridge_command_step(cm1e_sim_bridge_axis_t *axis)
{
    if (axis->answer != ORIGIN_SEARCH)
        return;
    if (axis->search.phase == SEARCH_DONE) {
        axis->answer = SEARCH_COMPLETED;
    } else if (axis->search_failed || axis->error) {
        axis->answer = SEARCH_TIME_OUT;
    }
}

uint16_t cm1e_sim_bridge_command_status(const cm1e_sim_bridge_axis_t *axis) { return (uint16_t)(axis->answer << 8); }

/* ---- CPIO ------------------------------------------------------------------------------------------------------- */

/* Ignores a word of another mode. Bits 4 to 7 are outputs here, not a new set-point or a fault reset. */
void cm1e_sim_bridge_cpio_outputs(cm1e_sim_bridge_axis_t *axis)
{
    if (axis->controlword >> 12 != CPIO)
        return;
    axis->outputs = (uint8_t)(axis->controlword >> 4 & 0x0F & cm1e_bridge_output_mask(axis->motor));
    cm1e_sim_bridge_axis_obey(axis, axis->controlword & CPIO_POSITION_CONTROL);
}

uint16_t cm1e_sim_bridge_cpio_status(const cm1e_sim_bridge_axis_t *axis)
{
    const unsigned inputs = cm1e_sim_bridge_inputs_of(axis), status = cm1e_sim_bridge_motor_status(axis);
    const unsigned state = cm1e_sim_bridge_state_bits(axis);
    return (uint16_t)(CPIO << 12 | (status & 0x0F) << 8 | (inputs & 0x0F) << 4 | (state & 0x0F));
}
