/* The slaves of a bus file: texts that name objects, PDOs and values become numbers. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "busfile/busfile.h"
#include "config/esi_reader.h"
#include "config/io_types.h"

typedef struct place {
    cm1e_config_problem_t *problem;
    uint32_t slave;
} place_t;

__attribute__((format(printf, 3, 4)))
static bool wrong(const place_t *place, const char *key, const char *format, ...)
{
    cm1e_config_problem_t *problem = place->problem;
    snprintf(problem->path, sizeof problem->path, "slaves[%u].%s", place->slave, key);
    va_list args;
    va_start(args, format);
    vsnprintf(problem->text, sizeof problem->text, format, args);
    va_end(args);
    return false;
}

/* ---- texts into numbers ------------------------------------------------------------------------------------------ */

/* "0x" and 1 ... `digits` hexadecimal digits; `*end` is behind them. */
static bool take_hex(const char *text, size_t digits, uint32_t *value, const char **end)
{
    static const char hex[] = "0123456789abcdefABCDEF";
    const size_t length = strncmp(text, "0x", 2) == 0 ? strspn(text + 2, hex) : 0;
    *value = (uint32_t)strtoul(text, NULL, 16);
    *end = text + 2 + length;
    return length >= 1 && length <= digits;
}

static bool convert_identity(const place_t *place, const char *key, const char *text, uint32_t *value)
{
    const char *end = "";
    *value = 0;
    if (text[0] == '\0' || (take_hex(text, 8, value, &end) && *end == '\0'))
        return true;
    return wrong(place, key, "%s is '%s'; expected it as in 0x0000001A", key, text);
}

/* "0x6000:01", "0x1A00"; `*end` is behind it. */
static bool take_object(const char *text, uint16_t *index, uint8_t *subindex, const char **end)
{
    static const char hex[] = "0123456789abcdefABCDEF";
    uint32_t value;
    if (!take_hex(text, 4, &value, end))
        return false;
    *index = (uint16_t)value;
    *subindex = 0;
    if (**end != ':')
        return true;
    const size_t length = strspn(*end + 1, hex);
    *subindex = (uint8_t)strtoul(*end + 1, NULL, 16);
    *end += 1 + length;
    return length >= 1 && length <= 2;
}

static bool convert_pdo(const place_t *place, const char *key, const char *text, uint16_t *pdo)
{
    const char *end;
    uint32_t value;
    const bool good = take_hex(text, 4, &value, &end) && *end == '\0';
    *pdo = (uint16_t)value;
    return good || wrong(place, key, "'%s' is no PDO; expected it as in 0x1A00", text);
}

static bool convert_pdos(const place_t *place, const char *key, const cm1e_busfile_text_t *texts, uint32_t count,
                         uint16_t *pdos, uint16_t *to_count)
{
    char item[32];
    for (uint32_t i = 0; i < count; i++) {
        snprintf(item, sizeof item, "%s[%u]", key, i);
        if (!convert_pdo(place, item, texts[i], &pdos[i]))
            return false;
    }
    *to_count = (uint16_t)count;
    return true;
}

/* ---- what is written into the slave ------------------------------------------------------------------------------ */

static bool take_entry(const char *text, cm1e_pdo_entry_config_t *entry)
{
    const char *end = text + 3;
    entry->index = 0;
    entry->subindex = 0;
    if (strncmp(text, "gap", 3) != 0 && !take_object(text, &entry->index, &entry->subindex, &end))
        return false;
    char *last;
    const unsigned long bits = *end == '/' ? strtoul(end + 1, &last, 10) : 0;
    entry->bits = (uint8_t)bits;
    return bits >= 1 && bits <= 255 && *last == '\0' && end[1] >= '1'; /* no sign, space or 0 */
}

