/* The dictionary of an analog device, of an encoder, or of one with modules, in the shape of ETG.5001: a channel or
 * slot has its inputs at 0x6000, outputs at 0x7000 and settings at 0x8000, 0x10 apart. Of each analog input there are
 * two PDOs, one with state and value, one with the value. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "description/describe.h"
#include "sim/io_device.h"
#include "sim/store.h"

enum { RO = CM1E_ACCESS_READ, RW = RO | CM1E_ACCESS_WRITE, RW_PREOP = RW | CM1E_ACCESS_WRITE_PREOP_ONLY };
enum { STEP = 0x10, INPUTS = 0x6000, OUTPUTS = 0x7000, SETTINGS = 0x8000, OUTPUT_SETTINGS = 0x8080 };
enum { MODULAR_PROFILE = 0xF000, CONFIGURED = 0xF030, DETECTED = 0xF050 };
enum { FIRST_TXPDO = 0x1A00, TO_PARAMETER = 0x200, EXCLUDES = 6 };
enum { UNDERRANGE = 0x01, OVERRANGE = 0x02, VALUE = 0x11, OFFSET = 0x12, LIMIT = 32760 };

/* ---- making ------------------------------------------------------------------------------------------------------ */

static void add_object(cm1e_sim_io_objects_t *o, unsigned index, uint8_t code, unsigned highest, const char *name)
{
    o->objects[o->object_count++] = (cm1e_object_t){.index = (uint16_t)index, .object_code = code, .name = name,
                                                    .highest_subindex = (uint8_t)highest,
                                                    .entries = &o->entries[o->entry_count]};
}

static void add_entry(cm1e_sim_io_objects_t *o, unsigned subindex, unsigned access, cm1e_data_type_t type,
                      const char *name, int64_t value)
{
    static const uint8_t bits[] = {[CM1E_TYPE_BOOL] = 1, [CM1E_TYPE_INT] = 16, [CM1E_TYPE_USINT] = 8,
                                   [CM1E_TYPE_UINT] = 16, [CM1E_TYPE_UDINT] = 32};
    cm1e_object_t *object = &o->objects[o->object_count - 1];
    const bool is_signed = type == CM1E_TYPE_INT;
    object->entry_count++;
    o->entries[o->entry_count++] = (cm1e_entry_t){
        .index = object->index, .subindex = (uint8_t)subindex, .access = (uint8_t)access, .type = type,
        .bits = bits[type], .name = name, .unit = "", .default_value = value, .minimum = is_signed ? INT16_MIN : 0,
        .maximum = is_signed ? INT16_MAX : (INT64_C(1) << bits[type]) - 1};
}

static void add_count(cm1e_sim_io_objects_t *o, unsigned access, int64_t count)
{
    add_entry(o, 0, access, CM1E_TYPE_USINT, "Number of entries", count);
}

static void add_identity(cm1e_sim_io_objects_t *o, const cm1e_description_t *device)
{
    add_object(o, 0x1000, CM1E_OBJECT_VAR, 0, "Device type");
    add_entry(o, 0, RO, CM1E_TYPE_UDINT, "Device type", 0x00001389); /* modular device profile */
    add_object(o, OBJ_1018_IDENTITY, CM1E_OBJECT_RECORD, 4, "Identity");
    add_count(o, RO, 4);
    add_entry(o, 1, RO, CM1E_TYPE_UDINT, "Vendor ID", device->vendor_id);
    add_entry(o, 2, RO, CM1E_TYPE_UDINT, "Product code", device->product_code);
    add_entry(o, 3, RO, CM1E_TYPE_UDINT, "Revision number", device->revision);
    add_entry(o, 4, RO, CM1E_TYPE_UDINT, "Serial number", 0);
}

/* Mailbox out and in, outputs, inputs (ETG.1000.6 section 5.6.7.4). */
static void add_sync_managers(cm1e_sim_io_objects_t *o, bool swapped)
{
    static const uint8_t uses[] = {1, 2, 3, 4}, of_swapped[] = {1, 2, 4, 3};
    add_object(o, OBJ_1C00_SM_TYPES, CM1E_OBJECT_ARRAY, 4, "Sync manager type");
    add_count(o, RO, 4);
    for (unsigned i = 1; i <= 4; i++)
        add_entry(o, i, RO, CM1E_TYPE_USINT, "Sync manager type", swapped ? of_swapped[i - 1] : uses[i - 1]);
}

