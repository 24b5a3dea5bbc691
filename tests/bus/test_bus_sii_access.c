/* The SII of a live slave: read as a whole, written word by word; refused where it could do harm; a fault at every
 * frame, a slave that goes at every word, and the backup as the way back. */
#include "bus/datagram.h"
#include "bus_support.h"
#include "cm1e/sii.h"
#include "description/sii_image.h"
#include "sim/esc_chip.h"

enum { WORD_CHECKSUM = 7, WRITE_COMMAND = 0x0201 };

static uint8_t before[CM1E_SII_SIZE], image[CM1E_SII_SIZE], after[CM1E_SII_SIZE];
static const cm1e_sii_write_options_t plain;

static cm1e_bus_t *opened(uint32_t slaves)
{
    sim_config(slaves);
    return open_bus();
}

static uint8_t *eeprom_of(cm1e_bus_t *bus, uint32_t position)
{
    return cm1e_sim_segment_slave(segment_of(bus), position)->sii;
}

/** A bus with slave 1's SII in `before`, and a good image with other contents in `image`. */
static cm1e_bus_t *with_images(void)
{
    cm1e_bus_t *bus = opened(1);
    memcpy(before, eeprom_of(bus, 1), sizeof before);
    memcpy(image, before, sizeof image);
    image[2 * 0x0C] ^= 0x5A;  /* revision */
    image[2 * 0x44] ^= 0x01;  /* in the strings */
    image[2 * 0x120] ^= 0x5A;
    return bus;
}

static void put_checksum(uint8_t *bytes) { bytes[2 * WORD_CHECKSUM] = cm1e_sii_crc8(bytes, 2 * WORD_CHECKSUM); }

