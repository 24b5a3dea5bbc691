#include "sim/esc_clock_orders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "sim/esc_chip.h"

enum { FEATURE_DC = 0x000C };
/* Of a plain crystal: 0.5 ppm for a kelvin. */
#define DRIFT_PER_KELVIN 0.5e-6

static void drift(cm1e_sim_slave_t *slave, double ppm) { slave->clock.crystal.drift = ppm * 1e-6; }

/* The crystal follows slowly, through its housing: what is still away counts from here. */
static void temperature(cm1e_sim_slave_t *slave, double kelvin)
{
    esc_crystal_t *crystal = &slave->clock.crystal;
    const double present = crystal->warm - crystal->warming;
    crystal->warm = kelvin * DRIFT_PER_KELVIN;
    crystal->warming = crystal->warm - present;
}

static void jitter(cm1e_sim_slave_t *slave, double ns)
{
    slave->clock.crystal.jitter_ns = (uint32_t)ns;
    slave->clock.jitter_ns = 0;
}

static void step(cm1e_sim_slave_t *slave, double ns) { slave->clock.crystal_ns += ns; }

static void let_free(cm1e_sim_slave_t *slave, double number)
{
    (void)number;
    slave->clock.troubles.free = true;
}

static void follow(cm1e_sim_slave_t *slave, double number)
{
    (void)number;
    slave->clock.troubles.free = slave->clock.measuring = false;
}

static void silent(cm1e_sim_slave_t *slave, double number)
{
    (void)number;
    slave->clock.troubles.no_pulses = true;
}

static void pulses(cm1e_sim_slave_t *slave, double number)
{
    (void)number;
    slave->clock.troubles.no_pulses = false;
}

static void set_fitted(cm1e_sim_slave_t *slave, bool fitted)
{
    slave->clock.troubles.absent = !fitted;
    cm1e_put_u16(slave->memory + ESC_FEATURES, fitted ? FEATURE_DC : 0);
}

static void none(cm1e_sim_slave_t *slave, double number)
{
    (void)number;
    set_fitted(slave, false);
}

static void fitted(cm1e_sim_slave_t *slave, double number)
{
    (void)number;
    set_fitted(slave, true);
}

static const struct order {
    const char *word, *unit; /* unit NULL: it has no number */
    double least, most;
    void (*act)(cm1e_sim_slave_t *slave, double number);
} orders[] = {
    {"drift", "ppm", -500, 500, drift},
    {"temperature", "K", -100, 100, temperature}, /* against that at which the drift was stated */
    {"jitter", "ns", 0, 1000, jitter},
    {"step", "ns", -1e6, 1e6, step},
    {"free", NULL, 0, 0, let_free},     /* the control loop no longer follows the reference clock */
    {"follow", NULL, 0, 0, follow},
    {"silent", NULL, 0, 0, silent},     /* SYNC0 and SYNC1 stay away */
    {"pulses", NULL, 0, 0, pulses},
    {"none", NULL, 0, 0, none},         /* a controller without distributed clocks */
    {"fitted", NULL, 0, 0, fitted},
};
enum { ORDERS = sizeof orders / sizeof orders[0] };

static bool take_number(const struct order *order, const char *value, double *number)
{
    char *end;
    *number = strtod(value, &end);
    if (!order->unit)
        return value[0] == '\0';
    return end != value && *end == '\0' && *number >= order->least && *number <= order->most;
}

static bool carry_out(const struct order *order, cm1e_sim_slave_t *slave, const char *value, char *text, size_t size)
{
    double number;
    if (take_number(order, value, &number)) {
        order->act(slave, number);
        snprintf(text, size, "clock %s%s%s%s%s", order->word, order->unit ? " " : "", value, order->unit ? " " : "",
                 order->unit ? order->unit : "");
        return true;
    }
    if (order->unit)
        snprintf(text, size, "\"%.20s\": expected %s, %g to %g", value, order->unit, order->least, order->most);
    else
        snprintf(text, size, "\"%.20s\" is too much behind %s", value, order->word);
    return false;
}

bool cm1e_sim_clock_order(cm1e_sim_slave_t *slave, const char *word, const char *value, char *text, size_t size)
{
    for (int i = 0; i < ORDERS; i++)
        if (strcmp(word, orders[i].word) == 0)
            return carry_out(&orders[i], slave, value, text, size);
    snprintf(text, size, "\"%.20s\": expected drift, temperature, jitter, step, free, follow, silent, pulses, none or "
             "fitted", word);
    return false;
}
