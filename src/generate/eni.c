#include "generate/eni.h"

#include <string.h>

#include "core/bytes.h"
#include "description/compare.h"
#include "generate/eni_registers.h"

const char *const cm1e_eni_transition_names[CM1E_ENI_TRANSITION_COUNT] = {
#define NAME(name) #name,
    CM1E_ENI_TRANSITIONS(NAME)
#undef NAME
};
const char *const cm1e_eni_state_names[CM1E_ENI_STATE_COUNT] = {"INIT", "PREOP", "SAFEOP", "OP"};

void cm1e_eni_free(cm1e_eni_t *document)
{
    cm1e_arena_free(&document->arena);
    *document = (cm1e_eni_t){0};
}

cm1e_eni_command_t cm1e_eni_command(uint8_t code)
{
    return (cm1e_eni_command_t){.code = code, .count = CM1E_ENI_NOT_GIVEN, .retries = CM1E_ENI_NOT_GIVEN,
                                .timeout_ms = CM1E_ENI_NOT_GIVEN, .input_offset = CM1E_ENI_NOT_GIVEN,
                                .output_offset = CM1E_ENI_NOT_GIVEN};
}

bool cm1e_eni_is_logical(uint8_t code)
{
    return code == CM1E_ENI_LRD || code == CM1E_ENI_LWR || code == CM1E_ENI_LRW;
}

bool cm1e_eni_sets(const cm1e_eni_command_t *command, uint16_t first, unsigned size, unsigned *n)
{
    const bool writes = command->code == CM1E_ENI_FPWR || command->code == CM1E_ENI_APWR;
    if (!writes || command->ado < first || (command->ado - first) % size != 0 || command->data.size != size)
        return false;
    *n = (command->ado - first) / size;
    return *n < 16;
}

bool cm1e_eni_add_pdo_bits(const cm1e_eni_device_t *device, const cm1e_eni_sync_manager_t *manager, uint32_t *bits)
{
    for (size_t i = 0; i < manager->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = cm1e_pdo_find(&device->pdos, manager->pdos.at[i]);
        if (!pdo)
            return false;
        *bits += cm1e_pdo_bits(pdo);
    }
    return manager->pdos.count > 0;
}

/* ---- a slave in the words of descriptions ----------------------------------------------------------------------- */

/* What the last command that switches a sync manager on writes is what it is: a file's DefaultSize is a proposal. */
static void describe_written(cm1e_described_sync_manager_t managers[SYNC_MANAGERS], const cm1e_eni_device_t *device)
{
    for (size_t i = 0; i < device->commands.count; i++) {
        const cm1e_eni_command_t *command = &device->commands.at[i];
        const uint8_t *data = command->data.data;
        unsigned n;
        if (!(command->transitions & (CM1E_ENI_IP | CM1E_ENI_PS)) ||
            !cm1e_eni_sets(command, SYNC_MANAGER, SYNC_MANAGER_BYTES, &n) || !(data[6] & 1))
            continue;
        managers[n].place = command->place;
        managers[n].start = cm1e_get_u16(data);
        managers[n].length = cm1e_get_u16(data + 2);
        managers[n].length_given = true;
        managers[n].control = data[4];
        managers[n].enable = 1;
    }
}

