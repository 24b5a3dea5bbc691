#include "generate/eni_slave.h"

#include <stdio.h>
#include <stdlib.h>

#include "description/describe.h"
#include "device/device.h"
#include "generate/esi.h"
#include "generate/esi_take.h"

enum { FIRST_TXPDO = 0x1A00, FIRST_RXPDO = 0x1600, END_OF_PDOS = 0x1C00, FIRST_ASSIGNMENT = 0x1C10 };
enum { COUNT_BYTES = 1, PDO_BYTES = 2, ENTRY_BYTES = 4, MODE_BYTES = 1, SYNC_TYPE_BYTES = 2 };
enum { CONFIGURED_MODULES = 0xF030, SYNC_TYPE = 1, CSP = 8, CSV = 9 }; /* modes of CiA 402 */

static cm1e_error_t wrong(const cm1e_slave_config_t *slave, cm1e_diag_t *diag, const char *what)
{
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "slave %s: %s", slave->name, what);
}

/* ---- which device ------------------------------------------------------------------------------------------------ */

/** The file shares its arena with the one that the device is read from, so that what the device points to stays. */
static cm1e_error_t describe_by_esi(cm1e_description_file_t *file, const cm1e_slave_config_t *slave, cm1e_diag_t *diag)
{
    cm1e_description_file_t esi = {.arena = file->arena};
    cm1e_description_t device;
    cm1e_diag_t why = {0};
    const cm1e_error_t error = cm1e_esi_device(&esi, &device, slave, &why);
    file->arena = esi.arena;
    if (error != CM1E_OK)
        return cm1e_diag_set(diag, error, 0, "slave %s: %.100s %.300s", slave->name, slave->esi, why.text);
    *(cm1e_description_t *)CM1E_APPEND(&file->arena, &file->devices) = device;
    return CM1E_OK;
}

cm1e_error_t cm1e_eni_describe_slave(cm1e_description_file_t *file, const cm1e_slave_config_t *slave, bool simulated,
                                     cm1e_diag_t *diag)
{
    if (slave->esi[0])
        return describe_by_esi(file, slave, diag);
    if (!simulated || slave->sim.kind == CM1E_SIM_SLAVE_GAP)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "slave %s: the bus file does not say what its process "
                             "data are: name its `esi`, or make the ENI from a scan of the network", slave->name);
    cm1e_describe_io_device(file, slave);
    return CM1E_OK;
}

/* ---- PDOs that are written anew ---------------------------------------------------------------------------------- */

/** An entry with the name and type that another PDO or the dictionary has for it. */
static cm1e_described_pdo_entry_t described_entry(const cm1e_description_t *device, const cm1e_pdo_entry_config_t *from)
{
    cm1e_described_pdo_entry_t made = {.index = from->index, .subindex = from->subindex, .bits = from->bits,
                                       .type = ""};
    if (from->index == 0)
        return made;
    for (size_t i = 0; i < device->pdos.count; i++)
        for (size_t e = 0; e < device->pdos.at[i].entries.count; e++) {
            const cm1e_described_pdo_entry_t *entry = &device->pdos.at[i].entries.at[e];
            if (entry->index == from->index && entry->subindex == from->subindex && entry->bits == from->bits)
                return *entry;
        }
    const cm1e_described_entry_t *entry = cm1e_description_entry(device, from->index, from->subindex);
    if (entry) {
        made.name = entry->name;
        made.type = entry->bits == from->bits ? entry->type : "";
    }
    return made;
}

static void map_anew(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    for (unsigned first = 0, end; first < slave->entry_count; first = end) {
        const unsigned index = slave->entries[first].pdo;
        cm1e_described_pdo_t made = {.index = (uint16_t)index, .transmit = index >= FIRST_TXPDO, .name = "",
                                     .sync_manager = CM1E_NO_SYNC_MANAGER};
        for (end = first; end < slave->entry_count && slave->entries[end].pdo == index; end++)
            *(cm1e_described_pdo_entry_t *)CM1E_APPEND(arena, &made.entries) =
                described_entry(device, &slave->entries[end]);
        cm1e_described_pdo_t *present = cm1e_pdo_find(&device->pdos, (uint16_t)index);
        if (present)
            made.name = present->name;
        else
            present = CM1E_APPEND(arena, &device->pdos);
        *present = made;
    }
}