static void check_read(cm1e_bus_t *bus, uint16_t position)
{
    size_t size = sizeof after;
    ck_assert_msg(cm1e_sii_read_device(bus, position, after, &size, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(size, CM1E_SII_SIZE);
    ck_assert_mem_eq(after, eeprom_of(bus, position), size);
}

static cm1e_error_t write_image(cm1e_bus_t *bus, const cm1e_sii_write_options_t *options)
{
    return cm1e_sii_write_device(bus, 1, image, sizeof image, options, &diag);
}

static void check_unchanged(cm1e_bus_t *bus) { ck_assert_mem_eq(eeprom_of(bus, 1), before, sizeof before); }

/* ---- reading ---------------------------------------------------------------------------------------------------- */

START_TEST(the_whole_sii_is_read_with_and_without_a_scan)
{
    cm1e_bus_t *bus = opened(3);
    for (uint16_t position = 1; position <= 3; position++)
        check_read(bus, position);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    for (uint16_t position = 1; position <= 3; position++) {
        cm1e_sim_segment_slave(segment_of(bus), position)->sii_reads_8_bytes = position % 2;
        check_read(bus, position);
    }
    /* the slaves have their SII back, and the bus starts */
    ck_assert_uint_eq(cm1e_sim_segment_slave(segment_of(bus), 1)->memory[0x0500], 1);
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_buffer_too_small_is_told_the_size)
{
    cm1e_bus_t *bus = opened(1);
    size_t size = CM1E_SII_SIZE - 1;
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, after, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_uint_eq(size, CM1E_SII_SIZE);
    size = 0;
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, NULL, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, after, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sii_read_device(NULL, 1, after, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    for (uint16_t position = 0; position <= 2; position += 2) {
        ck_assert_int_eq(cm1e_sii_read_device(bus, position, after, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
        ck_assert_ptr_nonnull(strstr(diag.text, "no slave"));
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_sii_that_states_no_size_is_read_as_16_kbit)
{
    static const uint16_t words[] = {0, 0xFFFF, 0x1000};
    cm1e_bus_t *bus = opened(1);
    for (unsigned i = 0; i < 3; i++) {
        cm1e_put_u16(eeprom_of(bus, 1) + 2 * 0x3E, words[i]);
        check_read(bus, 1);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_sii_that_states_more_than_there_is_ends_in_an_error_at_its_end)
{
    static uint8_t large[4 * CM1E_SII_SIZE];
    cm1e_bus_t *bus = opened(1);
    size_t size = sizeof large;
    cm1e_put_u16(eeprom_of(bus, 1) + 2 * 0x3E, 31);
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, large, &size, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_msg(strstr(diag.text, "0x0400") != NULL, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- writing ---------------------------------------------------------------------------------------------------- */

static unsigned writes;
static uint32_t written[CM1E_SII_SIZE];
static cm1e_tap_verdict_t count_writes(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction == CM1E_TAP_SENT && frame->length >= 32 && cm1e_get_u16(frame->bytes + 20) == 0x0502 &&
        frame->bytes[16] == COMMAND_FPWR && cm1e_get_u16(frame->bytes + 26) == WRITE_COMMAND)
        written[writes++] = cm1e_get_u32(frame->bytes + 28);
    return CM1E_TAP_PASS;
}

START_TEST(only_words_that_differ_are_written_the_header_last)
{
    cm1e_bus_t *bus = with_images();
    writes = 0;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), count_writes, NULL);
    ck_assert_msg(write_image(bus, &plain) == CM1E_OK, "%s", diag.text);
    ck_assert_mem_eq(eeprom_of(bus, 1), image, sizeof image);
    ck_assert_uint_eq(writes, 3);
    ck_assert(written[0] == 0x44 && written[1] == 0x120 && written[2] == 0x0C);
    ck_assert_int_eq(write_image(bus, NULL), CM1E_OK); /* nothing left to do */
    ck_assert_uint_eq(writes, 3);
    cm1e_bus_close(bus);
}
END_TEST

/** Reading behind the end, which some EEPROMs refuse. */
static bool beyond;
static cm1e_tap_verdict_t watch_the_end(void *context, cm1e_tap_frame_t *frame)
{
    const unsigned *words = context;
    if (frame->direction == CM1E_TAP_SENT && frame->length >= 32 && cm1e_get_u16(frame->bytes + 20) == 0x0502 &&
        frame->bytes[16] == COMMAND_FPWR && cm1e_get_u16(frame->bytes + 26) == 0x0100)
        beyond |= cm1e_get_u32(frame->bytes + 28) + *words > CM1E_SII_SIZE / 2;
    return CM1E_TAP_PASS;
}

START_TEST(every_word_up_to_the_last_is_written_without_reading_behind_it)
{
    for (unsigned words = 2; words <= 4; words += 2) { /* that the controller reads at a time */
        cm1e_bus_t *bus = with_images();
        cm1e_sim_segment_slave(segment_of(bus), 1)->sii_reads_8_bytes = words == 4;
        for (size_t i = 0x600; i < sizeof image; i++)
            image[i] = (uint8_t)(i * 7);
        beyond = false;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_the_end, &words);
        ck_assert_msg(write_image(bus, &plain) == CM1E_OK, "%s", diag.text);
        ck_assert_mem_eq(eeprom_of(bus, 1), image, sizeof image);
        ck_assert(!beyond);
        cm1e_bus_close(bus);
    }
}
END_TEST

START_TEST(an_image_shorter_than_the_eeprom_leaves_the_rest_as_it_is)
{
    cm1e_bus_t *bus = with_images();
    cm1e_put_u16(image + 0x80, 0xFFFF); /* no categories */
    uint8_t *alone = malloc(0x82); /* sanitizers see who reads behind it */
    memcpy(alone, image, 0x82);
    ck_assert_msg(cm1e_sii_write_device(bus, 1, alone, 0x82, NULL, &diag) == CM1E_OK, "%s", diag.text);
    free(alone);
    ck_assert_mem_eq(eeprom_of(bus, 1), image, 0x82);
    ck_assert_mem_eq(eeprom_of(bus, 1) + 0x82, before + 0x82, sizeof before - 0x82);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(alias_and_serial_number_stay_those_of_the_slave_unless_asked)
{
    cm1e_bus_t *bus = with_images();
    cm1e_put_u16(image + 2 * 4, 0x0815);
    cm1e_put_u32(image + 2 * 0x0E, 0x12345678);
    put_checksum(image);
    ck_assert_msg(write_image(bus, &plain) == CM1E_OK, "%s", diag.text);
    ck_assert_mem_eq(eeprom_of(bus, 1), before, 16);
    ck_assert_mem_eq(eeprom_of(bus, 1) + 2 * 0x0E, before + 2 * 0x0E, 4);
    ck_assert_uint_eq(cm1e_get_u16(eeprom_of(bus, 1) + 2 * 0x0C), cm1e_get_u16(image + 2 * 0x0C));
    const cm1e_sii_write_options_t own = {.own_alias_and_serial = true};
    /* An older program does not know that option: what lies behind its struct is not its own. */
    ck_assert_int_eq(cm1e_sii_write_device_sized(bus, 1, image, sizeof image, &own,
                                                 offsetof(cm1e_sii_write_options_t, own_alias_and_serial), &diag),
                     CM1E_OK);
    ck_assert_mem_eq(eeprom_of(bus, 1), before, 16);
    ck_assert_int_eq(write_image(bus, &own), CM1E_OK);
    ck_assert_mem_eq(eeprom_of(bus, 1), image, sizeof image);
    /* Of a slave whose header is not valid there is nothing to keep. */
    memset(eeprom_of(bus, 1) + 2, 0xEE, 14);
    ck_assert_msg(write_image(bus, &plain) == CM1E_OK, "%s", diag.text);
    ck_assert_mem_eq(eeprom_of(bus, 1), image, sizeof image);
    cm1e_bus_close(bus);
}
END_TEST

/* UG 4.2.4: rotary switches and an alias exclude each other. */
START_TEST(an_alias_beside_rotary_switches_is_refused_and_told_at_the_next_start)
{
    const cm1e_sii_write_options_t own = {.own_alias_and_serial = true};
    const cm1e_sii_write_options_t forced = {.own_alias_and_serial = true, .force_configuration = true};
    char said[100];
    cm1e_bus_t *bus = with_images();
    cm1e_bus_simulate(bus, "switches 1 07", said, sizeof said);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_put_u16(image + 2 * 4, 5);
    put_checksum(image);
    ck_assert_int_eq(write_image(bus, &own), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "explicit device ID 7") && strstr(diag.text, "alias 5"), "%s", diag.text);
    check_unchanged(bus);
    ck_assert_msg(write_image(bus, &forced) == CM1E_OK, "%s", diag.text);
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment_of(bus), 1);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK); /* until its next power-on */
    cm1e_sim_esc_power_on(slave, slave->now_ns);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_ERROR_BUS_STATE);
    ck_assert_msg(strstr(diag.text, "refuses PRE-OP") && strstr(diag.text, "the alias 5") &&
                      strstr(diag.text, "rotary switches"), "%s", diag.text);
    cm1e_bus_simulate(bus, "switches 1 00", said, sizeof said);
    cm1e_sim_esc_power_on(slave, slave->now_ns);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave(bus, 1)->alias, 5);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- refused ---------------------------------------------------------------------------------------------------- */

static void break_checksum(cm1e_bus_t *bus) { (void)bus, image[2 * WORD_CHECKSUM] ^= 1; }
static void other_product(cm1e_bus_t *bus) { (void)bus, image[2 * 0x0A] ^= 1; }
static void other_vendor(cm1e_bus_t *bus) { (void)bus, image[2 * 0x08] ^= 1; }
static void foreign_slave(cm1e_bus_t *bus)
{
    eeprom_of(bus, 1)[2 * 0x0A] ^= 1;
    memcpy(before, eeprom_of(bus, 1), sizeof before);
    image[2 * 0x0A] ^= 1;
}
static void other_configuration(cm1e_bus_t *bus)
{
    (void)bus;
    image[0] ^= 0x80;
    put_checksum(image);
}
static void endless_categories(cm1e_bus_t *bus) { (void)bus, cm1e_put_u16(image + 0x82, 0x7FFF); }
static void larger_eeprom(cm1e_bus_t *bus) { (void)bus, cm1e_put_u16(image + 2 * 0x3E, 31); }

static const struct refusal {
    const char *name;
    void (*prepare)(cm1e_bus_t *bus);
    cm1e_error_t error;
    const char *words;
    cm1e_sii_write_options_t force; /* the one thing that lets it pass; zeroed: nothing does */
} refusals[] = {
    {"checksum", break_checksum, CM1E_ERROR_FILE, "checksum", {.force_checksum = true}},
    {"other product", other_product, CM1E_ERROR_BUS_IDENTITY, "another product", {.force_identity = true}},
    {"other vendor", other_vendor, CM1E_ERROR_BUS_IDENTITY, "another product", {.force_identity = true}},
    {"foreign slave", foreign_slave, CM1E_ERROR_BUS_IDENTITY, "is not a CM1-E", {.force_identity = true}},
    {"configuration", other_configuration, CM1E_ERROR_CONFIG, "word 0", {.force_configuration = true}},
    {"endless categories", endless_categories, CM1E_ERROR_FILE, "do not end", {0}},
    {"larger EEPROM", larger_eeprom, CM1E_ERROR_FILE, "4096", {0}},
};

START_TEST(what_could_do_harm_is_refused_unless_that_very_thing_is_forced)
{
    const struct refusal *refusal = &refusals[_i];
    cm1e_bus_t *bus = with_images();
    refusal->prepare(bus);
    ck_assert_int_eq(write_image(bus, &plain), refusal->error);
    ck_assert_msg(strstr(diag.text, refusal->words) != NULL, "%s: %s", refusal->name, diag.text);
    check_unchanged(bus);
    cm1e_sii_write_options_t all_others = {true, true, true, true};
    all_others.force_checksum &= !refusal->force.force_checksum;
    all_others.force_identity &= !refusal->force.force_identity;
    all_others.force_configuration &= !refusal->force.force_configuration;
    ck_assert_int_eq(write_image(bus, &all_others), refusal->error);
    check_unchanged(bus);
    const cm1e_sii_write_options_t zero = {0};
    if (memcmp(&refusal->force, &zero, sizeof zero) != 0) {
        ck_assert_msg(write_image(bus, &refusal->force) == CM1E_OK, "%s: %s", refusal->name, diag.text);
        ck_assert_mem_eq(eeprom_of(bus, 1), image, sizeof image);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(sizes_that_no_image_has_are_refused)
{
    static uint8_t large[2 * CM1E_SII_SIZE];
    static const size_t sizes[] = {0, 2, 0x80, 0x7E, 0x101, sizeof large};
    cm1e_bus_t *bus = with_images();
    memcpy(large, before, sizeof before);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        ck_assert_int_eq(cm1e_sii_write_device(bus, 1, large, sizes[i], NULL, &diag), CM1E_ERROR_FILE);
        check_unchanged(bus);
    }
    ck_assert_int_eq(cm1e_sii_write_device(bus, 1, NULL, 2048, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_slave_in_safe_operational_or_operational_is_left_alone)
{
    cm1e_bus_t *bus = with_images();
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_OK);
    const cm1e_sii_write_options_t all = {true, true, true, true};
    ck_assert_int_eq(write_image(bus, &all), CM1E_ERROR_STATE);
    ck_assert_msg(strstr(diag.text, "SAFE-OP") != NULL, "%s", diag.text);
    check_read(bus, 1); /* reading does no harm */
    ck_assert_int_eq(cm1e_bus_operate(bus, &diag), CM1E_OK);
    size_t size = sizeof after;
    ck_assert_int_eq(write_image(bus, &all), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, after, &size, &diag), CM1E_ERROR_STATE);
    check_unchanged(bus);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- faults ----------------------------------------------------------------------------------------------------- */

static cm1e_tap_verdict_t no_write_commands(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction == CM1E_TAP_SENT && frame->length >= 32 && cm1e_get_u16(frame->bytes + 20) == 0x0502 &&
        frame->bytes[16] == COMMAND_FPWR && cm1e_get_u16(frame->bytes + 26) == WRITE_COMMAND)
        cm1e_put_u16(frame->bytes + 26, 0);
    return CM1E_TAP_PASS;
}

START_TEST(an_eeprom_that_keeps_nothing_is_told_from_its_first_word)
{
    cm1e_bus_t *bus = with_images();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), no_write_commands, NULL);
    ck_assert_int_eq(write_image(bus, &plain), CM1E_ERROR_TIMEOUT);
    ck_assert_msg(strstr(diag.text, "stopped at word 0x0044") && strstr(diag.text, "protected") &&
                      strstr(diag.text, "backup"), "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

static cm1e_tap_verdict_t busy_for_ever(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction == CM1E_TAP_RECEIVED && frame->length >= 30 && cm1e_get_u16(frame->bytes + 20) == 0x0502 &&
        frame->bytes[16] == COMMAND_FPRD)
        frame->bytes[27] |= 0x80;
    return CM1E_TAP_PASS;
}

START_TEST(an_interface_that_stays_busy_ends_in_an_error_soon)
{
    cm1e_bus_t *bus = with_images();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), busy_for_ever, NULL);
    size_t size = sizeof after;
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, after, &size, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_int_eq(write_image(bus, &plain), CM1E_ERROR_TIMEOUT);
    ck_assert_int_lt(now_of(bus), INT64_C(1000000000));
    check_unchanged(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Every 50th look finds the interface busy, and then this process stands still for longer than any memory chip takes. */
static cm1e_tap_verdict_t stand_still(void *context, cm1e_tap_frame_t *frame)
{
    static unsigned looks;
    cm1e_bus_t *bus = context;
    const bool looked = frame->direction == CM1E_TAP_RECEIVED && frame->length >= 30 &&
                        cm1e_get_u16(frame->bytes + 20) == 0x0502 && frame->bytes[16] == COMMAND_FPRD;
    if (looked && ++looks % 50 == 0) {
        frame->bytes[27] |= 0x80;
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 30000000);
    }
    return CM1E_TAP_PASS;
}

START_TEST(a_process_that_stands_still_takes_no_eeprom_for_one_that_stays_busy)
{
    cm1e_bus_t *bus = with_images();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), stand_still, bus);
    check_read(bus, 1);
    ck_assert_msg(write_image(bus, &plain) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/** What happens to frame number `at` of its direction. */
typedef struct strike {
    enum { LOSE_THERE, LOSE_BACK, TWICE, LATE, NOT_COUNTED, STRIKES } kind;
    unsigned at, seen;
} strike_t;

static cm1e_tap_verdict_t strike(void *context, cm1e_tap_frame_t *frame)
{
    strike_t *fault = context;
    const cm1e_tap_direction_t direction = fault->kind == LOSE_THERE ? CM1E_TAP_SENT : CM1E_TAP_RECEIVED;
    if (frame->direction != direction || fault->seen++ != fault->at)
        return CM1E_TAP_PASS;
    if (fault->kind <= LOSE_BACK)
        return CM1E_TAP_DROP;
    if (fault->kind == TWICE)
        frame->copies = 2;
    else if (fault->kind == LATE)
        frame->delay_ns = 3000000;
    else
        cm1e_put_u16(frame->bytes + 26 + (cm1e_get_u16(frame->bytes + 22) & 0x7FF), 0);
    return CM1E_TAP_PASS;
}

/** With one disturbed frame the image is written, or nothing was, or the words tell where it stopped. */
START_TEST(one_disturbed_frame_never_leaves_a_wrong_word_unnoticed)
{
    unsigned good = 0, bad = 0;
    strike_t fault = {.kind = _i};
    for (bool struck = true; struck; fault.at++) {
        cm1e_bus_t *bus = with_images();
        cm1e_put_u16(image + 0x80, 0xFFFF); /* short: every frame gets its turn */
        image[0x84] ^= 0xFF;
        fault.seen = 0;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), strike, &fault);
        const cm1e_error_t error = cm1e_sii_write_device(bus, 1, image, 0x86, &plain, &diag);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        struck = fault.seen > fault.at;
        ck_assert_mem_eq(eeprom_of(bus, 1) + 0x86, before + 0x86, sizeof before - 0x86);
        if (error == CM1E_OK) {
            good++;
            ck_assert_mem_eq(eeprom_of(bus, 1), image, 0x86);
        } else {
            bad++;
            ck_assert_int_eq(cm1e_sii_write_device(bus, 1, before, sizeof before, &plain, &diag), CM1E_OK);
            check_unchanged(bus);
        }
        cm1e_bus_close(bus);
    }
    ck_assert_uint_gt(good, 100);
    ck_assert_msg(bad <= 4, "%u", bad); /* those before the first register is read with patience */
}
END_TEST

