/** cm1e sdo read|write|list: one object of one slave, with its type from the device tables if the slave is a CM1-E or a
 *  bridge; or the dictionary of the slave. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "command.h"
#include "core/bytes.h"
#include "core/json_text.h"
#include "core/text.h"
#include "device/device.h"
#include "sdo_list.h"
#include "which_slave.h"

enum { KEY_TYPE = 0x200, KEY_VALUES, MAX_SDO_BYTES = 4096 };

static const struct {
    const char *name;
    cm1e_data_type_t type;
    unsigned bytes;
    bool is_signed;
} types[] = {
    {"SINT", CM1E_TYPE_SINT, 1, true},   {"INT", CM1E_TYPE_INT, 2, true},   {"DINT", CM1E_TYPE_DINT, 4, true},
    {"USINT", CM1E_TYPE_USINT, 1, false}, {"UINT", CM1E_TYPE_UINT, 2, false}, {"UDINT", CM1E_TYPE_UDINT, 4, false},
    {"STRING", CM1E_TYPE_STRING, 0, false},
};
#define TYPES "SINT|INT|DINT|USINT|UINT|UDINT|STRING" /* in the order of the table */
enum { TYPE_COUNT = sizeof types / sizeof types[0] };

typedef struct sdo_options {
    common_options_t common;
    const char *type_name;
    bool values;
    const char *words[4]; /**< read|write|list, position, index[:sub], value */
    int word_count;
} sdo_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    sdo_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_TYPE: options->type_name = arg; return 0;
    case KEY_VALUES: options->values = true; return 0;
    case ARGP_KEY_ARG:
        if (options->word_count >= 4)
            argp_error(state, "too many arguments from \"%s\" on", arg);
        if (options->word_count == 0 && choose_word("action", arg, "read|write|list") < 0)
            return EINVAL;
        options->words[options->word_count++] = arg;
        return 0;
    case ARGP_KEY_END: {
        const bool read = options->word_count == 3 && strcmp(options->words[0], "read") == 0;
        const bool write = options->word_count == 4 && strcmp(options->words[0], "write") == 0;
        const bool list = options->word_count == 2 && strcmp(options->words[0], "list") == 0;
        if (!read && !write && !list)
            argp_error(state, "expected: read POSITION|AXIS INDEX[:SUB], write POSITION|AXIS INDEX[:SUB] VALUE, or list "
                              "POSITION|AXIS");
        return 0;
    }
    default: return ARGP_ERR_UNKNOWN;
    }
}

static bool parse_object(const char *word, uint16_t *index, uint8_t *subindex)
{
    if (read_object(word, index, subindex))
        return true;
    complain("the object is \"%s\"; expected the index, 0 ... FFFF, and behind a colon the sub-index, 0 ... FF, both hexadecimal, "
             "for instance 0x60F6:1B", word);
    return false;
}

/** Row of the type to use: the given type, otherwise that of the device table. -1: unknown (raw bytes); -2:
 *  complained. */
static int find_type(const char *name, const cm1e_entry_t *entry)
{
    if (name) {
        const int i = choose_word("type", name, TYPES);
        return i < 0 ? -2 : i;
    }
    for (int i = 0; entry && i < TYPE_COUNT; i++)
        if (types[i].type == entry->type)
            return i;
    return -1;
}

static int64_t sign_extend(uint64_t value, unsigned bytes)
{
    const unsigned shift = 64 - 8 * bytes;
    /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): a number has 1 byte or more */
    return (int64_t)(value << shift) >> shift;
}

static void print_value(const uint8_t *data, size_t size, int type, const cm1e_entry_t *entry, bool json)
{
    char hex[3 * 64 + 4] = "", text[MAX_SDO_BYTES + 1];
    cm1e_text_of_device(text, sizeof text, data, size);
    for (size_t i = 0; i < size && i < 64; i++)
        snprintf(hex + strlen(hex), sizeof hex - strlen(hex), "%s%02X", i ? " " : "", data[i]);
    const bool is_text = type >= 0 && types[type].type == CM1E_TYPE_STRING;
    const bool is_number = !is_text && type >= 0 && size == types[type].bytes;
    const uint64_t bits = is_number ? cm1e_get_uint(data, (unsigned)size) : 0;
    const int64_t number = is_number && types[type].is_signed ? sign_extend(bits, (unsigned)size) : (int64_t)bits;
    if (json) {
        json_t *object = json_pack("{s:s, s:s}", "type", type >= 0 ? types[type].name : "raw", "bytes", hex);
        if (entry)
            json_object_set_new(object, "name", json_string(entry->name));
        if (is_text)
            json_object_set_new(object, "value", cm1e_json_text(text));
        else if (is_number)
            json_object_set_new(object, "value", json_integer(number));
        print_json(object);
    } else if (is_text) {
        printf("%s\n", text);
    } else if (is_number) {
        printf("%" PRId64 " (0x%0*" PRIX64 ")\n", number, (int)size * 2, bits);
    } else {
        printf("%s\n", hex);
    }
}

