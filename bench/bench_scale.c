/**
 * Motors on one network (docs/SCALE.md): simulated ones are started, enabled and moved in this process, on virtual time.
 * What their process data take on the wire is computed from the frames that were sent: 80 ns for each byte, and the
 * delay of each slave.
 *
 *     bench_scale [CYCLE_US MOTORS ...]     39, 48, 98 and 198 motors at 200, 250, 500 and 1000 us
 *     bench_scale --overlap ...             with overlapped inputs and outputs; 53, 67, 135 and 271 motors
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/config.h"
#include "support/axes_described.h"
#include "support/moved_drives.h"

enum { MOST_CYCLES = 20000, SHARE_PERCENT = 80 };
static const double delays_us[] = {0.6, 1.2, 2.0};
static bool overlap;

static bool measure(unsigned cycle_us, uint32_t motors)
{
    cm1e_bus_config_t config = {0};
    moved_drives_t result;
    describe_axes(&config, motors);
    if (config.axis_count != motors) {
        printf("%8u %6u  so many cannot be configured\n", cycle_us, motors);
        return false;
    }
    config.cycle_time_ns = cycle_us * INT64_C(1000);
    config.overlap = overlap;
    const cm1e_error_t error = moved_drives_run(&config, MOST_CYCLES, &result);
    cm1e_bus_config_free(&config);
    if (error != CM1E_OK) {
        printf("%8u %6u  %s\n", cycle_us, motors, result.diag.text);
        return false;
    }
    printf("%8u %6u %6u %8llu %4llu %6u %7u", cycle_us, motors, result.moved, (unsigned long long)result.cycles,
           (unsigned long long)result.bad_cycles, result.frames, result.bytes);
    for (size_t i = 0; i < sizeof delays_us / sizeof delays_us[0]; i++) {
        const double us = moved_drives_wire_us(&result, motors, delays_us[i]);
        printf(" %8.1f%s", us, us * 100 < cycle_us * (double)SHARE_PERCENT ? " " : "!");
    }
    printf("\n");
    return result.moved == motors && result.bad_cycles == 0;
}

int main(int count, char **words)
{
    static const struct {
        unsigned cycle_us;
        uint32_t motors[2];
    } usual[] = {{200, {39, 53}}, {250, {48, 67}}, {500, {98, 135}}, {1000, {198, 271}}};
    bool passed = true;
    overlap = count > 1 && strcmp(words[1], "--overlap") == 0;
    count -= overlap;
    words += overlap;
    printf("Microseconds on the wire by the delay of a slave; !: not less than %d %% of the cycle.\n", SHARE_PERCENT);
    printf("%8s %6s %6s %8s %4s %6s %7s", "cycle us", "motors", "moved", "cycles", "bad", "frames", "bytes");
    for (size_t i = 0; i < sizeof delays_us / sizeof delays_us[0]; i++)
        printf(" %6.1f us", delays_us[i]);
    printf("\n");
    for (size_t i = 0; count < 3 && i < sizeof usual / sizeof usual[0]; i++)
        passed &= measure(usual[i].cycle_us, usual[i].motors[overlap]);
    for (int i = 2; i < count; i++)
        passed &= measure((unsigned)strtoul(words[1], NULL, 10), (uint32_t)strtoul(words[i], NULL, 10));
    return passed ? 0 : 1;
}
