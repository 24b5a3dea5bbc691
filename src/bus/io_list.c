/* The signals of slaves, as they are listed: see cm1e/io.h. */
#include "bus/io_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/sii_reader.h"
#include "config/io_types.h"

/* ---- the signals that a slave has -------------------------------------------------------------------------------- */

static cm1e_io_info_t info_of_sii(const cm1e_sii_signal_t *signal)
{
    cm1e_io_info_t info = {.output = !signal->input, .index = signal->index, .subindex = signal->subindex,
                           .type = signal->type, .bits = signal->bits, .bit_offset = signal->bit_offset};
    memcpy(info.name, signal->name, sizeof info.name);
    return info;
}

static cm1e_io_info_t info_of_mapping(const cm1e_device_t *device, const cm1e_mapped_entry_t *mapped, bool output)
{
    cm1e_io_info_t info = {.output = output, .index = mapped->index, .subindex = mapped->subindex, .bits = mapped->bits,
                           .type = cm1e_io_type_of_bits(mapped->bits), .bit_offset = mapped->bit_offset};
    const cm1e_entry_t *entry = device ? device->entry(device, mapped->index, mapped->subindex) : NULL;
    if (!entry)
        return info;
    snprintf(info.name, sizeof info.name, "%.63s", entry->name);
    if (entry->bits == mapped->bits)
        info.type = entry->type == CM1E_TYPE_SINT ? CM1E_IO_SINT : entry->type == CM1E_TYPE_INT ? CM1E_IO_INT :
                    entry->type == CM1E_TYPE_DINT ? CM1E_IO_DINT : info.type;
    return info;
}

/** Name and type of an object that the SII knows, perhaps in another PDO. */
static void name_by_sii(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_io_info_t *info)
{
    const cm1e_sii_signals_t *signals = cm1e_soem_signals(bus->soem, slave->info.position);
    for (uint32_t i = 0; signals && i < signals->count; i++) {
        const cm1e_sii_signal_t *signal = &signals->at[i];
        if (signal->index != info->index || signal->subindex != info->subindex || signal->input == info->output)
            continue;
        memcpy(info->name, signal->name, sizeof info->name);
        if (signal->bits == info->bits)
            info->type = (cm1e_io_type_t)signal->type;
        return;
    }
}

/** Signal `number` (1 = first) of a slave in one direction, by its SII or its mapping. */
static bool find_own(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, bool output, unsigned number,
                     cm1e_io_info_t *info)
{
    unsigned seen = 0;
    if (cm1e_bus_has_motors(slave) || slave->by_pdos) {
        const cm1e_mapped_direction_t *mapped = &slave->mapped[!output];
        for (unsigned i = 0; i < mapped->entry_count && seen < number; i++)
            if (mapped->entries[i].index != 0 && ++seen == number)
                *info = info_of_mapping(cm1e_bus_has_motors(slave) ? slave->info.device : NULL, &mapped->entries[i],
                                        output);
    } else {
        const cm1e_sii_signals_t *signals = cm1e_soem_signals(bus->soem, slave->info.position);
        for (uint32_t i = 0; signals && i < signals->count && seen < number; i++)
            if (signals->at[i].input != output && ++seen == number)
                *info = info_of_sii(&signals->at[i]);
    }
    if (number == 0 || seen < number)
        return false;
    if (slave->by_pdos)
        name_by_sii(bus, slave, info);
    info->position = slave->info.position;
    info->number = (uint16_t)number;
    info->of_axis = cm1e_bus_has_motors(slave);
    if (!info->name[0])
        snprintf(info->name, sizeof info->name, "0x%04X:%02X", info->index, info->subindex);
    return true;
}

/* ---- names of the configuration ---------------------------------------------------------------------------------- */

static uint32_t own_count(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, bool output)
{
    cm1e_io_info_t info;
    unsigned count = 0;
    while (find_own(bus, slave, output, count + 1, &info))
        count++;
    return count;
}

static bool has_type(const cm1e_signal_config_t *signal, unsigned bits)
{
    const cm1e_io_type_row_t *type = &cm1e_io_types[signal->type];
    const bool exact = type->is_real || signal->type == CM1E_IO_BOOL;
    return !signal->type_stated || !type->bits || (exact ? bits == type->bits : bits <= type->bits);
}

static unsigned bits_of_place(const cm1e_signal_config_t *signal)
{
    return signal->bits ? signal->bits : signal->type_stated ? cm1e_io_types[signal->type].bits : 1;
}

/** The entry from `first` on that a signal of the configuration means; NULL: none, so it may be bits of its own. */
static cm1e_listed_signal_t *find_meant(cm1e_signal_list_t *list, uint32_t first, const cm1e_signal_config_t *signal)
{
    for (uint32_t i = first; i < list->count; i++) {
        const cm1e_io_info_t *info = &list->at[i].info;
        const bool object = signal->index && info->index == signal->index && info->subindex == signal->subindex;
        const bool place = !signal->index && info->bit_offset == signal->bit && info->bits == bits_of_place(signal);
        if (info->output == signal->output && (object || place))
            return &list->at[i];
    }
    return NULL;
}

