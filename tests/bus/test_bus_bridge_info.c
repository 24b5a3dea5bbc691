/* What a bridge tells of itself (BR 7.3, 7.4), and what becomes of answers that are refused, damaged or do not come. */
#include "bus_support.h"
#include "cm1e/bridge.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/bridge_app.h"

/* ---- a bridge that lies ----------------------------------------------------------------------------------------- */

typedef enum lie { TRUTH = 0, REFUSE, SHORT, LONG, VALUE, SILENCE } lie_t;
static struct {
    lie_t lie;
    uint16_t index;
    uint8_t subindex;
    uint32_t value;
    unsigned asked; /* reads of a four-byte object since `lie` was set */
    cm1e_sim_slave_t *slave;
} liar;

static uint32_t read_lie(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data, size_t *size)
{
    const size_t room = *size;
    const uint32_t abort = cm1e_sim_bridge_sdo_read(app, index, subindex, al_state, data, size);
    liar.asked += index >= 0xF000;
    if (liar.lie == TRUTH || index != liar.index || subindex != liar.subindex || room < 8)
        return abort;
    switch (liar.lie) {
    case REFUSE: return SDO_ABORT_STATE;
    case SHORT: *size = 2; break;
    case LONG: *size = 8; break;
    case VALUE: cm1e_put_u32(data, liar.value); break;
    case SILENCE: cm1e_sim_slave_reset(liar.slave, INT64_MAX); break;
    default: break;
    }
    return abort;
}

static cm1e_sim_slave_t *make_liar(cm1e_device_model_t model)
{
    static cm1e_sim_app_ops_t ops;
    const cm1e_device_options_t options = {.model = model, .vendor_id = CM1E_SIM_BRIDGE_VENDOR_ID,
                                           .product_code = cm1e_sim_bridge_product_code(model),
                                           .revision = CM1E_SIM_BRIDGE_REVISION};
    cm1e_description_file_t file = {0};
    uint8_t sii[CM1E_SII_SIZE];
    ck_assert_int_eq(cm1e_describe(&file, &options, CM1E_ESI_FLAT, NULL), CM1E_OK);
    const size_t size = cm1e_sii_write(sii, sizeof sii, &file.devices.at[0], NULL);
    cm1e_description_file_free(&file);
    ops = cm1e_sim_bridge_ops;
    ops.sdo_read = read_lie;
    memset(&liar, 0, sizeof liar);
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_create_app(model, NULL);
    bridge->slave = liar.slave = cm1e_sim_slave_create(sii, size, &ops, bridge);
    return liar.slave;
}

static cm1e_bus_t *scanned_bus(cm1e_sim_slave_t *slave)
{
    sim_config(0);
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    ck_assert_int_eq(cm1e_sim_segment_add(segment, slave), CM1E_OK);
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    liar.asked = 0;
    return bus;
}

/* ---- every value, by the objects that the guide names ------------------------------------------------------------ */

static cm1e_bridge_info_t info;

static const struct {
    cm1e_bridge_value_t *value;
    uint16_t index;
    uint8_t subindex;
} rows[] = {
#define CHANNEL(n)                                                                                                  \
    {&info.channels[n].type, 0xF511 + n, 1}, {&info.channels[n].baud_rate, 0xF511 + n, 2},                          \
    {&info.channels[n].cycle_time_ms, 0xF511 + n, 3}, {&info.channels[n].receive_errors, 0xF530, 1 + n},            \
    {&info.channels[n].status, 0xF530, 5 + n}, {&info.channels[n].sent, 0xF530, 9 + n},                             \
    {&info.channels[n].received, 0xF530, 13 + n}, {&info.channels[n].profile, 0xF010, 1 + n},                       \
    {&info.channels[n].configured_module, 0xF030, 1 + n}, {&info.channels[n].detected_module, 0xF050, 1 + n}
    CHANNEL(0), CHANNEL(1), CHANNEL(2), CHANNEL(3),
    {&info.pdo_longest_us, 0xF530, 17}, {&info.pdo_shortest_us, 0xF530, 18}, {&info.pdo_late, 0xF530, 19},
    {&info.pdo_early, 0xF530, 20}, {&info.test[0], 0xF530, 21}, {&info.test[1], 0xF530, 22},
    {&info.test[2], 0xF530, 23}, {&info.test[3], 0xF530, 24}, {&info.maker_mode, 0xF540, 1},
    {&info.master_mode, 0xF540, 5}, {&info.serial_cycle_ms, 0xF540, 6}, {&info.config_code, 0xF540, 11},
    {&info.serial_number, 0xF540, 12},
};
enum { ROWS = sizeof rows / sizeof *rows };

