#include <stdio.h>

#include "description/check_private.h"

/* Compares mapping objects (0x1600 ..., 0x1A00 ...), assignment objects (0x1C12, 0x1C13) and start-up commands with the
 * PDOs. */

enum { ASSIGNMENT_BASE = 0x1C10, ROWS_MAX = 254 };
enum { FIRST_MAPPING = 0x1600, LAST_RX_MAPPING = 0x17FF, FIRST_TX_MAPPING = 0x1A00, LAST_MAPPING = 0x1BFF };

/* Rows of a mapping or an assignment object, by default or as start-up commands leave them. */
typedef struct rows {
    uint32_t at[ROWS_MAX];
    unsigned count;          /* as stated, may exceed the array */
    cm1e_place_t place;      /* of the count */
    cm1e_place_t places[ROWS_MAX];
    bool given[ROWS_MAX];
} rows_t;

/* false: they are not stated, or not all. */
static bool default_rows(const cm1e_check_t *check, uint16_t object, rows_t *rows)
{
    uint32_t count;
    if (!cm1e_check_default(check, object, 0, &count, &rows->place) || count == 0)
        return false;
    rows->count = count;
    for (unsigned k = 0; k < count && k < ROWS_MAX; k++) {
        if (!cm1e_check_default(check, object, (uint8_t)(k + 1), &rows->at[k], &rows->places[k]))
            return false;
        rows->given[k] = rows->at[k] != 0; /* which the device fills in */
    }
    return true;
}

static bool all_given(const rows_t *rows)
{
    for (unsigned k = 0; k < rows->count && k < ROWS_MAX; k++)
        if (!rows->given[k])
            return false;
    return true;
}

/* ---- mapping ----------------------------------------------------------------------------------------------------- */

typedef struct mapped {
    uint16_t index;
    uint8_t subindex;
    uint32_t bits;
    bool depends_on_slot;
    cm1e_place_t place;
    size_t row;
} mapped_t;

/* Gaps may be cut differently on both sides: neighbours count as one. false: the end. */
static bool next_of_pdo(const cm1e_described_pdo_t *pdo, size_t *row, mapped_t *mapped)
{
    if (*row >= pdo->entries.count)
        return false;
    const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[*row];
    *mapped = (mapped_t){entry->index, entry->index ? entry->subindex : 0, entry->bits, entry->depends_on_slot,
                         entry->place, (*row)++};
    while (mapped->index == 0 && *row < pdo->entries.count && pdo->entries.at[*row].index == 0)
        mapped->bits += pdo->entries.at[(*row)++].bits;
    return true;
}

static bool next_of_rows(const rows_t *rows, size_t *row, mapped_t *mapped)
{
    if (*row >= rows->count || *row >= ROWS_MAX)
        return false;
    const uint32_t value = rows->at[*row];
    const uint16_t index = (uint16_t)(value >> 16);
    *mapped = (mapped_t){index, index ? (uint8_t)(value >> 8) : 0, value & 0xFF, false, rows->places[*row], *row};
    ++*row;
    while (mapped->index == 0 && *row < rows->count && *row < ROWS_MAX && rows->at[*row] >> 16 == 0)
        mapped->bits += rows->at[(*row)++] & 0xFF;
    return true;
}

/* A module's mapping object may say the index of the first slot or that of its own. */
static bool is_same(const cm1e_check_t *check, const mapped_t *pdo, const mapped_t *row)
{
    const uint16_t increment = check->slot_index_increment;
    const bool moved = pdo->depends_on_slot && increment > 0 && row->index < pdo->index &&
                       (pdo->index - row->index) % increment == 0;
    return (pdo->index == row->index || moved) && pdo->subindex == row->subindex;
}

/* A PDO entry with another length than its object is reported as PDO_ENTRY_SIZE. */
static bool is_told_by_size(const cm1e_check_t *check, const mapped_t *pdo, const mapped_t *row)
{
    const cm1e_check_entry_t *found = cm1e_check_find_entry(check, pdo->index, pdo->subindex);
    return is_same(check, pdo, row) && found && found->entry->bits != pdo->bits && found->entry->bits == row->bits;
}

static const char *mapped_text(char *text, size_t room, const mapped_t *mapped)
{
    if (mapped->index == 0)
        snprintf(text, room, "a gap of %u bits", (unsigned)mapped->bits);
    else
        snprintf(text, room, "0x%04X:%02X with %u bits", mapped->index, mapped->subindex, (unsigned)mapped->bits);
    return text;
}

