/* Sync managers on top of each other: lengths once for mailboxes, three times for process data. */
#include <stdio.h>

#include "description/check.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

enum { MAILBOX = 0x26, BUFFERED = 0x64 };

static const struct {
    struct {
        uint16_t start, length;
        uint8_t control, enable;
    } managers[2];
    bool overlap;
} cases[] = {
    {{{0x1000, 128, MAILBOX, 1}, {0x1080, 128, MAILBOX, 1}}, false},
    {{{0x1000, 129, MAILBOX, 1}, {0x1080, 128, MAILBOX, 1}}, true},
    {{{0x1080, 128, MAILBOX, 1}, {0x1000, 129, MAILBOX, 1}}, true}, /* found where the upper one stands */
    {{{0x1080, 128, MAILBOX, 1}, {0x1000, 128, MAILBOX, 1}}, false},
    {{{0x1100, 16, BUFFERED, 1}, {0x1130, 16, BUFFERED, 1}}, false},
    {{{0x1100, 17, BUFFERED, 1}, {0x1130, 16, BUFFERED, 1}}, true},
    {{{0x1130, 16, BUFFERED, 1}, {0x1101, 16, BUFFERED, 1}}, true},
    {{{0x1000, 128, MAILBOX, 1}, {0x1010, 1, MAILBOX, 1}}, true}, /* within */
    {{{0x1000, 128, MAILBOX, 0}, {0x1010, 1, MAILBOX, 1}}, false},
    {{{0x1000, 128, MAILBOX, 1}, {0x1010, 1, MAILBOX, 0}}, false},
    {{{0x1000, 0, MAILBOX, 1}, {0x0FF0, 128, MAILBOX, 1}}, false},
    {{{0x1000, 128, MAILBOX, 1}, {0x1010, 0, MAILBOX, 1}}, false},
    {{{0xFFFF, 0xFFFF, BUFFERED, 1}, {0x1000, 16, MAILBOX, 1}}, false}, /* no wrap at 64 kB */
};

static void test_what_lies_on_top_of_each_other_is_found(void)
{
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cm1e_described_sync_manager_t managers[2] = {{.place = 10}, {.place = 20}};
        char which[32];
        snprintf(which, sizeof which, "case %zu", i);
        for (int n = 0; n < 2; n++) {
            managers[n].start = cases[i].managers[n].start;
            managers[n].length = cases[i].managers[n].length;
            managers[n].control = cases[i].managers[n].control;
            managers[n].enable = cases[i].managers[n].enable;
        }
        cm1e_findings_t *findings = cm1e_findings_create();
        cm1e_check_overlap(findings, managers, 2);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(cases[i].overlap, cm1e_findings_count(findings), which);
        if (cases[i].overlap) {
            TEST_ASSERT_EQUAL_STRING("sync-managers-overlap", cm1e_findings_at(findings, 0)->rule);
            TEST_ASSERT_EQUAL_UINT(managers[0].start > managers[1].start ? 10 : 20,
                                   cm1e_findings_at(findings, 0)->line);
        }
        cm1e_findings_free(findings);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_lies_on_top_of_each_other_is_found);
    return UNITY_END();
}
