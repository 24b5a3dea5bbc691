/* Devices with inputs and outputs as the bus file names them for the simulator: their SII. */
#include <string.h>

#include "device/module_kinds.h"
#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"

/* In SII word 0: a digital I/O process data interface, and whether the controller emulates the device (0x0141
 * bit 0). */
enum { PDI_DIGITAL_IO = 0x0004, DEVICE_EMULATION = 0x0100 };
enum { STEP = 0x10, INPUTS = 0x6000, OUTPUTS = 0x7000 };
enum { UNDERRANGE = 0x01, OVERRANGE = 0x02, OPEN_CIRCUIT = 0x01, VALUE = 0x11 };
enum { OUTPUT_PDO = 0x1600, INPUT_PDO = 0x1A00 };

static void add_entry(cm1e_arena_t *arena, cm1e_described_pdo_t *pdo, unsigned index, unsigned subindex, uint32_t bits,
                      const char *name)
{
    cm1e_described_pdo_entry_t *entry = CM1E_APPEND(arena, &pdo->entries);
    entry->index = (uint16_t)index;
    entry->subindex = (uint8_t)subindex;
    entry->bits = bits;
    entry->name = name;
    entry->type = index == 0 ? "" : bits == 1 ? "BOOL" : bits == 32 ? "UDINT" : "INT";
}

static cm1e_described_pdo_t *add_pdo(cm1e_arena_t *arena, cm1e_description_t *device, unsigned index, const char *kind,
                                     unsigned channel, int sync_manager)
{
    cm1e_described_pdo_t *pdo = CM1E_APPEND(arena, &device->pdos);
    pdo->transmit = index >= INPUT_PDO;
    pdo->index = (uint16_t)index;
    pdo->name = cm1e_arena_format(arena, "%s %u", kind, channel + 1);
    pdo->sync_manager = sync_manager;
    return pdo;
}

/* ---- digital ----------------------------------------------------------------------------------------------------- */

static void add_sync_manager(cm1e_arena_t *arena, cm1e_description_t *device, cm1e_sync_manager_use_t use)
{
    const bool outputs = use == CM1E_SM_OUTPUTS;
    cm1e_described_sync_manager_t *manager = CM1E_APPEND(arena, &device->sync_managers);
    manager->use = use;
    manager->start = outputs ? 0x1000 : 0x1100;
    manager->length = 1;
    manager->length_given = true;
    manager->control = outputs ? 0x44 : 0x00; /* buffered, outputs with watchdog */
    manager->enable = 1;
    cm1e_described_fmmu_t *fmmu = CM1E_APPEND(arena, &device->fmmus);
    fmmu->use = outputs ? CM1E_FMMU_OUTPUTS : CM1E_FMMU_INPUTS;
}

/* As digital terminals have it: a PDO per channel, and no sync manager for a direction without any. */
static void describe_digital(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_sim_slave_config_t *sim)
{
    int manager = 0;
    for (unsigned n = 0; n < sim->outputs; n++)
        add_entry(arena, add_pdo(arena, device, OUTPUT_PDO + n, "Channel", n, manager), OUTPUTS + n * STEP, 1, 1,
                  "Output");
    if (sim->outputs) {
        add_sync_manager(arena, device, CM1E_SM_OUTPUTS);
        manager++;
    }
    for (unsigned n = 0; n < sim->inputs; n++)
        add_entry(arena, add_pdo(arena, device, INPUT_PDO + n, "Channel", n, manager), INPUTS + n * STEP, 1, 1,
                  "Input");
    if (sim->inputs)
        add_sync_manager(arena, device, CM1E_SM_INPUTS);
}

static void describe_eeprom(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    /* A controller that emulates the device knows no explicit ID. */
    const bool emulates = slave->address_kind != CM1E_ADDRESS_EXPLICIT_ID;
    uint8_t config[CM1E_SII_CONFIG_BYTES] = {0};
    cm1e_put_u16(config, PDI_DIGITAL_IO | (emulates ? DEVICE_EMULATION : 0));
    device->eeprom.byte_size = 2048;
    device->eeprom.version = 1;
    device->eeprom.config_data = (cm1e_bytes_t){cm1e_arena_bytes(arena, config, sizeof config), sizeof config};
}

/* ---- analog ------------------------------------------------------------------------------------------------------ */

/* As devices of this kind have them: by process data, by SYNC0 with every cycle, and several samples a cycle, with
 * SYNC1 for the last one. */
