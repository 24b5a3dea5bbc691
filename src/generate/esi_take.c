#include "generate/esi_take.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "config/clock_pulses.h"
#include "config/esi_reader.h"
#include "config/io_types.h"
#include "core/regular_file.h"
#include "description/expand.h"
#include "generate/esi.h"

enum { FILE_MAX = 64 << 20, BITS_MAX = 8 * 1486 }; /* of process data: those of a frame */
enum { FIRST_RXPDO = 0x1600, END_OF_PDOS = 0x1C00, ASSIGNMENTS = 0x1C10, END_OF_ASSIGNMENTS = 0x1C30 };

/* ---- which device ------------------------------------------------------------------------------------------------ */

static bool fits(const cm1e_slave_config_t *slave, const cm1e_description_t *device)
{
    return (!slave->vendor || slave->vendor == device->vendor_id) &&
           (!slave->product || slave->product == device->product_code) &&
           (!slave->revision || slave->revision == device->revision);
}

static cm1e_error_t no_device(const cm1e_slave_config_t *slave, const cm1e_description_file_t *file, bool several,
                              cm1e_diag_t *diag)
{
    char list[200] = "";
    for (size_t i = 0, used = 0; i < file->devices.count && used + 60 < sizeof list; i++) {
        const cm1e_description_t *device = &file->devices.at[i];
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%.20s (0x%08X)", used ? ", " : "",
                                 /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): `count` devices are there */
                                 device->type, (unsigned)device->product_code);
    }
    if (several)
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "describes %zu devices, %s; expected the product of this "
                             "slave beside it", file->devices.count, list);
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "does not describe vendor 0x%08X, product 0x%08X, revision "
                         "0x%08X (0: any), but vendor 0x%08X: %s; expected the file of this device",
                         (unsigned)slave->vendor, (unsigned)slave->product, (unsigned)slave->revision,
                         (unsigned)file->vendor_id, list);
}

/** The device with the identity of the slave; of several revisions the highest one. */
static cm1e_error_t find_device(const cm1e_slave_config_t *slave, const cm1e_description_file_t *file,
                                const cm1e_description_t **found, cm1e_diag_t *diag)
{
    bool several = false;
    *found = NULL;
    for (size_t i = 0; i < file->devices.count; i++) {
        const cm1e_description_t *device = &file->devices.at[i];
        if (!fits(slave, device))
            continue;
        several |= *found && (*found)->product_code != device->product_code;
        if (!*found || device->revision > (*found)->revision)
            *found = device;
    }
    return *found && !several ? CM1E_OK : no_device(slave, file, several, diag);
}

/* ---- process data ------------------------------------------------------------------------------------------------ */

static bool is_listed(const uint16_t *pdos, unsigned count, unsigned index)
{
    for (unsigned i = 0; i < count; i++)
        if (pdos[i] == index)
            return true;
    return false;
}

/** Whether a PDO is assigned: as the bus file says, else by default. */
static bool is_assigned(const cm1e_slave_config_t *stated, const cm1e_described_pdo_t *pdo)
{
    const unsigned count = pdo->transmit ? stated->inputs_pdo_count : stated->outputs_pdo_count;
    if (count)
        return is_listed(pdo->transmit ? stated->inputs_pdos : stated->outputs_pdos, count, pdo->index);
    return pdo->sync_manager != CM1E_NO_SYNC_MANAGER;
}

static bool is_rewritten(const cm1e_slave_config_t *slave, unsigned pdo)
{
    for (unsigned i = 0; i < slave->entry_count; i++)
        if (slave->entries[i].pdo == pdo)
            return true;
    return false;
}

/** The file may say which PDOs exclude each other; it is not asked of those that are not assigned. */
static cm1e_error_t check_excludes(const cm1e_slave_config_t *stated, const cm1e_description_t *device,
                                   cm1e_diag_t *diag)
{
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        for (size_t n = 0; n < pdo->excludes.count && is_assigned(stated, pdo); n++)
            for (size_t k = 0; k < device->pdos.count; k++)
                if (device->pdos.at[k].index == pdo->excludes.at[n].index && k != i &&
                    is_assigned(stated, &device->pdos.at[k]))
                    return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, 0, "line %u: the PDO 0x%04X excludes 0x%04X, "
                                         "and both are assigned; expected one of them in %s", (unsigned)pdo->place,
                                         pdo->index, pdo->excludes.at[n].index,
                                         pdo->transmit ? "inputs_pdos" : "outputs_pdos");
    }
    return CM1E_OK;
}