static void compare_mapping(const cm1e_check_t *check, cm1e_rule_t rule, const cm1e_described_pdo_t *pdo,
                            const rows_t *rows, const char *says)
{
    size_t in_pdo = 0, in_rows = 0;
    mapped_t of_pdo = {0}, of_row = {0};
    char pdo_text[48], row_text[48];
    for (;;) {
        const bool more = next_of_pdo(pdo, &in_pdo, &of_pdo), more_rows = next_of_rows(rows, &in_rows, &of_row);
        if (!more && !more_rows)
            return;
        if (more != more_rows) {
            cm1e_check_add(check, rule, rows->place, "0x%04X:00 %s %u objects; %s 0x%04X has %zu", pdo->index, says,
                           rows->count, cm1e_pdo_kind(pdo), pdo->index, pdo->entries.count);
            return;
        }
        if (is_told_by_size(check, &of_pdo, &of_row))
            continue;
        if (!is_same(check, &of_pdo, &of_row) || of_pdo.bits != of_row.bits) {
            cm1e_check_add(check, rule, of_row.place, "0x%04X:%02X %s %s; entry %zu of %s 0x%04X is %s", pdo->index,
                           (unsigned)of_row.row + 1, says, mapped_text(row_text, sizeof row_text, &of_row),
                           of_pdo.row + 1, cm1e_pdo_kind(pdo), pdo->index,
                           mapped_text(pdo_text, sizeof pdo_text, &of_pdo));
            return;
        }
    }
}

void cm1e_check_mapping_objects(const cm1e_check_t *check)
{
    rows_t rows = {0};
    for (size_t i = 0; i < check->device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &check->device->pdos.at[i];
        const bool master_maps = check->device->mailbox.pdo_config && !pdo->fixed;
        if (!pdo->is_virtual && !master_maps && cm1e_check_only_pdo(check, pdo->index) &&
            default_rows(check, pdo->index, &rows) && all_given(&rows))
            compare_mapping(check, CM1E_RULE_MAPPING_OBJECT, pdo, &rows, "maps by default");
    }
}

/* ---- assignment -------------------------------------------------------------------------------------------------- */

/* The PDOs that sync manager `n` carries, in the order of the file, beside those of `rows`. */
static void compare_assignment(const cm1e_check_t *check, cm1e_rule_t rule, int n, const rows_t *rows, const char *says)
{
    const cm1e_description_t *device = check->device;
    unsigned assigned = 0;
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        if (pdo->sync_manager != n || pdo->is_virtual)
            continue;
        const bool given = assigned < rows->count && assigned < ROWS_MAX && rows->given[assigned];
        if (given && rows->at[assigned] != pdo->index) {
            cm1e_check_add(check, rule, rows->places[assigned],
                           "0x%04X:%02X %s 0x%04X; by its Sm, PDO %u of sync manager %d is 0x%04X",
                           (unsigned)(ASSIGNMENT_BASE + n), assigned + 1, says, (unsigned)rows->at[assigned],
                           assigned + 1, n, pdo->index);
            return;
        }
        assigned++;
    }
    if (assigned != rows->count)
        cm1e_check_add(check, rule, rows->place, "0x%04X:00 %s %u PDO%s; sync manager %d has %u by their Sm",
                       (unsigned)(ASSIGNMENT_BASE + n), says, rows->count, rows->count == 1 ? "" : "s", n, assigned);
}

static bool is_process_data(const cm1e_check_t *check, size_t n)
{
    const cm1e_sync_manager_use_t use = check->device->sync_managers.at[n].use;
    return use == CM1E_SM_OUTPUTS || use == CM1E_SM_INPUTS;
}

void cm1e_check_assignment(const cm1e_check_t *check)
{
    rows_t rows = {0};
    for (size_t n = 0; n < check->device->sync_managers.count && n < 16; n++)
        if (is_process_data(check, n) && default_rows(check, (uint16_t)(ASSIGNMENT_BASE + n), &rows))
            compare_assignment(check, CM1E_RULE_ASSIGNMENT_OBJECT, (int)n, &rows, "is by default");
}

/* ---- start-up commands ------------------------------------------------------------------------------------------- */

static void set_row(rows_t *rows, unsigned subindex, uint32_t value, cm1e_place_t place)
{
    if (subindex == 0) {
        rows->count = value;
        rows->place = place;
    } else if (subindex <= ROWS_MAX) {
        rows->at[subindex - 1] = value;
        rows->places[subindex - 1] = place;
        rows->given[subindex - 1] = true;
    }
}

/* Complete access: sub-index 0 in 16 bits, then the rows (ETG.1000.6 5.6.2). */
static void set_rows(rows_t *rows, const cm1e_init_command_t *command, size_t row_bytes)
{
    size_t at = 0;
    if (command->subindex == 0) {
        if (command->data.size < 2)
            return;
        set_row(rows, 0, command->data.data[0], command->place);
        at = 2;
    }
    for (unsigned row = 1; row <= ROWS_MAX && at + row_bytes <= command->data.size; row++, at += row_bytes)
        set_row(rows, row, (uint32_t)cm1e_bytes_unsigned((cm1e_bytes_t){command->data.data + at, row_bytes}),
                command->place);
}

/* Contents of the object after all commands. Returns false if no command writes it, or if it stays empty for the
 * master. */
static bool commanded_rows(const cm1e_check_t *check, uint16_t object, size_t row_bytes, size_t first, rows_t *rows)
{
    const cm1e_description_t *device = check->device;
    *rows = (rows_t){0};
    for (size_t i = first; i < device->init_commands.count; i++) {
        const cm1e_init_command_t *command = &device->init_commands.at[i];
        if (command->index != object || command->data.size == 0)
            continue;
        if (command->complete_access)
            set_rows(rows, command, row_bytes);
        else
            set_row(rows, command->subindex, (uint32_t)cm1e_bytes_unsigned(command->data), command->place);
    }
    return rows->count > 0;
}

