/*
 * Blending (2.4.2, appendix A figures 56-63) by brute force: over random chains of moves, what the axis emits is
 * integrated, compared with the velocity that each mode says at each junction, and its duration with the best of a grid
 * of junction velocities. The ways and times of the grid are this file's own: ramps of velocity, without the kernel.
 */
#include <stdlib.h>

#include "../support/axis_bench.h"
#include "../support/axis_witness.h"

enum { MOVES_MAX = 3, PAIRS = 500, TRIPLES = 600, GRID = 80 };

/** u/s2, u/s3; of the axis */
static const double steepest = 200.0, most_jerk = 9000.0;
/** u/s; what the velocity of a cycle around a junction may differ from the one at it, where there is no acceleration */
static const double blur = 9000.0 * 1e-6;

typedef struct {
    double length, velocity, acceleration, deceleration, jerk;
    MC_BUFFER_MODE mode; /**< how it follows the one before */
} leg_t;

typedef struct {
    int count;
    double sign;
    leg_t legs[MOVES_MAX];
    char name[400];
} chain_t;

static uint64_t random_state;

static double uniform(double low, double high) /* splitmix64 */
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

void setUp(void) {}
void tearDown(void) { bench_end(); }

static void begin(void)
{
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_acceleration = steepest;
    bus.config.axes[0].max_deceleration = steepest;
    bus.config.axes[0].max_jerk = most_jerk;
    bench_create();
    bench_enable();
    watch_begin();
}

static chain_t random_chain(int count)
{
    chain_t chain = {.count = count, .sign = uniform(0, 1) < 0.5 ? -1.0 : 1.0};
    int length = snprintf(chain.name, sizeof chain.name, "of %+g:", chain.sign);
    for (int i = 0; i < count; i++) {
        chain.legs[i] = (leg_t){
            .length = pow(10.0, uniform(-1.5, 0.9)), .velocity = uniform(0.5, 15.0),
            .acceleration = uniform(30, 200), .deceleration = uniform(30, 200), .jerk = uniform(1000, 9000),
            .mode = i ? (MC_BUFFER_MODE)(mcBlendingLow + (int)uniform(0, 4)) : mcAborting};
        const leg_t *leg = &chain.legs[i];
        length += snprintf(chain.name + length, sizeof chain.name - (size_t)length, " {%.17g, %g, %g, %g, %g, mode %d}",
                           leg->length, leg->velocity, leg->acceleration, leg->deceleration, leg->jerk, leg->mode);
        if (length >= (int)sizeof chain.name)
            length = sizeof chain.name - 1;
    }
    return chain;
}

/* ---- by brute force ---------------------------------------------------------------------------------------------- */

/** Time of a ramp between two velocities, both without acceleration. */
static double ramp_time(const leg_t *leg, double from, double to)
{
    const double most = to > from ? leg->acceleration : leg->deceleration, change = fabs(to - from);
    return change * leg->jerk >= most * most ? change / most + most / leg->jerk : 2 * sqrt(change / leg->jerk);
}

static double ramp_way(const leg_t *leg, double from, double to)
{
    return (from + to) / 2 * ramp_time(leg, from, to);
}

/** Of a leg by way of a velocity; a way that is left over is gone at that velocity. NaN: too short. */
static double time_by_way_of(const leg_t *leg, double from, double peak, double to)
{
    const double left = leg->length - ramp_way(leg, from, peak) - ramp_way(leg, peak, to);
    return left < -1e-9 * leg->length ? NAN
                                      : ramp_time(leg, from, peak) + ramp_time(leg, peak, to) + fmax(0, left) / peak;
}

/** Of a leg that is entered and left with these velocities, at no acceleration; NaN: too short. Infinite: long enough,
 *  but it comes down to its own velocity without ever cruising, which ramps from velocity to velocity cannot show. */
static double leg_time(const leg_t *leg, double from, double to)
{
    const double time = time_by_way_of(leg, from, leg->velocity, to);
    if (!isnan(time))
        return time;
    if (ramp_way(leg, from, to) > leg->length)
        return NAN;
    if (from > leg->velocity)
        return INFINITY;
    /* The velocity in between that just fits. A leg that is left faster than its own velocity may use that at the end
     * only. */
    double fits = to > leg->velocity ? from : fmax(from, to), too_much = leg->velocity;
    for (int i = 0; i < 60; i++) {
        const double peak = (fits + too_much) / 2;
        if (isnan(time_by_way_of(leg, from, peak, to)))
            too_much = peak;
        else
            fits = peak;
    }
    return time_by_way_of(leg, from, fits, to);
}