static void add_dc_modes(cm1e_arena_t *arena, cm1e_description_t *device)
{
    static const cm1e_dc_mode_t modes[] = {
        {.name = "SM-Synchron"},
        {.name = "DC-Synchron", .assign_activate = 0x0300, .sync0_given = true, .sync0_factor = 1,
         .sync0_shift_ns = 10000},
        {.name = "DC-Oversampling", .assign_activate = 0x0730, .sync0_given = true, .sync1_given = true,
         .sync0_factor = -4, .sync1_factor = 4},
    };
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++)
        *(cm1e_dc_mode_t *)CM1E_APPEND(arena, &device->dc_modes) = modes[i];
}

static void exclude(cm1e_arena_t *arena, cm1e_described_pdo_t *pdo, unsigned index)
{
    cm1e_exclude_t *excluded = CM1E_APPEND(arena, &pdo->excludes);
    excluded->index = (uint16_t)index;
}

/* A PDO for each counter: a bit of state, and padding up to the counter, as encoder terminals have it. */
static void describe_counters(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_sim_slave_config_t *sim)
{
    for (unsigned n = 0; n < sim->inputs; n++) {
        cm1e_described_pdo_t *pdo =
            add_pdo(arena, device, INPUT_PDO + n, "ENC Status Channel", n, CM1E_SM_NUMBER_INPUTS);
        add_entry(arena, pdo, INPUTS + n * STEP, OPEN_CIRCUIT, 1, "Open circuit");
        add_entry(arena, pdo, 0, 0, 15, NULL);
        add_entry(arena, pdo, INPUTS + n * STEP, VALUE, 32, "Counter value");
    }
}

/* A PDO for each slot, whose objects and PDOs are moved by its number (ETG.5001: SlotIndexIncrement 16,
 * SlotPdoIncrement 1). */
static void describe_modules(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    for (unsigned output = 0; output < 2; output++)
        for (unsigned n = 0; n < slave->module_count; n++) {
            const cm1e_module_kind_t *module = cm1e_module_kind(slave->modules[n]);
            if (!module || module->output != (output == 0))
                continue;
            cm1e_described_pdo_t *pdo = add_pdo(arena, device, (module->output ? OUTPUT_PDO : INPUT_PDO) + n, "Slot", n,
                                                module->output ? CM1E_SM_NUMBER_OUTPUTS : CM1E_SM_NUMBER_INPUTS);
            for (unsigned c = 0; c < module->channels; c++)
                add_entry(arena, pdo, (module->output ? OUTPUTS : INPUTS) + n * STEP, c + 1, module->bits,
                          cm1e_arena_format(arena, "Channel %u", c + 1));
            if (module->padding)
                add_entry(arena, pdo, 0, 0, module->padding, NULL);
        }
}

/* Outputs before inputs, or inputs on the first sync manager of process data and outputs on the second one. */
static void describe_managers(cm1e_arena_t *arena, cm1e_description_t *device, bool swapped)
{
    cm1e_sync_manager_t managers[4];
    memcpy(managers, cm1e_device_sync_managers, sizeof managers);
    if (swapped) {
        managers[CM1E_SM_NUMBER_OUTPUTS] = cm1e_device_sync_managers[CM1E_SM_NUMBER_INPUTS];
        managers[CM1E_SM_NUMBER_INPUTS] = cm1e_device_sync_managers[CM1E_SM_NUMBER_OUTPUTS];
    }
    for (size_t i = 0; swapped && i < device->pdos.count; i++)
        if (device->pdos.at[i].sync_manager != CM1E_NO_SYNC_MANAGER)
            device->pdos.at[i].sync_manager = device->pdos.at[i].transmit ? CM1E_SM_NUMBER_OUTPUTS
                                                                           : CM1E_SM_NUMBER_INPUTS;
    cm1e_describe_sync_managers(arena, device, managers, &device->pdos);
}

