/* Rules about the slaves of an ENI; those about frames and images are in eni_check_frames.c. */
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "device/devices.h"
#include "generate/eni.h"
#include "generate/eni_registers.h"

enum { STATIONS = 0x10000 };

/* ---- addresses -------------------------------------------------------------------------------------------------- */

static void check_addresses(cm1e_findings_t *findings, const cm1e_eni_t *document)
{
    cm1e_place_t *seen = calloc(STATIONS, sizeof *seen);
    findings->arena.failed |= !seen;
    for (size_t i = 0; seen && i < document->devices.count; i++) {
        const cm1e_eni_device_t *device = &document->devices.at[i];
        if (device->station == 0)
            cm1e_findings_add(findings, CM1E_RULE_ENI_STATION, device->place,
                              "%s has no PhysAddr; every slave needs a station address of its own.", device->name);
        else if (seen[device->station])
            cm1e_findings_add(findings, CM1E_RULE_ENI_STATION, device->place,
                              "%s has PhysAddr %u, which the slave in line %u has already.", device->name,
                              device->station, (unsigned)seen[device->station]);
        else
            seen[device->station] = device->place;
        const uint16_t expected = (uint16_t)(0x10000 - i);
        if (device->position_given && device->position != expected)
            cm1e_findings_add(findings, CM1E_RULE_ENI_POSITION, device->place,
                              "%s is slave %zu, so its AutoIncAddr is %u and not %u: they count down from 0.",
                              device->name, i + 1, expected, device->position);
    }
    free(seen);
}

static void check_previous_ports(cm1e_findings_t *findings, const cm1e_eni_t *document)
{
    bool *before = calloc(STATIONS, sizeof *before);
    findings->arena.failed |= !before;
    for (size_t i = 0; before && i < document->devices.count; i++) {
        const cm1e_eni_device_t *device = &document->devices.at[i];
        for (size_t p = 0; p < device->previous.count; p++) {
            const cm1e_eni_previous_port_t *previous = &device->previous.at[p];
            if (previous->station != CM1E_ENI_NOT_GIVEN && !before[previous->station])
                cm1e_findings_add(findings, CM1E_RULE_ENI_PREVIOUS_PORT, previous->place,
                                  "%s hangs on port %c of the slave with PhysAddr %d, but there is none before it.",
                                  device->name, previous->port, (int)previous->station);
        }
        before[device->station] = true;
    }
    free(before);
}

/* ---- InitCmds --------------------------------------------------------------------------------------------------- */

static void check_target(cm1e_findings_t *findings, const cm1e_eni_device_t *device, const cm1e_eni_command_t *command)
{
    const bool by_station = command->code >= CM1E_ENI_FPRD && command->code <= CM1E_ENI_FPRW;
    const bool by_position = command->code >= CM1E_ENI_APRD && command->code <= CM1E_ENI_APRW;
    if (by_station && command->adp != device->station)
        cm1e_findings_add(findings, CM1E_RULE_ENI_COMMAND_ADDRESS, command->place,
                          "A command of %s goes to station %u; its PhysAddr is %u.", device->name, command->adp,
                          device->station);
    if (by_position && device->position_given && command->adp != device->position)
        cm1e_findings_add(findings, CM1E_RULE_ENI_COMMAND_ADDRESS, command->place,
                          "A command of %s goes to position %u; its AutoIncAddr is %u.", device->name, command->adp,
                          device->position);
    if (command->code == CM1E_ENI_APWR && command->ado == STATION_ADDRESS && command->data.size == 2 &&
        cm1e_get_u16(command->data.data) != device->station)
        cm1e_findings_add(findings, CM1E_RULE_ENI_COMMAND_ADDRESS, command->place,
                          "%s is given the station address %u, but its PhysAddr is %u.", device->name,
                          cm1e_get_u16(command->data.data), device->station);
}

