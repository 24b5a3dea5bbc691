/* The check of the slaves without an axis. Keys are those of a bus file. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "config/io_types.h"
#include "config/ranges.h"
#include "device/module_kinds.h"
#include "device/place.h"

enum { WATCHDOG_MS_MAX = 6000, FIRST_OBJECT = 0x1000, PDOS_OF_A_KIND = 0x200, OUTPUT_PDO = 0x1600, INPUT_PDO = 0x1A00 };
enum { PROCESS_DATA_BITS = 8 * 1486, CHANNELS_MAX = 8 };
#define COUNTS_PER_S_MAX 1e9

typedef struct slave_check {
    const cm1e_bus_config_t *config;
    cm1e_config_problem_t *problem;
    const cm1e_slave_config_t *slave;
    uint32_t index;
    char name[CM1E_NAME_LENGTH];
} slave_check_t;

__attribute__((format(printf, 3, 4)))
static bool slave_wrong(const slave_check_t *check, const char *key, const char *format, ...)
{
    cm1e_config_problem_t *problem = check->problem;
    snprintf(problem->path, sizeof problem->path, "slaves[%u].%s", check->index, key);
    const int length = snprintf(problem->text, sizeof problem->text, "slave %s: %s ", check->name, key);
    va_list args;
    va_start(args, format);
    vsnprintf(problem->text + length, sizeof problem->text - (size_t)length, format, args);
    va_end(args);
    return false;
}

/* ---- name and address -------------------------------------------------------------------------------------------- */

static void effective_name(char name[CM1E_NAME_LENGTH], const char *stated, const char *kind, uint32_t index)
{
    if (stated[0])
        snprintf(name, CM1E_NAME_LENGTH, "%s", stated);
    else
        snprintf(name, CM1E_NAME_LENGTH, "%s%u", kind, index + 1);
}

/* "3" and "slave 3" name a slave by its position. */
static bool is_a_position(const char *name)
{
    if (strncasecmp(name, "slave ", 6) == 0)
        name += 6;
    return name[strspn(name, "0123456789")] == '\0';
}

static bool check_name(slave_check_t *check)
{
    char other[CM1E_NAME_LENGTH];
    snprintf(check->name, sizeof check->name, "%u", check->index + 1);
    if (!IS_TEXT(check->slave->name))
        return slave_wrong(check, "name", NO_TEXT, sizeof check->slave->name);
    effective_name(check->name, check->slave->name, "slave", check->index);
    if (strchr(check->name, '.') || is_a_position(check->name))
        return slave_wrong(check, "name", "is '%s'; expected a name without '.' that is no position, because signals "
                           "are found as in \"valves.clamp\" and \"3.input 1\"", check->name);
    for (uint32_t i = 0; i < check->index; i++) {
        effective_name(other, check->config->slaves[i].name, "slave", i);
        if (strcasecmp(other, check->name) == 0)
            return slave_wrong(check, "name", "is also the name of entry %u of the list; expected a name of its own",
                               i + 1);
    }
    for (uint32_t i = 0; i < check->config->axis_count; i++) {
        effective_name(other, check->config->axes[i].name, "axis", i);
        if (strcasecmp(other, check->name) == 0)
            return slave_wrong(check, "name", "is also the name of an axis; expected a name of its own");
    }
    return true;
}