/* ---- PDOs that are assigned -------------------------------------------------------------------------------------- */

static int sync_manager_of(const cm1e_description_t *device, bool transmit)
{
    const cm1e_sync_manager_use_t use = transmit ? CM1E_SM_INPUTS : CM1E_SM_OUTPUTS;
    for (size_t n = 0; n < device->sync_managers.count; n++)
        if (device->sync_managers.at[n].use == use)
            return (int)n;
    return CM1E_NO_SYNC_MANAGER;
}

static const uint16_t *assigned(const cm1e_slave_config_t *slave, bool transmit, unsigned *count)
{
    *count = transmit ? slave->inputs_pdo_count : slave->outputs_pdo_count;
    return transmit ? slave->inputs_pdos : slave->outputs_pdos;
}

static bool is_assigned(const cm1e_slave_config_t *slave, const cm1e_described_pdo_t *pdo)
{
    unsigned count;
    const uint16_t *pdos = assigned(slave, pdo->transmit, &count);
    for (unsigned i = 0; i < count; i++)
        if (pdos[i] == pdo->index)
            return true;
    return false;
}

/** Those of a direction come first, in the order of the bus file, because it is that of the process data. */
static cm1e_error_t assign(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave,
                           cm1e_diag_t *diag)
{
    cm1e_pdo_list_t ordered = {0};
    unsigned count, others;
    for (int transmit = 0; transmit < 2; transmit++) {
        const uint16_t *pdos = assigned(slave, transmit, &count);
        const int manager = sync_manager_of(device, transmit);
        for (unsigned i = 0; i < count; i++) {
            const cm1e_described_pdo_t *pdo = cm1e_pdo_find(&device->pdos, pdos[i]);
            if (!pdo || manager == CM1E_NO_SYNC_MANAGER)
                return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "slave %s: its description has no PDO 0x%04X, or no "
                                     "sync manager for it", slave->name, pdos[i]);
            cm1e_described_pdo_t *added = CM1E_APPEND(arena, &ordered);
            *added = *pdo;
            added->sync_manager = manager;
        }
    }
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        if (is_assigned(slave, pdo))
            continue;
        cm1e_described_pdo_t *added = CM1E_APPEND(arena, &ordered);
        *added = *pdo;
        assigned(slave, pdo->transmit, &others);
        if (others)
            added->sync_manager = CM1E_NO_SYNC_MANAGER;
    }
    device->pdos = ordered;
    return CM1E_OK;
}

/* ---- names ------------------------------------------------------------------------------------------------------- */

static const char *name_of(const cm1e_slave_config_t *slave, const cm1e_described_pdo_entry_t *entry, bool output,
                           unsigned bit)
{
    for (unsigned i = 0; i < slave->signal_count; i++) {
        const cm1e_signal_config_t *signal = &slave->signals[i];
        const bool object = signal->index && signal->index == entry->index && signal->subindex == entry->subindex;
        const bool place = !signal->index && signal->bit == bit && (signal->bits ? signal->bits : 1u) == entry->bits;
        if (signal->output == output && (object || place))
            return signal->name;
    }
    return NULL;
}

static void name_all(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    unsigned bits[2] = {0, 0};
    for (size_t i = 0; i < device->pdos.count; i++) {
        cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        for (size_t e = 0; pdo->sync_manager != CM1E_NO_SYNC_MANAGER && e < pdo->entries.count; e++) {
            cm1e_described_pdo_entry_t *entry = &pdo->entries.at[e];
            const char *name = entry->index ? name_of(slave, entry, !pdo->transmit, bits[pdo->transmit]) : NULL;
            if (name)
                entry->name = cm1e_arena_text(arena, name);
            bits[pdo->transmit] += entry->bits;
        }
    }
}

/* ---- start-up commands ------------------------------------------------------------------------------------------- */

typedef struct writer {
    cm1e_arena_t *arena;
    cm1e_init_command_list_t list;
} writer_t;

