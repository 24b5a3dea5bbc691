/* An EEPROM that does not acknowledge a word that is written, for a while or for ever, and one that loses a word behind the
 * check of that word: the SII is whole, or the words tell where it is not. */
#include "bus/datagram.h"
#include "bus_support.h"
#include "cm1e/sii.h"
#include "description/sii_image.h"

enum { COMMAND_AT = 16, OFFSET_AT = 20, DATA_OF_FRAME = 26, WORD_OF_FRAME = 28, REG_EEPROM = 0x0502 };
enum { WRITE_COMMAND = 0x0201, READ_COMMAND = 0x0100, NACK = 0x2000, FIRST = 0x44, WORDS = 3, TRIES = 3 };
static const uint16_t changed[WORDS] = {FIRST, 0x120, 0x0C}; /* in the order in which they are written */
static uint8_t before[CM1E_SII_SIZE], image[CM1E_SII_SIZE];

static cm1e_bus_t *with_images(void)
{
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    memcpy(before, sii_memory_of(bus, 1), sizeof before);
    memcpy(image, before, sizeof image);
    for (int i = 0; i < WORDS; i++)
        image[2 * changed[i]] ^= 0x5A;
    return bus;
}

static cm1e_error_t write_image(cm1e_bus_t *bus) { return cm1e_sii_write_device(bus, 1, image, sizeof image, NULL, &diag); }

/** The command that a frame gives to the EEPROM interface; 0: none. */
static uint16_t command_of(const cm1e_tap_frame_t *frame)
{
    const bool of_eeprom = cm1e_get_u16(frame->bytes + OFFSET_AT) == REG_EEPROM && frame->length >= 32;
    return of_eeprom && frame->direction == CM1E_TAP_SENT && frame->bytes[COMMAND_AT] == COMMAND_FPWR
               ? cm1e_get_u16(frame->bytes + DATA_OF_FRAME) : 0;
}

/* ---- not acknowledged ------------------------------------------------------------------------------------------- */

typedef struct refusal {
    uint16_t word;    /* that is not acknowledged */
    unsigned left;    /* so many times more */
    bool pending;
} refusal_t;

/** The command does not come to the memory; the status that is read next says so. */
static cm1e_tap_verdict_t refuse(void *context, cm1e_tap_frame_t *frame)
{
    refusal_t *refusal = context;
    const uint16_t command = command_of(frame);
    if (command == WRITE_COMMAND && cm1e_get_u16(frame->bytes + WORD_OF_FRAME) == refusal->word && refusal->left > 0) {
        cm1e_put_u16(frame->bytes + DATA_OF_FRAME, 0);
        refusal->pending = true;
        refusal->left--;
    } else if (refusal->pending && frame->direction == CM1E_TAP_RECEIVED &&
               frame->bytes[COMMAND_AT] == COMMAND_FPRD && cm1e_get_u16(frame->bytes + OFFSET_AT) == REG_EEPROM) {
        cm1e_put_u16(frame->bytes + DATA_OF_FRAME, NACK);
        refusal->pending = false;
    }
    return CM1E_TAP_PASS;
}

/** A memory that is busy with the word before is asked again, a few times. */
START_TEST(a_word_that_is_not_acknowledged_is_written_again)
{
    for (int word = 0; word < WORDS; word++)
        for (unsigned times = 1; times < TRIES; times++) {
            cm1e_bus_t *bus = with_images();
            refusal_t refusal = {.word = changed[word], .left = times};
            cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse, &refusal);
            ck_assert_msg(write_image(bus) == CM1E_OK, "word %d, %u times: %s", word, times, diag.text);
            ck_assert_mem_eq(sii_memory_of(bus, 1), image, sizeof image);
            ck_assert_uint_eq(refusal.left, 0);
            cm1e_bus_close(bus);
        }
}
END_TEST

START_TEST(a_word_that_is_never_acknowledged_is_told_with_the_words_before_it)
{
    for (unsigned word = 0; word < WORDS; word++) {
        char words[2][60];
        cm1e_bus_t *bus = with_images();
        refusal_t refusal = {.word = changed[word], .left = UINT32_MAX};
        cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse, &refusal);
        ck_assert_int_eq(write_image(bus), CM1E_ERROR_TIMEOUT);
        snprintf(words[0], sizeof words[0], "Slave 1: writing its SII stopped at word 0x%04X", changed[word]);
        snprintf(words[1], sizeof words[1], "%u words were written before", word);
        ck_assert_msg(strstr(diag.text, words[0]) && strstr(diag.text, words[1]), "%s", diag.text);
        for (unsigned n = 0; n < WORDS; n++)
            ck_assert_mem_eq(sii_memory_of(bus, 1) + 2 * changed[n], (n < word ? image : before) + 2 * changed[n], 2);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        ck_assert_msg(cm1e_sii_write_device(bus, 1, before, sizeof before, NULL, &diag) == CM1E_OK, "%s", diag.text);
        ck_assert_mem_eq(sii_memory_of(bus, 1), before, sizeof before);
        cm1e_bus_close(bus);
    }
}
END_TEST

/* ---- lost again ------------------------------------------------------------------------------------------------- */

static cm1e_bus_t *forgetful;
static unsigned writes;

/** After the last word has been written, the first one becomes what it was. */
static cm1e_tap_verdict_t forget(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    const uint16_t command = command_of(frame);
    writes += command == WRITE_COMMAND;
    if (command == READ_COMMAND && writes == WORDS && cm1e_get_u16(frame->bytes + WORD_OF_FRAME) == 0)
        memcpy(sii_memory_of(forgetful, 1) + 2 * FIRST, before + 2 * FIRST, 2);
    return CM1E_TAP_PASS;
}

START_TEST(a_word_that_is_lost_behind_its_check_is_found_at_the_end)
{
    char words[100];
    cm1e_bus_t *bus = forgetful = with_images();
    writes = 0;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), forget, NULL);
    ck_assert_int_eq(write_image(bus), CM1E_ERROR_TIMEOUT);
    snprintf(words, sizeof words, "read back word 0x0044 holds 0x%04X in place of 0x%04X",
             cm1e_get_u16(before + 2 * FIRST), cm1e_get_u16(image + 2 * FIRST));
    ck_assert_msg(strstr(diag.text, words) && strstr(diag.text, "backup"), "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_msg(write_image(bus) == CM1E_OK, "%s", diag.text);
    ck_assert_mem_eq(sii_memory_of(bus, 1), image, sizeof image);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_sii_wrong");
    TCase *tests = tcase_create("sii_wrong");
    tcase_add_test(tests, a_word_that_is_not_acknowledged_is_written_again);
    tcase_add_test(tests, a_word_that_is_never_acknowledged_is_told_with_the_words_before_it);
    tcase_add_test(tests, a_word_that_is_lost_behind_its_check_is_found_at_the_end);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