static bool check_address(const slave_check_t *check)
{
    const cm1e_bus_config_t *config = check->config;
    const cm1e_slave_config_t *slave = check->slave;
    const unsigned kind = slave->address_kind;
    if (kind > CM1E_ADDRESS_EXPLICIT_ID)
        return slave_wrong(check, "position", "is of the unknown kind %u; expected position, alias or explicit ID",
                           kind);
    const char *key = cm1e_config_addresses[kind].key;
    if (slave->address == 0)
        return slave_wrong(check, "position", "is missing; expected position, alias or explicit_id");
    if (slave->address > cm1e_config_addresses[kind].maximum)
        return slave_wrong(check, key, "is %u; expected 1 ... %u", slave->address, cm1e_config_addresses[kind].maximum);
    const bool is_member = cm1e_slave_is_member(slave);
    for (uint32_t i = 0; i < check->index; i++)
        if (config->slaves[i].address_kind == slave->address_kind && config->slaves[i].address == slave->address &&
            is_member == cm1e_slave_is_member(&config->slaves[i]) &&
            (!is_member || strcmp(config->slaves[i].hot_connect, slave->hot_connect) == 0))
            return slave_wrong(check, key, "is %u, which entry %u of the list has already; expected one slave at each "
                               "address", slave->address, i + 1);
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (!is_member && cm1e_axis_has_motor(&config->axes[i]) &&
            config->axes[i].address_kind == slave->address_kind && cm1e_axis_address(config, i) == slave->address)
            return slave_wrong(check, key, "is %u, where the axis %.31s is; expected another place, or an axis that "
                               "states its own", slave->address, config->axes[i].name);
    return true;
}

/* ---- PDOs and start-up SDOs -------------------------------------------------------------------------------------- */

static bool is_pdo(uint16_t pdo, uint16_t first) { return pdo >= first && pdo < first + PDOS_OF_A_KIND; }

static bool check_assignment(const slave_check_t *check, const char *key, const uint16_t *pdos, unsigned count,
                             uint16_t first)
{
    char place[32];
    if (count > CM1E_SLAVE_PDOS)
        return slave_wrong(check, key, "has %u PDOs; expected at most %d", count, CM1E_SLAVE_PDOS);
    for (unsigned i = 0; i < count; i++) {
        snprintf(place, sizeof place, "%s[%u]", key, i);
        if (!is_pdo(pdos[i], first))
            return slave_wrong(check, place, "is 0x%04X; expected 0x%04X ... 0x%04X", pdos[i], first,
                               first + PDOS_OF_A_KIND - 1);
        for (unsigned j = 0; j < i; j++)
            if (pdos[j] == pdos[i])
                return slave_wrong(check, place, "is 0x%04X, which the list has already; expected it once", pdos[i]);
    }
    return true;
}

static bool check_entries(const slave_check_t *check)
{
    const cm1e_slave_config_t *slave = check->slave;
    if (slave->entry_count > CM1E_SLAVE_PDO_ENTRIES)
        return slave_wrong(check, "mapping", "has %u entries; expected at most %d in all PDOs", slave->entry_count,
                           CM1E_SLAVE_PDO_ENTRIES);
    for (unsigned i = 0; i < slave->entry_count; i++) {
        const cm1e_pdo_entry_config_t *entry = &slave->entries[i];
        if (!is_pdo(entry->pdo, OUTPUT_PDO) && !is_pdo(entry->pdo, INPUT_PDO))
            return slave_wrong(check, "mapping", "has the PDO 0x%04X; expected 0x1600 ... 0x17FF or 0x1A00 ... 0x1BFF",
                               entry->pdo);
        if (entry->bits == 0)
            return slave_wrong(check, "mapping", "has an entry of 0 bits in 0x%04X; expected 1 ... 255", entry->pdo);
        for (unsigned j = 0; j + 1 < i; j++)
            if (slave->entries[j].pdo == entry->pdo && slave->entries[i - 1].pdo != entry->pdo)
                return slave_wrong(check, "mapping", "has the PDO 0x%04X twice; expected all its entries together",
                                   entry->pdo);
    }
    return true;
}

/** Whether the bytes of an SDO of more than 8 are there. */
static bool has_data(const cm1e_slave_config_t *slave, const cm1e_sdo_config_t *sdo)
{
    return slave->sdo_data_count <= CM1E_SLAVE_SDO_DATA && sdo->size > 0 && sdo->size <= slave->sdo_data_count &&
           sdo->value <= (uint64_t)slave->sdo_data_count - sdo->size;
}

