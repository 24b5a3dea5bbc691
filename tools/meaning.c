#include "meaning.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/codes.h"
#include "device/bridge_status.h"
#include "device/devices.h"

typedef struct list {
    meaning_t *rows;
    size_t count, room;
    bool full;
} list_t;

static const struct {
    cm1e_error_t error;
    const char *when;
    const char *blocks; /* "*": of nearly all */
} notes[] = {
#define ERROR_NOTE(name, when, blocks) {CM1E_##name, when, blocks},
#include "error_notes.inc"
#undef ERROR_NOTE
};
enum { NOTES = sizeof notes / sizeof notes[0] };

static meaning_t *add(list_t *list, uint32_t code, int digits, const char *clause)
{
    if (list->count == list->room) {
        const size_t room = list->room ? 2 * list->room : 512;
        meaning_t *rows = realloc(list->rows, room * sizeof *rows);
        if (!rows) {
            list->full = true;
            return NULL;
        }
        list->rows = rows;
        list->room = room;
    }
    meaning_t *row = &list->rows[list->count++];
    *row = (meaning_t){.code = code, .digits = digits, .clause = clause};
    return row;
}

/* ---- the tables -------------------------------------------------------------------------------------------------- */

static const char *effect_of(const cm1e_device_error_t *error)
{
    if (!error->fault)
        return error->code == 0 ? NULL : "none: it is a state, not a fault";
    return error->fault_only_when_enabled ? "from Operation enabled only, the drive goes to Fault"
                                          : "the drive goes to Fault (statusword bit 3)";
}

static void add_errors_of(list_t *list, const cm1e_device_drive_t *drive)
{
    for (uint32_t code = 0; code <= UINT16_MAX; code++) {
        const cm1e_device_error_t *error = drive->error((uint16_t)code);
        meaning_t *row = error ? add(list, code, 4, drive->error_clause) : NULL;
        if (!row)
            continue;
        snprintf(row->whose, sizeof row->whose, "error code of a %s (object 0x603F)", drive->name);
        snprintf(row->text, sizeof row->text, "%s", error->text);
        row->cause = error->cause;
        row->effect = effect_of(error);
        row->cure = error->cure;
        if (error->fault)
            snprintf(row->page, sizeof row->page, "docs/blocks/MC_Reset.md");
    }
}

static void add_device_errors(list_t *list)
{
    const cm1e_device_t *device;
    for (size_t n = 0; (device = cm1e_device_number(n)) != NULL; n++) {
        const cm1e_device_drive_t *drive = device->drives[0];
        if (drive && drive->error && drive->error_clause)
            add_errors_of(list, drive);
    }
}

static void set_pages(meaning_t *row, const char *blocks)
{
    if (strcmp(blocks, "*") == 0) {
        snprintf(row->page, sizeof row->page, "docs/FUNCTION-BLOCKS.md");
        return;
    }
    size_t length = 0;
    for (const char *at = blocks; *at && length < sizeof row->page; at += strspn(at, " ")) {
        const int bytes = (int)strcspn(at, " ");
        length += (size_t)snprintf(row->page + length, sizeof row->page - length, "%sdocs/blocks/%.*s.md",
                                   length ? ", " : "", bytes, at);
        at += bytes;
    }
}

static void add_error_ids(list_t *list)
{
    size_t count;
    const cm1e_error_row_t *errors = cm1e_error_rows(&count);
    for (size_t i = 0; i < count; i++) {
        meaning_t *row = errors[i].error != CM1E_OK ? add(list, cm1e_error_id(errors[i].error), 4, NULL) : NULL;
        if (!row)
            continue;
        snprintf(row->whose, sizeof row->whose, "ErrorID of this library's function blocks (error %d)",
                 errors[i].error);
        snprintf(row->text, sizeof row->text, "%s", errors[i].text);
        row->error = errors[i].error;
        row->name = errors[i].name;
        row->cure = cm1e_error_cure(errors[i].error);
        for (int n = 0; n < NOTES; n++)
            if (notes[n].error == errors[i].error) {
                row->cause = notes[n].when;
                set_pages(row, notes[n].blocks);
            }
    }
}

static void add_codes(list_t *list, const cm1e_code_t *codes, size_t count, int digits, const char *whose,
                      const char *clause)
{
    for (size_t i = 0; i < count; i++) {
        meaning_t *row = add(list, codes[i].code, digits, clause);
        if (!row)
            return;
        snprintf(row->whose, sizeof row->whose, "%s", whose);
        snprintf(row->text, sizeof row->text, "%s", codes[i].text);
        row->cure = codes[i].cure;
    }
}

static void add_statuses(list_t *list)
{
    static const char *const names[] = {[CM1E_BRIDGE_CM1] = "CM1", [CM1E_BRIDGE_CM2] = "CM2"};
    for (uint32_t status = 0; status <= UINT8_MAX; status++)
        for (cm1e_bridge_motor_t motor = CM1E_BRIDGE_CM1; motor <= CM1E_BRIDGE_CM2; motor++) {
            meaning_t *row = cm1e_bridge_status_is_listed(motor, status)
                                 ? add(list, status, 2, CM1E_BRIDGE_STATUS_CLAUSE) : NULL;
            if (!row)
                continue;
            snprintf(row->whose, sizeof row->whose,
                     "status of a %s behind a bridge (CML ?99, objects 0xF530:05 ... 08)",
                     names[motor]);
            cm1e_bridge_status_text(motor, status, row->text, sizeof row->text);
            row->cure = cm1e_bridge_status_cure(motor, status);
            row->effect = row->cure[0] ? "an error of the motor" : "none: it is a state, not an error";
            snprintf(row->page, sizeof row->page, "docs/BRIDGE.md");
        }
}

meaning_t *all_meanings(size_t *count)
{
    list_t list = {0};
    size_t codes;
    add_device_errors(&list);
    add_error_ids(&list);
    const cm1e_code_t *rows = cm1e_al_status_codes(&codes);
    add_codes(&list, rows, codes, 4, "AL status code of an EtherCAT slave (register 0x0134)", CM1E_AL_STATUS_CLAUSE);
    rows = cm1e_sdo_abort_codes(&codes);
    add_codes(&list, rows, codes, 8, "SDO abort code of a slave", CM1E_SDO_ABORT_CLAUSE);
    rows = cm1e_foe_error_codes(&codes);
    add_codes(&list, rows, codes, 4, "error code of FoE, files of a slave", CM1E_FOE_ERROR_CLAUSE);
    add_statuses(&list);
    if (list.full) {
        free(list.rows);
        return NULL;
    }
    *count = list.count;
    return list.rows;
}