static unsigned cut_at;
static cm1e_bus_t *cut_bus;
static cm1e_tap_verdict_t lose_power(void *context, cm1e_tap_frame_t *frame)
{
    const unsigned known = writes;
    count_writes(context, frame);
    if (writes > known && writes == cut_at)
        simulate(cut_bus, "power-cycle 1 1000");
    return CM1E_TAP_PASS;
}

/** Whichever word is the last one that arrives: the diagnosis names it, and the backup brings the slave back. */
START_TEST(a_slave_that_goes_at_any_word_comes_back_by_its_backup)
{
    for (cut_at = 1;; cut_at++) {
        cm1e_bus_t *bus = cut_bus = with_images();
        cm1e_put_u16(image + 2 * 4, 0x0815);
        put_checksum(image);
        const cm1e_sii_write_options_t own = {.own_alias_and_serial = true};
        writes = 0;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_power, NULL);
        const cm1e_error_t error = write_image(bus, &own);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        if (error == CM1E_OK) {
            cm1e_bus_close(bus);
            break;
        }
        char word[32];
        snprintf(word, sizeof word, "stopped at word 0x%04X", (unsigned)written[cut_at - 1]);
        ck_assert_int_eq(error, CM1E_ERROR_BUS_LOST);
        ck_assert_msg(strstr(diag.text, word) && strstr(diag.text, "backup"), "%s (%s)", diag.text, word);
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + INT64_C(2000000000));
        ck_assert_msg(cm1e_sii_write_device(bus, 1, before, sizeof before, &plain, &diag) == CM1E_OK, "%s", diag.text);
        check_unchanged(bus);
        cm1e_bus_close(bus);
    }
    ck_assert_uint_eq(cut_at, 6); /* 3 words of the body, alias, checksum */
}
END_TEST

