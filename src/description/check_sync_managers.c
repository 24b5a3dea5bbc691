#include "description/check_private.h"
#include "description/sii_image.h"

/* Sync managers, FMMUs and the mailbox: registers 0x0800 and 0x0600 of the slave controller (ETG.1000.4 6.6, 6.7). */

/* Control byte (ETG.1000.4 table 58). */
enum {
    CONTROL_MODE = 0x03, MODE_BUFFERED = 0x00, MODE_MAILBOX = 0x02,
    CONTROL_DIRECTION = 0x0C, DIRECTION_READ = 0x00, DIRECTION_WRITE = 0x04,
    CONTROL_WATCHDOG = 0x40,
};
/* User memory begins at 0x1000; below are registers, among them those of digital I/O, where sync managers may stand. */
enum { FIRST_MEMORY = 0x1000, END_OF_DIGITAL_INPUTS = 0x1004, END_OF_ADDRESSES = 0x10000 };
enum { BITS_MAX = 0x1000000 };
/* Header of the mailbox 6 bytes, of CoE 2, an expedited SDO 8 (ETG.1000.6 5.6.2). */
enum { LEAST_MAILBOX = 6, LEAST_COE_MAILBOX = 16, LONGEST_MAILBOX = 1486 };

static const char *const use_names[] = {
    [CM1E_SM_UNUSED] = "nothing", [CM1E_SM_MAILBOX_OUT] = "the mailbox to the device",
    [CM1E_SM_MAILBOX_IN] = "the mailbox from the device", [CM1E_SM_OUTPUTS] = "outputs", [CM1E_SM_INPUTS] = "inputs",
};

/* Bytes of the PDOs of each sync manager by default, limited to the memory. */
static void count_bytes(const cm1e_description_t *device, uint32_t *bytes)
{
    for (size_t n = 0; n < device->sync_managers.count; n++)
        bytes[n] = 0;
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        if (pdo->is_virtual || pdo->sync_manager < 0 || (size_t)pdo->sync_manager >= device->sync_managers.count)
            continue;
        uint32_t *bits = &bytes[pdo->sync_manager];
        for (size_t row = 0; row < pdo->entries.count; row++)
            *bits = pdo->entries.at[row].bits > BITS_MAX - *bits ? BITS_MAX : *bits + pdo->entries.at[row].bits;
    }
    for (size_t n = 0; n < device->sync_managers.count; n++)
        bytes[n] = (bytes[n] + 7) / 8;
}

static bool is_mailbox(const cm1e_described_sync_manager_t *manager)
{
    return cm1e_sync_manager_is_mailbox(manager->use);
}
static bool is_process_data(const cm1e_described_sync_manager_t *manager)
{
    return manager->use == CM1E_SM_OUTPUTS || manager->use == CM1E_SM_INPUTS;
}

/* ---- one by one -------------------------------------------------------------------------------------------------- */

static void check_control(const cm1e_check_t *check, size_t n, bool carries)
{
    static const uint8_t usual[] = {0, 0x26, 0x22, 0x64, 0x20};
    const cm1e_described_sync_manager_t *manager = &check->device->sync_managers.at[n];
    if (manager->use == CM1E_SM_UNUSED || manager->control_missing)
        return;
    const bool writes = cm1e_sync_manager_is_written(manager->use);
    const unsigned mode = manager->control & CONTROL_MODE, direction = manager->control & CONTROL_DIRECTION;
    /* Process data may also have one buffer, in which the reader waits for the writer. */
    const bool mode_fits = mode == MODE_MAILBOX || (mode == MODE_BUFFERED && is_process_data(manager));
    if (!mode_fits || direction != (writes ? DIRECTION_WRITE : DIRECTION_READ))
        cm1e_check_add(check, CM1E_RULE_SYNC_MANAGER_CONTROL, manager->place,
                       "sync manager %zu is for %s, but its control byte 0x%02X is of another %s; usual is 0x%02X", n,
                       use_names[manager->use], manager->control, mode_fits ? "direction" : "mode",
                       usual[manager->use]);
    else if (manager->use == CM1E_SM_OUTPUTS && carries && !(manager->control & CONTROL_WATCHDOG))
        cm1e_check_add(check, CM1E_RULE_SYNC_MANAGER_WATCHDOG, manager->place,
                       "sync manager %zu is for outputs, but its control byte 0x%02X lacks the watchdog (bit 6): when "
                       "the master stops, the device is not told",
                       n, manager->control);
}