static bool check_sdos(const slave_check_t *check)
{
    const cm1e_slave_config_t *slave = check->slave;
    char place[32];
    if (slave->sdo_count > CM1E_SLAVE_SDOS)
        return slave_wrong(check, "sdo", "has %u entries; expected at most %d", slave->sdo_count, CM1E_SLAVE_SDOS);
    for (unsigned i = 0; i < slave->sdo_count; i++) {
        snprintf(place, sizeof place, "sdo[%u].object", i);
        if (slave->sdos[i].index < FIRST_OBJECT)
            return slave_wrong(check, place, "is 0x%04X:%02X; expected an object from 0x1000 on", slave->sdos[i].index,
                               slave->sdos[i].subindex);
        if (slave->sdos[i].bytes > 8 || (slave->sdos[i].bytes == 0 && !has_data(slave, &slave->sdos[i])))
            return slave_wrong(check, place, "has %u bytes; expected 1 ... 8, or data of its own",
                               slave->sdos[i].bytes);
        if (slave->sdos[i].complete_access && slave->sdos[i].subindex > 1)
            return slave_wrong(check, place, "has complete access from sub-index %u on; expected 0 or 1",
                               slave->sdos[i].subindex);
    }
    return true;
}

/* ---- signals ----------------------------------------------------------------------------------------------------- */

/* "input 3", "output 3" and "0x6000:01" name a signal already. */
static bool is_a_place(const char *name)
{
    static const char *const words[] = {"input ", "output "};
    for (int i = 0; i < 2; i++)
        if (strncasecmp(name, words[i], strlen(words[i])) == 0 && isdigit((unsigned char)name[strlen(words[i])]))
            return true;
    return strncasecmp(name, "0x", 2) == 0;
}

static bool check_signal_name(const slave_check_t *check, const cm1e_signal_config_t *signal, const char *key)
{
    if (!IS_TEXT(signal->name) || !signal->name[0] || is_a_place(signal->name))
        return slave_wrong(check, key, "has the name '%s'; expected a text of 1 to %d bytes, unlike \"%s 1\" and "
                           "\"0x6000:01\"", IS_TEXT(signal->name) ? signal->name : "?", CM1E_NAME_LENGTH - 1,
                           signal->output ? "output" : "input");
    for (const cm1e_signal_config_t *other = check->slave->signals; other < signal; other++)
        if (strcasecmp(other->name, signal->name) == 0)
            return slave_wrong(check, key, "has the name '%s', which another signal of the slave has already; expected "
                               "a name of its own", signal->name);
    return true;
}

static bool check_signal_type(const slave_check_t *check, const cm1e_signal_config_t *signal, const char *key)
{
    if ((unsigned)signal->type >= CM1E_IO_TYPE_COUNT)
        return slave_wrong(check, key, "has the type %d; expected one of the enumeration", (int)signal->type);
    const cm1e_io_type_row_t *type = &cm1e_io_types[signal->type];
    const bool exact = signal->type == CM1E_IO_BOOL || type->is_real;
    if (signal->index && (signal->bit || signal->bits))
        return slave_wrong(check, key, "is an object, and a bit is given; expected one of them");
    if (signal->type_stated && signal->bits && type->bits && (exact ? signal->bits != type->bits
                                                                    : signal->bits > type->bits))
        return slave_wrong(check, key, "has %u bits; a %s has %u", signal->bits, type->name, type->bits);
    if (!signal->index && signal->type_stated && signal->type == CM1E_IO_BYTES && !signal->bits)
        return slave_wrong(check, key, "is of type BYTES; expected its number of bits too");
    if ((unsigned)signal->bit + signal->bits > PROCESS_DATA_BITS)
        return slave_wrong(check, key, "ends with bit %u; expected at most %d", signal->bit + signal->bits,
                           PROCESS_DATA_BITS);
    return true;
}