static void describe_sync_managers(cm1e_arena_t *arena, cm1e_description_t *into, const cm1e_eni_device_t *device)
{
    cm1e_described_sync_manager_t managers[SYNC_MANAGERS] = {{0}};
    size_t count = 0;
    if (device->mailbox.present) {
        managers[0].control = CONTROL_MAILBOX_OUT;
        managers[1].control = CONTROL_MAILBOX_IN;
        managers[0].use = CM1E_SM_MAILBOX_OUT;
        managers[0].start = device->mailbox.send.start;
        managers[0].length = device->mailbox.send.length;
        managers[1].use = CM1E_SM_MAILBOX_IN;
        managers[1].start = device->mailbox.receive.start;
        managers[1].length = device->mailbox.receive.length;
        for (int n = 0; n < 2; n++) {
            managers[n].place = device->mailbox.place;
            managers[n].length_given = true;
            managers[n].enable = 1;
        }
    }
    for (size_t i = 0; i < device->sync_managers.count; i++)
        if (device->sync_managers.at[i].number < SYNC_MANAGERS)
            managers[device->sync_managers.at[i].number] = device->sync_managers.at[i].manager;
    describe_written(managers, device);
    for (size_t n = 0; n < SYNC_MANAGERS; n++)
        if (managers[n].place != 0 || managers[n].use != CM1E_SM_UNUSED)
            count = n + 1;
    for (size_t n = 0; n < count; n++)
        *(cm1e_described_sync_manager_t *)CM1E_APPEND(arena, &into->sync_managers) = managers[n];
}

static void describe_pdos(cm1e_arena_t *arena, cm1e_description_t *into, const cm1e_eni_device_t *device)
{
    for (size_t i = 0; i < device->pdos.count; i++) {
        cm1e_described_pdo_t *pdo = CM1E_APPEND(arena, &into->pdos);
        *pdo = device->pdos.at[i];
        pdo->sync_manager = CM1E_NO_SYNC_MANAGER;
        for (size_t m = 0; m < device->sync_managers.count; m++)
            for (size_t p = 0; p < device->sync_managers.at[m].pdos.count; p++)
                if (device->sync_managers.at[m].pdos.at[p] == pdo->index)
                    pdo->sync_manager = device->sync_managers.at[m].number;
    }
}

cm1e_description_t cm1e_eni_describe(cm1e_arena_t *arena, const cm1e_eni_device_t *device)
{
    cm1e_description_t description;
    cm1e_description_init(&description);
    description.place = description.identity_place = device->place;
    description.vendor_id = device->vendor_id;
    description.product_code = device->product_code;
    description.revision = device->revision;
    description.product_given = description.revision_given = true;
    description.mailbox = (cm1e_mailbox_protocols_t){
        .place = device->mailbox.place, .present = device->mailbox.present, .aoe = device->mailbox.aoe,
        .eoe = device->mailbox.eoe, .coe = device->mailbox.coe, .foe = device->mailbox.foe,
        .soe = device->mailbox.soe, .voe = device->mailbox.voe,
        .data_link_layer = device->mailbox.data_link_layer};
    describe_sync_managers(arena, &description, device);
    describe_pdos(arena, &description, device);
    return description;
}

/* A master switches a sync manager on for its PDOs only, while a description proposes to switch it on for those that
 * may be assigned. Of one without PDOs a file says nothing about that. */
static void take_enable(cm1e_description_t *file, const cm1e_description_t *device)
{
    for (size_t n = 0; n < file->sync_managers.count && n < device->sync_managers.count; n++) {
        cm1e_described_sync_manager_t *manager = &file->sync_managers.at[n];
        const bool of_process_data = manager->use == CM1E_SM_OUTPUTS || manager->use == CM1E_SM_INPUTS;
        if (of_process_data && cm1e_description_process_bytes(file, (unsigned)n) == 0)
            manager->enable = device->sync_managers.at[n].enable;
    }
}

void cm1e_eni_compare(cm1e_findings_t *findings, const cm1e_eni_t *document, uint16_t position,
                      const cm1e_description_t *device)
{
    if (position == 0 || position > document->devices.count) {
        cm1e_findings_add(findings, CM1E_RULE_DIFFERS, 0, "The file has %zu slaves, and none at position %u.",
                          document->devices.count, position);
        return;
    }
    cm1e_arena_t arena = {0};
    cm1e_description_t described = cm1e_eni_describe(&arena, &document->devices.at[position - 1]);
    if (!arena.failed) {
        take_enable(&described, device);
        cm1e_compare(findings, &described, device);
    }
    findings->arena.failed |= arena.failed;
    cm1e_arena_free(&arena);
}
