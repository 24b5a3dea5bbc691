/* A bridge that says anything, and callers that command anything: what the drive writes keeps its rules. */
#include "drive_bridge_bench.h"

#include "../support/seeds.h"
#include "../support/xorshift.h"

enum { CYCLES = 3000 };

static uint64_t seed;
static unsigned number; /* of the run, from which the seed is made */

void setUp(void) {}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("it was seed %u\n", number);
    bench_close();
}

static uint32_t draw(uint32_t below)
{
    return (uint32_t)(xorshift(&seed) >> 33) % below;
}

static const int modes[] = {8, 8, 8, 6, 101, 120, 121, 0, 9, -1};

/* Mostly the truth, so that the drive gets far enough to be wrong. */
static void lie(void)
{
    cm1e_sim_bridge_axis_t *axis = fake_bridge_axis();
    if (draw(40) == 0)
        fake_bridge.statusword = draw(3) ? -1 : (int)draw(0x10000);
    if (draw(300) == 0)
        fake_bridge.mode_shown = draw(3) ? -1 : modes[draw(7)];
    if (draw(100) == 0)
        fake_bridge.broken_sdo = draw(4);
    if (draw(800) == 0)
        cm1e_sim_bridge_axis_error(axis, (uint8_t)(1u << draw(3)));
    if (draw(1500) == 0)
        cm1e_sim_bridge_axis_plug(axis, draw(3) > 0);
    if (draw(2000) == 0)
        axis->zero += (int64_t)draw(UINT32_MAX) - INT32_MAX;
    if (draw(1000) == 0) {
        cm1e_sim_bridge_ops.power_on(fake_bridge.app, bus.clock.virtual_now_ns);
        cm1e_sim_bridge_ops.state_change(fake_bridge.app, CM1E_AL_INIT, CM1E_AL_OP);
    }
    fake_bridge.lost = fake_bridge.lost ? draw(5) > 0 : draw(150) == 0;
    bus.sdo_full = draw(200) == 0;
    if (draw(400) == 0)
        bus.watch = (cm1e_slave_watch_t){.al_state = draw(2) ? CM1E_AL_OP : (uint16_t)draw(32), .lost = draw(4) == 0};
    else if (draw(50) == 0)
        bus.watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_OP};
}

static void command(void)
{
    static const int cmds[] = {0xF1, 0xF2, 0xF3, 0xF4, 0xF6, 0, 0xF5};
    cm1e_drive_command_t *c = &drive.command;
    if (draw(60) == 0)
        c->enable = draw(5) > 0;
    if (draw(300) == 0)
        c->mode = (cm1e_mode_t)modes[draw(10)];
    c->mode_insist = draw(2);
    c->reset = draw(20) == 0;
    c->homing_start = draw(3) > 0;
    c->halt = draw(10) == 0;
    c->target_position = draw(300) ? drive.feedback.position + (int32_t)draw(50) - 25 : (int32_t)draw(UINT32_MAX);
    if (draw(50) == 0)
        c->digital_outputs = (uint16_t)draw(0x10000);
    if (draw(100) == 0)
        cm1e_drive_want_inputs(&drive);
    if (draw(20) == 0)
        cm1e_drive_cmd_start(&drive, (cm1e_drive_cmd_t)cmds[draw(7)], draw(2) ? 0 : (int64_t)draw(1000) * CYCLE_NS);
    if (draw(500) == 0)
        cm1e_drive_cmd_release(&drive);
    if (draw(500) == 0)
        cm1e_drive_fail(&drive, draw(2) ? CM1E_ERROR_BUS_LOST : CM1E_ERROR_BUS_WORKING_COUNTER);
}

static int32_t target_before;
static unsigned reset_bit_cycles;