static double wanted(const chain_t *chain, int junction)
{
    const double first = chain->legs[junction].velocity, second = chain->legs[junction + 1].velocity;
    switch (chain->legs[junction + 1].mode) {
    case mcBlendingLow: return fmin(first, second);
    case mcBlendingPrevious: return first;
    case mcBlendingNext: return second;
    default: return fmax(first, second);
    }
}

static double chain_time(const chain_t *chain, const double velocities[])
{
    double time = 0, from = 0;
    for (int i = 0; i < chain->count; i++) {
        const double to = i + 1 < chain->count ? velocities[i] : 0;
        time += leg_time(&chain->legs[i], from, to);
        from = to;
    }
    return time;
}

/** The shortest over a grid of junction velocities up to those that the modes say, which alone count at a junction that
 *  the axis passes as its mode says. NaN: the grid has none that fits. */
static double best_time(const chain_t *chain, const double passed[], double best[])
{
    double shortest = NAN;
    for (int a = 0; a <= GRID; a++)
        for (int b = 0; b <= (chain->count > 2 ? GRID : 0); b++) {
            const double velocities[] = {wanted(chain, 0) * a / GRID,
                                         chain->count > 2 ? wanted(chain, 1) * b / GRID : 0};
            const bool counts = (a == GRID || fabs(passed[0] - wanted(chain, 0)) > blur) &&
                                (chain->count == 2 || b == GRID || fabs(passed[1] - wanted(chain, 1)) > blur);
            const double time = counts ? chain_time(chain, velocities) : NAN;
            if (!isnan(time) && !(time >= shortest)) {
                shortest = time;
                best[0] = velocities[0];
                best[1] = velocities[1];
            }
        }
    return shortest;
}

/* ---- by the axis ------------------------------------------------------------------------------------------------- */

typedef struct {
    double time, velocities[MOVES_MAX];
} run_t;

/** Within the limits of the move that is active, but for what a junction asks: only then, and only towards it. */
static void check_limits(const chain_t *chain, int leg, double acceleration_before)
{
    const leg_t *limits = &chain->legs[leg];
    const double v = chain->sign * axis->setpoint.velocity, a = chain->sign * axis->setpoint.acceleration;
    WATCH(v >= -1e-9, "backwards at %g", v);
    WATCH(v <= limits->velocity * (1 + 1e-9) || a >= -1e-6 || leg > 0, "faster without need: %g", v);
    const double most = a > 0 ? limits->acceleration : limits->deceleration;
    const double step = fabs(a - acceleration_before);
    WATCH(fabs(a) <= most * (1 + 1e-9), "acceleration %.12g above %.12g", a, most);
    WATCH(step <= limits->jerk * axis->cycle_s * (1 + 1e-9) + 1e-7, "jerk %.12g above %.12g", step / axis->cycle_s,
          limits->jerk);
}

/** Runs the chain, integrates what it emits, and says how fast the junctions were passed. */
static run_t run_chain(const chain_t *chain)
{
    cm1e_command_id_t ids[MOVES_MAX];
    double ends[MOVES_MAX], end = 0, sum = 0;
    begin();
    watch.run = chain->name;
    const double begins_at = bench_info().set_position;
    for (int i = 0; i < chain->count; i++) {
        const leg_t *leg = &chain->legs[i];
        end += leg->length;
        ends[i] = end;
        ids[i] = bench_start_command(&(cm1e_axis_command_t){
            .kind = i % 2 ? CM1E_COMMAND_MOVE_RELATIVE : CM1E_COMMAND_MOVE_ABSOLUTE,
            .position = i % 2 ? chain->sign * leg->length : begins_at + chain->sign * end,
            .velocity = leg->velocity, .acceleration = leg->acceleration, .deceleration = leg->deceleration,
            .jerk = leg->jerk, .buffer_mode = leg->mode});
    }
    run_t run = {0};
    const double t = axis->cycle_s;
    int leg = 0;
    while (bench_state_of(ids[chain->count - 1]) != CM1E_COMMAND_DONE) {
        const double v0 = axis->setpoint.velocity, a0 = axis->setpoint.acceleration;
        watch_cycles(1);
        const double way = chain->sign * (bench_info().set_position - begins_at), v = axis->setpoint.velocity;
        const double a = axis->setpoint.acceleration;
        run.time += t;
        sum += chain->sign * (t * (v0 + v) / 2 - t * t * (a - a0) / 12); /* exact under a constant jerk */
        WATCH(run.time < 60, "never ends");
        WATCH(fabs(sum - way) <= 40 * most_jerk * t * t * t, "at %.12g, the integral is %.12g", way, sum);
        if (leg + 1 < chain->count && way >= ends[leg] - 1e-12) { /* the junction lies in this cycle */
            run.velocities[leg++] = fmin(fabs(v0), fabs(v)) == 0 ? 0 : fabs(v0 + v) / 2;
            WATCH(bench_state_of(ids[leg - 1]) == CM1E_COMMAND_DONE, "junction %d passed, not done", leg);
            WATCH(leg + 1 == chain->count || way < ends[leg], "two junctions in a cycle");
        } else {
            WATCH(bench_state_of(ids[leg]) != CM1E_COMMAND_DONE || leg + 1 == chain->count, "done too early");
            check_limits(chain, leg, chain->sign * a0);
        }
    }
    WATCH(fabs(end - chain->sign * (bench_info().set_position - begins_at)) <= 1e-9, "ends elsewhere");
    return run;
}