/* As the description has the PDO; further entries are empty. */
static void add_pdo(cm1e_sim_io_objects_t *o, const cm1e_described_pdo_t *pdo, unsigned access)
{
    add_object(o, pdo->index, CM1E_OBJECT_RECORD, IO_MAPPED, pdo->name);
    add_count(o, access, (int64_t)pdo->entries.count);
    for (unsigned i = 0; i < IO_MAPPED; i++) {
        const cm1e_described_pdo_entry_t *entry = i < pdo->entries.count ? &pdo->entries.at[i] : NULL;
        const uint32_t value =
            entry ? (uint32_t)entry->index << 16 | (uint32_t)entry->subindex << 8 | entry->bits : 0;
        add_entry(o, i + 1, access, CM1E_TYPE_UDINT, "Mapped object", value);
    }
}

static void add_pdos(cm1e_sim_io_objects_t *o, const cm1e_description_t *device, bool transmit, unsigned access)
{
    for (size_t i = 0; i < device->pdos.count; i++)
        if (device->pdos.at[i].transmit == transmit)
            add_pdo(o, &device->pdos.at[i], access);
}

/* Which PDOs may not be assigned beside it (ETG.1000.6 section 5.6.7.4): a string of octets, two for each. */
static void add_excludes(cm1e_sim_io_objects_t *o, const cm1e_description_t *device)
{
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        if (pdo->excludes.count == 0)
            continue;
        add_object(o, pdo->index - TO_PARAMETER, CM1E_OBJECT_RECORD, EXCLUDES, "PDO parameter");
        add_count(o, RO, EXCLUDES);
        add_entry(o, EXCLUDES, RO, CM1E_TYPE_UINT, "Exclude PDOs", pdo->excludes.at[0].index);
    }
}

/* 0x1C12 is that of sync manager 2, whatever it carries. */
static void add_assignment(cm1e_sim_io_objects_t *o, const cm1e_description_t *device, bool swapped, bool second,
                           unsigned access)
{
    const bool transmit = second != swapped;
    unsigned count = 0;
    uint16_t assigned[IO_CHANNELS] = {0};
    for (size_t i = 0; i < device->pdos.count && count < IO_CHANNELS; i++)
        if (device->pdos.at[i].transmit == transmit && device->pdos.at[i].sync_manager != CM1E_NO_SYNC_MANAGER)
            assigned[count++] = device->pdos.at[i].index;
    add_object(o, second ? OBJ_1C13_TXPDO_ASSIGN : OBJ_1C12_RXPDO_ASSIGN, CM1E_OBJECT_ARRAY, IO_CHANNELS,
               transmit ? "TxPDO assign" : "RxPDO assign");
    add_count(o, access, count);
    for (unsigned i = 0; i < IO_CHANNELS; i++)
        add_entry(o, i + 1, access, CM1E_TYPE_UINT, "Assigned PDO", assigned[i]);
}

/* How it is synchronised (ETG.1020): 1 by process data, 2 by SYNC0, 3 by SYNC1; all of these are supported. */
static void add_synchronisation(cm1e_sim_io_objects_t *o)
{
    for (unsigned index = OBJ_1C32_SM_OUTPUT_PARAMETER; index <= OBJ_1C32_SM_OUTPUT_PARAMETER + 1; index++) {
        add_object(o, index, CM1E_OBJECT_RECORD, 4, "Synchronisation");
        add_count(o, RO, 4);
        add_entry(o, 1, RW_PREOP, CM1E_TYPE_UINT, "Synchronisation type", 1);
        add_entry(o, 4, RO, CM1E_TYPE_UINT, "Synchronisation types supported", 0x000E);
    }
}

