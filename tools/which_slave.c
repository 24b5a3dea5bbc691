#include "which_slave.h"

#include <stdio.h>
#include <string.h>

#include "config/places.h"
#include "core/near.h"
#include "device/devices.h"
#include "device/place.h"

int find_axis_at(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave, uint8_t channel)
{
    const cm1e_places_t places = {config, bus, cm1e_bus_slave};
    const uint16_t place = cm1e_place_of(&places, slave);
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (config->axes[i].channel == channel && cm1e_place_is_of_axis(&places, i, slave, place))
            return (int)i;
    return -1;
}

bool is_position(const char *word) { return word[0] && strspn(word, "0123456789") == strlen(word); }

bool parse_position(const char *word, uint16_t *position)
{
    long long number;
    const bool good = parse_number(word, "the position", 1, CM1E_MAX_SLAVES, &number);
    *position = good ? (uint16_t)number : 0;
    return good;
}

/* ---- names ------------------------------------------------------------------------------------------------------ */

/** What the bus file calls by a word: an axis with a motor, or a slave; or nothing. */
typedef struct named {
    const cm1e_axis_config_t *axis;
    const cm1e_slave_config_t *slave;
} named_t;

static named_t look_up(const cm1e_bus_config_t *config, const char *word)
{
    named_t named = {0};
    if (is_position(word))
        return named;
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (cm1e_axis_has_motor(&config->axes[i]) && strcmp(config->axes[i].name, word) == 0)
            named.axis = &config->axes[i];
    for (uint32_t i = 0; i < config->slave_count && !named.axis; i++)
        if (strcmp(config->slaves[i].name, word) == 0)
            named.slave = &config->slaves[i];
    return named;
}

static const cm1e_slave_info_t *find_named(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const named_t *named)
{
    const cm1e_places_t places = {config, bus, cm1e_bus_slave};
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        const uint16_t place = cm1e_place_of(&places, slave);
        if (named->axis ? cm1e_place_is_of_axis(&places, (uint32_t)(named->axis - config->axes), slave, place)
                        : cm1e_place_is_of_slave(&places, named->slave, slave, place))
            return slave;
    }
    return NULL;
}

/** Appends ", vendor 0x00000539" to a text. */
static void add_number(char *text, size_t size, const char *name, uint32_t value)
{
    const size_t used = strlen(text);
    if (value)
        snprintf(text + used, size - used, "%s%s 0x%08X", used ? ", " : "", name, (unsigned)value);
}

/** What the bus file says of the device, in words; false: the slave is that. */
static bool is_another(const named_t *named, const cm1e_slave_info_t *slave, char *expected, size_t size)
{
    const cm1e_slave_config_t *config = named->slave;
    expected[0] = '\0';
    if (named->axis) {
        const cm1e_device_t *device = cm1e_device_configured(named->axis);
        snprintf(expected, size, "a %s", device ? device->label : "motor");
        return device && !cm1e_device_same_kind(device, slave->device);
    }
    add_number(expected, size, "vendor", config->vendor);
    add_number(expected, size, "product", config->product);
    add_number(expected, size, "revision", config->revision);
    return (config->vendor && config->vendor != slave->vendor_id) ||
           (config->product && config->product != slave->product_code) ||
           (config->revision && config->revision != slave->revision);
}

/** A name means the device of the bus file, not whatever is in its place now. */
static int refuse_another(const named_t *named, const char *word, const cm1e_slave_info_t *slave)
{
    char expected[160];
    if (!is_another(named, slave, expected, sizeof expected))
        return EXIT_OK;
    complain("expected %s as %s \"%s\", and found \"%s\" (vendor 0x%08X, product 0x%08X, revision 0x%08X) there, slave %u. "
             "Nothing was done. The position %u instead of the name takes whatever device is there", expected,
             named->axis ? "axis" : "slave", word, slave->name, (unsigned)slave->vendor_id,
             (unsigned)slave->product_code, (unsigned)slave->revision, slave->position, slave->position);
    return EXIT_FAILED;
}

/** Complains of a word that the bus file does not have. */
static int refuse_word(const cm1e_bus_config_t *config, const char *word)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = word};
    bool is_axis = false; /* and has no motor */
    for (uint32_t i = 0; i < config->axis_count; i++) {
        is_axis |= strcmp(config->axes[i].name, word) == 0;
        cm1e_near_look(&near, config->axes[i].name);
    }
    for (uint32_t i = 0; i < config->slave_count; i++)
        cm1e_near_look(&near, config->slaves[i].name);
    if (is_axis || config->slave_count == 0)
        (void)find_axis(config, word);
    else
        complain("the bus file has neither an axis nor a slave \"%s\"%s", word, cm1e_near_text(&near, text, sizeof text));
    return EXIT_WRONG_USE;
}

/* ---- the slave of a word ----------------------------------------------------------------------------------------- */

int find_motor_of(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const char *word, uint16_t *position,
                  uint8_t *channel)
{
    const named_t named = look_up(config, word);
    const uint32_t count = cm1e_bus_slave_count(bus);
    *channel = named.axis ? named.axis->channel : 0;
    if (named.axis || named.slave) {
        const cm1e_slave_info_t *slave = find_named(bus, config, &named);
        if (!slave)
            complain(named.axis ? "the slave of axis \"%s\" is not on the network" : "slave \"%s\" is not on the network", word);
        *position = slave ? slave->position : 0;
        return slave ? refuse_another(&named, word, slave) : EXIT_FAILED;
    }
    if ((word[0] < '0' || word[0] > '9') && word[0] != '-')
        return refuse_word(config, word);
    if (!parse_position(word, position))
        return EXIT_WRONG_USE;
    if (*position <= count)
        return EXIT_OK;
    complain("there is no slave %u; the network has %u", *position, count);
    return EXIT_FAILED;
}

int find_slave(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const char *word, uint16_t *position)
{
    uint8_t channel = 0;
    const int status = find_motor_of(bus, config, word, position, &channel);
    if (status != EXIT_OK || channel == 0)
        return status;
    complain("axis \"%s\" is connector %u of the bridge at position %u, and this concerns the bridge with all of its motors: "
             "give the position, %u", word, channel, *position, *position);
    return EXIT_WRONG_USE;
}

int find_slave_unscanned(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const char *word, uint16_t *position)
{
    cm1e_diag_t diag = {0};
    if (is_position(word))
        return parse_position(word, position) ? EXIT_OK : EXIT_WRONG_USE;
    return cm1e_bus_scan(bus, &diag) == CM1E_OK ? find_slave(bus, config, word, position) : fail(&diag);
}

int run_on_slave(const common_options_t *common, const char *where, slave_action_t action, const void *options)
{
    static cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    uint16_t position;
    if (!load_configuration(common, &config))
        return EXIT_WRONG_USE;
    if (open_scanned(&config, &bus) != EXIT_OK)
        return EXIT_FAILED;
    int status = find_slave(bus, &config, where, &position);
    if (status == EXIT_OK)
        status = action(bus, &config, options, position);
    return close_bus(bus, common, status);
}
