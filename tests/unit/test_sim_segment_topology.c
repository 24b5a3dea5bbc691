/* The segment: line and ring, every cut, slaves that reset, links and lost-link counters, frame faults. */
#include "sim_fake_app.h"

enum { SLAVES = 5 };

static bench_t b;

void setUp(void) { bench_open(&b, SLAVES); }
void tearDown(void) { bench_close(&b); }

/* Sends a broadcast into a port; the working counter, -1: lost. Where it came out is in b.came_out. */
static int broadcast(int port)
{
    uint8_t data[1] = {0};
    b.port = port;
    const int counter = send_to(&b, BRD, 0, 0x0000, data, 1);
    b.port = 0;
    return counter;
}

static void test_line_gives_frames_back_at_the_entry(void)
{
    TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, b.came_out);
    TEST_ASSERT_EQUAL_INT(-1, broadcast(1));
    TEST_ASSERT_EQUAL_INT(-1, broadcast(2));
    TEST_ASSERT_EQUAL_INT(-1, broadcast(-1));
}

static void test_cut_line_ends_before_the_cut(void)
{
    for (uint32_t position = 1; position <= SLAVES + 1; position++) {
        cm1e_sim_segment_cut(b.segment, position, true);
        TEST_ASSERT_EQUAL_INT(position == 1 ? -1 : (int)position - 1, broadcast(0));
        cm1e_sim_segment_cut(b.segment, position, false);
        TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
    }
}

static void test_whole_ring_processes_one_way_and_passes_the_other(void)
{
    cm1e_sim_segment_close_ring(b.segment);
    TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_SECONDARY, b.came_out);
    TEST_ASSERT_EQUAL_HEX8(0x03, b.frame[6]);
    TEST_ASSERT_EQUAL_INT(0, broadcast(1));
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, b.came_out);
    TEST_ASSERT_EQUAL_HEX8(0x01, b.frame[6]); /* no processing unit has seen it */
}

/* Every slave is reached from exactly one side, wherever the ring is cut. */
static void test_cut_ring_is_reached_from_both_sides(void)
{
    cm1e_sim_segment_close_ring(b.segment);
    for (uint32_t position = 1; position <= SLAVES + 1; position++) {
        cm1e_sim_segment_cut(b.segment, position, true);
        TEST_ASSERT_EQUAL_INT(position == 1 ? -1 : (int)position - 1, broadcast(0));
        if (position > 1)
            TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, b.came_out);
        TEST_ASSERT_EQUAL_INT(position == SLAVES + 1 ? -1 : (int)(SLAVES + 1 - position), broadcast(1));
        if (position <= SLAVES) {
            TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_SECONDARY, b.came_out);
            TEST_ASSERT_EQUAL_HEX16(0x4000, cm1e_get_u16(b.frame + 22) & 0x4000); /* turned around at a closed port 0 */
        }
        cm1e_sim_segment_cut(b.segment, position, false);
    }
}

/* A frame that has come by a closed port 0 once is destroyed the second time: nothing goes round for ever. */
static void test_circulating_frame_is_destroyed(void)
{
    uint8_t frame[FRAME_MAX], data[1] = {0};
    cm1e_sim_segment_close_ring(b.segment);
    cm1e_sim_segment_cut(b.segment, 3, true);
    const size_t end = frame_add(frame, frame_begin(frame), BRD, 0, data, 1);
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_SECONDARY, cm1e_sim_segment_process(b.segment, 1, frame, end, b.now_ns));
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_LOST, cm1e_sim_segment_process(b.segment, 1, frame, end, b.now_ns));
}

/* Slaves behind the cut are processed in the order of the ring: the first of them sees position 0. */
static void test_positions_count_from_the_cut(void)
{
    cm1e_sim_segment_close_ring(b.segment);
    for (unsigned i = 0; i < SLAVES; i++)
        write_u16(&b, i, 0x0010, (uint16_t)(STATION + i));
    cm1e_sim_segment_cut(b.segment, 4, true);
    uint8_t data[2] = {0};
    b.port = 1;
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x0010, data, 2));
    TEST_ASSERT_EQUAL_HEX16(STATION + 3, cm1e_get_u16(data));
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0xFFFF, 0x0010, data, 2));
    TEST_ASSERT_EQUAL_HEX16(STATION + 4, cm1e_get_u16(data));
}

static void test_two_cuts_isolate_what_is_between(void)
{
    cm1e_sim_segment_close_ring(b.segment);
    cm1e_sim_segment_cut(b.segment, 2, true);
    cm1e_sim_segment_cut(b.segment, 4, true);
    TEST_ASSERT_EQUAL_INT(1, broadcast(0));
    TEST_ASSERT_EQUAL_INT(2, broadcast(1));
}