static void add_counters(cm1e_sim_io_objects_t *o, const cm1e_sim_slave_config_t *config)
{
    for (unsigned n = 0; n < config->inputs; n++) {
        add_object(o, INPUTS + n * STEP, CM1E_OBJECT_RECORD, VALUE, "Encoder");
        add_count(o, RO, VALUE);
        add_entry(o, UNDERRANGE, RO, CM1E_TYPE_BOOL, "Open circuit", 0);
        add_entry(o, VALUE, RO, CM1E_TYPE_UDINT, "Counter value", 0);
    }
}

static void add_channels(cm1e_sim_io_objects_t *o, const cm1e_sim_slave_config_t *config)
{
    if (config->kind == CM1E_SIM_SLAVE_ENCODER) {
        add_counters(o, config);
        return;
    }
    for (unsigned n = 0; n < config->inputs; n++) {
        add_object(o, INPUTS + n * STEP, CM1E_OBJECT_RECORD, VALUE, "Analog input");
        add_count(o, RO, VALUE);
        add_entry(o, UNDERRANGE, RO, CM1E_TYPE_BOOL, "Underrange", 0);
        add_entry(o, OVERRANGE, RO, CM1E_TYPE_BOOL, "Overrange", 0);
        add_entry(o, VALUE, RO, CM1E_TYPE_INT, "Value", 0);
    }
    for (unsigned n = 0; n < config->outputs; n++) {
        add_object(o, OUTPUTS + n * STEP, CM1E_OBJECT_RECORD, VALUE, "Analog output");
        add_count(o, RO, VALUE);
        add_entry(o, VALUE, RW, CM1E_TYPE_INT, "Value", 0);
    }
    for (unsigned n = 0; n < config->inputs; n++) {
        add_object(o, SETTINGS + n * STEP, CM1E_OBJECT_RECORD, OFFSET, "Settings of an analog input");
        add_count(o, RO, OFFSET);
        add_entry(o, OFFSET, RW, CM1E_TYPE_INT, "User offset", 0);
    }
    for (unsigned n = 0; n < config->outputs; n++) {
        add_object(o, OUTPUT_SETTINGS + n * STEP, CM1E_OBJECT_RECORD, OFFSET, "Settings of an analog output");
        add_count(o, RO, OFFSET);
        add_entry(o, OFFSET, RW, CM1E_TYPE_INT, "User offset", 0);
    }
}

static void add_slots(cm1e_sim_io_objects_t *o, const cm1e_sim_io_device_t *device, bool output)
{
    for (unsigned n = 0; n < device->module_count; n++) {
        const cm1e_module_kind_t *module = device->modules[n];
        if (module->output != output)
            continue;
        add_object(o, (output ? OUTPUTS : INPUTS) + n * STEP, CM1E_OBJECT_RECORD, module->channels, module->name);
        add_count(o, RO, module->channels);
        for (unsigned c = 1; c <= module->channels; c++)
            add_entry(o, c, output ? RW : RO, module->bits == 1 ? CM1E_TYPE_BOOL : CM1E_TYPE_INT, "Channel", 0);
    }
}

static void add_idents(cm1e_sim_io_objects_t *o, const cm1e_sim_io_device_t *device, unsigned index, unsigned access,
                       const char *name)
{
    const bool detected = access == RO;
    add_object(o, index, CM1E_OBJECT_ARRAY, device->module_count, name);
    add_count(o, access, detected ? device->module_count : 0);
    for (unsigned n = 0; n < device->module_count; n++)
        add_entry(o, n + 1, access, CM1E_TYPE_UDINT, "Module ident", detected ? device->modules[n]->ident : 0);
}

/* ETG.5001: what each slot has, and the lists of modules that are configured and detected. */
static void add_modules(cm1e_sim_io_objects_t *o, const cm1e_sim_io_device_t *device)
{
    add_slots(o, device, false);
    add_slots(o, device, true);
    add_object(o, MODULAR_PROFILE, CM1E_OBJECT_RECORD, 2, "Modular device profile");
    add_count(o, RO, 2);
    add_entry(o, 1, RO, CM1E_TYPE_UINT, "Index distance", STEP);
    add_entry(o, 2, RO, CM1E_TYPE_UINT, "Maximum number of modules", IO_CHANNELS);
    add_idents(o, device, CONFIGURED, RW_PREOP, "Configured module ident list");
    add_idents(o, device, DETECTED, RO, "Detected module ident list");
}