static void check_validation(cm1e_findings_t *findings, const cm1e_eni_command_t *command)
{
    if (!command->validates)
        return;
    if (command->expected.size == 0 || command->expected.size > command->length)
        cm1e_findings_add(findings, CM1E_RULE_ENI_VALIDATE, command->place,
                          "Validate compares %zu bytes with an answer of %u.", command->expected.size,
                          (unsigned)command->length);
    if (command->mask.size != 0 && command->mask.size != command->expected.size)
        cm1e_findings_add(findings, CM1E_RULE_ENI_VALIDATE, command->place,
                          "DataMask has %zu bytes, the Data of Validate have %zu; there has to be a bit for a bit.",
                          command->mask.size, command->expected.size);
}

/* A slave goes nowhere unless somebody asks it to; some masters do that without being told. */
static void check_start(cm1e_findings_t *findings, const cm1e_eni_device_t *device)
{
    static const struct {
        uint16_t transition;
        uint8_t state;
        const char *name;
    } steps[] = {{CM1E_ENI_IP, 2, "PREOP"}, {CM1E_ENI_PS, 4, "SAFEOP"}, {CM1E_ENI_SO, 8, "OP"}};
    for (size_t s = 0; s < sizeof steps / sizeof steps[0]; s++) {
        bool asked = false;
        for (size_t i = 0; i < device->commands.count; i++) {
            const cm1e_eni_command_t *command = &device->commands.at[i];
            asked |= (command->transitions & steps[s].transition) && command->ado == AL_CONTROL &&
                     command->data.size > 0 && (command->data.data[0] & 0x0F) == steps[s].state;
        }
        if (!asked)
            cm1e_findings_add(findings, CM1E_RULE_ENI_START, device->place,
                              "No InitCmd of %s asks it for %s (AL control, 0x0120).", device->name, steps[s].name);
    }
}

static void check_commands(cm1e_findings_t *findings, const cm1e_eni_t *document)
{
    for (size_t i = 0; i < document->commands.count; i++)
        check_validation(findings, &document->commands.at[i]);
    for (size_t d = 0; d < document->devices.count; d++) {
        const cm1e_eni_device_t *device = &document->devices.at[d];
        for (size_t i = 0; i < device->commands.count; i++) {
            check_target(findings, device, &device->commands.at[i]);
            check_validation(findings, &device->commands.at[i]);
        }
        check_start(findings, device);
    }
}

/* ---- sync managers ---------------------------------------------------------------------------------------------- */

static const cm1e_eni_sync_manager_t *find_manager(const cm1e_eni_device_t *device, unsigned number)
{
    for (size_t i = 0; i < device->sync_managers.count; i++)
        if (device->sync_managers.at[i].number == number)
            return &device->sync_managers.at[i];
    return NULL;
}

static void check_written_manager(cm1e_findings_t *findings, const cm1e_eni_device_t *device,
                                  const cm1e_eni_command_t *command, const cm1e_eni_sync_manager_t *manager)
{
    const uint16_t start = cm1e_get_u16(command->data.data), length = cm1e_get_u16(command->data.data + 2);
    uint32_t bits = 0;
    const bool known = cm1e_eni_add_pdo_bits(device, manager, &bits);
    const uint32_t bytes = (bits + 7) / 8;
    if (start != manager->manager.start || command->data.data[4] != manager->manager.control)
        cm1e_findings_add(findings, CM1E_RULE_ENI_SYNC_MANAGER, command->place,
                          "%s: sync manager %u is set to 0x%04X with control 0x%02X; Sm%u says 0x%04X and 0x%02X.",
                          device->name, manager->number, start, command->data.data[4], manager->number,
                          manager->manager.start, manager->manager.control);
    if (known && length != bytes)
        cm1e_findings_add(findings, CM1E_RULE_ENI_SYNC_MANAGER, command->place,
                          "%s: sync manager %u is set to %u bytes; the PDOs that it carries have %u.", device->name,
                          manager->number, length, (unsigned)bytes);
}

