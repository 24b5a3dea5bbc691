/* Tables of positions, velocities or accelerations over time, as MC_PositionProfile, MC_VelocityProfile and
 * MC_AccelerationProfile hand them to the axis. A table is refused, or all that is said of it is finite (but for the jerk of
 * a step), and so is every state: within the extremes, and the same whichever state was asked for before.
 *
 * Numbers below 1e-100 are taken for 0: their squares are.
 *
 * An input: kind, number of points, state of the axis, jerk, factor of the times; then for each point a distance in ns, as
 * the blocks have it, and a value; then times. */
#include <math.h>
#include <string.h>

#include "fuzz.h"
#include "motion/table_profile.h"

enum { POINTS = CM1E_TABLE_POINTS_MAX + 2, SAMPLES = 200 };

static double plain(double value) { return isfinite(value) ? value : 1.0; }

static int take_points(const uint8_t **at, const uint8_t *end, cm1e_table_point_t *points)
{
    const int count = (int)(fuzz_take(at, end, 1) % POINTS);
    const double scale = fuzz_take_real(at, end);
    double time_s = 0;
    for (int i = 0; i < count; i++) {
        time_s += fuzz_take(at, end, 4) * 1e-9 * scale;
        points[i] = (cm1e_table_point_t){time_s, fuzz_take_real(at, end)};
    }
    return count;
}

static void judge_table(const cm1e_table_profile_t *table, const cm1e_table_extremes_t *needed)
{
    const double all[] = {needed->lowest, needed->highest, needed->velocity, needed->acceleration, needed->deceleration,
                          table->duration_s, table->end.position, table->end.velocity, table->end.acceleration};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!isfinite(all[i]))
            fuzz_fail("an accepted table has %g as its number %zu", all[i], i);
    if (isnan(needed->jerk) || table->duration_s < 0)
        fuzz_fail("jerk %g, duration %g s", needed->jerk, table->duration_s);
}

static double rounding(double size) { return 1e-6 * size + 1e-100; }

static bool near(double a, double b, double size) { return fabs(a - b) <= rounding(size); }

static void sample_at(cm1e_table_profile_t *table, const cm1e_table_extremes_t *needed, double time_s)
{
    cm1e_table_profile_t fresh = *table;
    cm1e_motion_state_t first, again;
    if (!(time_s >= 0 && time_s <= table->duration_s))
        return;
    fresh.at = 0;
    fresh.here = fresh.start;
    cm1e_table_profile_sample(table, time_s, &first);
    cm1e_table_profile_sample(&fresh, time_s, &again);
    if (!isfinite(first.position) || !isfinite(first.velocity) || !isfinite(first.acceleration))
        fuzz_fail("at %g s: %g, %g, %g", time_s, first.position, first.velocity, first.acceleration);
    const double speed = needed->velocity, gain = fmax(needed->acceleration, needed->deceleration);
    const double size = fmax(fabs(needed->lowest), fabs(needed->highest)) + table->duration_s * speed;
    const double speed_size = speed + table->duration_s * gain;
    if (first.position < needed->lowest - rounding(size) || first.position > needed->highest + rounding(size) ||
        fabs(first.velocity) > speed + rounding(speed_size))
        fuzz_fail("at %g s: position %g and velocity %g, beyond %g ... %g and %g", time_s, first.position, first.velocity,
                  needed->lowest, needed->highest, speed);
    if (!near(first.position, again.position, size) ||
        !near(first.velocity, again.velocity, speed_size))
        fuzz_fail("at %g s: %g after another state, %g as the first one", time_s, first.position, again.position);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    const uint8_t *at = bytes, *end = size ? bytes + size : bytes;
    cm1e_table_point_t points[POINTS];
    cm1e_table_profile_t table;
    cm1e_table_extremes_t needed;
    const unsigned head = fuzz_take(&at, end, 1);
    const cm1e_motion_state_t start = {0, head & 8 ? plain(fuzz_take_real(&at, end)) : 0,
                                       head & 16 ? plain(fuzz_take_real(&at, end)) : 0};
    const double jerk = head & 32 ? INFINITY : 1000;
    const int count = take_points(&at, end, points);
    const cm1e_error_t error = cm1e_table_profile(&table, (cm1e_table_kind_t)(head % 3), &start, points, count, jerk,
                                                  &needed);
    if (error != CM1E_OK && error != CM1E_ERROR_INVALID_ARGUMENT)
        fuzz_fail("error %d", error);
    if (error != CM1E_OK)
        return false;
    judge_table(&table, &needed);
    for (int i = 0; i < table.knot_count; i++)
        sample_at(&table, &needed, table.knots[i].time_s);
    for (int i = 0; i < SAMPLES && at < end; i++)
        sample_at(&table, &needed, fuzz_take(&at, end, 2) / 65535.0 * table.duration_s);
    return false;
}

void fuzz_seeds(void)
{
    for (int head = 0; head < 64; head += 1) {
        uint8_t bytes[120] = {(uint8_t)head};
        char name[16];
        size_t at = 1;
        for (int i = 0; i < (head & 8 ? 1 : 0) + (head & 16 ? 1 : 0); i++, at += 3)
            bytes[at] = 0x90;
        bytes[at++] = 6;
        bytes[at++] = 13; /* times as they are */
        for (int i = 0; i < 6; i++, at += 7) {
            bytes[at + 3] = 6;
            bytes[at + 4] = 0x90;
            bytes[at + 5] = (uint8_t)(i * 77 % 200);
        }
        for (; at < sizeof bytes; at++)
            bytes[at] = (uint8_t)(at * 37);
        snprintf(name, sizeof name, "table_%d", head);
        fuzz_seed(name, bytes, sizeof bytes);
    }
}