bool cm1e_sim_io_objects_create(cm1e_sim_io_device_t *device, const cm1e_slave_config_t *slave)
{
    cm1e_sim_io_objects_t *o = calloc(1, sizeof *o);
    cm1e_description_file_t file = {0};
    cm1e_describe_io_device(&file, slave);
    if (!o || file.arena.failed) {
        cm1e_description_file_free(&file);
        free(o);
        return false;
    }
    const cm1e_description_t *described = &file.devices.at[0];
    add_identity(o, described);
    const unsigned access = device->module_count ? RO : RW_PREOP; /* modules have the process data that they have */
    add_pdos(o, described, false, access);
    add_excludes(o, described);
    add_pdos(o, described, true, access);
    add_sync_managers(o, device->config.swapped);
    add_assignment(o, described, device->config.swapped, false, access);
    add_assignment(o, described, device->config.swapped, true, access);
    add_synchronisation(o);
    if (device->module_count)
        add_modules(o, device);
    else
        add_channels(o, &device->config);
    for (size_t i = 0; i < o->object_count; i++)
        if (o->objects[i].index >= 0x1600 && o->objects[i].index < 0x1C00)
            o->objects[i].name = "PDO mapping"; /* the names of the description end with it */
    cm1e_description_file_free(&file);
    device->objects = o;
    cm1e_sim_io_objects_power_on(device);
    return true;
}

/* ---- asking ------------------------------------------------------------------------------------------------------ */

const cm1e_object_t *cm1e_sim_io_objects_at(void *app, size_t n)
{
    const cm1e_sim_io_objects_t *o = ((const cm1e_sim_io_device_t *)app)->objects;
    return n < o->object_count ? &o->objects[n] : NULL;
}

const cm1e_entry_t *cm1e_sim_io_objects_entry(void *app, uint16_t index, uint8_t subindex)
{
    const cm1e_sim_io_objects_t *o = ((const cm1e_sim_io_device_t *)app)->objects;
    for (size_t i = 0; i < o->entry_count; i++)
        if (o->entries[i].index == index && o->entries[i].subindex == subindex)
            return &o->entries[i];
    return NULL;
}

/* NULL: there is no such entry. */
static int64_t *value_of(cm1e_sim_io_device_t *device, unsigned index, unsigned subindex)
{
    const cm1e_entry_t *entry = cm1e_sim_io_objects_entry(device, (uint16_t)index, (uint8_t)subindex);
    return entry ? &device->objects->values[entry - device->objects->entries] : NULL;
}

static uint32_t missing(cm1e_sim_io_device_t *device, uint16_t index)
{
    for (size_t i = 0; i < device->objects->object_count; i++)
        if (device->objects->objects[i].index == index)
            return SDO_ABORT_NO_SUBINDEX;
    return SDO_ABORT_NO_OBJECT;
}

uint32_t cm1e_sim_io_objects_read(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data,
                                  size_t *size)
{
    (void)al_state;
    cm1e_sim_io_device_t *device = app;
    const cm1e_entry_t *entry = cm1e_sim_io_objects_entry(app, index, subindex);
    if (!entry)
        return missing(device, index);
    cm1e_sim_io_objects_give(device);
    return cm1e_sim_give_number(entry, *value_of(device, index, subindex), data, size);
}

/* ---- process data ------------------------------------------------------------------------------------------------ */

static void resolve_pdo(cm1e_sim_io_device_t *device, unsigned pdo, cm1e_sim_io_image_t *image)
{
    const int64_t *count = value_of(device, pdo, 0);
    for (unsigned i = 1; count && i <= *count; i++) {
        const uint32_t mapped = (uint32_t)*value_of(device, pdo, i);
        int64_t *value = mapped >> 16 ? value_of(device, mapped >> 16, mapped >> 8 & 0xFF) : NULL;
        if (image->slot_count < IO_SLOTS)
            image->slots[image->slot_count++] =
                (cm1e_sim_io_slot_t){value, (uint16_t)image->bits, (uint16_t)(mapped & 0xFF)};
        image->bits += mapped & 0xFF;
    }
}