static cm1e_error_t assign(cm1e_slave_config_t *slave, const cm1e_slave_config_t *stated,
                           const cm1e_description_t *device, cm1e_diag_t *diag)
{
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        uint16_t *count = pdo->transmit ? &slave->inputs_pdo_count : &slave->outputs_pdo_count;
        const bool by_file = pdo->transmit ? stated->inputs_pdo_count : stated->outputs_pdo_count;
        if (by_file || !is_assigned(stated, pdo))
            continue;
        if (*count == CM1E_SLAVE_PDOS)
            return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "assigns more than %d PDOs in a direction; expected "
                                 "inputs_pdos or outputs_pdos beside it", CM1E_SLAVE_PDOS);
        (pdo->transmit ? slave->inputs_pdos : slave->outputs_pdos)[(*count)++] = pdo->index;
    }
    return CM1E_OK;
}

/* ---- names ------------------------------------------------------------------------------------------------------- */

static bool is_taken(const cm1e_slave_config_t *slave, const char *name)
{
    for (unsigned i = 0; i < slave->signal_count; i++)
        if (strcasecmp(slave->signals[i].name, name) == 0)
            return true;
    return false;
}

/** "input 3", "output 3" and "0x6000:01" would be places. */
static bool is_a_name(const char *name)
{
    return name[0] && strncasecmp(name, "input ", 6) != 0 && strncasecmp(name, "output ", 7) != 0 &&
           strncasecmp(name, "0x", 2) != 0;
}

/** Whether several entries of the assigned PDOs have this name. */
static bool is_common(const cm1e_slave_config_t *stated, const cm1e_description_t *device, const char *entry)
{
    unsigned same = 0;
    for (size_t i = 0; i < device->pdos.count && same < 2; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        for (size_t e = 0; is_assigned(stated, pdo) && e < pdo->entries.count && same < 2; e++)
            same += pdo->entries.at[e].name && strcasecmp(pdo->entries.at[e].name, entry) == 0;
    }
    return same > 1;
}

enum { ENDS = 30 };

/** Beginning and end of a text; what is between them is lost anyhow. */
static void take_ends(char ends[2 * ENDS + 1], const char *text)
{
    const size_t length = strlen(text);
    const size_t skipped = length > 2 * ENDS ? length - 2 * ENDS : 0;
    snprintf(ends, 2 * ENDS + 1, "%.*s%s", skipped ? ENDS : 2 * ENDS, text, skipped ? text + ENDS + skipped : "");
}

/** Whether a letter of UTF-8 goes on here. */
static bool goes_on(char c) { return ((unsigned char)c & 0xC0) == 0x80; }

/** The name of the entry, with that of its PDO where several entries have it. A long one is cut. false: none is
 *  left. */
static bool make_name(const cm1e_slave_config_t *slave, const char *pdo, const char *entry,
                      char name[CM1E_NAME_LENGTH])
{
    char words[4 * ENDS + 2], of_pdo[2 * ENDS + 1], of_entry[2 * ENDS + 1];
    take_ends(of_pdo, pdo);
    take_ends(of_entry, entry);
    snprintf(words, sizeof words, "%s%s%s", of_pdo, pdo[0] ? " " : "", of_entry);
    for (char *c = words; *c; c++)
        *c = (unsigned char)*c < ' ' || *c == 0x7F ? '_' : *c;
    const size_t length = strlen(words);
    /* The end tells channels apart, so a long name loses its middle, in whole letters. */
    if (length < CM1E_NAME_LENGTH) {
        memcpy(name, words, length + 1);
    } else {
        size_t head = 14, tail = length - (CM1E_NAME_LENGTH - 16);
        while (head > 0 && goes_on(words[head]))
            head--;
        while (goes_on(words[tail]))
            tail++;
        snprintf(name, CM1E_NAME_LENGTH, "%.*s~%s", (int)head, words, words + tail);
    }
    return is_a_name(name) && !is_taken(slave, name);
}

static bool is_named(const cm1e_slave_config_t *stated, bool output, unsigned index, unsigned subindex, unsigned bit)
{
    for (unsigned i = 0; i < stated->signal_count; i++) {
        const cm1e_signal_config_t *signal = &stated->signals[i];
        const bool same = signal->index ? signal->index == index && signal->subindex == subindex : signal->bit == bit;
        if (signal->output == output && same)
            return true;
    }
    return false;
}