static void check_size(const cm1e_check_t *check, size_t n, uint32_t bytes)
{
    const cm1e_described_sync_manager_t *manager = &check->device->sync_managers.at[n];
    const uint32_t least = manager->minimum_length, most = manager->maximum_length;
    const uint32_t length = is_process_data(manager) && bytes > 0 ? bytes : manager->length;
    if (is_process_data(manager) && bytes > 0 && manager->length_given && manager->length > 0 &&
        manager->length != bytes)
        cm1e_check_add(check, CM1E_RULE_SYNC_MANAGER_SIZE, manager->place,
                       "sync manager %zu has %u bytes by default; its PDOs have %u", n, manager->length,
                       (unsigned)bytes);
    else if (length > 0 && ((least > 0 && length < least) || (most > 0 && length > most)))
        cm1e_check_add(check, CM1E_RULE_SYNC_MANAGER_RANGE, manager->place,
                       "sync manager %zu has %u bytes; it may have %u to %u", n, (unsigned)length, (unsigned)least,
                       (unsigned)most);
}

/* ---- memory ------------------------------------------------------------------------------------------------------ */

static bool has_mailbox(const cm1e_description_t *device)
{
    for (size_t n = 0; n < device->sync_managers.count; n++)
        if (is_mailbox(&device->sync_managers.at[n]))
            return true;
    return false;
}

/* The sync manager as a master sets it, with the length of its PDOs. Without a processor behind the controller, which
 * would have a mailbox, registers 0x1000 to 0x1003 are digital inputs, without buffers. false: it takes no memory. */
static bool in_use(cm1e_described_sync_manager_t *used, const cm1e_described_sync_manager_t *manager, uint32_t bytes,
                   bool mailbox)
{
    const bool digital_input = !mailbox && manager->use == CM1E_SM_INPUTS && manager->start < END_OF_DIGITAL_INPUTS;
    *used = *manager;
    used->enable = 0;
    if (is_process_data(manager) && bytes > 0)
        used->length = bytes < UINT16_MAX ? (uint16_t)bytes : UINT16_MAX;
    const bool one_buffer = is_mailbox(manager) || digital_input ||
                            (!manager->control_missing && (manager->control & CONTROL_MODE) != MODE_BUFFERED);
    used->control = one_buffer ? MODE_MAILBOX : MODE_BUFFERED;
    return manager->use != CM1E_SM_UNUSED && used->length > 0 && manager->start >= FIRST_MEMORY;
}

static void check_memory(const cm1e_check_t *check, const cm1e_described_sync_manager_t *used, size_t n)
{
    const cm1e_description_t *device = check->device;
    const uint32_t end = cm1e_sync_manager_end(used);
    const uint32_t memory_end = device->dpram_bytes > 0 && device->dpram_bytes <= END_OF_ADDRESSES - FIRST_MEMORY
                                    ? FIRST_MEMORY + (uint32_t)device->dpram_bytes
                                    : END_OF_ADDRESSES;
    if (end > memory_end)
        cm1e_check_add(check, CM1E_RULE_SYNC_MANAGER_BEYOND_MEMORY, used->place,
                       "sync manager %zu takes 0x%04X to 0x%04X%s; the memory ends at 0x%04X", n, used->start,
                       (unsigned)(end - 1), used->control == MODE_BUFFERED ? ", its length three times" : "",
                       (unsigned)(memory_end - 1));
}

static void check_areas(const cm1e_check_t *check, const uint32_t *bytes)
{
    const size_t count = check->device->sync_managers.count;
    cm1e_described_sync_manager_t *used = cm1e_arena_take(check->arena, count * sizeof *used);
    if (check->arena->failed)
        return;
    const bool mailbox = has_mailbox(check->device);
    for (size_t n = 0; n < count; n++)
        if (in_use(&used[n], &check->device->sync_managers.at[n], bytes[n], mailbox)) {
            used[n].enable = 1;
            check_memory(check, &used[n], n);
        }
    cm1e_check_overlap(check->findings, used, count);
}

/* ---- all of them ------------------------------------------------------------------------------------------------- */