static bool convert_mapping(const place_t *place, unsigned n, const cm1e_busfile_mapping_t *from,
                            cm1e_slave_config_t *slave)
{
    char key[40];
    uint16_t pdo;
    snprintf(key, sizeof key, "mapping[%u].pdo", n);
    if (!convert_pdo(place, key, from->pdo, &pdo))
        return false;
    for (uint32_t i = 0; i < from->count; i++) {
        snprintf(key, sizeof key, "mapping[%u].entries[%u]", n, i);
        if (slave->entry_count == CM1E_SLAVE_PDO_ENTRIES)
            return wrong(place, key, "the mapping of a slave has at most %d entries in all PDOs",
                         CM1E_SLAVE_PDO_ENTRIES);
        cm1e_pdo_entry_config_t *entry = &slave->entries[slave->entry_count++];
        if (!take_entry(from->entries[i], entry))
            return wrong(place, key, "'%s' is no entry of a PDO; expected object and bits as in 0x6000:01/16, or a gap "
                         "as in gap/8", from->entries[i]);
        entry->pdo = pdo;
    }
    return true;
}

/* true, false and their other spellings, as the file has them elsewhere. */
static bool take_truth(const char *text, uint64_t *raw)
{
    static const char *const words[] = {"false", "true", "off", "on", "no", "yes"};
    for (unsigned i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcasecmp(text, words[i]) == 0) {
            *raw = i % 2;
            return true;
        }
    return false;
}

static bool take_whole(const char *text, bool is_signed, unsigned bits, uint64_t *raw)
{
    const bool hex = strncmp(text, "0x", 2) == 0, negative = text[0] == '-';
    const char *digits = text + (hex ? 2 : negative);
    const char *allowed = hex ? "0123456789abcdefABCDEF" : "0123456789";
    if (digits[0] == '\0' || strspn(digits, allowed) != strlen(digits))
        return false;
    errno = 0;
    const uint64_t size = strtoull(digits, NULL, hex ? 16 : 10), half = UINT64_C(1) << (bits - 1);
    *raw = negative ? -size : size;
    if (errno)
        return false;
    if (is_signed && !hex)
        return size <= half - !negative;
    return !negative && (bits == 64 || size >> bits == 0);
}

/* Finite in the type, and 0 only if 0 is meant. */
static bool take_real(const char *text, bool is_narrow, double *value)
{
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || strpbrk(text, "xXnN"))
        return false;
    const double kept = is_narrow ? (double)(float)*value : *value; /* as it is written */
    return isfinite(kept) && (kept != 0 || (*value == 0 && errno == 0));
}

/* The bits of a value of this type; false: it is none. */
static bool take_value(const char *text, cm1e_io_type_t type, uint64_t *raw)
{
    const cm1e_io_type_row_t *row = &cm1e_io_types[type];
    double value;
    if (type == CM1E_IO_BOOL && take_truth(text, raw))
        return true;
    if (!row->is_real)
        return take_whole(text, row->is_signed, row->bits, raw);
    if (!take_real(text, type == CM1E_IO_REAL, &value))
        return false;
    const float narrow = (float)value;
    uint32_t word;
    memcpy(&word, &narrow, sizeof word);
    memcpy(raw, &value, sizeof value);
    *raw = type == CM1E_IO_REAL ? word : *raw;
    return true;
}

/* What a value of this type can be. */
static void list_values(cm1e_io_type_t type, char text[80])
{
    const cm1e_io_type_row_t *row = &cm1e_io_types[type];
    const uint64_t largest = UINT64_MAX >> (64 - row->bits), half = largest >> 1;
    if (type == CM1E_IO_BOOL)
        snprintf(text, 80, "true, false, 0 or 1");
    else if (row->is_real)
        snprintf(text, 80, "a number that is neither too large nor too small for it");
    else if (row->is_signed)
        snprintf(text, 80, "-%" PRIu64 " ... %" PRIu64 ", or 0x0 ... 0x%" PRIX64, half + 1, half, largest);
    else
        snprintf(text, 80, "0 ... %" PRIu64 ", or 0x0 ... 0x%" PRIX64, largest, largest);
}

/* "BOOL, SINT ...": of numbers only. */
static void list_types(char text[100])
{
    size_t used = 0;
    for (unsigned i = 0; i < CM1E_IO_BYTES; i++)
        used += (size_t)snprintf(text + used, 100 - used, "%s%s", i ? ", " : "", cm1e_io_types[i].name);
}

static bool convert_type(const place_t *place, const char *key, const char *text, cm1e_io_type_t *type)
{
    char types[100];
    const unsigned found = cm1e_io_type_of_name(text);
    *type = (cm1e_io_type_t)found;
    list_types(types);
    return found < CM1E_IO_BYTES || wrong(place, key, "type is '%s'; expected one of: %s", text, types);
}