static void check_commanded(const cm1e_check_t *check, uint16_t object, size_t first)
{
    rows_t rows = {0};
    const size_t managers = check->device->sync_managers.count;
    if (object >= ASSIGNMENT_BASE && object < ASSIGNMENT_BASE + 16) {
        const size_t n = object - ASSIGNMENT_BASE;
        if (check->by_default && n < managers && is_process_data(check, n) &&
            commanded_rows(check, object, 2, first, &rows))
            compare_assignment(check, CM1E_RULE_ASSIGNMENT_COMMAND, (int)n, &rows, "becomes at start-up");
        return;
    }
    const cm1e_described_pdo_t *pdo = cm1e_check_only_pdo(check, object);
    if (pdo && commanded_rows(check, object, 4, first, &rows) && all_given(&rows))
        compare_mapping(check, CM1E_RULE_MAPPING_COMMAND, pdo, &rows, "maps after start-up");
}

static void check_process_data_commands(const cm1e_check_t *check)
{
    static const struct { uint16_t first, last; } ranges[] = {
        {FIRST_MAPPING, LAST_RX_MAPPING}, {FIRST_TX_MAPPING, LAST_MAPPING}, {ASSIGNMENT_BASE, ASSIGNMENT_BASE + 15}};
    bool seen[0x1000] = {false};
    for (size_t i = 0; i < check->device->init_commands.count; i++) {
        const uint16_t object = check->device->init_commands.at[i].index;
        for (size_t r = 0; r < sizeof ranges / sizeof ranges[0]; r++)
            if (object >= ranges[r].first && object <= ranges[r].last && !seen[object - 0x1000]) {
                seen[object - 0x1000] = true;
                check_commanded(check, object, i);
            }
    }
}

static void check_command_data(const cm1e_check_t *check, const cm1e_init_command_t *command,
                               const cm1e_described_entry_t *entry)
{
    char value[32], least[32], most[32];
    const size_t bytes = ((size_t)entry->bits + 7) / 8;
    const uint16_t code = cm1e_type_code(entry->type ? entry->type : "");
    const bool may_be_shorter = code == 0 || (code >= 0x09 && code <= 0x0B);
    if (command->data.size == 0 || entry->bits == 0)
        return;
    if (command->data.size > bytes || (command->data.size < bytes && !may_be_shorter))
        cm1e_check_add(check, CM1E_RULE_INIT_COMMAND_SIZE, command->place,
                       "the start-up command writes %zu byte%s to 0x%04X:%02X, which has %u bits, %zu byte%s",
                       command->data.size, command->data.size == 1 ? "" : "s", command->index, command->subindex,
                       (unsigned)entry->bits, bytes, bytes == 1 ? "" : "s");
    else if (!cm1e_check_within_range(entry, command->data))
        cm1e_check_add(check, CM1E_RULE_INIT_COMMAND_RANGE, command->place,
                       "the start-up command writes %s to 0x%04X:%02X; its range is %s to %s",
                       cm1e_check_value_text(value, sizeof value, entry, command->data), command->index,
                       command->subindex,
                       entry->minimum.size ? cm1e_check_value_text(least, sizeof least, entry, entry->minimum) : "any",
                       entry->maximum.size ? cm1e_check_value_text(most, sizeof most, entry, entry->maximum) : "any");
}

static void check_command(const cm1e_check_t *check, const cm1e_init_command_t *command, bool silent)
{
    const cm1e_check_entry_t *found = cm1e_check_find_entry(check, command->index, command->subindex);
    if (command->complete_access && check->device->mailbox.coe && !check->device->mailbox.complete_access)
        cm1e_check_add(check, CM1E_RULE_INIT_COMMAND_COMPLETE_ACCESS, command->place,
                       "the start-up command writes all of 0x%04X at once, but the device does not announce complete "
                       "access",
                       command->index);
    if (!check->has_dictionary)
        return;
    if (!found && !silent && !(command->complete_access && cm1e_check_find_object(check, command->index)))
        cm1e_check_add(check, CM1E_RULE_INIT_COMMAND_OBJECT, command->place,
                       "the start-up command writes 0x%04X:%02X, which is not in the dictionary", command->index,
                       command->subindex);
    if (!found || command->complete_access)
        return;
    if ((found->entry->access & (CM1E_ACCESS_READ | CM1E_ACCESS_WRITE)) == CM1E_ACCESS_READ)
        cm1e_check_add(check, CM1E_RULE_INIT_COMMAND_READ_ONLY, command->place,
                       "the start-up command writes 0x%04X:%02X, which is read-only", command->index,
                       command->subindex);
    check_command_data(check, command, found->entry);
}

void cm1e_check_init_commands(const cm1e_check_t *check)
{
    for (size_t i = 0; i < check->device->init_commands.count; i++)
        check_command(check, &check->device->init_commands.at[i], check->silent_commands[i]);
    check_process_data_commands(check);
}