static cm1e_error_t refuse(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const cm1e_signal_config_t *signal,
                           cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    const char *direction = signal->output ? "outputs" : "inputs";
    const unsigned bytes = signal->output ? slave->placement.output_bytes : slave->placement.input_bytes;
    cm1e_bus_label(bus, slave, label);
    if (signal->index)
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, 0, "The signal \"%s\" is not there: object 0x%04X:%02X is "
                             "not among the %s of %s. `cm1e scan --pdos` lists them.", signal->name, signal->index,
                             signal->subindex, direction, label);
    return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, 0, "The signal \"%s\" is not there: it ends with bit %u, and %s "
                         "has %u bits of %s.", signal->name, signal->bit + bits_of_place(signal) - 1u, label, 8 * bytes,
                         direction);
}

/** Gives a signal its name, where nobody has named it yet; otherwise it is one more of the same place. */
static cm1e_error_t add_named(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_signal_list_t *list,
                              uint32_t first, const cm1e_signal_config_t *signal, cm1e_diag_t *diag)
{
    const unsigned there = 8u * (signal->output ? slave->placement.output_bytes : slave->placement.input_bytes);
    cm1e_listed_signal_t *meant = find_meant(list, first, signal);
    if (!meant && (signal->index || signal->bit + bits_of_place(signal) > there))
        return refuse(bus, slave, signal, diag);
    if (!meant || meant->config) {
        const cm1e_io_info_t place = {.position = slave->info.position, .output = signal->output,
                                      .bits = (uint16_t)bits_of_place(signal), .bit_offset = signal->bit,
                                      .type = cm1e_io_type_of_bits(bits_of_place(signal))};
        list->at[list->count].info = meant ? meant->info : place;
        list->at[list->count].info.number = (uint16_t)(list->count - first + 1);
        meant = &list->at[list->count++];
    }
    if (!has_type(signal, meant->info.bits))
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, 0, "The signal \"%s\" of slave %u has %u bits: it is no %s.",
                             signal->name, slave->info.position, meant->info.bits, cm1e_io_type_name(signal->type));
    meant->config = signal;
    meant->info.type = signal->type_stated ? signal->type : meant->info.type;
    memcpy(meant->info.name, signal->name, sizeof signal->name);
    return CM1E_OK;
}

cm1e_error_t cm1e_io_list_make(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    const uint32_t counts[2] = {own_count(bus, slave, false), own_count(bus, slave, true)};
    const size_t room = counts[0] + counts[1] + slave->config->signal_count;
    cm1e_signal_list_t *list = calloc(1, sizeof *list + room * sizeof list->at[0]);
    if (!list)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory for the signals of the slaves.");
    cm1e_error_t error = CM1E_OK;
    for (int output = 0; output < 2; output++) {
        const uint32_t first = list->count;
        for (uint32_t number = 1; number <= counts[output]; number++)
            find_own(bus, slave, output, number, &list->at[list->count++].info);
        for (unsigned i = 0; i < slave->config->signal_count && error == CM1E_OK; i++)
            if (slave->config->signals[i].output == output)
                error = add_named(bus, slave, list, first, &slave->config->signals[i], diag);
    }
    free(slave->signals);
    slave->signals = list;
    return error;
}

static bool find_number(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, bool output, unsigned number,
                        cm1e_io_info_t *info)
{
    if (!slave->signals)
        return find_own(bus, slave, output, number, info);
    for (uint32_t i = 0; i < slave->signals->count; i++) {
        *info = slave->signals->at[i].info;
        if (info->output == output && info->number == number)
            return true;
    }
    return false;
}

/* ---- one after the other ----------------------------------------------------------------------------------------- */

bool cm1e_io_next(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_io_info_t *info)
{
    if (info->position == 0)
        return find_number(bus, slave, false, 1, info) || find_number(bus, slave, true, 1, info);
    const cm1e_io_info_t last = *info;
    *info = (cm1e_io_info_t){0};
    return find_number(bus, slave, last.output, last.number + 1u, info) ||
           (!last.output && find_number(bus, slave, true, 1, info));
}

bool cm1e_io_at(const cm1e_bus_t *bus, uint32_t n, cm1e_io_info_t *info)
{
    for (uint32_t position = 1; bus && info && bus->layout.present && position <= bus->slave_count;
         position++) {
        *info = (cm1e_io_info_t){0};
        while (cm1e_io_next(bus, cm1e_bus_at(bus, position), info))
            if (n-- == 0)
                return true;
    }
    return false;
}

uint32_t cm1e_io_count(const cm1e_bus_t *bus)
{
    uint32_t count = 0;
    for (uint32_t position = 1; bus && bus->layout.present && position <= bus->slave_count; position++) {
        cm1e_io_info_t info = {0};
        while (cm1e_io_next(bus, cm1e_bus_at(bus, position), &info))
            count++;
    }
    return count;
}
