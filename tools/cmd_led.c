/** cm1e led: finds a motor by its status LED, or sets its brightness (UG 7.4.4, 7.4.5). */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "command.h"
#include "core/bytes.h"
#include "device/device.h"
#include "device/devices.h"
#include "which_slave.h"

enum { KEY_FOR = 0x600, KEY_BRIGHTNESS, KEY_FLASH, LONGEST_S = 3600 };
#define FIND_S 10.0

/* 0xFF01: red, green and blue in bytes 3, 2 and 1; byte 0: bit 0 overrides, bit 1 flashes (UG 7.4.5). */
#define RGB(red, green, blue) ((uint32_t)(red) << 24 | (uint32_t)(green) << 16 | (uint32_t)(blue) << 8)
#define COLOURS "off|red|green|blue|yellow|magenta|cyan|white|motor"
static const uint32_t colours[] = {RGB(0, 0, 0), RGB(1, 0, 0), RGB(0, 1, 0), RGB(0, 0, 1), RGB(1, 1, 0),
                                   RGB(1, 0, 1), RGB(0, 1, 1), RGB(1, 1, 1), RGB(0, 0, 0)};
enum { WHITE = 7, MOTOR = 8, OVERRIDE = 1, FLASH = 3 };

typedef struct led_options {
    common_options_t common;
    const char *where;
    int colour; /* -1: flash for a while, then as before */
    bool flash;
    double seconds;
    long long brightness; /* -1: leave it */
} led_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    led_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_FOR: return parse_seconds(arg, LONGEST_S, &options->seconds) ? 0 : EINVAL;
    case KEY_FLASH: options->flash = true; return 0;
    case KEY_BRIGHTNESS: return parse_number(arg, "the brightness", 0, 16, &options->brightness) ? 0 : EINVAL;
    case ARGP_KEY_ARG:
        if (!options->where) {
            options->where = arg;
            return 0;
        }
        if (options->colour >= 0)
            argp_error(state, "one colour at a time; \"%s\" is too many", arg);
        options->colour = choose_word("colour", arg, COLOURS);
        return options->colour < 0 ? EINVAL : 0;
    case ARGP_KEY_END:
        if (!options->where)
            argp_error(state, "which motor? Give its position, or the name of its axis in the bus file");
        if (options->seconds > 0 && options->colour == MOTOR)
            argp_error(state, "the motor itself has the LED then: leave --for out");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static bool read_led(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint32_t *value, cm1e_diag_t *diag)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    if (cm1e_sdo_read(bus, position, index, 0, data, &size, diag) != CM1E_OK)
        return false;
    *value = cm1e_get_u32(data);
    return true;
}

static bool write_led(cm1e_bus_t *bus, uint16_t position, uint32_t value, cm1e_diag_t *diag)
{
    uint8_t data[4];
    cm1e_put_uint(data, sizeof data, value);
    return cm1e_sdo_write(bus, position, OBJ_FF01_LED_OVERRIDE, 0, data, sizeof data, diag) == CM1E_OK;
}

static void wait_seconds(double seconds)
{
    struct timespec rest = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(fmod(seconds, 1) * 1e9)};
    while (nanosleep(&rest, &rest) != 0 && errno == EINTR)
        ;
}

static bool set_brightness(cm1e_bus_t *bus, uint16_t position, long long brightness, cm1e_diag_t *diag)
{
    const uint8_t data[1] = {(uint8_t)brightness};
    return brightness < 0
           || cm1e_sdo_write(bus, position, OBJ_FF00_LED_BRIGHTNESS, 0, data, sizeof data, diag) == CM1E_OK;
}

static void tell(const led_options_t *options, const cm1e_bus_config_t *config, uint16_t position, uint32_t before,
                 uint32_t now, uint32_t brightness)
{
    if (options->common.json)
        print_json(json_pack("{s:i, s:I, s:I, s:I, s:b}", "position", position, "before", (json_int_t)before, "now",
                             (json_int_t)now, "brightness", (json_int_t)(brightness & 0xFF), "simulated",
                             is_simulated(config)));
    else
        printf("slave %u: the LED override was 0x%08X, is 0x%08X; brightness %u of 16%s\n", position, (unsigned)before,
               (unsigned)now, (unsigned)(brightness & 0xFF), simulated_mark(config));
}

static int set_led(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const led_options_t *options = context;
    cm1e_diag_t diag = {0};
    if (cm1e_bus_slave(bus, position)->device != &cm1e_device_cm1e) {
        complain("slave %u is not a CM1-E: only a CM1-E has an LED that can be set", position);
        return EXIT_FAILED;
    }
    uint32_t before, now, brightness;
    const bool find = options->colour < 0 && options->brightness < 0;
    const uint32_t colour = colours[find ? WHITE : options->colour < 0 ? MOTOR : options->colour];
    const uint32_t wanted = options->colour == MOTOR ? 0 : colour | (find || options->flash ? FLASH : OVERRIDE);
    const double seconds = find && options->seconds == 0 ? FIND_S : options->seconds;
    if (!read_led(bus, position, OBJ_FF01_LED_OVERRIDE, &before, &diag)
        || !set_brightness(bus, position, options->brightness, &diag))
        return fail(&diag);
    if ((find || options->colour >= 0) && !write_led(bus, position, wanted, &diag))
        return fail(&diag);
    if (seconds > 0 && (find || options->colour >= 0)) {
        if (!options->common.json)
            fprintf(stderr, "slave %u: its LED shows 0x%08X for %g s\n", position, (unsigned)wanted, seconds);
        wait_seconds(seconds);
        if (!write_led(bus, position, before, &diag))
            return fail(&diag);
    }
    if (!read_led(bus, position, OBJ_FF01_LED_OVERRIDE, &now, &diag)
        || !read_led(bus, position, OBJ_FF00_LED_BRIGHTNESS, &brightness, &diag))
        return fail(&diag);
    tell(options, config, position, before, now, brightness);
    return EXIT_OK;
}

static const struct argp_option table[] = {
    {"for", KEY_FOR, "SECONDS", 0, "Give the LED back after this time; default 10 without a colour, else never", 0},
    {"flash", KEY_FLASH, NULL, 0, "Flash in the colour", 0},
    {"brightness", KEY_BRIGHTNESS, "N", 0, "0 (off) ... 16; the motor keeps it when its power is off", 0},
    {0}};
const struct argp argp_led = {
    table, parse, "POSITION|AXIS [" COLOURS "]",
    "Finds a motor by its status LED: without a colour it flashes white for 10 s, and is then as before. With a "
    "colour it "
    "stays so; `off` is dark, `motor` gives the LED back to the motor. No motor moves.", common_children, NULL, NULL};

int command_led(int argc, char **argv)
{
    led_options_t options = {.colour = -1, .brightness = -1};
    if (parse_options(&argp_led, argc, argv, &options))
        return EXIT_WRONG_USE;
    return run_on_slave(&options.common, options.where, set_led, &options);
}