static void test_links_show_in_dl_status(void)
{
    /* bit 4/5: link at port 0/1, 8/10: loop closed, 9/11: communication; ports 2 and 3 closed; SII loaded */
    TEST_ASSERT_EQUAL_HEX16(0x5A33, read_u16(&b, 0, 0x0110));
    TEST_ASSERT_EQUAL_HEX16(0x5A33, read_u16(&b, 1, 0x0110));
    TEST_ASSERT_EQUAL_HEX16(0x5613, read_u16(&b, SLAVES - 1, 0x0110));
    cm1e_sim_segment_cut(b.segment, 2, true);
    TEST_ASSERT_EQUAL_HEX16(0x5613, read_u16(&b, 0, 0x0110));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x0310));
    TEST_ASSERT_EQUAL_HEX8(1, read_u8(&b, 0, 0x0311));
    cm1e_sim_segment_cut(b.segment, 2, false);
    TEST_ASSERT_EQUAL_HEX16(0x5A33, read_u16(&b, 0, 0x0110));
    TEST_ASSERT_EQUAL_HEX8(1, read_u8(&b, 1, 0x0310));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 1, 0x0313, 0));
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 1, 0x0310));
    cm1e_sim_segment_close_ring(b.segment);
    TEST_ASSERT_EQUAL_HEX16(0x5A33, read_u16(&b, SLAVES - 1, 0x0110));
}

static void test_master_can_close_a_port(void)
{
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 2, 0x0101, 0x0C));
    TEST_ASSERT_EQUAL_INT(3, broadcast(0));
    TEST_ASSERT_EQUAL_HEX16(0x5633, read_u16(&b, 2, 0x0110)); /* the link is there, the loop closed */
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 2, 0x0101, 0x00));
    TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
}

static void test_resetting_slave_cuts_the_line_until_it_is_back(void)
{
    for (uint32_t position = 1; position <= SLAVES; position++) {
        cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(b.segment, position);
        write_u16(&b, position - 1, 0x0010, 0x7777);
        const unsigned before = b.apps[position - 1]->power_ons;
        cm1e_sim_slave_reset(slave, b.now_ns + 50000000);
        TEST_ASSERT_EQUAL_INT(position == 1 ? -1 : (int)position - 1, broadcast(0));
        bench_wait(&b, 49999999);
        TEST_ASSERT_EQUAL_INT(position == 1 ? -1 : (int)position - 1, broadcast(0));
        TEST_ASSERT_EQUAL_UINT(before, b.apps[position - 1]->power_ons);
        bench_wait(&b, 1);
        TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
        TEST_ASSERT_EQUAL_UINT(before + 1, b.apps[position - 1]->power_ons);
        TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, position - 1, 0x0010)); /* everything is forgotten */
    }
}

static void test_ring_around_a_resetting_slave(void)
{
    cm1e_sim_segment_close_ring(b.segment);
    cm1e_sim_slave_reset(cm1e_sim_segment_slave(b.segment, 3), b.now_ns + 1000000);
    TEST_ASSERT_EQUAL_INT(2, broadcast(0));
    TEST_ASSERT_EQUAL_INT(2, broadcast(1));
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
}

static void test_a_slave_behind_a_cut_notices_by_its_watchdog(void)
{
    bring_to(&b, 1, CM1E_AL_OP);
    cm1e_sim_segment_cut(b.segment, 2, true);
    for (int i = 0; i < 101; i++) {
        b.now_ns += 1000000;
        TEST_ASSERT_EQUAL_INT(1, broadcast(0));
    }
    TEST_ASSERT_EQUAL_UINT(1, b.apps[1]->watchdogs);
    cm1e_sim_segment_cut(b.segment, 2, false);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP | CM1E_AL_ERROR, read_u16(&b, 1, 0x0130));
}

static void test_empty_segment_answers_nothing(void)
{
    uint8_t frame[FRAME_MAX], data[1] = {0};
    cm1e_sim_segment_t *empty = cm1e_sim_segment_create_empty();
    const size_t end = frame_add(frame, frame_begin(frame), BRD, 0, data, 1);
    TEST_ASSERT_EQUAL_UINT32(0, cm1e_sim_segment_slave_count(empty));
    TEST_ASSERT_NULL(cm1e_sim_segment_slave(empty, 1));
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_LOST, cm1e_sim_segment_process(empty, 0, frame, end, 0));
    /* a cable from one interface to the other */
    cm1e_sim_segment_close_ring(empty);
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_SECONDARY, cm1e_sim_segment_process(empty, 0, frame, end, 0));
    TEST_ASSERT_EQUAL_INT(CM1E_SIM_PORT_PRIMARY, cm1e_sim_segment_process(empty, 1, frame, end, 0));
    cm1e_sim_segment_destroy(empty);
    cm1e_sim_segment_destroy(NULL);
}

