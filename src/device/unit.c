#include "device/unit.h"

#include <math.h>

#include "device/devices.h"

__extension__ typedef unsigned __int128 wide_t;

/* A positive fraction while it is multiplied. */
typedef struct ratio {
    wide_t numerator, denominator;
} ratio_t;

static uint32_t or_one(uint32_t value) { return value ? value : 1; }

static double units_per_revolution(const cm1e_axis_config_t *config)
{
    return config->units_per_revolution > 0.0 ? config->units_per_revolution : 1.0;
}

double cm1e_unit_counts_per_revolution(const cm1e_axis_config_t *config)
{
    const cm1e_device_t *device = cm1e_device_configured(config);
    return device ? device->counts_per_revolution(config) : CM1E_COUNTS_PER_REVOLUTION;
}

double cm1e_unit_count(const cm1e_axis_config_t *config)
{
    return cm1e_unit_counts_per_revolution(config) / CM1E_COUNTS_PER_REVOLUTION;
}

double cm1e_unit_peak_velocity(const cm1e_axis_config_t *config)
{
    if (config->type != CM1E_AXIS_MOTOR && config->max_velocity > 0.0)
        return config->max_velocity * cm1e_unit_scale(config);
    if (config->type != CM1E_AXIS_MOTOR)
        return 50.0 * cm1e_unit_counts_per_revolution(config);
    const cm1e_device_t *device = cm1e_device_configured(config);
    return device ? device->peak_velocity(config) : 0.0;
}

double cm1e_unit_backlash_velocity(const cm1e_axis_config_t *config)
{
    return cm1e_unit_counts_per_revolution(config);
}

cm1e_unit_t cm1e_unit_of(const cm1e_axis_config_t *config)
{
    if (config->counts_per_unit > 0.0)
        return (cm1e_unit_t){.counts = config->counts_per_unit, .units = 1.0};
    return (cm1e_unit_t){
        .counts = cm1e_unit_counts_per_revolution(config) * or_one(config->gear_numerator),
        .units = units_per_revolution(config) * or_one(config->gear_denominator),
    };
}

double cm1e_unit_scale(const cm1e_axis_config_t *config)
{
    const cm1e_unit_t unit = cm1e_unit_of(config);
    return unit.counts / unit.units;
}

static wide_t divisor(wide_t a, wide_t b)
{
    while (b) {
        const wide_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static const wide_t largest = (wide_t)1 << 62;

/* The first convergent of the continued fraction that rounds to `value`: what a person wrote, or close enough that no
 * double tells the difference. Doubles from 2^-60 to 2^60 are quotients of 128-bit numbers themselves. */
static bool rational(double value, ratio_t *result)
{
    int exponent;
    if (!(value > 0x1p-60) || !(value < 0x1p60))
        return false;
    wide_t a = (wide_t)ldexp(frexp(value, &exponent), 53), b = 1;
    exponent -= 53;
    if (exponent > 0)
        a <<= exponent;
    else
        b <<= -exponent;
    ratio_t before = {0, 1}, now = {1, 0};
    while (b) {
        const wide_t whole = a / b, rest = a % b;
        const ratio_t next = {whole * now.numerator + before.numerator, whole * now.denominator + before.denominator};
        if (next.numerator > largest || next.denominator > largest)
            return false;
        before = now;
        now = next;
        if ((double)now.numerator / (double)now.denominator == value)
            break;
        a = b;
        b = rest;
    }
    *result = now;
    return true;
}

/* a *= numerator / denominator, kept in lowest terms. false: too large. */
static bool multiply(ratio_t *a, wide_t numerator, wide_t denominator)
{
    const wide_t left = divisor(a->numerator, denominator), right = divisor(numerator, a->denominator);
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): a divisor is 0 only of two zeros */
    const wide_t up = a->numerator / left, by = numerator / right;
    const wide_t down = a->denominator / right, under = denominator / left;
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): quotients by a divisor are above 0 */
    if (up > largest / by || down > largest / under)
        return false;
    *a = (ratio_t){up * by, down * under};
    return true;
}

bool cm1e_unit_modulo(const cm1e_axis_config_t *config, cm1e_fraction_t *turn)
{
    ratio_t range, unit;
    if (!rational(config->modulo_range, &range))
        return false;
    bool good;
    if (config->counts_per_unit > 0.0) {
        good = rational(config->counts_per_unit, &unit) && multiply(&range, unit.numerator, unit.denominator);
    } else {
        good = rational(units_per_revolution(config), &unit) && multiply(&range, unit.denominator, unit.numerator) &&
               multiply(&range, or_one(config->gear_numerator), or_one(config->gear_denominator)) &&
               multiply(&range, (wide_t)cm1e_unit_counts_per_revolution(config), 1);
    }
    if (!good)
        return false;
    *turn = (cm1e_fraction_t){(int64_t)range.numerator, (int64_t)range.denominator};
    return true;
}