/** Converts a word to bytes. Returns 0, with a complaint, if it is not a value of the type. */
static size_t encode_value(const char *word, int type, uint8_t *data)
{
    if (types[type].type == CM1E_TYPE_STRING) {
        const size_t length = strlen(word);
        if (length == 0 || length > MAX_SDO_BYTES) {
            complain("the value must have 1 ... %d characters", MAX_SDO_BYTES);
            return 0;
        }
        /* NOLINTNEXTLINE(bugprone-not-null-terminated-result): strings of CoE have no end 0 */
        memcpy(data, word, length);
        return length;
    }
    const unsigned bits = types[type].bytes * 8;
    const long long maximum = (1LL << (types[type].is_signed ? bits - 1 : bits)) - 1;
    const long long minimum = types[type].is_signed ? -maximum - 1 : 0;
    long long value;
    if (!parse_number(word, "the value", minimum, maximum, &value))
        return 0;
    cm1e_put_uint(data, types[type].bytes, (uint64_t)value);
    return types[type].bytes;
}

/** Explains an expected refusal. */
static int fail_at(const cm1e_entry_t *entry, const cm1e_diag_t *diag)
{
    const int status = fail(diag);
    const char *mark = availability_mark(entry);
    if (mark[0])
        complain("0x%04X:%02X \"%s\" is marked \"%s\" in the guide: %s", entry->index, entry->subindex, entry->name,
                 mark, entry->availability == CM1E_NO_PARAMETER ? "the motor has no such parameter"
                                                                 : "the object exists, but cannot be accessed");
    return status;
}

static int transfer(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const sdo_options_t *options, cm1e_diag_t *diag)
{
    uint16_t position, index = 0;
    uint8_t subindex = 0;
    const bool list = options->word_count == 2;
    const int found = find_slave(bus, axes_to_name(&options->common, config), options->words[1], &position);
    if (found != EXIT_OK)
        return found;
    if (!list && !parse_object(options->words[2], &index, &subindex))
        return EXIT_WRONG_USE;
    const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, position);
    if (list)
        return list_dictionary(bus, slave, options->values, options->common.json);
    const cm1e_entry_t *entry = find_entry(slave, index, subindex);
    const int type = find_type(options->type_name, entry);
    if (type == -2)
        return EXIT_WRONG_USE;
    static uint8_t data[MAX_SDO_BYTES];
    size_t size = sizeof data;
    if (options->word_count == 3) {
        if (cm1e_sdo_read(bus, position, index, subindex, data, &size, diag) != CM1E_OK)
            return fail_at(entry, diag);
        print_value(data, size, type, entry, options->common.json);
        return EXIT_OK;
    }
    if (type < 0) {
        complain("the type of 0x%04X:%02X is unknown: state it with --type", index, subindex);
        return EXIT_WRONG_USE;
    }
    size = encode_value(options->words[3], type, data);
    if (size == 0)
        return EXIT_WRONG_USE;
    const cm1e_error_t error = cm1e_sdo_write(bus, position, index, subindex, data, size, diag);
    return error == CM1E_OK ? EXIT_OK : fail_at(entry, diag);
}

static const struct argp_option table[] = {
    {"type", KEY_TYPE, TYPES, 0, "The type of the object; default: as the device tables say", 0},
    {"values", KEY_VALUES, NULL, 0, "list: also show the present values of the objects", 0},
    {0}};
const struct argp argp_sdo = {
    table, parse, "read POSITION|AXIS INDEX[:SUB]\nwrite POSITION|AXIS INDEX[:SUB] VALUE\nlist POSITION|AXIS",
    "Reads or writes an object, for example `cm1e sdo read -i eth1 1 0x60F6:1B` (index and sub-index are hexadecimal), "
    "or lists the dictionary of the slave: type, bits, access (p: in Pre-Operational only), whether the object can be "
    "mapped, name. AXIS is the name of an axis or a slave in the bus file.",
    attach_children, NULL, NULL};

static int act(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *options, uint16_t position)
{
    cm1e_diag_t diag = {0};
    (void)position;
    return transfer(bus, config, options, &diag);
}

int command_sdo(int argc, char **argv)
{
    sdo_options_t options = {0};
    char *words[MAX_WORDS + 2];
    const int count = shelter_negative_value(argc, argv, words);
    if (count < 0)
        return EXIT_WRONG_USE;
    if (parse_options(&argp_sdo, count, words, &options))
        return EXIT_WRONG_USE;
    return look_at_network(&options.common, NULL, act, &options);
}
