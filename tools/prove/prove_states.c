/* EtherCAT states, and requests for states that are refused. The motor is disabled throughout. */
#include <stdio.h>
#include <string.h>

#include "cm1e/esc.h"
#include "core/bytes.h"
#include "description/sii_image.h"
#include "prove/prove.h"

enum { REG_AL_STATUS = 0x0130, REG_SM0 = 0x0800, REG_SM0_ACTIVATE = 0x0806, NO_STATE = 5 };
#define TIMEOUT_NS INT64_C(3000000000)

/** The codes are those of ETG.1000.6 table 11; the guides do not say which request gets which. */
static const struct {
    uint8_t from, to;
    uint16_t code; /* 0: it goes there */
} rows[] = {
    {CM1E_AL_INIT, CM1E_AL_SAFE_OP, 0x0011},   {CM1E_AL_INIT, CM1E_AL_OP, 0x0011},
    {CM1E_AL_INIT, NO_STATE, 0x0012},          {CM1E_AL_INIT, CM1E_AL_PRE_OP, 0x0016},
    {CM1E_AL_INIT, CM1E_AL_PRE_OP, 0},         {CM1E_AL_PRE_OP, CM1E_AL_OP, 0x0011},
    {CM1E_AL_PRE_OP, CM1E_AL_BOOT, 0x0011},    {CM1E_AL_PRE_OP, CM1E_AL_SAFE_OP, 0x001D},
    {CM1E_AL_PRE_OP, CM1E_AL_INIT, 0},
};
enum { ROW_WITHOUT_MAILBOX = 3, ROW_OPERATIONAL = 9 };

static bool request(prove_t *prove, uint8_t state, cm1e_al_answer_t *answer)
{
    cm1e_diag_t diag = {0};
    if (cm1e_esc_request_state(prove->bus, prove->position, state, TIMEOUT_NS, answer, &diag) == CM1E_OK)
        return true;
    prove_note(prove, "%.300s", diag.text);
    return false;
}

static bool switch_mailbox(prove_t *prove, bool on)
{
    const uint8_t value = on;
    return cm1e_esc_write(prove->bus, prove->position, REG_SM0_ACTIVATE, &value, 1, NULL) == CM1E_OK;
}

static void walk(prove_t *prove, int row)
{
    cm1e_al_answer_t answer;
    char thing[48], state[40], wanted[40];
    if (!prove_scan(prove) || (rows[row].from == CM1E_AL_INIT && !request(prove, CM1E_AL_INIT, &answer)))
        return;
    if (row == ROW_WITHOUT_MAILBOX && !switch_mailbox(prove, false))
        return;
    if (request(prove, rows[row].to, &answer)) {
        const uint16_t expected = rows[row].code ? rows[row].from | CM1E_AL_ERROR : rows[row].to;
        snprintf(wanted, sizeof wanted, "%s", al_state_name(expected, state, sizeof state));
        prove_compare(prove, "state", wanted, al_state_name(answer.state, state, sizeof state));
        snprintf(thing, sizeof thing, "AL status code");
        prove_compare_code(prove, "al_status", thing, rows[row].code, answer.code);
    }
    if (row == ROW_WITHOUT_MAILBOX)
        switch_mailbox(prove, true);
    prove_scan(prove);
}

/* ---- Bootstrap --------------------------------------------------------------------------------------------------- */

/** The mailboxes of Bootstrap, as the EEPROM has them (ETG.1000.6 5.4). */
static bool set_boot_mailboxes(prove_t *prove)
{
    for (unsigned n = 0; n < 2; n++) {
        const uint8_t *place = prove->sii + CM1E_SII_BOOTSTRAP + 4 * n;
        const uint8_t manager[8] = {place[0], place[1], place[2], place[3], n == 0 ? 0x26 : 0x22, 0, 1, 0};
        if (prove->sii_size < CM1E_SII_BOOTSTRAP + CM1E_SII_BOOTSTRAP_BYTES || cm1e_get_uint(place + 2, 2) == 0) {
            prove_note(prove, "the EEPROM names no mailboxes for Bootstrap");
            return false;
        }
        if (cm1e_esc_write(prove->bus, prove->position, (uint16_t)(REG_SM0 + 8 * n), manager, 8, NULL) != CM1E_OK)
            return false;
    }
    return true;
}

static void compare_state(prove_t *prove, const char *thing, uint16_t expected, const cm1e_al_answer_t *answer)
{
    char wanted[40], found[40];
    const char *name = al_state_name(expected, wanted, sizeof wanted);
    prove_compare(prove, thing, name, al_state_name(answer->state, found, sizeof found));
}

/** No file is sent: the device keeps what it has. A loss of its power in Bootstrap loses nothing. */
void look_boot(prove_t *prove, const point_t *point)
{
    cm1e_al_answer_t answer = {0};
    if (prove_scan(prove) && request(prove, CM1E_AL_INIT, &answer) && set_boot_mailboxes(prove) &&
        request(prove, CM1E_AL_BOOT, &answer)) {
        compare_state(prove, "Init to Bootstrap", CM1E_AL_BOOT, &answer);
        if (point->row == BOOT_PREOP && answer.state == CM1E_AL_BOOT && request(prove, CM1E_AL_PRE_OP, &answer)) {
            compare_state(prove, "Bootstrap to Pre-Operational", CM1E_AL_BOOT | CM1E_AL_ERROR, &answer);
            prove_compare_code(prove, "al_status", "AL status code", 0x0011, answer.code);
        }
    }
    if (request(prove, CM1E_AL_INIT, &answer))
        compare_state(prove, "Bootstrap to Init", CM1E_AL_INIT, &answer);
    const cm1e_slave_info_t before = *prove->slave;
    if (prove_scan(prove))
        prove_compare(prove, "firmware", before.software_version, prove->slave->software_version);
}

/** Nobody commands the axes: their outputs are zeros, and the controlword 0 enables nothing. */
static void walk_to_operational(prove_t *prove)
{
    cm1e_diag_t diag = {0};
    if (!prove_scan(prove))
        return;
    const bool started = cm1e_bus_identify(prove->bus, &diag) == CM1E_OK
                         && cm1e_bus_configure(prove->bus, &diag) == CM1E_OK
                         && cm1e_bus_operate(prove->bus, &diag) == CM1E_OK;
    prove_compare(prove, "start", "Operational", started ? "Operational" : diag.text);
    if (started)
        cm1e_bus_stop(prove->bus);
    prove_scan(prove);
}

void look_state(prove_t *prove, const point_t *point)
{
    if (point->row == ROW_OPERATIONAL)
        walk_to_operational(prove);
    else
        walk(prove, point->row);
}

bool prove_is_at_rest(prove_t *prove)
{
    uint8_t status[2] = {0};
    cm1e_diag_t diag = {0};
    if (cm1e_esc_read(prove->bus, 0, REG_AL_STATUS, status, sizeof status, &diag) != CM1E_OK) {
        fail(&diag);
        return false;
    }
    if ((status[0] & CM1E_AL_OP) == 0)
        return true;
    complain("a slave is in Operational: another master operates the network, and a motor may be enabled. End that "
             "master first");
    return false;
}