static void test_positions_outside_are_refused(void)
{
    TEST_ASSERT_NULL(cm1e_sim_segment_slave(b.segment, 0));
    TEST_ASSERT_NULL(cm1e_sim_segment_slave(b.segment, SLAVES + 1));
    cm1e_sim_segment_cut(b.segment, 0, true);
    cm1e_sim_segment_cut(b.segment, SLAVES + 2, true);
    TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_NO_MEMORY, cm1e_sim_segment_add(b.segment, NULL));
}

static void test_time_does_not_run_backwards(void)
{
    const int64_t now = b.now_ns;
    write_u16(&b, 0, 0x0120, 0x0008);
    b.now_ns = 0;
    TEST_ASSERT_EQUAL_INT(SLAVES, broadcast(0));
    b.now_ns = now + 199999;
    TEST_ASSERT_EQUAL_HEX16(0x01, read_u16(&b, 0, 0x0130));
    b.now_ns = now + 200000;
    TEST_ASSERT_EQUAL_HEX16(0x11, read_u16(&b, 0, 0x0130));
}

static void test_frame_faults_are_used_up(void)
{
    int64_t delay = -1;
    TEST_ASSERT_EQUAL_INT(CM1E_FRAME_OK, cm1e_sim_segment_next_frame_fault(b.segment, &delay));
    TEST_ASSERT_EQUAL_INT64(0, delay);
    cm1e_sim_segment_set_frame_fault(b.segment, CM1E_FRAME_LOSE, 2, 5);
    cm1e_sim_segment_set_frame_fault(b.segment, CM1E_FRAME_DELAY, 3, 4000);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_FRAME_DELAY, cm1e_sim_segment_next_frame_fault(b.segment, &delay));
        TEST_ASSERT_EQUAL_INT64(4000, delay);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_FRAME_OK, cm1e_sim_segment_next_frame_fault(b.segment, &delay));
    TEST_ASSERT_EQUAL_INT64(0, delay);
}

/* An I/O module without mailbox among the drives, as SOEM configures it. */
static void test_io_module_mirrors_its_outputs(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_segment_add(b.segment, cm1e_sim_io_module_create()));
    TEST_ASSERT_EQUAL_INT(SLAVES + 1, broadcast(0));
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, SLAVES, 0x0502) & 0x0040); /* four bytes of the SII at a time */
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, request_state(&b, SLAVES, CM1E_AL_PRE_OP));
    TEST_ASSERT_EQUAL_HEX16(0x12, request_state(&b, SLAVES, CM1E_AL_SAFE_OP));
    write_sm(&b, SLAVES, 0, 0x1000, 1, 0x44, 1);
    write_sm(&b, SLAVES, 1, 0x1100, 1, 0x00, 1);
    write_fmmu(&b, SLAVES, 0, 0, 1, 0, 7, 0x1000, 0, 2);
    write_fmmu(&b, SLAVES, 1, 1, 1, 0, 7, 0x1100, 0, 1);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP, request_state(&b, SLAVES, CM1E_AL_SAFE_OP | CM1E_AL_ERROR));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, request_state(&b, SLAVES, CM1E_AL_OP));
    uint8_t data[2] = {0xA5, 0};
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, 0, data, 2));
    TEST_ASSERT_EQUAL_HEX8(0, data[1]);
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, 0, data, 2));
    TEST_ASSERT_EQUAL_HEX8(0xA5, data[1]);
    bench_wait(&b, 100000000);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP | CM1E_AL_ERROR, read_u16(&b, SLAVES, 0x0130));
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, 0, data, 2));
    TEST_ASSERT_EQUAL_HEX8(0, data[1]); /* the watchdog switched the outputs off */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_line_gives_frames_back_at_the_entry);
    RUN_TEST(test_cut_line_ends_before_the_cut);
    RUN_TEST(test_whole_ring_processes_one_way_and_passes_the_other);
    RUN_TEST(test_cut_ring_is_reached_from_both_sides);
    RUN_TEST(test_circulating_frame_is_destroyed);
    RUN_TEST(test_positions_count_from_the_cut);
    RUN_TEST(test_two_cuts_isolate_what_is_between);
    RUN_TEST(test_links_show_in_dl_status);
    RUN_TEST(test_master_can_close_a_port);
    RUN_TEST(test_resetting_slave_cuts_the_line_until_it_is_back);
    RUN_TEST(test_ring_around_a_resetting_slave);
    RUN_TEST(test_a_slave_behind_a_cut_notices_by_its_watchdog);
    RUN_TEST(test_empty_segment_answers_nothing);
    RUN_TEST(test_positions_outside_are_refused);
    RUN_TEST(test_time_does_not_run_backwards);
    RUN_TEST(test_frame_faults_are_used_up);
    RUN_TEST(test_io_module_mirrors_its_outputs);
    return UNITY_END();
}