/** `bit`: where the entry lies by default. */
static void name_entry(cm1e_slave_config_t *slave, const cm1e_slave_config_t *stated, const cm1e_description_t *device,
                       const cm1e_described_pdo_t *pdo, const cm1e_described_pdo_entry_t *entry, unsigned bit)
{
    cm1e_signal_config_t signal = {.output = !pdo->transmit, .index = entry->index, .subindex = entry->subindex};
    const unsigned type = cm1e_io_type_of_name(entry->type);
    if (entry->index == 0 || entry->bits == 0 || !entry->name || slave->signal_count == CM1E_SLAVE_SIGNALS ||
        is_named(stated, signal.output, entry->index, entry->subindex, bit))
        return;
    if (!make_name(slave, is_common(stated, device, entry->name) ? pdo->name : "", entry->name, signal.name))
        return;
    signal.type_stated = type < CM1E_IO_BYTES && cm1e_io_types[type].bits == entry->bits;
    signal.type = signal.type_stated ? (cm1e_io_type_t)type : CM1E_IO_BOOL;
    if (!device->mailbox.coe) { /* such a slave cannot be asked for objects: its process data is what its file says */
        signal.index = 0;
        signal.subindex = 0;
        signal.bit = (uint16_t)bit;
        signal.bits = (uint16_t)entry->bits;
    }
    slave->signals[slave->signal_count++] = signal;
}

/** Behind the entries that are written: those of the assigned PDOs, with their gaps, so that the place of a signal is
 *  known while its slave is absent. Where there is no room for all, none is kept. */
static void describe_entries(cm1e_slave_config_t *slave, const cm1e_slave_config_t *stated,
                             const cm1e_description_t *device)
{
    unsigned count = slave->entry_count;
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        const bool described = is_assigned(stated, pdo) && !is_rewritten(stated, pdo->index);
        for (size_t e = 0; described && e < pdo->entries.count; e++) {
            const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[e];
            if (count == CM1E_SLAVE_PDO_ENTRIES || entry->bits == 0 || entry->bits > UINT8_MAX)
                return;
            slave->entries[count++] = (cm1e_pdo_entry_config_t){pdo->index, entry->index, entry->subindex,
                                                                (uint8_t)entry->bits};
        }
    }
    slave->described_count = (uint16_t)(count - slave->entry_count);
}

static void name_all(cm1e_slave_config_t *slave, const cm1e_slave_config_t *stated, const cm1e_description_t *device)
{
    unsigned bits[2] = {0, 0};
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        if (!is_assigned(stated, pdo) || is_rewritten(stated, pdo->index))
            continue;
        for (size_t e = 0; e < pdo->entries.count && bits[pdo->transmit] < BITS_MAX; e++) {
            name_entry(slave, stated, device, pdo, &pdo->entries.at[e], bits[pdo->transmit]);
            bits[pdo->transmit] += pdo->entries.at[e].bits;
        }
    }
}

/* ---- start-up commands ------------------------------------------------------------------------------------------- */

/** Whether the bus file writes this object itself, so that its value counts. */
static bool is_overruled(const cm1e_slave_config_t *stated, const cm1e_description_t *device,
                         const cm1e_init_command_t *command)
{
    for (unsigned i = 0; i < stated->sdo_count; i++)
        if (stated->sdos[i].index == command->index &&
            (command->complete_access || stated->sdos[i].subindex == command->subindex))
            return true;
    if (command->index >= FIRST_RXPDO && command->index < END_OF_PDOS)
        return is_rewritten(stated, command->index);
    const size_t manager = command->index - (size_t)ASSIGNMENTS;
    const bool known = command->index >= ASSIGNMENTS && manager < device->sync_managers.count;
    const bool outputs = known ? device->sync_managers.at[manager].use == CM1E_SM_OUTPUTS : command->index == 0x1C12;
    const bool inputs = known ? device->sync_managers.at[manager].use == CM1E_SM_INPUTS : command->index == 0x1C13;
    return (outputs && stated->outputs_pdo_count) || (inputs && stated->inputs_pdo_count);
}