static cm1e_init_command_t *command(writer_t *to, unsigned index, unsigned subindex, uint64_t value, size_t bytes,
                                    bool before_op)
{
    cm1e_init_command_t *made = CM1E_APPEND(to->arena, &to->list);
    *made = (cm1e_init_command_t){.transitions = before_op ? CM1E_TRANSITION_SO : CM1E_TRANSITION_PS,
                                  .index = (uint16_t)index, .subindex = (uint8_t)subindex,
                                  .data = cm1e_bytes_of(to->arena, (int64_t)value, bytes)};
    return made;
}

static void command_sdos(writer_t *to, const cm1e_slave_config_t *slave, bool before_op)
{
    for (unsigned i = 0; i < slave->sdo_count; i++) {
        const cm1e_sdo_config_t *sdo = &slave->sdos[i];
        if (sdo->before_op != before_op)
            continue;
        cm1e_init_command_t *made = command(to, sdo->index, sdo->subindex, sdo->value, sdo->bytes, before_op);
        made->complete_access = sdo->complete_access;
        if (sdo->bytes == 0)
            made->data = (cm1e_bytes_t){cm1e_arena_bytes(to->arena, slave->sdo_data + sdo->value, sdo->size),
                                        sdo->size};
    }
}

static void command_mapping(writer_t *to, const cm1e_slave_config_t *slave)
{
    for (unsigned first = 0, end; first < slave->entry_count; first = end) {
        const unsigned pdo = slave->entries[first].pdo;
        command(to, pdo, 0, 0, COUNT_BYTES, false);
        for (end = first; end < slave->entry_count && slave->entries[end].pdo == pdo; end++) {
            const cm1e_pdo_entry_config_t *entry = &slave->entries[end];
            const uint32_t value = (uint32_t)entry->index << 16 | (uint32_t)entry->subindex << 8 | entry->bits;
            command(to, pdo, end - first + 1, value, ENTRY_BYTES, false);
        }
        command(to, pdo, 0, end - first, COUNT_BYTES, false);
    }
}

/** Whether the dictionary of a device has an entry that can be written. A master stops where a start-up command is
 *  refused, so what this library only tries is in the file if that says that it goes. */
static bool is_writable(const cm1e_description_t *device, unsigned index, unsigned subindex)
{
    const cm1e_described_entry_t *entry = cm1e_description_entry(device, (uint16_t)index, (uint8_t)subindex);
    return entry && (entry->access & CM1E_ACCESS_WRITE);
}

/** A simulated device has no dictionary here, and takes them. */
static bool takes_modules(const cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    const bool is_simulated = device->objects.count == 0 && slave->sim.kind == CM1E_SIM_SLAVE_MODULAR;
    return slave->module_count > 0 && (is_simulated || (is_writable(device, CONFIGURED_MODULES, 0) &&
                                                        is_writable(device, CONFIGURED_MODULES, 1)));
}

static void command_modules(writer_t *to, const cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    if (!takes_modules(device, slave))
        return;
    command(to, CONFIGURED_MODULES, 0, 0, COUNT_BYTES, false);
    for (unsigned i = 0; i < slave->module_count; i++)
        command(to, CONFIGURED_MODULES, i + 1, slave->modules[i], ENTRY_BYTES, false);
    command(to, CONFIGURED_MODULES, 0, slave->module_count, COUNT_BYTES, false);
}

/** That of the sync manager of the direction. */
static uint16_t assignment_of(const cm1e_description_t *device, bool transmit)
{
    const int manager = sync_manager_of(device, transmit);
    return (uint16_t)(manager < 0 ? OBJ_1C12_RXPDO_ASSIGN + transmit : FIRST_ASSIGNMENT + manager);
}

static void command_assignment(writer_t *to, const cm1e_description_t *device, const cm1e_slave_config_t *slave,
                               bool clear)
{
    unsigned count;
    for (int transmit = 0; transmit < 2; transmit++) {
        const unsigned index = assignment_of(device, transmit);
        const uint16_t *pdos = assigned(slave, transmit, &count);
        if (count && clear)
            command(to, index, 0, 0, COUNT_BYTES, false);
        for (unsigned i = 0; !clear && i < count; i++)
            command(to, index, i + 1, pdos[i], PDO_BYTES, false);
        if (count && !clear)
            command(to, index, 0, count, COUNT_BYTES, false);
    }
}

