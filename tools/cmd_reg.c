/** cm1e reg read|write: registers of a slave controller (ETG.1000.4). */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "attach.h"
#include "cm1e/esc.h"
#include "core/bytes.h"
#include "which_slave.h"

enum { KEY_ALLOW = 0x9A0, KEY_SIZE, WORDS = 4, ROW_BYTES = 16 };

typedef struct reg_options {
    common_options_t common;
    const char *words[WORDS]; /* read or write, slave, address, bytes or value */
    int word_count;
    bool writes, allow;
    long long address, size, value;
} reg_options_t;

/** Registers that people look for; the rest is in the data sheet of the controller. */
static const struct {
    uint16_t address;
    uint8_t size;
    const char *name;
} names[] = {
    {0x0000, 1, "type of the controller"}, {0x0001, 1, "revision of the controller"},
    {0x0004, 1, "FMMUs"}, {0x0005, 1, "sync managers"}, {0x0006, 1, "KiB of process data RAM"},
    {0x0007, 1, "port descriptor"}, {0x0010, 2, "station address"}, {0x0012, 2, "station alias"},
    {0x0100, 4, "DL control"}, {0x0110, 2, "DL status: links and loops of the ports"}, {0x0120, 2, "AL control"},
    {0x0130, 2, "AL status"}, {0x0134, 2, "AL status code"}, {0x0140, 1, "PDI control"},
    {0x0220, 4, "AL event request"}, {0x0300, 2, "port 0: invalid frames, receive errors"},
    {0x0302, 2, "port 1: invalid frames, receive errors"}, {0x0304, 2, "port 2: invalid frames, receive errors"},
    {0x0306, 2, "port 3: invalid frames, receive errors"}, {0x0308, 4, "forwarded errors of ports 0 to 3"},
    {0x030C, 1, "errors of the processing unit"}, {0x030D, 1, "errors of the PDI"},
    {0x0310, 4, "lost links of ports 0 to 3"}, {0x0400, 2, "divider of the watchdogs"},
    {0x0420, 2, "time of the process data watchdog"}, {0x0440, 2, "status of the process data watchdog"},
    {0x0442, 1, "expiries of the process data watchdog"}, {0x0502, 2, "control of the EEPROM"},
    {0x0805, 1, "status of sync manager 0"}, {0x080D, 1, "status of sync manager 1"},
    {0x0910, 8, "system time"}, {0x092C, 4, "difference of the system time"},
};

static void check_words(reg_options_t *options, struct argp_state *state)
{
    if (options->word_count < 3 || (options->writes && options->word_count < WORDS))
        argp_error(state, "expected: read POSITION|AXIS ADDRESS [BYTES], or write POSITION|AXIS ADDRESS VALUE");
    if (options->writes && !options->allow)
        argp_error(state, "a wrong register stops a slave or the network, and may move a motor: --allow-write");
}

static bool parse_word(reg_options_t *options, const char *word, int place)
{
    switch (place) {
    case 0:
        options->writes = strcmp(word, "write") == 0;
        return choose_word("action", word, "read|write") >= 0;
    case 2: return parse_number(word, "the address", 0, 0xFFFF, &options->address);
    case 3:
        return options->writes ? parse_number(word, "the value", 0, 0xFFFFFFFF, &options->value)
                               : parse_number(word, "the number of bytes", 1, CM1E_ESC_BYTES, &options->size);
    default: return true;
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    reg_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_ALLOW: options->allow = true; return 0;
    case KEY_SIZE: return parse_number(arg, "the size", 1, 4, &options->size) ? 0 : EINVAL;
    case ARGP_KEY_ARG:
        if (options->word_count == WORDS)
            argp_error(state, "too many arguments from \"%s\" on", arg);
        if (!parse_word(options, arg, options->word_count))
            return EINVAL;
        options->words[options->word_count++] = arg;
        return 0;
    case ARGP_KEY_END: check_words(options, state); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

static void print_rows(const reg_options_t *options, const uint8_t *data)
{
    for (long long row = 0; row < options->size; row += ROW_BYTES) {
        printf("0x%04llX ", (unsigned long long)(options->address + row));
        for (long long i = row; i < options->size && i < row + ROW_BYTES; i++)
            printf(" %02x", data[i]);
        putchar('\n');
    }
}

/** The registers that lie wholly in what was read. */
static void print_names(const reg_options_t *options, const uint8_t *data)
{
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const long long at = names[i].address - options->address;
        if (at < 0 || at + names[i].size > options->size)
            continue;
        const unsigned long long value = cm1e_get_uint(data + at, names[i].size);
        printf("  0x%04X = %llu (0x%0*llX): %s\n", names[i].address, value, 2 * names[i].size, value, names[i].name);
    }
}

static int show(const reg_options_t *options, uint16_t position, const uint8_t *data)
{
    char digits[2 * CM1E_ESC_BYTES + 1] = "";
    for (long long i = 0; i < options->size; i++)
        snprintf(digits + 2 * i, 3, "%02x", data[i]);
    if (options->common.json) {
        print_json(json_pack("{s:i, s:I, s:s}", "position", position, "address", (json_int_t)options->address, "data",
                             digits));
    } else {
        print_rows(options, data);
        print_names(options, data);
    }
    return EXIT_OK;
}

static int read_registers(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const reg_options_t *options = context;
    uint8_t data[CM1E_ESC_BYTES] = {0};
    cm1e_diag_t diag = {0};
    (void)config;
    if (cm1e_esc_read(bus, position, (uint16_t)options->address, data, (uint16_t)options->size, &diag) != CM1E_OK)
        return fail(&diag);
    return show(options, position, data);
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

static int write_registers(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const reg_options_t *options = context;
    uint8_t data[4] = {0};
    cm1e_diag_t diag = {0};
    if (options->size < 4 && options->value >> 8 * options->size != 0) {
        complain("0x%llX does not fit into %lld byte%s: give a larger --size", (unsigned long long)options->value, options->size,
                 options->size == 1 ? "" : "s");
        return EXIT_FAILED;
    }
    cm1e_put_uint(data, (unsigned)options->size, (uint64_t)options->value);
    if (cm1e_esc_write(bus, position, (uint16_t)options->address, data, (uint16_t)options->size, &diag) != CM1E_OK)
        return fail(&diag);
    return read_registers(bus, config, options, position); /* what the register says now may be something else */
}

/* ---- the command ------------------------------------------------------------------------------------------------ */

static const struct argp_option table[] = {
    {"size", KEY_SIZE, "BYTES", 0, "Bytes to write, 1 to 4; default: 2", 0},
    {"allow-write", KEY_ALLOW, NULL, 0, "Write: a wrong register stops a slave or the network", 0},
    {0}};
const struct argp argp_reg = {
    table, parse, "read POSITION|AXIS ADDRESS [BYTES]\nwrite POSITION|AXIS ADDRESS VALUE",
    "Shows registers of a slave controller, or writes one and shows what it is then. The bytes are in the order of the "
    "wire. Where a program runs the network, it is asked, for registers below 0x0900; else the network is brought to "
    "Pre-Operational, which sets counters of errors to 0. Writing needs the network for itself.",
    attach_children, NULL, NULL};

int command_reg(int argc, char **argv)
{
    reg_options_t options = {.size = 2};
    if (parse_options(&argp_reg, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (!options.writes)
        return look_at_network(&options.common, options.words[1], read_registers, &options);
    if (options.common.attach) {
        complain("writing a register needs the network for itself: leave --attach out, and end the program before");
        return EXIT_WRONG_USE;
    }
    return run_on_slave(&options.common, options.words[1], write_registers, &options);
}