static void check(void)
{
    const cm1e_drive_feedback_t *f = &drive.feedback;
    const uint16_t word = bench_word();
    const int32_t target = bench_target();
    const bool cpio = word >> 12 == 0xC, cmd = word >> 12 == 0xF;
    const unsigned low = word & 0x0F;
    const bool torque = !cmd && f->mode != CM1E_BRIDGE_MODE_CMD && (low == 0x0F || low == 0x07);
    TEST_ASSERT_TRUE(low == 0x06 || low == 0x07 || low == 0x0F || low == 0);
    TEST_ASSERT_TRUE(!cpio || f->mode == CM1E_BRIDGE_MODE_CPIO);
    TEST_ASSERT_TRUE(!cmd || f->mode == CM1E_BRIDGE_MODE_CMD);
    TEST_ASSERT_TRUE(word != 0x0007 || f->mode == CM1E_BRIDGE_MODE_CMD || f->mode == 8 || f->mode == 6);
    if (f->mode == CM1E_BRIDGE_MODE_CML) /* strings go only while no controlword does */
        TEST_ASSERT_EQUAL_HEX16(0, word);
    if (!drive.command.enable)
        TEST_ASSERT_FALSE(torque);
    const bool rampable = drive.fault.error == CM1E_ERROR_BUS_LOST ||
                          drive.fault.error == CM1E_ERROR_BUS_WORKING_COUNTER ||
                          drive.fault.error == CM1E_ERROR_DRIVE_POSITION;
    /* a target beyond K37 is refused in the cycle itself: the torque goes in the next */
    if (drive.fault.error && !rampable && drive.fault.error != CM1E_ERROR_AXIS_POSITION_RANGE)
        TEST_ASSERT_FALSE(torque);
    if (torque && f->state != OPERATION_ENABLED) { /* on the way: actual position, the right mode shown */
        TEST_ASSERT_EQUAL_INT32(f->position, target);
        TEST_ASSERT_EQUAL_INT8(drive.mode.commanded, f->mode);
        TEST_ASSERT_TRUE(f->online);
    }
    if (!f->enabled)
        TEST_ASSERT_TRUE(target == f->position || (target == target_before && f->state == OPERATION_ENABLED));
    else
        TEST_ASSERT_TRUE(target == drive.command.target_position || target == target_before ||
                         target == f->position);
    if (torque && f->state == OPERATION_ENABLED && target != f->position && target != target_before)
        TEST_ASSERT_TRUE(target <= 999999999 && target >= -999999999);
    reset_bit_cycles = !cpio && !cmd && (word & CONTROLWORD_FAULT_RESET) ? reset_bit_cycles + 1 : 0;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(22, reset_bit_cycles);
    target_before = target;
}

static unsigned run(unsigned shown[128])
{
    seed = UINT64_C(0x9E3779B97F4A7C15) * (number + 1);
    static const cm1e_device_model_t models[] = {CM1E_DEVICE_EB01, CM1E_DEVICE_EB02, CM1E_DEVICE_EB12};
    bench_open(models[draw(3)], 1 + draw(4));
    bus.sdo_delay = draw(8);
    unsigned enabled_cycles = 0;
    char text[600];
    reset_bit_cycles = 0;
    target_before = bench_target();
    for (int i = 0; i < CYCLES; i++) {
        fake_bus_cycle(&bus, CYCLE_NS);
        lie();
        cm1e_drive_read(&drive, !fake_bridge.lost && draw(30) > 0, bus.clock.virtual_now_ns);
        enabled_cycles += drive.feedback.enabled;
        shown[drive.feedback.mode & 0x7F]++;
        command();
        cm1e_drive_write(&drive);
        check();
        if (i % 50 == 0)
            cm1e_drive_fault_text(&drive, text, sizeof text);
    }
    TEST_ASSERT_GREATER_THAN_INT64(5000000, fake_bridge.shortest_mode_interval_ns);
    return enabled_cycles;
}

static void test_any_inputs_and_commands_keep_the_rules(void)
{
    unsigned enabled_cycles = 0, shown[128] = {0};
    for (int i = 0; i < seeds_of(200); i++) {
        number = seed_of(i);
        enabled_cycles += run(shown);
    }
    printf("%u of %d cycles enabled; csp %u, hm %u, CML %u, CMD %u, CPIO %u\n", enabled_cycles,
           seeds_of(200) * CYCLES, shown[8], shown[6], shown[101], shown[120], shown[121]);
    if (seeds_given())
        return;
    TEST_ASSERT_GREATER_THAN_UINT(10000, enabled_cycles); /* else the lies were too thick to test anything */
    for (int i = 0; i < 7; i++)
        TEST_ASSERT_GREATER_THAN_UINT(3000, shown[modes[i]]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_any_inputs_and_commands_keep_the_rules);
    return UNITY_END();
}