static cm1e_error_t take_command(cm1e_slave_config_t *slave, const cm1e_init_command_t *command, cm1e_diag_t *diag)
{
    const size_t size = command->data.size, room = CM1E_SLAVE_SDO_DATA - slave->sdo_data_count;
    const bool too_long = size > 8 && size > room;
    if (size < 1 || too_long)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "line %u: the start-up command for object 0x%04X:%02X "
                             "has %zu bytes; expected 1 ... %zu: state it under `sdo`, which replaces it",
                             (unsigned)command->place, command->index, command->subindex, size, room);
    if (command->complete_access && command->subindex > 1)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "line %u: the start-up command for object 0x%04X has "
                             "complete access from sub-index %u on; expected 0 or 1 (ETG.1000.6 section 5.6.2.1)",
                             (unsigned)command->place, command->index, command->subindex);
    if (slave->sdo_count == CM1E_SLAVE_SDOS)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "has more start-up commands than %d, those of the bus "
                             "file included", CM1E_SLAVE_SDOS);
    cm1e_sdo_config_t *sdo = &slave->sdos[slave->sdo_count++];
    *sdo = (cm1e_sdo_config_t){.index = command->index, .subindex = command->subindex,
                               .complete_access = command->complete_access,
                               .before_op = !(command->transitions & (CM1E_TRANSITION_IP | CM1E_TRANSITION_PS))};
    if (size <= 8) {
        sdo->bytes = (uint8_t)size;
        sdo->value = cm1e_bytes_unsigned(command->data);
        return CM1E_OK;
    }
    sdo->size = (uint16_t)size;
    sdo->value = slave->sdo_data_count;
    memcpy(slave->sdo_data + slave->sdo_data_count, command->data.data, size);
    slave->sdo_data_count = (uint16_t)(slave->sdo_data_count + size);
    return CM1E_OK;
}

/** Those of a start: IP and PS before Safe-Operational, SO in it. */
static cm1e_error_t take_commands(cm1e_slave_config_t *slave, const cm1e_slave_config_t *stated,
                                  const cm1e_description_t *device, cm1e_diag_t *diag)
{
    const unsigned of_a_start = CM1E_TRANSITION_IP | CM1E_TRANSITION_PS | CM1E_TRANSITION_SO;
    cm1e_error_t error = CM1E_OK;
    for (size_t i = 0; i < device->init_commands.count && error == CM1E_OK; i++)
        if (device->init_commands.at[i].transitions & of_a_start &&
            !is_overruled(stated, device, &device->init_commands.at[i]))
            error = take_command(slave, &device->init_commands.at[i], diag);
    return error;
}

static bool commands_assign(const cm1e_description_t *device)
{
    for (size_t i = 0; i < device->init_commands.count; i++)
        if (device->init_commands.at[i].index >= ASSIGNMENTS && device->init_commands.at[i].index < END_OF_ASSIGNMENTS)
            return true;
    return false;
}

/* ---- clocks ------------------------------------------------------------------------------------------------------ */

static cm1e_error_t take_mode(cm1e_slave_config_t *slave, const cm1e_description_t *device, const char *name,
                              int64_t cycle_time_ns, cm1e_diag_t *diag)
{
    char list[200] = "";
    size_t used = 0;
    if (slave->dc.sync0_us != 0 || slave->dc.sync1_us != 0 || slave->dc.mode[0])
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "gives the pulses of the OpMode '%s', and dc states some too; "
                             "expected one of them", name);
    for (size_t i = 0; i < device->dc_modes.count; i++) {
        const cm1e_dc_mode_t *mode = &device->dc_modes.at[i];
        if (used + 50 < sizeof list)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%.40s", used ? ", " : "", mode->name);
        const cm1e_dc_facts_t facts = {mode->assign_activate, mode->sync0_cycle_ns, mode->sync0_factor,
                                       mode->sync0_shift_ns, mode->sync1_factor, mode->sync1_shift_ns};
        if (strcasecmp(mode->name, name) != 0 && !(strcmp(name, "first") == 0 && cm1e_config_mode_has_sync0(&facts)))
            continue;
        slave->dc = cm1e_config_pulses_of_mode(&facts, slave->dc.shift_us, cycle_time_ns ? cycle_time_ns : 1000000);
        return CM1E_OK;
    }
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "has no OpMode '%s'; it has %s", name, used ? list : "none");
}

/* ---- all together ------------------------------------------------------------------------------------------------ */

static cm1e_error_t take_device(cm1e_slave_config_t *slave, const cm1e_description_t *device, const char *mode,
                                int64_t cycle_time_ns, cm1e_diag_t *diag)
{
    const cm1e_slave_config_t stated = *slave;
    cm1e_error_t error = CM1E_OK;
    slave->vendor = device->vendor_id;
    if (device->product_given)
        slave->product = device->product_code;
    error = check_excludes(&stated, device, diag);
    if (error != CM1E_OK)
        return error;
    name_all(slave, &stated, device);
    if (device->mailbox.coe)
        describe_entries(slave, &stated, device);
    if (device->mailbox.coe && device->mailbox.pdo_assign && !commands_assign(device))
        error = assign(slave, &stated, device, diag);
    if (error == CM1E_OK && device->mailbox.coe)
        error = take_commands(slave, &stated, device, diag);
    return error == CM1E_OK && mode[0] ? take_mode(slave, device, mode, cycle_time_ns, diag) : error;
}

