#include "init_slaves.h"

#include <string.h>

#include "bus/bus_image.h"
#include "command.h"
#include "core/bytes.h"
#include "device/module_kinds.h"
#include "pdo_list.h"

enum { CHANNELS = 8, STEP = 0x10, INPUTS = 0x6000, OUTPUTS = 0x7000, VALUE = 0x11 };

static void print_identity(FILE *file, const cm1e_slave_info_t *slave)
{
    if (slave->vendor_id)
        fprintf(file, "    vendor: 0x%08X\n", (unsigned)slave->vendor_id);
    if (slave->product_code)
        fprintf(file, "    product: 0x%08X\n", (unsigned)slave->product_code);
    if (slave->revision)
        fprintf(file, "    # revision: 0x%08X   # without the leading # another revision is an error\n",
                (unsigned)slave->revision);
}

/** The modules that a modular device has found in its slots (ETG.5001). */
typedef struct module_list {
    unsigned count; /**< 0: it is none, or it has more than a bus file can name */
    uint32_t idents[CM1E_SLAVE_MODULES];
} module_list_t;

static uint32_t read_number(cm1e_bus_t *bus, uint16_t position, unsigned index, unsigned subindex)
{
    uint8_t data[4] = {0};
    size_t size = sizeof data;
    return cm1e_sdo_read(bus, position, (uint16_t)index, (uint8_t)subindex, data, &size, NULL) == CM1E_OK
               ? cm1e_get_u32(data) : 0;
}

static void print_modules(FILE *file, cm1e_bus_t *bus, uint16_t position, module_list_t *list)
{
    enum { DETECTED = 0xF050 };
    const unsigned count = cm1e_bus_slave_has_coe(bus, position) ? read_number(bus, position, DETECTED, 0) & 0xFF : 0;
    list->count = count <= CM1E_SLAVE_MODULES ? count : 0;
    for (unsigned n = 0; n < list->count; n++) {
        list->idents[n] = read_number(bus, position, DETECTED, n + 1);
        fprintf(file, "%s0x%08X", n ? ", " : "    modules: [", (unsigned)list->idents[n]);
    }
    if (list->count)
        fprintf(file, "]   # slot by slot\n");
}

/** A mailbox tells the objects; without one only the place counts. Entries beyond the maximum are comments. */
static void print_signals(FILE *file, const pdo_list_t *list, bool output, unsigned *named)
{
    unsigned number = 0;
    for (size_t i = 0; i < list->count; i++) {
        const listed_entry_t *entry = &list->entries[i];
        if (entry->output != output || entry->index == 0)
            continue;
        if (++number == 1)
            fprintf(file, "    %s:\n", output ? "outputs" : "inputs");
        const char *comment = ++*named > CM1E_SLAVE_SIGNALS ? "# " : "";
        fprintf(file, "      %s- {name: %s%u, ", comment, output ? "out" : "in", number);
        if (list->by_coe)
            fprintf(file, "object: 0x%04X:%02X}", entry->index, entry->subindex);
        else if (entry->bits == 1)
            fprintf(file, "bit: %u}", entry->bit);
        else
            fprintf(file, "bit: %u, bits: %u}", entry->bit, entry->bits);
        fprintf(file, "   # %s%s%s%s%s\n", entry->type, entry->pdo_name[0] ? ", " : "", entry->pdo_name,
                entry->name[0] ? ", " : "", entry->name);
    }
}

/* ---- the simulated device ---------------------------------------------------------------------------------------- */

/** Bits in a row from 0 on, and nothing else. */
static bool is_digital(const pdo_list_t *list, unsigned counts[2])
{
    counts[0] = counts[1] = 0;
    for (size_t i = 0; i < list->count; i++) {
        const listed_entry_t *entry = &list->entries[i];
        if (list->by_coe || entry->bits != 1 || entry->index == 0 || entry->bit != counts[entry->output])
            return false;
        counts[entry->output]++;
    }
    return counts[0] <= CHANNELS && counts[1] <= CHANNELS && counts[0] + counts[1] > 0;
}

/** Whether a simulated device with CoE has the objects, analog or encoder: see src/sim/io_device_objects.c. `states`: of
 *  the bits that it has for an input. */
static bool is_of_values(const pdo_list_t *list, unsigned bits, unsigned states, unsigned counts[2])
{
    counts[0] = counts[1] = 0;
    for (size_t i = 0; i < list->count; i++) {
        const listed_entry_t *entry = &list->entries[i];
        const unsigned first = entry->output ? OUTPUTS : INPUTS, channel = (entry->index - first) / STEP;
        const bool value = entry->subindex == VALUE && entry->bits == bits;
        const bool state = !entry->output && entry->subindex >= 1 && entry->subindex <= states && entry->bits == 1;
        if (entry->index == 0)
            continue;
        if (entry->index < first || entry->index % STEP || channel >= CHANNELS || (!value && !state))
            return false;
        if (channel >= counts[entry->output])
            counts[entry->output] = channel + 1;
    }
    return list->by_coe && counts[0] + counts[1] > 0;
}

/** The kind of the simulated device that has these process data, and its channels, inputs and outputs; NULL: none. */
static const char *simulated_device(const pdo_list_t *list, unsigned counts[2])
{
    if (is_digital(list, counts))
        return "digital";
    if (is_of_values(list, 16, 2, counts))
        return "analog";
    return is_of_values(list, 32, 1, counts) && !counts[1] ? "encoder" : NULL;
}

/** A byte each way: the device that the simulator has where the file names none (`sim_gaps`). */
static bool is_module(const pdo_list_t *list)
{
    return !list->by_coe && list->count == 2 && list->entries[0].bits == 8 && list->entries[1].bits == 8 &&
           list->entries[0].output != list->entries[1].output;
}

static bool are_simulated(const module_list_t *modules)
{
    for (unsigned n = 0; n < modules->count; n++)
        if (!cm1e_module_kind(modules->idents[n]))
            return false;
    return modules->count > 0 && modules->count <= CHANNELS;
}

static void print_sim(FILE *file, const pdo_list_t *list, const module_list_t *modules)
{
    unsigned counts[2]; /* inputs, outputs */
    const char *device = simulated_device(list, counts);
    if (list->unknown)
        return;
    if (are_simulated(modules)) {
        fprintf(file, "    sim: {device: modular}\n");
    } else if (list->count == 0) {
        fprintf(file, "    sim: {device: coupler}\n");
    } else if (device) {
        fprintf(file, "    sim: {device: %s", device);
        if (counts[0])
            fprintf(file, ", inputs: %u", counts[0]);
        if (counts[1])
            fprintf(file, ", outputs: %u", counts[1]);
        fprintf(file, "}\n");
    } else if (!is_module(list)) {
        fprintf(file, "    # The simulator has no such device: without its inputs and outputs the file runs there.\n");
    }
}

void init_print_slave(FILE *file, cm1e_bus_t *bus, const cm1e_slave_info_t *slave)
{
    pdo_list_t list;
    unsigned named = 0;
    module_list_t modules;
    print_identity(file, slave);
    print_modules(file, bus, slave->position, &modules);
    if (!pdo_list_read(bus, slave->position, &list)) {
        complain("out of memory");
        return;
    }
    if (list.unknown)
        fprintf(file, "    # Its process data could not be read.\n");
    print_signals(file, &list, true, &named);
    print_signals(file, &list, false, &named);
    print_sim(file, &list, &modules);
    pdo_list_free(&list);
}
