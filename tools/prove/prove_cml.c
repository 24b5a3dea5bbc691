/* Modes of a motor behind a bridge, with the motor disabled: CML with queries and back, CPIO and CMD, which are dead
 * ends. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cm1e/cml.h"
#include "device/bridge_facts.h"
#include "prove/prove.h"
#include "which_slave.h"

enum { K_FIRST = 21, K_PROVED = 42, STATUS_QUERY = 99, SWITCH_READS = 40,
       SWITCH_PAUSE_US = 1000 };

/** The motor of the first axis that the bus file has behind this bridge; else the one at connector 1. */
static unsigned connector_of(const prove_t *prove)
{
    for (uint8_t channel = 1; channel <= CM1E_BRIDGE_AXES; channel++)
        if (find_axis_at(prove->bus, prove->config, prove->slave, channel) >= 0)
            return channel;
    return 1;
}

static bool read_number(prove_t *prove, uint16_t index, uint8_t subindex, bool is_signed, int64_t *value)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    cm1e_diag_t diag = {0};
    if (cm1e_sdo_read(prove->bus, prove->position, index, subindex, data, &size, &diag) != CM1E_OK) {
        prove_note(prove, "%.300s", diag.text);
        return false;
    }
    *value = prove_number_of(data, size, is_signed);
    return true;
}

/** Sends a query of one line. false: the answer is none, with a note. */
static bool ask(prove_t *prove, unsigned channel, const char *text, cm1e_cml_answer_t *answer)
{
    static cm1e_cml_exchange_t exchange;
    cm1e_diag_t diag = {0};
    char line[CM1E_CML_BYTES + 2];
    exchange = (cm1e_cml_exchange_t){.position = prove->position, .channel = (uint8_t)channel, .text = text};
    if (cm1e_cml_exchange(prove->bus, &exchange, &diag) != CM1E_OK || exchange.count == 0) {
        prove_note(prove, "%.300s", diag.text[0] ? diag.text : "the motor gives no answer");
        return false;
    }
    snprintf(line, sizeof line, "%s\n", exchange.lines[0]);
    return cm1e_cml_parse(answer, line, strlen(line)) == CM1E_OK;
}

static void compare_mode(prove_t *prove, unsigned channel, const char *thing, int mode)
{
    int64_t found;
    const uint16_t index = (uint16_t)(OBJ_6061_MODES_OF_OPERATION_DISPLAY +
                                      CM1E_BRIDGE_INDEX_INCREMENT * (channel - 1));
    if (read_number(prove, index, 0, true, &found))
        prove_compare_number(prove, thing, mode, found, 0);
}

static void compare_with_object(prove_t *prove, unsigned channel, int row, const char *text, int32_t told)
{
    int64_t value;
    const bool status = row == CML_STATUS;
    const uint16_t index = status ? OBJ_F530_SYSTEM_INFO
                                  : (uint16_t)(OBJ_60F6_K_PARAMETERS + CM1E_BRIDGE_INDEX_INCREMENT * (channel - 1));
    const uint8_t subindex = status ? CM1E_BRIDGE_STATUS_SUBINDEX(channel) : K_PROVED - K_FIRST + 1;
    if (read_number(prove, index, subindex, !status, &value))
        prove_compare_number(prove, text, value, told, 0);
}

void look_cml(prove_t *prove, const point_t *point)
{
    const unsigned channel = connector_of(prove);
    const bool status = point->row != CML_PARAMETER;
    cm1e_cml_answer_t answer = {0};
    cm1e_diag_t diag = {0};
    char text[16];
    snprintf(text, sizeof text, status ? "?%d.%u" : "K%d.%u", status ? STATUS_QUERY : K_PROVED, channel);
    if (point->row == CML_MODE)
        compare_mode(prove, channel, "mode before", CM1E_BRIDGE_MODE_CSP);
    const bool answered = ask(prove, channel, text, &answer);
    if (answered && point->row == CML_MODE) {
        compare_mode(prove, channel, "mode after a string", CM1E_BRIDGE_MODE_CML);
    } else if (answered) {
        prove_compare_number(prove, "kind of the answer", status ? CM1E_CML_STATUS : CM1E_CML_K, answer.what, 0);
        compare_with_object(prove, channel, point->row, text, answer.value);
    }
    if (cm1e_cml_leave(prove->bus, prove->position, (uint8_t)channel, false, &diag) != CM1E_OK)
        prove_note(prove, "%.300s", diag.text);
    else if (point->row == CML_MODE)
        compare_mode(prove, channel, "mode at the end", CM1E_BRIDGE_MODE_CSP);
}

static void switch_to(prove_t *prove, unsigned channel, int8_t mode, const char *thing, int expected)
{
    const uint16_t index = (uint16_t)(OBJ_6060_MODES_OF_OPERATION + CM1E_BRIDGE_INDEX_INCREMENT * (channel - 1));
    cm1e_diag_t diag = {0};
    if (cm1e_sdo_write(prove->bus, prove->position, index, 0, &mode, 1, &diag) != CM1E_OK) {
        prove_note(prove, "%.300s", diag.text);
        return;
    }
    /* 0x6060 is not written again before 5 ms have passed (BR 6.2.2 note 2). Virtual time passes only by transfers. */
    for (int n = 0; n < SWITCH_READS; n++) {
        int64_t unused;
        read_number(prove, index, 0, true, &unused);
        usleep(SWITCH_PAUSE_US);
    }
    compare_mode(prove, channel, thing, expected);
}

void look_dead_ends(prove_t *prove, const point_t *point)
{
    const unsigned channel = connector_of(prove);
    (void)point;
    compare_mode(prove, channel, "mode before", CM1E_BRIDGE_MODE_CSP);
    switch_to(prove, channel, CM1E_BRIDGE_MODE_CPIO, "csp to CPIO", CM1E_BRIDGE_MODE_CPIO);
    switch_to(prove, channel, CM1E_BRIDGE_MODE_CMD, "CPIO to CMD", CM1E_BRIDGE_MODE_CMD);
    switch_to(prove, channel, CM1E_BRIDGE_MODE_CSP, "CMD to csp", CM1E_BRIDGE_MODE_CMD);
    complain("the motor at connector %u is in CMD: switch the bridge off and on before it is used again", channel);
}
