#include "units_log.h"

#include "chance.h"

enum { LONGEST = 8000 };

typedef struct moment {
    int32_t target[AXES_MOST], target_velocity[AXES_MOST], state[AXES_MOST], error[AXES_MOST];
    bool in_position[AXES_MOST];
    double set[AXES_MOST], velocity[AXES_MOST], acceleration[AXES_MOST], actual[AXES_MOST];
    double note[UNITS_NOTES];
} moment_t;

/* In place of that of libm, which rounds the roots of numbers below 1 otherwise than those above. */
double cbrt(double x)
{
    int exponent;
    const double part = frexp(x, &exponent);
    const int third = (int)floor(exponent / 3.0);
    return ldexp((double)cbrtl(ldexp(part, exponent - 3 * third)), third);
}

/* 1 first; then other powers of 64, so that roots change no digit either. */
static const double units[UNITS_COUNT] = {1, 0x1p-24, 0x1p24, 0x1p-12};
double in_units;

static moment_t first[LONGEST], now;
static int run, cycle, noted;

bool mirrored(void) { return in_units < 0; }

void units_describe(void)
{
    for (int n = 0; n < axes_bench.count; n++)
        axes_config(n)->counts_per_unit = 50000 / fabs(in_units);
}

void units_note(double number)
{
    AXES_MUST(noted < UNITS_NOTES, "too many notes");
    now.note[noted++] = number;
}

/* `slack`: of the mirror, in which fractions of a count are rounded otherwise. */
static void must_be(const char *what, int n, double is, double was, double slack)
{
    AXES_MUST(fabs(is - was) <= (mirrored() ? slack : 0) || (isnan(is) && isnan(was)),
              "run with u = %g: %s %d is %.17g, with 1 it was %.17g", in_units, what, n, is, was);
}

static void write_down(int n)
{
    const cm1e_axis_info_t info = axes_info(n);
    now.target[n] = (int32_t)fake_output(axes_motor(n), OBJ_607A_TARGET_POSITION, 0);
    now.target_velocity[n] = (int32_t)fake_output(axes_motor(n), OBJ_60FF_TARGET_VELOCITY, 0);
    now.state[n] = info.state;
    now.error[n] = info.error;
    now.in_position[n] = info.in_position;
    now.set[n] = info.set_position / in_units;
    now.velocity[n] = info.set_velocity / in_units;
    now.acceleration[n] = axes_axis(n)->setpoint.acceleration / in_units;
    now.actual[n] = info.actual_position / in_units;
}

static void compare(const moment_t *was, int n)
{
    must_be("state of axis", n, now.state[n], was->state[n], 0);
    must_be("error of axis", n, now.error[n], was->error[n], 0);
    must_be("target of axis", n, now.target[n], was->target[n], 1);
    must_be("target velocity of axis", n, now.target_velocity[n], was->target_velocity[n], 30);
    must_be("being in position of axis", n, now.in_position[n], was->in_position[n], 0);
    must_be("set position of axis", n, now.set[n], was->set[n], 1e-8);
    must_be("set velocity of axis", n, now.velocity[n], was->velocity[n], 1e-7);
    must_be("acceleration of axis", n, now.acceleration[n], was->acceleration[n], 1e-4);
    must_be("actual position of axis", n, now.actual[n], was->actual[n], 2.1e-5);
}

void units_cycle(void)
{
    AXES_MUST(cycle < LONGEST, "too long");
    for (int n = 0; n < axes_bench.count; n++)
        write_down(n);
    if (run == 0)
        first[cycle] = now;
    for (int n = 0; n < axes_bench.count; n++)
        compare(&first[cycle], n);
    for (int i = 0; i < UNITS_NOTES; i++)
        must_be("note", i, now.note[i], first[cycle].note[i], 1e-7);
    cycle++;
    noted = 0;
    now = (moment_t){0};
}

double in(double base) { return base * in_units; }

double size(double base) { return base * fabs(in_units); }

double decade(double low, double high) { return exp(uniform(log(low), log(high))); }

double or_default(double base) { return one_in(2) ? 0 : size(base); }

static void run_in(const units_program_t *program, int number, double unit, int seed)
{
    char name[40];
    snprintf(name, sizeof name, "CM1E_TEST_SEED=%d", seed);
    run = number;
    in_units = unit;
    cycle = noted = 0;
    now = (moment_t){0};
    chance_seed((uint64_t)seed);
    program->begin();
    axes_bench.run = name;
    for (int i = 0; i < program->cycles; i++)
        program->cycle();
    axes_bench.run = NULL;
}

void units_compare(const units_program_t *program, int seed, bool mirror)
{
    for (int k = 0; k < (mirror ? 2 : UNITS_COUNT); k++)
        run_in(program, k, !mirror ? units[k] : k ? -1 : 1, seed);
}
