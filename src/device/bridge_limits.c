#include "device/bridge_facts.h"

/* BR appendix 5. Resolutions 0 ... 10 and 40 ... 50 repeat 20 higher with a finer unit of speed (10 pps), and with a
 * CM2 the first ones once more at 80 (1 pps). Of its two tables the first is taken for the CM1's, as its headings
 * stand; in the second one speeds in 1 pps occur, which no page mentions for a CM1. */
enum { RESOLUTIONS = 11, REPEATED = 20, OTHER_RESOLUTIONS = 40, FINEST = 80 };

static const int32_t common[RESOLUTIONS] = {8589934,   17179869,  21474836,  42949672, 85899345, 107374182,
                                            214748364, 429496729, 999999999, 0,        999999999};
static const int32_t others[][RESOLUTIONS] = {
    {13421772, 17895697, 26843545, 35791394, 53687091, 67108863, 134217727, 178956970, 268435455, 357913941, 536870911},
    {12884901, 17179869, 25769803, 34359738, 51539607, 64424509, 128849018, 171798691, 257698037, 343597383, 515396075},
};

int32_t cm1e_bridge_position_limit(cm1e_bridge_motor_t motor, int32_t k37)
{
    if (k37 < 0 || k37 >= FINEST + REPEATED || (k37 >= FINEST && motor == CM1E_BRIDGE_CM1))
        return 0;
    const int32_t resolution = k37 % REPEATED;
    if (resolution >= RESOLUTIONS)
        return 0;
    return k37 < OTHER_RESOLUTIONS || k37 >= FINEST ? common[resolution]
                                                    : others[motor == CM1E_BRIDGE_CM2][resolution];
}

/* The guide has no resolutions. Known of CM1 and CM2; appendix 5 is 42,949.67 times them, 44,739.24 times the second
 * row behind a CM1, as far as it is not cut to 999,999,999. */
int32_t cm1e_bridge_counts_per_revolution(int32_t k37)
{
    static const int32_t resolutions[][RESOLUTIONS] = {
        {200, 400, 500, 1000, 2000, 2500, 5000, 10000, 25000, 0, 50000},
        {300, 400, 600, 800, 1200, 1500, 3000, 4000, 6000, 8000, 12000},
    };
    if (cm1e_bridge_position_limit(CM1E_BRIDGE_CM2, k37) == 0)
        return 0;
    return resolutions[k37 >= OTHER_RESOLUTIONS && k37 < FINEST][k37 % REPEATED];
}

int cm1e_bridge_offset_unit(int32_t k45)
{
    static const int units[] = {CM1E_BRIDGE_OFFSET_UNIT, 10, 1};
    const int digit = k45 / 10 % 10;
    return digit >= 0 && digit < (int)(sizeof units / sizeof units[0]) ? units[digit] : 0;
}