/** Reads the device of a slave, with the modules that it has when nobody chooses. */
static cm1e_error_t read_device(cm1e_description_file_t *file, cm1e_description_t *device, const void *bytes,
                                size_t size, const cm1e_slave_config_t *slave, cm1e_diag_t *diag)
{
    const cm1e_description_t *found;
    cm1e_error_t error = cm1e_esi_read(file, bytes, size, diag);
    if (error == CM1E_OK)
        error = find_device(slave, file, &found, diag);
    if (error != CM1E_OK)
        return error;
    *device = *found;
    if (found->slots.count > 0) {
        uint32_t idents[CM1E_PLACES_MAX];
        const size_t places = cm1e_description_places(found);
        cm1e_description_default_modules(found, idents, places);
        for (size_t n = 0; n < places && slave->module_count > 0; n++)
            idents[n] = n < slave->module_count ? slave->modules[n] : 0;
        cm1e_description_expand(&file->arena, device, file, found, idents, places);
    }
    if (file->arena.failed)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "needs more memory than there is");
    return CM1E_OK;
}

cm1e_error_t cm1e_esi_take(cm1e_slave_config_t *slave, const void *bytes, size_t size, const char *mode,
                           int64_t cycle_time_ns, cm1e_diag_t *diag)
{
    cm1e_description_file_t file = {0};
    cm1e_description_t device;
    cm1e_error_t error = read_device(&file, &device, bytes, size, slave, diag);
    if (error == CM1E_OK)
        error = take_device(slave, &device, mode, cycle_time_ns, diag);
    cm1e_description_file_free(&file);
    return error;
}

/** NULL: `diag` says why. */
static FILE *open_file(const char *path, cm1e_diag_t *diag)
{
    int descriptor;
    char why[200];
    if (cm1e_regular_file_open(path, &descriptor, why, sizeof why) != CM1E_OK) {
        cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s; expected the file of an ESI", why);
        return NULL;
    }
    FILE *file = fdopen(descriptor, "rb");
    if (!file) {
        cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "cannot be read: out of memory");
        close(descriptor);
    }
    return file;
}

static cm1e_error_t read_file(const char *path, uint8_t **bytes, size_t *size, cm1e_diag_t *diag)
{
    cm1e_diag_t why = {0};
    FILE *file = open_file(path, &why);
    *size = 0;
    *bytes = NULL;
    if (!file)
        return cm1e_diag_set(diag, why.error, 0, "%s", why.text);
    for (size_t room = 1 << 20; !ferror(file) && !feof(file) && room <= FILE_MAX; room *= 2) {
        uint8_t *larger = realloc(*bytes, room);
        if (!larger)
            break;
        *bytes = larger;
        *size += fread(*bytes + *size, 1, room - *size, file);
    }
    const bool whole = feof(file);
    fclose(file);
    return whole ? CM1E_OK : cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "cannot be read whole; expected an ESI of at most "
                                           "%d bytes", FILE_MAX);
}

static cm1e_error_t take_from_file(cm1e_slave_config_t *slave, const char *path, const char *mode,
                                   int64_t cycle_time_ns, cm1e_diag_t *diag)
{
    uint8_t *bytes;
    size_t size;
    cm1e_error_t error = read_file(path, &bytes, &size, diag);
    if (error == CM1E_OK)
        error = cm1e_esi_take(slave, bytes, size, mode, cycle_time_ns, diag);
    free(bytes);
    return error;
}

cm1e_error_t cm1e_esi_device(cm1e_description_file_t *file, cm1e_description_t *device,
                             const cm1e_slave_config_t *slave, cm1e_diag_t *diag)
{
    uint8_t *bytes;
    size_t size;
    cm1e_error_t error = read_file(slave->esi, &bytes, &size, diag);
    if (error == CM1E_OK)
        error = read_device(file, device, bytes, size, slave, diag);
    free(bytes);
    return error;
}

void cm1e_generate_register(void) { cm1e_esi_register_reader(take_from_file); }

/* Runs before main(). The target cm1e::generate has the linker ask for cm1e_generate_register(), which brings this
 * object. */
__attribute__((constructor)) static void register_at_start(void) { cm1e_generate_register(); }