static void check_zeros_but(int first, int end)
{
    for (int i = 0; i < ROWS; i++)
        if (i < first || i >= end)
            ck_assert_msg(rows[i].value->known && !rows[i].value->error, "%04X:%u", rows[i].index, rows[i].subindex);
}

START_TEST(every_value_is_that_of_its_object)
{
    cm1e_bus_t *bus = scanned_bus(make_liar(CM1E_DEVICE_EB12));
    ck_assert_int_eq(ROWS, 4 * 10 + 13);
    liar.lie = VALUE;
    for (int i = 0; i < ROWS; i++) {
        liar.index = rows[i].index;
        liar.subindex = rows[i].subindex;
        liar.value = 0x12345600u + (unsigned)i;
        ck_assert_msg(cm1e_bridge_read(bus, 1, &info, &diag) == CM1E_OK, "%s", diag.text);
        for (int k = 0; k < ROWS; k++)
            ck_assert_msg((rows[k].value->value == liar.value) == (i == k), "%04X:%u shows that of %04X:%u",
                          rows[k].index, rows[k].subindex, rows[i].index, rows[i].subindex);
        check_zeros_but(0, 0);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_bridge_tells_its_model_and_its_lines)
{
    cm1e_bus_t *bus = scanned_bus(cm1e_sim_bridge_create(CM1E_DEVICE_EB12, NULL, 0));
    simulate(bus, "motor 1 2 unplug");
    simulate(bus, "motor 1 4 error overload");
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 50 * INT64_C(1000000));
    ck_assert_int_eq(cm1e_bridge_read(bus, 1, &info, &diag), CM1E_OK);
    ck_assert(info.position == 1 && info.model_known && info.model == CM1E_DEVICE_EB12);
    for (int i = 0; i < 4; i++) {
        const cm1e_bridge_channel_t *channel = &info.channels[i];
        ck_assert_uint_eq(channel->type.value, i < 2 ? CM1E_BRIDGE_CM1 : CM1E_BRIDGE_CM2);
        ck_assert_uint_eq(cm1e_bridge_bits_per_second(channel->baud_rate.value), 176800);
        ck_assert_uint_eq(channel->cycle_time_ms.value, 1);
        ck_assert_uint_eq(channel->profile.value, 0x40192);
        ck_assert_uint_eq(channel->configured_module.value, 0x219800);
        ck_assert_uint_eq(channel->detected_module.value, 0x219800);
        ck_assert_uint_gt(channel->sent.value, 40);
        /* The line may have gone on between the two answers. */
        ck_assert_int_eq(channel->received.value - channel->sent.value <= 1, i != 1);
        ck_assert_int_eq(channel->receive_errors.value > 40, i == 1);
    }
    ck_assert_uint_eq(info.channels[1].status.value, 0x0F);
    ck_assert_uint_eq(info.channels[3].status.value, 0x04);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- answers that are no good ------------------------------------------------------------------------------------ */

START_TEST(a_refused_value_is_marked_alone)
{
    cm1e_bus_t *bus = scanned_bus(make_liar(CM1E_DEVICE_EB02));
    liar.lie = REFUSE;
    liar.index = rows[_i].index;
    liar.subindex = rows[_i].subindex;
    ck_assert_int_eq(cm1e_bridge_read(bus, 1, &info, &diag), CM1E_OK);
    check_zeros_but(_i, _i + 1);
    ck_assert(!rows[_i].value->known && rows[_i].value->value == 0);
    ck_assert_int_eq(rows[_i].value->error, CM1E_ERROR_SDO_ABORT);
    ck_assert_uint_eq(rows[_i].value->abort_code, SDO_ABORT_STATE);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_answer_of_another_size_is_no_value)
{
    cm1e_bus_t *bus = scanned_bus(make_liar(CM1E_DEVICE_EB01));
    liar.lie = _i % 2 ? SHORT : LONG;
    const int row = _i * ROWS / 10;
    liar.index = rows[row].index;
    liar.subindex = rows[row].subindex;
    ck_assert_int_eq(cm1e_bridge_read(bus, 1, &info, &diag), CM1E_OK);
    check_zeros_but(row, row + 1);
    ck_assert(!rows[row].value->known && rows[row].value->value == 0);
    ck_assert_int_eq(rows[row].value->error, CM1E_ERROR_BUS_MAILBOX);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_bridge_that_falls_silent_takes_one_time_out)
{
    cm1e_bus_t *bus = scanned_bus(make_liar(CM1E_DEVICE_EB12));
    const int64_t begin_ns = now_of(bus);
    liar.lie = SILENCE;
    liar.index = rows[_i].index;
    liar.subindex = rows[_i].subindex;
    const cm1e_error_t error = cm1e_bridge_read(bus, 1, &info, &diag);
    ck_assert_int_ne(error, CM1E_OK);
    ck_assert_int_eq(diag.error, error);
    ck_assert_msg(strstr(diag.text, "lave 1"), "%s", diag.text);
    ck_assert_int_lt(now_of(bus) - begin_ns, INT64_C(3000000000));
    ck_assert_uint_eq(liar.asked, (unsigned)_i + 1);
    check_zeros_but(_i, ROWS);
    for (int i = _i; i < ROWS; i++)
        ck_assert(!rows[i].value->known && rows[i].value->error == error);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- who is asked ------------------------------------------------------------------------------------------------ */

START_TEST(a_slave_that_is_no_bridge_is_not_asked)
{
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    memset(&info, 0xFF, sizeof info);
    ck_assert_int_eq(cm1e_bridge_read(bus, 1, &info, &diag), CM1E_ERROR_UNSUPPORTED);
    ck_assert_ptr_nonnull(strstr(diag.text, "Slave 1 (CM1-E) is no Cool MUSCLE Bridge"));
    ck_assert(!info.channels[0].status.known && !info.serial_number.known);
    ck_assert_int_eq(cm1e_bridge_read(bus, 2, &info, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(diag.text, "no slave 2; 1 were found"));
    ck_assert_int_eq(cm1e_bridge_read(bus, 0, &info, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_bridge_read(NULL, 1, &info, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_bridge_of_no_known_model_tells_what_it_has)
{
    cm1e_sim_slave_t *slave = make_liar(CM1E_DEVICE_EB01);
    liar.lie = VALUE;
    liar.index = 0xF512;
    liar.subindex = 1;
    liar.value = 7;
    cm1e_bus_t *bus = scanned_bus(slave);
    ck_assert_int_eq(cm1e_bridge_read(bus, 1, &info, &diag), CM1E_OK);
    ck_assert(!info.model_known && info.channels[1].type.known);
    ck_assert_uint_eq(info.channels[1].type.value, 7);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_bridge_info");
    TCase *tests = tcase_create("info");
    tcase_add_test(tests, every_value_is_that_of_its_object);
    tcase_add_test(tests, a_bridge_tells_its_model_and_its_lines);
    tcase_add_loop_test(tests, a_refused_value_is_marked_alone, 0, ROWS);
    tcase_add_loop_test(tests, an_answer_of_another_size_is_no_value, 0, 10);
    tcase_add_loop_test(tests, a_bridge_that_falls_silent_takes_one_time_out, 0, ROWS);
    tcase_add_test(tests, a_slave_that_is_no_bridge_is_not_asked);
    tcase_add_test(tests, a_bridge_of_no_known_model_tells_what_it_has);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
