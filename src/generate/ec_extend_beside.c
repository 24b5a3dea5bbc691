#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "generate/ec_extend.h"

typedef struct beside {
    cm1e_findings_t *findings; /* NULL: only counted */
    cm1e_rule_t rule;
    size_t count;
} beside_t;

static void found(beside_t *beside, cm1e_place_t place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void found(beside_t *beside, cm1e_place_t place, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    beside->count++;
    if (beside->findings)
        cm1e_findings_add(beside->findings, beside->rule, place, "%s", text);
}

/* ---- process data: order and length are the whole contract ------------------------------------------------------ */

static const cm1e_described_pdo_t *default_pdo(const cm1e_description_t *device, bool transmit)
{
    for (size_t i = 0; i < device->pdos.count; i++)
        if (device->pdos.at[i].transmit == transmit && device->pdos.at[i].sync_manager != CM1E_NO_SYNC_MANAGER)
            return &device->pdos.at[i];
    return NULL;
}

/* A name may be of no object (VRs) or not known: then only its length can be judged. */
static bool fits(const cm1e_ec_entry_t *entry, const cm1e_described_pdo_entry_t *mapped)
{
    const cm1e_ec_name_t *name = cm1e_ec_name(entry->name);
    return entry->length * 8 == mapped->bits && (!name || name->object == 0 || name->object == mapped->index);
}

static void compare_entries(beside_t *beside, const cm1e_ec_pdo_t *list, const cm1e_described_pdo_t *pdo)
{
    size_t n = 0;
    for (size_t i = 0; i < list->entries.count; i++) {
        const cm1e_ec_entry_t *entry = &list->entries.at[i];
        if (strcmp(entry->name, CM1E_EC_END_ENTRY) == 0)
            break;
        if (n == pdo->entries.count) {
            found(beside, entry->place, "%s, %u bytes: PDO 0x%04X of the device ends before it, with %zu entries",
                  entry->name, (unsigned)entry->length, pdo->index, n);
            return;
        }
        const cm1e_described_pdo_entry_t *mapped = &pdo->entries.at[n++];
        if (fits(entry, mapped))
            continue;
        found(beside, entry->place,
              "%s, %u bytes: in PDO 0x%04X of the device entry %zu is 0x%04X:%02X %s, %u bytes, in a list %s. All that "
              "comes behind would be misread, too",
              entry->name, (unsigned)entry->length, pdo->index, n, mapped->index, mapped->subindex,
              mapped->name ? mapped->name : "", (unsigned)(mapped->bits + 7) / 8,
              cm1e_ec_name_of(mapped, pdo->transmit));
        return;
    }
    if (n < pdo->entries.count)
        found(beside, list->place, "%s has %zu entries, PDO 0x%04X of the device %zu: 0x%04X:%02X %s comes next",
              list->name, n, pdo->index, pdo->entries.count, pdo->entries.at[n].index, pdo->entries.at[n].subindex,
              pdo->entries.at[n].name ? pdo->entries.at[n].name : "");
}

static void compare_pdo(beside_t *beside, const cm1e_ec_pdo_t *list, const cm1e_ec_command_list_t *commands,
                        const cm1e_description_t *device, bool transmit)
{
    const cm1e_ec_command_t *command = NULL;
    const uint16_t assigned = cm1e_ec_assigned_pdo(commands, transmit, &command);
    const cm1e_described_pdo_t *pdo = assigned ? cm1e_description_pdo(device, assigned) : default_pdo(device, transmit);
    if (device->pdos.count == 0)
        return;
    if (assigned && !pdo)
        found(beside, command->place, "PDO 0x%04X is assigned, which the device does not have", assigned);
    if (pdo && list)
        compare_entries(beside, list, pdo);
}

/* ---- sync managers ---------------------------------------------------------------------------------------------- */

static void compare_sync_manager(beside_t *beside, const cm1e_ec_sync_manager_t *manager,
                                 const cm1e_description_t *device)
{
    bool bootstrap;
    const cm1e_sync_manager_use_t use = cm1e_ec_use(manager->function, &bootstrap);
    if (bootstrap || device->sync_managers.count == 0)
        return;
    if (manager->index >= device->sync_managers.count) {
        found(beside, manager->place, "sync manager %u: the device has %zu", (unsigned)manager->index,
              device->sync_managers.count);
        return;
    }
    const cm1e_described_sync_manager_t *its = &device->sync_managers.at[manager->index];
    if (manager->start != its->start)
        found(beside, manager->place, "sync manager %u starts at 0x%04X here, at 0x%04X in the device",
              (unsigned)manager->index, manager->start, its->start);
    if (manager->control != its->control)
        found(beside, manager->place, "sync manager %u has control byte 0x%02X here, 0x%02X in the device",
              (unsigned)manager->index, manager->control, its->control);
    if (use != its->use)
        found(beside, manager->place, "sync manager %u is %s here, %s in the device", (unsigned)manager->index,
              manager->function, cm1e_ec_function(its->use));
    const bool mailbox = cm1e_sync_manager_is_mailbox(use);
    if (mailbox && manager->size >= 0 && its->length_given && manager->size != its->length)
        found(beside, manager->place, "the mailbox of sync manager %u has %d bytes here, %u in the device",
              (unsigned)manager->index, (int)manager->size, its->length);
}

/* ---- start-up commands ------------------------------------------------------------------------------------------ */

static void compare_command(beside_t *beside, const cm1e_ec_command_t *command, const cm1e_description_t *device)
{
    const cm1e_described_entry_t *entry = cm1e_description_entry(device, command->index, command->subindex);
    if (device->objects.count == 0)
        return;
    if (!entry) {
        found(beside, command->place, "0x%04X:%02X is written, which the device does not have", command->index,
              command->subindex);
        return;
    }
    if (entry->bits > 0 && command->length * 8 != entry->bits)
        found(beside, command->place, "0x%04X:%02X is written with %u bytes; in the device it has %u", command->index,
              command->subindex, (unsigned)command->length, (unsigned)(entry->bits + 7) / 8);
    if (!(entry->access & CM1E_ACCESS_WRITE))
        found(beside, command->place, "0x%04X:%02X is written; in the device it can only be read", command->index,
              command->subindex);
}

size_t cm1e_ec_extend_beside(cm1e_findings_t *findings, cm1e_rule_t rule, const cm1e_ec_extend_t *document,
                             const cm1e_ec_slave_t *slave, const cm1e_description_t *device)
{
    beside_t beside = {.findings = findings, .rule = rule};
    const cm1e_ec_command_list_t *commands = cm1e_ec_extend_commands(document, slave);
    const cm1e_ec_controller_t *controller = cm1e_ec_extend_controller(document, slave);
    compare_pdo(&beside, cm1e_ec_extend_rx_pdo(document, slave), commands, device, false);
    compare_pdo(&beside, cm1e_ec_extend_tx_pdo(document, slave), commands, device, true);
    for (size_t i = 0; controller && i < controller->sync_managers.count; i++)
        compare_sync_manager(&beside, &controller->sync_managers.at[i], device);
    for (size_t i = 0; commands && i < commands->entries.count; i++)
        compare_command(&beside, &commands->entries.at[i], device);
    return beside.count;
}

void cm1e_ec_extend_compare(cm1e_findings_t *findings, const cm1e_ec_extend_t *document,
                            const cm1e_description_t *device)
{
    const cm1e_ec_profile_t *profile = NULL;
    for (size_t i = 0; i < document->profiles.count; i++) {
        const cm1e_ec_profile_t *at = &document->profiles.at[i];
        if (at->vendor_id != device->vendor_id || at->product_code != device->product_code)
            continue;
        if (!profile || (at->revision == device->revision && profile->revision != device->revision))
            profile = at;
    }
    if (!profile) {
        cm1e_findings_add(findings, CM1E_RULE_DIFFERS, 0,
                          "the file has no profile for vendor 0x%08X, product 0x%08X: the controller would not know "
                          "this device",
                          (unsigned)device->vendor_id, (unsigned)device->product_code);
        return;
    }
    /* Trio's file has a profile with revision 0, for any revision as it seems. */
    if (device->revision_given && profile->revision != 0 && profile->revision != device->revision)
        cm1e_findings_add(findings, CM1E_RULE_DIFFERS, profile->place,
                          "the revision is 0x%08X in the file, 0x%08X in the device", (unsigned)profile->revision,
                          (unsigned)device->revision);
    const cm1e_ec_slave_t *slave = cm1e_ec_extend_slave(document, profile);
    if (slave)
        cm1e_ec_extend_beside(findings, CM1E_RULE_DIFFERS, document, slave, device);
}