/* The object that assigns the PDOs of a direction: that of its sync manager. */
static uint16_t assignment_of(const cm1e_sim_io_device_t *device, bool inputs)
{
    return inputs != device->config.swapped ? OBJ_1C13_TXPDO_ASSIGN : OBJ_1C12_RXPDO_ASSIGN;
}

/* The objects of the assigned PDOs, so that the cycle need not search. */
static void resolve(cm1e_sim_io_device_t *device)
{
    for (unsigned direction = 0; direction < 2; direction++) {
        const unsigned index = assignment_of(device, direction);
        device->images[direction] = (cm1e_sim_io_image_t){0};
        for (unsigned i = 1; i <= *value_of(device, index, 0); i++)
            resolve_pdo(device, (unsigned)*value_of(device, index, i), &device->images[direction]);
    }
}

void cm1e_sim_io_objects_power_on(cm1e_sim_io_device_t *device)
{
    for (size_t i = 0; i < device->objects->entry_count; i++)
        device->objects->values[i] = device->objects->entries[i].default_value;
    resolve(device);
}

static void count(cm1e_sim_io_device_t *device)
{
    const int64_t taken_ns = device->sync0_ns < device->now_ns ? device->sync0_ns : device->now_ns;
    const double seconds = (double)(taken_ns - device->power_on_ns) * 1e-9;
    const int64_t counts = (int64_t)floor(device->config.counts_per_s * seconds);
    for (unsigned n = 0; n < device->config.inputs; n++)
        *value_of(device, INPUTS + n * STEP, VALUE) = (uint32_t)(device->is_held[n] ? device->held[n] : counts);
}

/* Inputs of a module are wired to the next module with such outputs before it. */
static void wire_modules(cm1e_sim_io_device_t *device)
{
    for (unsigned n = 0; n < device->module_count; n++) {
        const cm1e_module_kind_t *module = device->modules[n];
        for (unsigned from = n; from-- > 0 && !module->output;) {
            const cm1e_module_kind_t *source = device->modules[from];
            if (!source->output || source->bits != module->bits)
                continue;
            for (unsigned c = 1; c <= module->channels && c <= source->channels; c++)
                *value_of(device, INPUTS + n * STEP, c) = *value_of(device, OUTPUTS + from * STEP, c);
            break;
        }
    }
}

void cm1e_sim_io_objects_release(cm1e_sim_io_device_t *device)
{
    for (unsigned n = 0; n < device->module_count; n++)
        for (unsigned c = 1; device->modules[n]->output && c <= device->modules[n]->channels; c++)
            *value_of(device, OUTPUTS + n * STEP, c) = 0;
}

bool cm1e_sim_io_objects_modules_agree(const cm1e_sim_io_device_t *device)
{
    cm1e_sim_io_device_t *own = (cm1e_sim_io_device_t *)(uintptr_t)device;
    const int64_t *count = device->objects ? value_of(own, CONFIGURED, 0) : NULL;
    if (!count || *count == 0)
        return true;
    for (unsigned n = 1; n <= device->module_count; n++)
        if (*value_of(own, CONFIGURED, n) != *value_of(own, DETECTED, n))
            return false;
    return *count == device->module_count;
}

void cm1e_sim_io_objects_give(cm1e_sim_io_device_t *device)
{
    if (device->module_count) {
        wire_modules(device);
        return;
    }
    if (device->config.kind == CM1E_SIM_SLAVE_ENCODER) {
        count(device);
        return;
    }
    for (unsigned n = 0; n < device->config.inputs; n++) {
        const unsigned index = INPUTS + n * STEP;
        const int64_t value = cm1e_sim_io_terminal(device, n) + *value_of(device, SETTINGS + n * STEP, OFFSET);
        *value_of(device, index, UNDERRANGE) = value < -LIMIT;
        *value_of(device, index, OVERRANGE) = value > LIMIT;
        *value_of(device, index, VALUE) = value < -LIMIT ? -LIMIT : value > LIMIT ? LIMIT : value;
    }
}