static void check_written_mailbox(cm1e_findings_t *findings, const cm1e_eni_device_t *device,
                                  const cm1e_eni_command_t *command, unsigned n)
{
    const cm1e_eni_mailbox_area_t *area = n == 0 ? &device->mailbox.send : &device->mailbox.receive;
    const uint16_t start = cm1e_get_u16(command->data.data), length = cm1e_get_u16(command->data.data + 2);
    if (start != area->start || length != area->length)
        cm1e_findings_add(findings, CM1E_RULE_ENI_SYNC_MANAGER, command->place,
                          "%s: sync manager %u is set to 0x%04X, %u bytes; the mailbox is at 0x%04X with %u.",
                          device->name, n, start, length, area->start, area->length);
}

static void check_sync_managers(cm1e_findings_t *findings, const cm1e_eni_device_t *device)
{
    cm1e_arena_t arena = {0};
    const cm1e_description_t described = cm1e_eni_describe(&arena, device);
    if (arena.failed)
        findings->arena.failed = true;
    else
        cm1e_check_overlap(findings, described.sync_managers.at, described.sync_managers.count);
    cm1e_arena_free(&arena);
    for (size_t i = 0; i < device->commands.count; i++) {
        const cm1e_eni_command_t *command = &device->commands.at[i];
        unsigned n;
        if (!(command->transitions & (CM1E_ENI_IP | CM1E_ENI_PS)) ||
            !cm1e_eni_sets(command, SYNC_MANAGER, SYNC_MANAGER_BYTES, &n) || !(command->data.data[6] & 1))
            continue;
        const cm1e_eni_sync_manager_t *manager = find_manager(device, n);
        if (manager)
            check_written_manager(findings, device, command, manager);
        else if (device->mailbox.present && n < 2)
            check_written_mailbox(findings, device, command, n);
    }
}

/* Some state bits, some whole bytes; some files name PDOs without describing them. */
static void check_range(cm1e_findings_t *findings, const cm1e_eni_device_t *device, bool send)
{
    const cm1e_eni_range_t *range = send ? &device->send : &device->receive;
    uint64_t bits = 0, rounded = 0;
    bool known = send ? device->has_send : device->has_receive;
    for (size_t i = 0; i < device->sync_managers.count; i++) {
        const cm1e_eni_sync_manager_t *manager = &device->sync_managers.at[i];
        if (manager->manager.use != (send ? CM1E_SM_OUTPUTS : CM1E_SM_INPUTS))
            continue;
        uint32_t carried = 0;
        known = known && (manager->pdos.count == 0 || cm1e_eni_add_pdo_bits(device, manager, &carried));
        bits += carried;
        rounded += (carried + 7) / 8 * 8;
    }
    if (known && bits > 0 && range->length != bits && range->length != rounded)
        cm1e_findings_add(findings, CM1E_RULE_ENI_PROCESS_DATA, range->place,
                          "%s: BitLength of %s is %u; the PDOs of its sync managers have %llu bits.", device->name,
                          send ? "Send" : "Recv", (unsigned)range->length, (unsigned long long)bits);
}

static void check_mailbox(cm1e_findings_t *findings, const cm1e_eni_device_t *device)
{
    const cm1e_eni_mailbox_t *mailbox = &device->mailbox;
    if (!mailbox->present)
        return;
    const cm1e_place_t place = mailbox->sdos.count > 0 ? mailbox->sdos.at[0].place : mailbox->place;
    if (mailbox->send.length == 0 || mailbox->receive.length == 0)
        cm1e_findings_add(findings, CM1E_RULE_MAILBOX_SIZE, mailbox->place,
                          "%s: a mailbox of 0 bytes; it has Send and Recv with a Length each.", device->name);
    if (mailbox->sdos.count > 0 && !mailbox->coe)
        cm1e_findings_add(findings, CM1E_RULE_ENI_MAILBOX, place,
                          "%s has CoE InitCmds, but CoE is none of its Protocols.", device->name);
    for (size_t i = 0; i < mailbox->sdos.count; i++) {
        const cm1e_eni_sdo_t *sdo = &mailbox->sdos.at[i];
        if (sdo->transitions == 0 || (sdo->specifier != 1 && sdo->specifier != 2) ||
            (sdo->specifier == 1 && sdo->data.size == 0))
            cm1e_findings_add(findings, CM1E_RULE_ENI_MAILBOX, sdo->place,
                              "%s: the CoE InitCmd of 0x%04X:%02X needs a Transition, a Ccs of 1 (download) or 2 "
                              "(upload), and Data where it is a download.",
                              device->name, sdo->index, sdo->subindex);
    }
}