/** Whether the bus file writes the object itself. Of an ESI it has all commands already. */
static bool is_replaced(const cm1e_description_t *device, const cm1e_slave_config_t *slave,
                        const cm1e_init_command_t *own)
{
    const bool of_pdos = own->index >= FIRST_RXPDO && own->index < END_OF_PDOS && slave->entry_count > 0;
    const bool outputs = own->index == assignment_of(device, false) && slave->outputs_pdo_count;
    const bool inputs = own->index == assignment_of(device, true) && slave->inputs_pdo_count;
    const bool modules = own->index == CONFIGURED_MODULES && takes_modules(device, slave);
    if (slave->esi[0] || of_pdos || outputs || inputs || modules)
        return true;
    for (unsigned i = 0; i < slave->sdo_count; i++)
        if (slave->sdos[i].index == own->index && slave->sdos[i].subindex == own->subindex)
            return true;
    return false;
}

/** In the order in which the bus of this library writes (bus/slave_setup.c). */
static void write_commands(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    writer_t to = {.arena = arena};
    for (size_t i = 0; i < device->init_commands.count; i++)
        if (!is_replaced(device, slave, &device->init_commands.at[i]))
            *(cm1e_init_command_t *)CM1E_APPEND(arena, &to.list) = device->init_commands.at[i];
    command_sdos(&to, slave, false);
    command_modules(&to, device, slave);
    command_assignment(&to, device, slave, true);
    command_mapping(&to, slave);
    command_assignment(&to, device, slave, false);
    command_sdos(&to, slave, true);
    device->init_commands = to.list;
}

cm1e_error_t cm1e_eni_configure_slave(cm1e_description_file_t *file, const cm1e_slave_config_t *slave,
                                      cm1e_diag_t *diag)
{
    cm1e_arena_t *arena = &file->arena;
    cm1e_description_t *device = &file->devices.at[file->devices.count - 1];
    const bool writes = slave->sdo_count || slave->entry_count || slave->outputs_pdo_count || slave->inputs_pdo_count ||
                        takes_modules(device, slave);
    if (writes && !device->mailbox.coe)
        return wrong(slave, diag, "the bus file writes objects into it, and it has no mailbox with CoE");
    map_anew(arena, device, slave);
    const cm1e_error_t error = assign(arena, device, slave, diag);
    if (error != CM1E_OK)
        return error;
    name_all(arena, device, slave);
    write_commands(arena, device, slave);
    return CM1E_OK;
}

/* ---- what goes with the configuration ---------------------------------------------------------------------------- */

void cm1e_eni_synchronise(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave,
                          bool inputs, unsigned type)
{
    const unsigned index = OBJ_1C32_SM_OUTPUT_PARAMETER + inputs;
    writer_t to = {.arena = arena, .list = device->init_commands};
    bool is_stated = false;
    for (unsigned i = 0; slave && i < slave->sdo_count; i++)
        is_stated |= slave->sdos[i].index == index && slave->sdos[i].subindex == SYNC_TYPE;
    if (is_stated || type == 0 || !is_writable(device, index, SYNC_TYPE))
        return;
    command(&to, index, SYNC_TYPE, type, SYNC_TYPE_BYTES, false)->comment = "synchronisation type";
    device->init_commands = to.list;
}

static bool has_output(const cm1e_description_t *device, unsigned index)
{
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        for (size_t e = 0; !pdo->transmit && pdo->sync_manager != CM1E_NO_SYNC_MANAGER && e < pdo->entries.count; e++)
            if (pdo->entries.at[e].index == index)
                return true;
    }
    return false;
}

void cm1e_eni_start_mode(cm1e_arena_t *arena, cm1e_description_t *device)
{
    const unsigned index = OBJ_6060_MODES_OF_OPERATION;
    writer_t to = {.arena = arena, .list = device->init_commands};
    if (has_output(device, index) || !is_writable(device, index, 0))
        return;
    const bool by_position = has_output(device, OBJ_607A_TARGET_POSITION);
    command(&to, index, 0, by_position ? CSP : CSV, MODE_BYTES, false)->comment = "mode of operation";
    device->init_commands = to.list;
}