/* Of an object whose type only the slave knows, its range is checked at the start. */
static bool check_safe(const slave_check_t *check, const cm1e_signal_config_t *signal, const char *key)
{
    const bool known = signal->type_stated || !signal->index;
    const cm1e_io_type_t type =
        signal->type_stated ? signal->type : cm1e_io_type_of_bits(signal->bits ? signal->bits : 1);
    const unsigned bits = signal->bits ? signal->bits : cm1e_io_types[type].bits;
    if (signal->hold && signal->safe != 0)
        return slave_wrong(check, key, "holds its value, and a safe value is given; expected one of them");
    if (!signal->output && (signal->hold || signal->safe != 0))
        return slave_wrong(check, key, "is an input, which has no safe value; expected none");
    if (signal->safe == 0 || !known || cm1e_io_fits(type, bits, signal->safe))
        return true;
    return slave_wrong(check, key, "has the safe value %.10g, which is no %s of %u bits", signal->safe,
                       cm1e_io_types[type].name, bits);
}

static bool check_signals(const slave_check_t *check)
{
    const cm1e_slave_config_t *slave = check->slave;
    unsigned counts[2] = {0, 0};
    if (slave->signal_count > CM1E_SLAVE_SIGNALS)
        return slave_wrong(check, "inputs", "and outputs have %u entries; expected at most %d", slave->signal_count,
                           CM1E_SLAVE_SIGNALS);
    for (unsigned i = 0; i < slave->signal_count; i++) {
        const cm1e_signal_config_t *signal = &slave->signals[i];
        char key[24];
        snprintf(key, sizeof key, "%s[%u]", signal->output ? "outputs" : "inputs", counts[signal->output]++);
        if (!check_signal_name(check, signal, key) || !check_signal_type(check, signal, key) ||
            !check_safe(check, signal, key))
            return false;
    }
    return true;
}

/* ---- the simulated device ---------------------------------------------------------------------------------------- */

static bool check_wire(const slave_check_t *check)
{
    const cm1e_sim_slave_config_t *sim = &check->slave->sim;
    char name[CM1E_NAME_LENGTH];
    if (!IS_TEXT(sim->wired_to))
        return slave_wrong(check, "sim.wired_to", NO_TEXT, sizeof sim->wired_to);
    if (!sim->wired_to[0])
        return true;
    if (sim->inputs == 0)
        return slave_wrong(check, "sim.wired_to", "is given, and there are no inputs to wire; expected one of them");
    for (uint32_t i = 0; i < check->config->slave_count; i++) {
        const cm1e_slave_config_t *other = &check->config->slaves[i];
        if (!IS_TEXT(other->name))
            continue;
        effective_name(name, other->name, "slave", i);
        if (strcasecmp(name, sim->wired_to) != 0)
            continue;
        return (other->sim.kind == sim->kind && other->sim.outputs > 0) ||
               slave_wrong(check, "sim.wired_to", "is '%s', which has no simulated outputs of this kind; expected a "
                           "slave that has", sim->wired_to);
    }
    return slave_wrong(check, "sim.wired_to", "is '%s'; expected the name of a slave of the list", sim->wired_to);
}