static void test_pairs_pass_the_junction_as_their_mode_says(void)
{
    int full = 0, compared = 0;
    for (int i = 0; i < PAIRS; i++) {
        const chain_t chain = random_chain(2);
        const run_t run = run_chain(&chain);
        /* the highest velocity that both moves allow, up to what the mode says */
        const double most = wanted(&chain, 0);
        double velocity = most;
        if (isnan(chain_time(&chain, &velocity))) {
            double low = 0, high = most;
            for (int k = 0; k < 60; k++) {
                velocity = (low + high) / 2;
                if (isnan(chain_time(&chain, &velocity)))
                    high = velocity;
                else
                    low = velocity;
            }
        }
        full += velocity == most;
        WATCH(fabs(run.velocities[0] - velocity) <= blur, "junction at %.9g instead of %.9g",
              run.velocities[0], velocity);
        double best[2];
        const double shortest = best_time(&chain, run.velocities, best);
        compared += !isnan(shortest);
        WATCH(!(run.time > shortest + 1.001 * axis->cycle_s), "%.6f s instead of %.6f s at %g", run.time, shortest,
              best[0]);
    }
    printf("%d of %d pairs have room for what their mode says, %d compared with a grid\n", full, PAIRS, compared);
    TEST_ASSERT_GREATER_THAN(PAIRS * 9 / 10, compared);
    TEST_ASSERT_GREATER_THAN(PAIRS / 5, full);
    TEST_ASSERT_LESS_THAN(PAIRS * 9 / 10, full);
}

static void test_triples_take_no_longer_than_the_best_of_their_junctions(void)
{
    int full = 0, compared = 0;
    for (int i = 0; i < TRIPLES; i++) {
        const chain_t chain = random_chain(3);
        const run_t run = run_chain(&chain);
        const double velocities[] = {wanted(&chain, 0), wanted(&chain, 1)};
        if (!isnan(chain_time(&chain, velocities))) {
            full++;
            for (int k = 0; k < 2; k++)
                WATCH(fabs(run.velocities[k] - velocities[k]) <= blur, "junction %d at %.9g instead of %.9g",
                      k, run.velocities[k], velocities[k]);
        }
        double best[2];
        const double shortest = best_time(&chain, run.velocities, best);
        compared += !isnan(shortest);
        WATCH(!(run.time > shortest + 1.001 * axis->cycle_s), "%.6f s at %g, %g instead of %.6f s at %g, %g", run.time,
              run.velocities[0], run.velocities[1], shortest, best[0], best[1]);
    }
    printf("%d of %d triples have room for what their modes say, %d compared with a grid\n", full, TRIPLES, compared);
    TEST_ASSERT_GREATER_THAN(TRIPLES * 8 / 10, compared);
    TEST_ASSERT_GREATER_THAN(TRIPLES / 10, full);
}

int main(void)
{
    const char *seed = getenv("CM1E_TEST_SEED");
    random_state = seed ? strtoull(seed, NULL, 0) : 20261121;
    printf("CM1E_TEST_SEED=%llu\n", (unsigned long long)random_state);
    UNITY_BEGIN();
    RUN_TEST(test_pairs_pass_the_junction_as_their_mode_says);
    RUN_TEST(test_triples_take_no_longer_than_the_best_of_their_junctions);
    return UNITY_END();
}