/* ---- devices that we know --------------------------------------------------------------------------------------- */

static bool pdo_known(const cm1e_device_t *known, const cm1e_described_pdo_t *pdo)
{
    cm1e_pdo_t table = {.index = pdo->index};
    if (pdo->entries.count > CM1E_PDO_MAX_ENTRIES)
        return false;
    for (size_t i = 0; i < pdo->entries.count; i++) {
        const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[i];
        if (entry->bits > UINT8_MAX)
            return false;
        table.entries[table.entry_count++] =
            (cm1e_pdo_entry_t){entry->index, entry->subindex, (uint8_t)entry->bits};
    }
    return known->pdo_known(&table, pdo->transmit);
}

static void check_known(cm1e_findings_t *findings, const cm1e_eni_device_t *device, const cm1e_device_t *known)
{
    if (known->revision_known && !known->revision_known(device->revision))
        cm1e_findings_add(findings, CM1E_RULE_ENI_CM1E_REVISION, device->place,
                          "%s is a %s of revision 0x%08X; known are %s.", device->name, known->label,
                          (unsigned)device->revision, known->revisions);
    for (size_t i = 0; i < device->pdos.count && known->pdo_known; i++)
        if (!pdo_known(known, &device->pdos.at[i]))
            cm1e_findings_add(findings, CM1E_RULE_ENI_CM1E_PDO, device->pdos.at[i].place,
                              "%s is a %s, whose mappings are fixed; none of them has the entries of this PDO 0x%04X.",
                              device->name, known->label, device->pdos.at[i].index);
}

static const cm1e_device_t *known_device(const cm1e_eni_device_t *device)
{
    return cm1e_device_of_identity(device->vendor_id, device->product_code);
}

/* A cycle time that a device in the file does not follow is told once. */
static void check_cycle_time(cm1e_findings_t *findings, const cm1e_eni_t *document, const cm1e_eni_cyclic_t *cyclic)
{
    char list[CM1E_CYCLE_TIMES_TEXT];
    for (size_t i = 0; i < document->devices.count && cyclic->cycle_time_us != CM1E_ENI_NOT_GIVEN; i++) {
        const cm1e_device_t *known = known_device(&document->devices.at[i]);
        if (!known || cm1e_device_has_cycle_time(known, cyclic->cycle_time_us * 1000))
            continue;
        cm1e_findings_add(findings, CM1E_RULE_ENI_CYCLE_TIME, cyclic->place,
                          "A cycle time of %lld us; a %s follows %s us.", (long long)cyclic->cycle_time_us,
                          known->label, cm1e_device_cycle_times(known, "and", list));
        return;
    }
}

void cm1e_eni_check(cm1e_findings_t *findings, const cm1e_eni_t *document)
{
    check_addresses(findings, document);
    check_previous_ports(findings, document);
    check_commands(findings, document);
    for (size_t i = 0; i < document->devices.count; i++) {
        const cm1e_eni_device_t *device = &document->devices.at[i];
        const cm1e_device_t *known = known_device(device);
        check_sync_managers(findings, device);
        check_range(findings, device, true);
        check_range(findings, device, false);
        check_mailbox(findings, device);
        if (known)
            check_known(findings, device, known);
    }
    for (size_t i = 0; i < document->cyclics.count; i++)
        check_cycle_time(findings, document, &document->cyclics.at[i]);
    cm1e_eni_check_frames(findings, document);
}