START_TEST(an_sii_that_no_scan_gets_past_is_written_anew)
{
    cm1e_bus_t *bus = with_images();
    memcpy(image, before, sizeof image);
    memset(eeprom_of(bus, 1) + 0x80, 0x01, sizeof before - 0x80);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_ERROR_BUS_IDENTITY);
    ck_assert_msg(write_image(bus, &plain) == CM1E_OK, "%s", diag.text);
    check_unchanged(bus);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    /* an erased one has no identity: that is to be forced */
    memset(eeprom_of(bus, 1), 0xFF, sizeof before);
    ck_assert_int_eq(write_image(bus, &plain), CM1E_ERROR_BUS_IDENTITY);
    const cm1e_sii_write_options_t force = {.force_identity = true};
    ck_assert_msg(write_image(bus, &force) == CM1E_OK, "%s", diag.text);
    check_unchanged(bus);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_sii_access");
    TCase *reading = tcase_create("reading");
    tcase_add_test(reading, the_whole_sii_is_read_with_and_without_a_scan);
    tcase_add_test(reading, an_alias_beside_rotary_switches_is_refused_and_told_at_the_next_start);
    tcase_add_test(reading, a_buffer_too_small_is_told_the_size);
    tcase_add_test(reading, an_sii_that_states_no_size_is_read_as_16_kbit);
    tcase_add_test(reading, an_sii_that_states_more_than_there_is_ends_in_an_error_at_its_end);
    suite_add_tcase(suite, reading);
    TCase *writing = tcase_create("writing");
    tcase_add_test(writing, only_words_that_differ_are_written_the_header_last);
    tcase_add_test(writing, every_word_up_to_the_last_is_written_without_reading_behind_it);
    tcase_add_test(writing, an_image_shorter_than_the_eeprom_leaves_the_rest_as_it_is);
    tcase_add_test(writing, alias_and_serial_number_stay_those_of_the_slave_unless_asked);
    tcase_add_loop_test(writing, what_could_do_harm_is_refused_unless_that_very_thing_is_forced, 0,
                        sizeof refusals / sizeof refusals[0]);
    tcase_add_test(writing, sizes_that_no_image_has_are_refused);
    tcase_add_test(writing, a_slave_in_safe_operational_or_operational_is_left_alone);
    suite_add_tcase(suite, writing);
    TCase *faults = tcase_create("faults");
    tcase_add_test(faults, an_eeprom_that_keeps_nothing_is_told_from_its_first_word);
    tcase_add_test(faults, an_interface_that_stays_busy_ends_in_an_error_soon);
    tcase_add_test(faults, a_process_that_stands_still_takes_no_eeprom_for_one_that_stays_busy);
    tcase_add_loop_test(faults, one_disturbed_frame_never_leaves_a_wrong_word_unnoticed, 0, STRIKES);
    tcase_add_test(faults, a_slave_that_goes_at_any_word_comes_back_by_its_backup);
    tcase_add_test(faults, an_sii_that_no_scan_gets_past_is_written_anew);
    suite_add_tcase(suite, faults);
    return run_suite(suite);
}