/* With a mailbox it takes sync managers 0 and 1, outputs have 2 and inputs 3 (ETG.1000.6 5.6.7.4: 0x1C12, 0x1C13). */
static void check_order(const cm1e_check_t *check)
{
    static const cm1e_sync_manager_use_t order[] = {CM1E_SM_MAILBOX_OUT, CM1E_SM_MAILBOX_IN, CM1E_SM_OUTPUTS,
                                                    CM1E_SM_INPUTS};
    const cm1e_description_t *device = check->device;
    const bool mailbox = has_mailbox(device);
    for (size_t n = 0; mailbox && n < device->sync_managers.count; n++) {
        const cm1e_described_sync_manager_t *manager = &device->sync_managers.at[n];
        const bool wrong = n < 4 ? manager->use != CM1E_SM_UNUSED && manager->use != order[n] : is_mailbox(manager);
        if (wrong)
            cm1e_check_add(check, CM1E_RULE_SYNC_MANAGER_ORDER, manager->place,
                           "sync manager %zu is for %s; in a device with a mailbox %s", n, use_names[manager->use],
                           n < 4 ? "0 and 1 are the mailbox, 2 is for outputs, 3 for inputs"
                                 : "the mailbox has sync managers 0 and 1");
    }
}

static void check_available(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    if (device->sync_managers_available > 0 && device->sync_managers.count > (size_t)device->sync_managers_available)
        cm1e_check_add(check, CM1E_RULE_SYNC_MANAGERS_TOO_MANY,
                       device->sync_managers.at[device->sync_managers_available].place,
                       "there are %zu sync managers; the controller has %d", device->sync_managers.count,
                       device->sync_managers_available);
    if (device->fmmus_available > 0 && device->fmmus.count > (size_t)device->fmmus_available)
        cm1e_check_add(check, CM1E_RULE_FMMUS_TOO_MANY, device->fmmus.at[device->fmmus_available].place,
                       "there are %zu FMMUs; the controller has %d", device->fmmus.count, device->fmmus_available);
}

/* A file that states no FMMU leaves them to the master. */
static void check_fmmu(const cm1e_check_t *check, cm1e_rule_t rule, cm1e_fmmu_use_t use, const char *what)
{
    const cm1e_description_t *device = check->device;
    for (size_t i = 0; i < device->fmmus.count; i++)
        if (device->fmmus.at[i].use == use)
            return;
    if (device->fmmus.count > 0)
        cm1e_check_add(check, rule, device->fmmus.at[0].place, "%s", what);
}

static uint32_t bytes_of(const cm1e_check_t *check, cm1e_sync_manager_use_t use, const uint32_t *bytes)
{
    uint32_t sum = 0;
    for (size_t n = 0; n < check->device->sync_managers.count; n++)
        if (check->device->sync_managers.at[n].use == use)
            sum += bytes[n];
    return sum;
}

/* There is a sync manager for outputs (inputs) and PDOs for it, but none is assigned: the device would run without
 * them. */
static void check_carries(const cm1e_check_t *check, bool transmit)
{
    const cm1e_description_t *device = check->device;
    const cm1e_described_sync_manager_t *manager = NULL;
    for (size_t n = 0; n < device->sync_managers.count && !manager; n++)
        if (device->sync_managers.at[n].use == (transmit ? CM1E_SM_INPUTS : CM1E_SM_OUTPUTS))
            manager = &device->sync_managers.at[n];
    size_t pdos = 0;
    for (size_t i = 0; manager && i < device->pdos.count; i++) {
        if (device->pdos.at[i].transmit != transmit || device->pdos.at[i].is_virtual)
            continue;
        if (device->pdos.at[i].sync_manager != CM1E_NO_SYNC_MANAGER)
            return;
        pdos++;
    }
    if (pdos > 0)
        cm1e_check_add(check, CM1E_RULE_NO_PDO_ASSIGNED, manager->place,
                       "none of the %zu %ss is assigned to a sync manager: without a choice by hand there are no %s",
                       pdos, transmit ? "TxPDO" : "RxPDO", transmit ? "inputs" : "outputs");
}