static void describe_analog(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_sim_slave_config_t *sim)
{
    for (unsigned n = 0; n < sim->outputs; n++)
        add_entry(arena, add_pdo(arena, device, OUTPUT_PDO + n, "AO Output Channel", n, CM1E_SM_NUMBER_OUTPUTS),
                  OUTPUTS + n * STEP, VALUE, 16, "Value");
    for (unsigned n = 0; n < sim->inputs; n++) {
        const unsigned index = INPUTS + n * STEP;
        cm1e_described_pdo_t *pdo =
            add_pdo(arena, device, INPUT_PDO + 2 * n, "AI Standard Channel", n, CM1E_SM_NUMBER_INPUTS);
        add_entry(arena, pdo, index, UNDERRANGE, 1, "Underrange");
        add_entry(arena, pdo, index, OVERRANGE, 1, "Overrange");
        add_entry(arena, pdo, 0, 0, 14, NULL);
        add_entry(arena, pdo, index, VALUE, 16, "Value");
        exclude(arena, pdo, INPUT_PDO + 2 * n + 1); /* the same channel */
        pdo = add_pdo(arena, device, INPUT_PDO + 2 * n + 1, "AI Compact Channel", n, CM1E_NO_SYNC_MANAGER);
        add_entry(arena, pdo, index, VALUE, 16, "Value");
        exclude(arena, pdo, INPUT_PDO + 2 * n);
    }
}

/* With a mailbox. */
static void describe_with_coe(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave)
{
    const cm1e_sim_slave_config_t *sim = &slave->sim;
    const cm1e_device_options_t options = {0};
    if (sim->kind == CM1E_SIM_SLAVE_ENCODER)
        describe_counters(arena, device, sim);
    else if (sim->kind == CM1E_SIM_SLAVE_MODULAR)
        describe_modules(arena, device, slave);
    else
        describe_analog(arena, device, sim);
    cm1e_describe_communication(arena, device, &options);
    add_dc_modes(arena, device);
    cm1e_describe_eeprom(arena, device, &options, false);
    describe_managers(arena, device, sim->swapped);
}

/* ---- identity ---------------------------------------------------------------------------------------------------- */

void cm1e_describe_io_identity(cm1e_description_file_t *file, const cm1e_slave_config_t *slave)
{
    if (file->devices.count == 0)
        return;
    cm1e_description_t *device = &file->devices.at[file->devices.count - 1];
    uint8_t config[CM1E_SII_CONFIG_BYTES] = {0};
    const cm1e_bytes_t present = device->eeprom.config_data;
    device->vendor_id = slave->vendor;
    device->product_code = slave->product ? slave->product : device->product_code;
    device->revision = slave->revision ? slave->revision : device->revision;
    device->eeprom.alias = slave->address_kind == CM1E_ADDRESS_ALIAS ? slave->address : 0;
    for (size_t i = 0; i < present.size && i < sizeof config; i++)
        config[i] = present.data[i];
    cm1e_put_u16(config + CM1E_SII_ALIAS, device->eeprom.alias);
    device->eeprom.config_data = (cm1e_bytes_t){cm1e_arena_bytes(&file->arena, config, sizeof config), sizeof config};
}

/* ---- any --------------------------------------------------------------------------------------------------------- */

/* Masters take devices of one product and revision for equal, so each has its own: 0xD0408 has 4 outputs, 8 inputs. */
static uint32_t product_code(const cm1e_sim_slave_config_t *sim)
{
    static const uint32_t kinds[] = {0, 0xC0000, 0xD0000, 0xA0000, 0xB0000, 0xE0000};
    return kinds[sim->kind] | (uint32_t)sim->swapped << 20 | (uint32_t)sim->outputs << 8 | sim->inputs;
}

void cm1e_describe_io_device(cm1e_description_file_t *file, const cm1e_slave_config_t *slave)
{
    static const char *const kinds[] = {"", "Coupler", "Digital", "Analog", "Modular", "Encoder"};
    const cm1e_sim_slave_config_t *sim = &slave->sim;
    cm1e_arena_t *arena = &file->arena;
    cm1e_description_t *device = CM1E_APPEND(arena, &file->devices);
    cm1e_description_init(device);
    device->product_code = product_code(sim);
    device->revision = 1;
    device->product_given = device->revision_given = true;
    device->name = sim->kind == CM1E_SIM_SLAVE_COUPLER
                       ? kinds[sim->kind]
                       : cm1e_arena_format(arena, "%s terminal %u+%u", kinds[sim->kind], sim->outputs, sim->inputs);
    device->type = device->name;
    device->group = "Simulated I/O";
    device->physics = "YY";
    if (sim->kind >= CM1E_SIM_SLAVE_ANALOG) {
        describe_with_coe(arena, device, slave);
    } else {
        describe_digital(arena, device, sim);
        describe_eeprom(arena, device, slave);
    }
    cm1e_describe_io_identity(file, slave);
}
