/* Registers of the slave controller, its clock. */
#include <stdio.h>
#include <time.h>

#include "cm1e/esc.h"
#include "core/bytes.h"
#include "description/sii_image.h"
#include "prove/prove.h"

enum { REG_FMMUS = 0x0004, REG_FEATURES = 0x0008, REG_ALIAS = 0x0012, REG_PDI = 0x0140, REG_DIVIDER = 0x0400,
       REG_DATA_WATCHDOG = 0x0420, REG_SYSTEM_TIME = 0x0910 };
enum { FEATURE_CLOCKS = 0x0004, NEEDED_MANAGERS = 4, NEEDED_FMMUS = 2, EXPLICIT_ID_MAX = 254 };

static bool read_register(prove_t *prove, uint16_t address, uint8_t *data, uint16_t size)
{
    cm1e_diag_t diag = {0};
    if (cm1e_esc_read(prove->bus, prove->position, address, data, size, &diag) == CM1E_OK)
        return true;
    prove_note(prove, "%.200s", diag.text);
    return false;
}

static void look_at_units(prove_t *prove)
{
    uint8_t units[2];
    if (!read_register(prove, REG_FMMUS, units, sizeof units))
        return;
    prove_compare_truth(prove, "FMMUs", units[0] >= NEEDED_FMMUS, "2 or more", "fewer than 2");
    prove_compare_truth(prove, "sync managers", units[1] >= NEEDED_MANAGERS, "4 or more", "fewer than 4");
    prove_note(prove, "%u FMMUs, %u sync managers", units[0], units[1]);
}

static void look_at_eeprom_word(prove_t *prove, uint16_t address, unsigned at, const char *thing)
{
    uint8_t data[2];
    if (prove->sii_size < CM1E_SII_HEADER_BYTES)
        prove_note(prove, "the EEPROM cannot be read");
    else if (read_register(prove, address, data, sizeof data))
        prove_compare_number(prove, thing, cm1e_get_u16(prove->sii + at), cm1e_get_u16(data), 4);
}

/** The watchdog counts (divider + 2) * 40 ns (ETG.1000.4). */
static void look_at_watchdog(prove_t *prove)
{
    uint8_t divider[2], ticks[2];
    if (!read_register(prove, REG_DIVIDER, divider, sizeof divider)
        || !read_register(prove, REG_DATA_WATCHDOG, ticks, sizeof ticks))
        return;
    const int64_t ns = (int64_t)(cm1e_get_u16(divider) + 2) * 40 * cm1e_get_u16(ticks);
    prove_compare_number(prove, "watchdog, ms", 100, ns / 1000000, 0);
}

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
}

/** Against the clock of this computer, within a hundredth and what the frames take. */
static void look_at_clock(prove_t *prove)
{
    uint8_t features[2], first[8], second[8];
    const struct timespec pause = {.tv_nsec = 100000000};
    if (!read_register(prove, REG_FEATURES, features, sizeof features))
        return;
    if (!(cm1e_get_u16(features) & FEATURE_CLOCKS)) {
        prove_note(prove, "the controller has no distributed clock");
        return;
    }
    if (prove->config->virtual_time)
        prove_note(prove, "the simulated segment runs on virtual time");
    if (prove->config->virtual_time || !read_register(prove, REG_SYSTEM_TIME, first, sizeof first))
        return;
    const int64_t begin_ns = now_ns();
    nanosleep(&pause, NULL);
    if (!read_register(prove, REG_SYSTEM_TIME, second, sizeof second))
        return;
    const double passed = (double)(now_ns() - begin_ns), shown = (double)(cm1e_get_u32(second) - cm1e_get_u32(first));
    prove_compare_truth(prove, "system time", shown > 0.9 * passed && shown < 1.1 * passed + 5e6, "runs in ns",
                        shown == 0 ? "does not change" : "runs at another rate");
    prove_note(prove, "%.1f ms in %.1f ms", shown * 1e-6, passed * 1e-6);
}

static void look_at_id(prove_t *prove)
{
    prove_compare_truth(prove, "explicit device ID", prove->slave->explicit_id <= EXPLICIT_ID_MAX, "0 ... 254",
                        "above 254");
    prove_note(prove, "the switches show %u; compare them", prove->slave->explicit_id);
}

void look_controller(prove_t *prove, const point_t *point)
{
    switch (point->row) {
    case ESC_UNITS: look_at_units(prove); break;
    case ESC_ALIAS: look_at_eeprom_word(prove, REG_ALIAS, CM1E_SII_ALIAS, "alias"); break;
    case ESC_CONFIGURATION: look_at_eeprom_word(prove, REG_PDI, CM1E_SII_CONFIG, "configuration"); break;
    case ESC_WATCHDOG: look_at_watchdog(prove); break;
    case ESC_CLOCK: look_at_clock(prove); break;
    default: look_at_id(prove); break;
    }
}
