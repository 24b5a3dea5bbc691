/* Whatever a master does with the simulated bridge: no step out of bounds, states and modes that the guide knows, texts
 * that end, positions that the mechanics allow. */
#include <math.h>
#include <stdio.h>

#include "chance.h"
#include "sim_bridge_bench.h"

enum { SEEDS = 300, CYCLES = 3000 };

static bench_t b;

void setUp(void) {}
void tearDown(void) { bench_close(&b); }

static void random_outputs(void)
{
    static const uint16_t words[] = {0, 0, 0, 0, 0x06, 0x07, 0x0F, 0x1F, 0x80, 0xF107, 0xF207, 0xF307, 0xF607, 0xC0FF};
    const int axis = pick(CM1E_BRIDGE_AXES);
    if (one_in(5))
        b.axes[axis].controlword = words[pick(sizeof words / sizeof words[0])];
    if (one_in(50))
        b.axes[axis].controlword = (uint16_t)chance();
    if (one_in(200))
        b.axes[axis].target = (int32_t)chance();
    else
        b.axes[axis].target = (int32_t)cm1e_sim_bridge_position(&b.bridge->axes[axis]) + pick(100);
}

/* Strings that the motor knows, mostly: few of letters at random would be. */
static void random_cml(void)
{
    static const char *const strings[] = {"K42=9,K43=9", "?99,?96", "?90", "O1,O2,O3,O4", "F1,F4", "|", "(", ")",
                                          "K37=3"};
    uint8_t text[128];
    const char *string = strings[pick(sizeof strings / sizeof strings[0])];
    size_t size = strlen(string);
    memcpy(text, string, size);
    if (one_in(3))
        size = (size_t)pick(70);
    for (size_t i = strlen(string); i < size; i++)
        text[i] = (uint8_t)chance();
    if (size > 0 && one_in(3))
        text[pick((int)size)] = (uint8_t)chance();
    b.ops->sdo_write(b.bridge, (uint16_t)(0xF581 + pick(4)), 0, BENCH_OP, text, size);
    size = sizeof text;
    TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_read(b.bridge, (uint16_t)(0xF591 + pick(4)), 0, BENCH_OP, text, &size));
    TEST_ASSERT_TRUE(size > 2 && size <= CM1E_CML_BYTES && text[size - 2] == '\r' && text[size - 1] == '\n');
}

static void random_sdo(void)
{
    const cm1e_object_t *object = b.ops->object(b.bridge, (size_t)pick(400));
    if (!object)
        return;
    const cm1e_entry_t *entry = &object->entries[pick(object->entry_count)];
    uint8_t data[128];
    size_t size = (size_t)pick(sizeof data);
    b.ops->sdo_read(b.bridge, entry->index, entry->subindex, BENCH_OP, data, &size);
    cm1e_put_u64(data, chance());
    b.ops->sdo_write(b.bridge, entry->index, entry->subindex, one_in(2) ? BENCH_PREOP : BENCH_OP, data,
                     (size_t)pick(9));
}

static void random_act(void)
{
    static const int8_t modes[] = {6, 8, 101, 120, 121, 3};
    const uint8_t mode = (uint8_t)modes[pick(sizeof modes)];
    if (one_in(8))
        b.ops->sdo_write(b.bridge, (uint16_t)(0x6060 + 0x800 * pick(4)), 0, BENCH_OP, &mode, 1);
    if (one_in(4))
        random_cml();
    if (one_in(4))
        random_sdo();
    if (one_in(300))
        cm1e_sim_bridge_axis_plug(&b.bridge->axes[pick(4)], one_in(2));
    if (one_in(700))
        b.ops->state_change(b.bridge, BENCH_OP, BENCH_SAFEOP);
    if (one_in(1000))
        b.ops->power_on(b.bridge, b.now_ns);
}

static void check_axis(const cm1e_sim_bridge_axis_t *axis)
{
    const int mode = axis->mode;
    TEST_ASSERT_TRUE(mode == 6 || mode == 8 || mode == 101 || mode == 120 || mode == 121);
    TEST_ASSERT_TRUE(axis->state < CM1E_FSA_STATE_COUNT && axis->state != QUICK_STOP_ACTIVE);
    TEST_ASSERT_TRUE(isfinite(axis->mechanics.position) && fabs(axis->mechanics.position) <= 250001);
    TEST_ASSERT_TRUE(isfinite(axis->servo.reference) && isfinite(axis->servo.torque));
    TEST_ASSERT_EQUAL_HEX8(0, axis->outputs & ~cm1e_bridge_output_mask(axis->motor));
    TEST_ASSERT_TRUE(axis->received <= axis->sent);
    if (axis->motor_free)
        TEST_ASSERT_TRUE(axis->servo.torque == 0);
}

static void test_anything_does_no_harm(void)
{
    static const cm1e_device_model_t models[] = {CM1E_DEVICE_EB01, CM1E_DEVICE_EB02, CM1E_DEVICE_EB12};
    for (int run = 0; run < seed_count(SEEDS); run++) {
        const unsigned seed = seed_of(run);
        chance_seed(seed);
        printf("seed %u\n", seed);
        bench_open(&b, models[pick(3)]);
        for (int n = 0; n < CYCLES; n++) {
            random_outputs();
            random_act();
            if (!one_in(20))
                bench_cycle_after(&b, BENCH_MS);
            for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
                check_axis(&b.bridge->axes[axis]);
        }
        bench_close(&b);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_anything_does_no_harm);
    return UNITY_END();
}