static bool convert_sdo(const place_t *place, unsigned n, const cm1e_busfile_sdo_t *from, cm1e_sdo_config_t *sdo)
{
    char key[32];
    const char *end;
    cm1e_io_type_t type;
    snprintf(key, sizeof key, "sdo[%u].object", n);
    if (!take_object(from->object, &sdo->index, &sdo->subindex, &end) || *end != '\0')
        return wrong(place, key, "object is '%s'; expected it as in 0x8000:06, in hexadecimal", from->object);
    snprintf(key, sizeof key, "sdo[%u].type", n);
    if (!convert_type(place, key, from->type, &type))
        return false;
    sdo->bytes = (uint8_t)((cm1e_io_types[type].bits + 7) / 8);
    sdo->before_op = from->before_op != 0;
    snprintf(key, sizeof key, "sdo[%u].value", n);
    char values[80];
    list_values(type, values);
    return take_value(from->value, type, &sdo->value) ||
           wrong(place, key, "value is '%s', which is no %s; expected %s", from->value, cm1e_io_types[type].name,
                 values);
}

/* ---- signals ----------------------------------------------------------------------------------------------------- */

static bool convert_safe(const place_t *place, const char *key, const char *text, cm1e_signal_config_t *signal)
{
    uint64_t truth;
    signal->hold = strcasecmp(text, "hold") == 0;
    if (text[0] == '\0' || signal->hold || take_real(text, false, &signal->safe))
        return true;
    if (!take_truth(text, &truth))
        return wrong(place, key, "safe is '%s'; expected a number, true, false or hold", text);
    signal->safe = (double)truth;
    return true;
}

static bool convert_signal(const place_t *place, const char *list, unsigned n, const cm1e_busfile_signal_t *from,
                           cm1e_signal_config_t *signal)
{
    char key[32];
    const char *end;
    snprintf(key, sizeof key, "%s[%u].object", list, n);
    if (from->object[0] && (!take_object(from->object, &signal->index, &signal->subindex, &end) || *end != '\0' ||
                            signal->index == 0))
        return wrong(place, key, "object is '%s'; expected it as in 0x6000:01, in hexadecimal", from->object);
    key[strlen(key) - sizeof ".object" + 1] = '\0';
    if ((from->object[0] != '\0') == (from->bit != NULL))
        return wrong(place, key, "signal '%s' has %s; expected one of object and bit", from->name,
                     from->bit ? "an object and a bit" : "neither an object nor a bit");
    memcpy(signal->name, from->name, sizeof signal->name);
    signal->bit = from->bit ? *from->bit : 0;
    signal->bits = from->bits;
    snprintf(key, sizeof key, "%s[%u].type", list, n);
    signal->type_stated = from->type[0] != '\0';
    if (signal->type_stated && !convert_type(place, key, from->type, &signal->type))
        return false;
    if (from->bit && !signal->bits)
        signal->bits = signal->type_stated ? cm1e_io_types[signal->type].bits : 1;
    snprintf(key, sizeof key, "%s[%u].safe", list, n);
    return convert_safe(place, key, from->safe, signal);
}

static bool convert_signals(const place_t *place, const cm1e_busfile_slave_t *from, bool output,
                            cm1e_slave_config_t *slave)
{
    const cm1e_busfile_signal_t *signals = output ? from->outputs : from->inputs;
    const char *list = output ? "outputs" : "inputs";
    const uint32_t count = output ? from->output_count : from->input_count;
    for (uint32_t i = 0; i < count; i++) {
        if (slave->signal_count == CM1E_SLAVE_SIGNALS)
            return wrong(place, list, "inputs and outputs of a slave have at most %d names", CM1E_SLAVE_SIGNALS);
        cm1e_signal_config_t *signal = &slave->signals[slave->signal_count++];
        signal->output = output;
        if (!convert_signal(place, list, i, &signals[i], signal))
            return false;
    }
    return true;
}

/* ---- ESI --------------------------------------------------------------------------------------------------------- */

