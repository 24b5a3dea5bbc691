#include "device/device.h"

/* UG 10.1. Versions that changed nothing visible on the bus (V1.3.1) have no row. */
static const cm1e_firmware_info_t firmwares[CM1E_FIRMWARE_COUNT] = {
    {
        .firmware = CM1E_FIRMWARE_1_2_0,
        .version = "1.2.0",
        .revision = 0x20020001, /* UG 7.1.6 and the EC_EXTEND of UG 11.2.1 */
        .velocity_in_counts_per_ms = true,
        .velocity_quarter_in_hm_pp = true,
        .shortest_cycle_ns = 1000000,
    },
    {
        .firmware = CM1E_FIRMWARE_1_3_0,
        .version = "1.3.0",
        .revision = 0x20020103,
        .velocity_in_counts_per_ms = true,
        .watchdog = true,
        .mode_in_profile_pdo = true,
        .following_bit = true,
        .shortest_cycle_ns = 1000000,
    },
    {
        .firmware = CM1E_FIRMWARE_1_3_2,
        .version = "1.3.2",
        .revision = 0x20020103,
        .velocity_in_counts_per_ms = true,
        .watchdog = true,
        .mode_in_profile_pdo = true,
        .following_bit = true,
        .all_cycle_times = true,
        .shortest_cycle_ns = 200000,
    },
    {
        .firmware = CM1E_FIRMWARE_1_3_3,
        .version = "1.3.3",
        .revision = 0x20020103,
        .watchdog = true,
        .mode_in_profile_pdo = true,
        .following_bit = true,
        .all_cycle_times = true,
        .shortest_cycle_ns = 200000,
    },
    {
        .firmware = CM1E_FIRMWARE_1_3_4,
        .version = "1.3.4",
        .revision = 0x20020103,
        .watchdog = true,
        .mode_in_profile_pdo = true,
        .following_bit = true,
        .all_cycle_times = true,
        .shortest_cycle_ns = 200000,
        .user_variables = true,
    },
    {
        .firmware = CM1E_FIRMWARE_1_3_5,
        .version = "1.3.5",
        .revision = 0x20020103,
        .watchdog = true,
        .mode_in_profile_pdo = true,
        .following_bit = true,
        .all_cycle_times = true,
        .shortest_cycle_ns = 200000,
        .user_variables = true,
        .communication_fault_resets = true,
        .fault_bit_on_7510 = true,
    },
};

const cm1e_firmware_info_t *cm1e_firmware_info(cm1e_firmware_t firmware)
{
    return (unsigned)firmware < CM1E_FIRMWARE_COUNT ? &firmwares[firmware] : NULL;
}

enum { VERSION_PARTS = 3, VERSION_PART_MAX = 999 };

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* "1.3.5", "V1.3.5", "1.3" (= 1.3.0), with blanks behind it, as one number that compares like the version; -1: none.
 * The text comes from a device: nothing in it is taken for granted. */
static int64_t parse_version(const char *text)
{
    int64_t parts[VERSION_PARTS] = {0};
    int count = 0;
    if (*text == 'V' || *text == 'v')
        text++;
    for (;;) {
        if (count == VERSION_PARTS || !is_digit(*text))
            return -1;
        for (; is_digit(*text); text++) {
            parts[count] = parts[count] * 10 + (*text - '0');
            if (parts[count] > VERSION_PART_MAX)
                return -1;
        }
        count++;
        if (*text != '.')
            break;
        text++;
    }
    while (*text == ' ')
        text++;
    if (*text != '\0' || count < 2)
        return -1;
    return (parts[0] * (VERSION_PART_MAX + 1) + parts[1]) * (VERSION_PART_MAX + 1) + parts[2];
}

const cm1e_firmware_info_t *cm1e_firmware_from_version(const char *version)
{
    const int64_t wanted = version ? parse_version(version) : -1;
    if (wanted < 0)
        return NULL;
    /* Below V1.2.0 the units are those of V1.2.0, which is what the driver must know. */
    const cm1e_firmware_info_t *found = &firmwares[0];
    for (int i = 1; i < CM1E_FIRMWARE_COUNT; i++)
        if (parse_version(firmwares[i].version) <= wanted)
            found = &firmwares[i];
    return found;
}