static bool check_sim(const slave_check_t *check)
{
    const cm1e_sim_slave_config_t *sim = &check->slave->sim;
    const unsigned modules = check->slave->module_count;
    const bool has_coe = sim->kind == CM1E_SIM_SLAVE_ANALOG || sim->kind == CM1E_SIM_SLAVE_ENCODER;
    const bool has_channels = sim->kind == CM1E_SIM_SLAVE_DIGITAL || has_coe;
    if ((unsigned)sim->kind > CM1E_SIM_SLAVE_ENCODER)
        return slave_wrong(check, "sim.device", "is %d; expected one of the enumeration", (int)sim->kind);
    if (sim->inputs > CHANNELS_MAX || sim->outputs > CHANNELS_MAX)
        return slave_wrong(check, sim->inputs > CHANNELS_MAX ? "sim.inputs" : "sim.outputs",
                           "is %u; expected 1 ... %d", sim->inputs > CHANNELS_MAX ? sim->inputs : sim->outputs,
                           CHANNELS_MAX);
    if (has_channels && sim->inputs == 0 && sim->outputs == 0)
        return slave_wrong(check, "sim", "has neither inputs nor outputs; expected their number, 1 ... %d",
                           CHANNELS_MAX);
    if (!has_channels && (sim->inputs || sim->outputs || sim->wired_to[0]))
        return slave_wrong(check, "sim", "has inputs or outputs, which its device has not; expected the device "
                           "digital, analog or encoder");
    if (sim->kind == CM1E_SIM_SLAVE_ENCODER && (sim->outputs || sim->wired_to[0]))
        return slave_wrong(check, sim->outputs ? "sim.outputs" : "sim.wired_to", "is given, and an encoder has inputs "
                           "only, which count by counts_per_s; expected none");
    if (modules > CM1E_SLAVE_MODULES)
        return slave_wrong(check, "modules", "has %u entries; expected at most %d", modules, CM1E_SLAVE_MODULES);
    if (sim->kind == CM1E_SIM_SLAVE_MODULAR && (modules == 0 || modules > CHANNELS_MAX))
        return slave_wrong(check, "modules", "has %u entries; expected 1 ... %d of a simulated modular device", modules,
                           CHANNELS_MAX);
    for (unsigned i = 0; i < modules && sim->kind == CM1E_SIM_SLAVE_MODULAR; i++)
        if (!cm1e_module_kind(check->slave->modules[i]))
            return slave_wrong(check, "modules", "has 0x%08X, which is not simulated; expected 0x%08X, 0x%08X, 0x%08X, "
                               "0x%08X, 0x%08X or 0x%08X", (unsigned)check->slave->modules[i], 0x105u, 0x108u, 0x205u,
                               0x208u, 0x302u, 0x402u);
    if (sim->swapped && !has_coe)
        return slave_wrong(check, "sim.swapped", "is true; expected it of the device analog or encoder only");
    if (!(fabs(sim->counts_per_s) <= COUNTS_PER_S_MAX) ||
        (sim->counts_per_s != 0 && sim->kind != CM1E_SIM_SLAVE_ENCODER))
        return slave_wrong(check, "sim.counts_per_s", "is %g; expected up to %g to both sides, of the device encoder "
                           "only", sim->counts_per_s, COUNTS_PER_S_MAX);
    return check_wire(check);
}

/* ---- all together ------------------------------------------------------------------------------------------------ */

static bool check_slave(slave_check_t *check)
{
    const cm1e_slave_config_t *slave = check->slave;
    if (!check_name(check) || !check_address(check))
        return false;
    if (slave->watchdog_ms > WATCHDOG_MS_MAX)
        return slave_wrong(check, "watchdog_ms", "is %u; expected 1 ... %d", slave->watchdog_ms, WATCHDOG_MS_MAX);
    char text[CM1E_WRONG_PULSES], absent[CM1E_WRONG_OPTIONAL];
    const char *wrong = cm1e_config_wrong_optional(check->config, check->index, absent);
    if (wrong)
        return slave_wrong(check, wrong, "%s", absent);
    const char *key = cm1e_config_wrong_pulses(check->config, &slave->dc, text);
    if (key)
        return slave_wrong(check, key, "%s", text);
    return check_assignment(check, "outputs_pdos", slave->outputs_pdos, slave->outputs_pdo_count, OUTPUT_PDO) &&
           check_assignment(check, "inputs_pdos", slave->inputs_pdos, slave->inputs_pdo_count, INPUT_PDO) &&
           check_entries(check) && check_sdos(check) && check_signals(check) && check_sim(check);
}

bool cm1e_config_check_slaves(const cm1e_bus_config_t *config, cm1e_config_problem_t *problem)
{
    slave_check_t check = {.config = config, .problem = problem};
    if (config->slave_count > CM1E_MAX_SLAVES || (config->slave_count > 0 && !config->slaves)) {
        snprintf(problem->text, sizeof problem->text, "slave_count is %u; expected at most %d, made with "
                 "cm1e_bus_config_add_slave()", config->slave_count, CM1E_MAX_SLAVES);
        return false;
    }
    for (check.index = 0; check.index < config->slave_count; check.index++) {
        check.slave = &config->slaves[check.index];
        if (!check_slave(&check))
            return false;
    }
    return true;
}