/* An ESI stands beside the bus file, unless its path begins with a slash. */
static bool take_esi(const place_t *place, cm1e_slave_config_t *slave, const cm1e_busfile_slave_t *from,
                     const char *path, int64_t cycle_time_ns)
{
    cm1e_diag_t diag = {0};
    const char *slash = strrchr(path, '/');
    const int folder = slash && from->esi[0] != '/' ? (int)(slash - path) + 1 : 0;
    if (!from->esi[0])
        return !from->esi_mode[0] || wrong(place, "esi_mode", "esi_mode is given without esi; expected both");
    if (!cm1e_esi_reader())
        return wrong(place, "esi", "esi is given, and this program cannot read ESI files: it has to be linked with "
                     "cm1e::generate");
    if (snprintf(slave->esi, sizeof slave->esi, "%.*s%s", folder, path, from->esi) >= (int)sizeof slave->esi)
        return wrong(place, "esi", "the path of the ESI is longer than %zu bytes", sizeof slave->esi - 1);
    if (cm1e_esi_reader()(slave, slave->esi, from->esi_mode, cycle_time_ns, &diag) == CM1E_OK)
        return true;
    if (diag.error == CM1E_ERROR_NO_MEMORY)
        return cm1e_busfile_no_memory(place->problem);
    return wrong(place, diag.error == CM1E_ERROR_NOT_FOUND && from->esi_mode[0] && strstr(diag.text, "OpMode")
                 ? "esi_mode" : "esi", "%.100s: %.280s", from->esi, diag.text);
}

/* ---- all together ------------------------------------------------------------------------------------------------ */

static bool convert_modules(const place_t *place, const cm1e_busfile_slave_t *from, cm1e_slave_config_t *slave)
{
    char key[24];
    for (uint32_t i = 0; i < from->module_count; i++) {
        const char *end;
        snprintf(key, sizeof key, "modules[%u]", i);
        if (!take_hex(from->modules[i], 8, &slave->modules[i], &end) || *end != '\0')
            return wrong(place, key, "'%s' is no ident of a module; expected it as in 0x00000205", from->modules[i]);
    }
    slave->module_count = (uint16_t)from->module_count;
    return true;
}

static bool convert_slave(const place_t *place, cm1e_slave_config_t *slave, const cm1e_busfile_slave_t *from)
{
    char name[CM1E_NAME_LENGTH];
    memcpy(name, slave->name, sizeof name); /* "slave<n>" */
    *slave = from->slave;
    if (slave->name[0] == '\0')
        memcpy(slave->name, name, sizeof name);
    const uint16_t stated[] = {from->position, from->alias, from->explicit_id};
    if (!cm1e_busfile_convert_address(stated, &slave->address_kind, &slave->address, "slaves", place->slave,
                                      place->problem) ||
        !convert_identity(place, "vendor", from->vendor, &slave->vendor) ||
        !convert_identity(place, "product", from->product, &slave->product) ||
        !convert_identity(place, "revision", from->revision, &slave->revision))
        return false;
    for (uint32_t i = 0; i < from->sdo_count; i++)
        if (!convert_sdo(place, i, &from->sdos[i], &slave->sdos[slave->sdo_count++]))
            return false;
    for (uint32_t i = 0; i < from->mapping_count; i++)
        if (!convert_mapping(place, i, &from->mappings[i], slave))
            return false;
    return convert_modules(place, from, slave) &&
           convert_pdos(place, "outputs_pdos", from->outputs_pdos, from->outputs_pdo_count, slave->outputs_pdos,
                        &slave->outputs_pdo_count) &&
           convert_pdos(place, "inputs_pdos", from->inputs_pdos, from->inputs_pdo_count, slave->inputs_pdos,
                        &slave->inputs_pdo_count) &&
           convert_signals(place, from, false, slave) && convert_signals(place, from, true, slave);
}

bool cm1e_busfile_convert_slaves(cm1e_bus_config_t *config, const cm1e_busfile_t *from, const char *path,
                                 cm1e_config_problem_t *problem)
{
    for (uint32_t i = 0; i < from->slave_count; i++) {
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(config, NULL);
        const place_t place = {problem, i};
        if (!slave)
            return cm1e_busfile_no_memory(problem);
        if (!convert_slave(&place, slave, &from->slaves[i]) ||
            !take_esi(&place, slave, &from->slaves[i], path, config->cycle_time_ns))
            return false;
    }
    return true;
}