void cm1e_check_sync_managers(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    const size_t count = device->sync_managers.count;
    if (count == 0 || count > CM1E_ARENA_LIMIT / sizeof(cm1e_described_sync_manager_t))
        return;
    uint32_t *bytes = cm1e_arena_take(check->arena, count * sizeof *bytes);
    if (check->arena->failed)
        return;
    count_bytes(device, bytes);
    for (size_t n = 0; n < count; n++) {
        check_control(check, n, bytes[n] > 0);
        check_size(check, n, bytes[n]);
    }
    check_areas(check, bytes);
    check_order(check);
    check_available(check);
    if (bytes_of(check, CM1E_SM_OUTPUTS, bytes) > 0)
        check_fmmu(check, CM1E_RULE_FMMU_MISSING, CM1E_FMMU_OUTPUTS, "there are outputs, but no FMMU for them");
    if (bytes_of(check, CM1E_SM_INPUTS, bytes) > 0)
        check_fmmu(check, CM1E_RULE_FMMU_MISSING, CM1E_FMMU_INPUTS, "there are inputs, but no FMMU for them");
    check_carries(check, false);
    check_carries(check, true);
}

/* ---- mailbox ----------------------------------------------------------------------------------------------------- */

static void check_mailbox_size(const cm1e_check_t *check, size_t n)
{
    const cm1e_described_sync_manager_t *manager = &check->device->sync_managers.at[n];
    const unsigned least = check->device->mailbox.coe ? LEAST_COE_MAILBOX : LEAST_MAILBOX;
    if (manager->length < least)
        cm1e_check_add(check, CM1E_RULE_MAILBOX_SIZE, manager->place,
                       "the mailbox in sync manager %zu has %u bytes; %s needs at least %u", n, manager->length,
                       check->device->mailbox.coe ? "an SDO" : "its header", least);
    else if (manager->length > LONGEST_MAILBOX)
        cm1e_check_add(check, CM1E_RULE_MAILBOX_SIZE, manager->place,
                       "the mailbox in sync manager %zu has %u bytes; no frame carries more than %u", n,
                       manager->length, LONGEST_MAILBOX);
}

static void check_bootstrap(const cm1e_check_t *check)
{
    const cm1e_described_eeprom_t *eeprom = &check->device->eeprom;
    if (eeprom->bootstrap.size == 0)
        return;
    if (eeprom->bootstrap.size != CM1E_SII_BOOTSTRAP_BYTES) {
        cm1e_check_add(check, CM1E_RULE_BOOTSTRAP_SIZE, eeprom->place,
                       "the bootstrap mailbox is described by %zu bytes; words 0x14 to 0x17 of the EEPROM are 8",
                       eeprom->bootstrap.size);
        return;
    }
    if (cm1e_bytes_unsigned(eeprom->bootstrap) != 0 && check->device->mailbox.present && !check->device->mailbox.foe)
        cm1e_check_add(check, CM1E_RULE_BOOTSTRAP_WITHOUT_FOE, eeprom->place,
                       "there is a bootstrap mailbox, but no FoE, with which it would be used");
}

void cm1e_check_mailbox(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    const cm1e_described_sync_manager_t *first = NULL;
    bool out = false, in = false;
    for (size_t n = 0; n < device->sync_managers.count; n++) {
        const cm1e_described_sync_manager_t *manager = &device->sync_managers.at[n];
        out = out || manager->use == CM1E_SM_MAILBOX_OUT;
        in = in || manager->use == CM1E_SM_MAILBOX_IN;
        if (is_mailbox(manager)) {
            check_mailbox_size(check, n);
            first = first ? first : manager;
        }
    }
    const cm1e_mailbox_protocols_t *mailbox = &device->mailbox;
    const bool used = mailbox->coe || mailbox->foe || mailbox->eoe || mailbox->soe || mailbox->voe || mailbox->aoe;
    if (used && (!out || !in))
        cm1e_check_add(check, CM1E_RULE_MAILBOX_WITHOUT_SYNC_MANAGER, device->mailbox.place,
                       "there is a mailbox, but no sync manager for it%s",
                       !out && !in ? "" : out ? " from the device" : " to the device");
    else if (first && !device->mailbox.present)
        cm1e_check_add(check, CM1E_RULE_MAILBOX_WITHOUT_PROTOCOL, first->place,
                       "there are sync managers for a mailbox, but no protocol for it is described");
    if (out && in && device->mailbox.present)
        check_fmmu(check, CM1E_RULE_FMMU_MAILBOX_MISSING, CM1E_FMMU_MAILBOX_STATE,
                   "no FMMU shows the state of the mailbox in the process data: a master has to poll it");
    check_bootstrap(check);
}