void cm1e_sim_io_objects_take(cm1e_sim_io_device_t *device)
{
    for (unsigned n = 0; n < device->config.outputs && !device->module_count; n++)
        device->outputs[n] = (int16_t)(uint16_t)*value_of(device, OUTPUTS + n * STEP, VALUE) +
                             *value_of(device, OUTPUT_SETTINGS + n * STEP, OFFSET);
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static bool is_assigned(cm1e_sim_io_device_t *device, uint16_t pdo)
{
    const unsigned index = assignment_of(device, pdo >= FIRST_TXPDO);
    for (unsigned i = 1; i <= *value_of(device, index, 0); i++)
        if (*value_of(device, index, i) == pdo)
            return true;
    return false;
}

/* Whether an entry may be mapped; of inputs only objects of inputs, of outputs only objects of outputs. */
static bool can_be_mapped(cm1e_sim_io_device_t *device, uint16_t pdo, uint32_t mapped)
{
    const unsigned index = mapped >> 16, first = pdo < 0x1A00 ? OUTPUTS : INPUTS;
    const cm1e_entry_t *entry = cm1e_sim_io_objects_entry(device, (uint16_t)index, (uint8_t)(mapped >> 8));
    return index == 0 || (entry && entry->subindex > 0 && entry->bits == (mapped & 0xFF) && index >= first &&
                          index < first + 0x1000u);
}

static uint32_t check_mapping(cm1e_sim_io_device_t *device, uint16_t index, uint8_t subindex, int64_t value)
{
    if (is_assigned(device, index))
        return SDO_ABORT_STATE;
    if (subindex > 0 && *value_of(device, index, 0) != 0)
        return SDO_ABORT_SUBINDEX_0_NOT_ZERO;
    for (unsigned i = 1; subindex == 0 && i <= value && i <= IO_MAPPED; i++)
        if (!can_be_mapped(device, index, (uint32_t)*value_of(device, index, i)))
            return SDO_ABORT_PDO_MAPPING;
    return subindex == 0 && value > IO_MAPPED ? (uint32_t)SDO_ABORT_TOO_HIGH : 0;
}

static bool excludes_another(cm1e_sim_io_device_t *device, uint16_t index, int64_t count)
{
    for (unsigned i = 1; i <= count; i++) {
        const unsigned pdo = (unsigned)*value_of(device, index, i);
        const int64_t *excluded = value_of(device, pdo - TO_PARAMETER, EXCLUDES);
        for (unsigned n = 1; excluded && n <= count; n++)
            if (*value_of(device, index, n) == *excluded)
                return true;
    }
    return false;
}

static uint32_t check_assignment(cm1e_sim_io_device_t *device, uint16_t index, uint8_t subindex, int64_t value)
{
    const int first = index == assignment_of(device, false) ? 0x1600 : FIRST_TXPDO;
    if (subindex == 0 && value > IO_CHANNELS)
        return SDO_ABORT_TOO_HIGH;
    if (subindex == 0)
        return excludes_another(device, index, value) ? (uint32_t)SDO_ABORT_INCOMPATIBLE : 0;
    if (*value_of(device, index, 0) != 0)
        return SDO_ABORT_SUBINDEX_0_NOT_ZERO;
    const bool is_pdo = value >= first && value < first + 0x200 && value_of(device, (unsigned)value, 0);
    return is_pdo ? 0 : (uint32_t)SDO_ABORT_RANGE;
}

uint32_t cm1e_sim_io_objects_write(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                                   size_t size)
{
    cm1e_sim_io_device_t *device = app;
    const cm1e_entry_t *entry = cm1e_sim_io_objects_entry(app, index, subindex);
    if (!entry)
        return missing(device, index);
    uint32_t code = cm1e_sim_check_write(entry, al_state, size);
    if (code)
        return code;
    const int64_t value = cm1e_sim_take_number(entry, data);
    code = cm1e_sim_check_range(entry, value);
    if (code == 0 && index >= 0x1600 && index < 0x1C00)
        code = check_mapping(device, index, subindex, value);
    else if (code == 0 && (index == OBJ_1C12_RXPDO_ASSIGN || index == OBJ_1C13_TXPDO_ASSIGN))
        code = check_assignment(device, index, subindex, value);
    if (code)
        return code;
    *value_of(device, index, subindex) = value;
    resolve(device);
    return 0;
}
