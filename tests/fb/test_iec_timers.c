/* TON, TOF, TP against a model that knows the whole history of inputs, not a state (IEC 61131-3, 2.5.2.3.4). */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "cm1e/iec.h"
#include "cm1e/scan_time.h"
#include "quick_check.h"
#include "../support/xorshift.h"

#define MS INT64_C(1000000)
#define DAY (INT64_C(86400) * 1000 * MS)

static TON_t ton;
static TOF_t tof;
static TP_t tp;

static void fresh(void)
{
    ton = (TON_t){0};
    tof = (TOF_t){0};
    tp = (TP_t){0};
}

static void call(TIME now, BOOL in, TIME pt)
{
    cm1e_scan_time_set(now);
    ton.IN = tof.IN = tp.IN = in;
    ton.PT = tof.PT = tp.PT = pt;
    TON(&ton);
    TOF(&tof);
    TP(&tp);
}

#define EXPECT(block, q, et)                                                                                           \
    do {                                                                                                               \
        if (block.Q != (q) || block.ET != (et)) /* an assertion of Check that holds costs a system call */             \
            ck_abort_msg("line %d: " #block " Q %d ET %lld, not %d and %lld", __LINE__, block.Q, (long long)block.ET,  \
                         q, (long long)(et));                                                                          \
    } while (0)

/* ---- the model --------------------------------------------------------------------------------------------------- */

enum { HISTORY = 160 };
typedef struct event {
    TIME now, pt;
    BOOL in;
} event_t;
static event_t history[HISTORY];
static int events;

static bool over(int since, int i)
{
    __extension__ typedef __int128 wide_t;
    return (wide_t)history[i].now - history[since].now >= (history[i].pt > 0 ? history[i].pt : 0);
}

static TIME bounded(TIME pt) { return pt > 0 ? pt : 0; }

static bool edge_at(int i, BOOL to) { return history[i].in == to && (i > 0 ? history[i - 1].in != to : to == TRUE); }

/** The last edge to the present level; -1: there was none. */
static int last_edge(BOOL to)
{
    int i = events - 1;
    while (i >= 0 && !edge_at(i, to))
        i--;
    return i;
}

static int first_over(int since)
{
    int i = since;
    while (i < events && !over(since, i))
        i++;
    return i;
}

static void model_delay(BOOL level, BOOL *reached, TIME *et)
{
    *reached = FALSE;
    *et = 0;
    if (history[events - 1].in != level)
        return;
    const int since = last_edge(level);
    if (since < 0)
        return;
    const int end = first_over(since);
    *reached = end < events;
    *et = *reached ? bounded(history[end].pt) : history[events - 1].now - history[since].now;
}

static void model_pulse(BOOL *q, TIME *et)
{
    *q = FALSE;
    *et = 0;
    for (int i = 0; i < events; i++) {
        if (!edge_at(i, TRUE))
            continue;
        const int end = first_over(i);
        if (end >= events) {
            *q = TRUE;
            *et = history[events - 1].now - history[i].now;
            return;
        }
        *et = bounded(history[end].pt);
        for (int k = end; k < events; k++)
            if (!history[k].in)
                *et = 0;
        i = end; /* an edge before, or with the end, starts nothing */
    }
}

static void step(TIME now, BOOL in, TIME pt)
{
    BOOL q;
    TIME et;
    history[events++] = (event_t){now, pt, in};
    call(now, in, pt);
    model_delay(TRUE, &q, &et);
    EXPECT(ton, q, et);
    model_delay(FALSE, &q, &et);
    const bool never = !in && last_edge(FALSE) < 0;
    EXPECT(tof, in || (!q && !never), et);
    model_pulse(&q, &et);
    EXPECT(tp, q, et);
}

/* ---- by hand ----------------------------------------------------------------------------------------------------- */

START_TEST(test_first_call_with_in_false_shows_nothing)
{
    for (TIME now = -5; now < 5; now++) {
        fresh();
        call(now * DAY, FALSE, now * MS);
        EXPECT(ton, FALSE, 0);
        EXPECT(tof, FALSE, 0);
        EXPECT(tp, FALSE, 0);
    }
}
END_TEST

/* PT 20, scan 10: the case in which libraries differ. */
START_TEST(test_a_time_counts_from_the_edge)
{
    fresh();
    call(0, FALSE, 20);
    call(10, TRUE, 20);
    EXPECT(ton, FALSE, 0);
    EXPECT(tof, TRUE, 0);
    EXPECT(tp, TRUE, 0);
    call(20, TRUE, 20);
    EXPECT(ton, FALSE, 10);
    EXPECT(tp, TRUE, 10);
    call(30, TRUE, 20);
    EXPECT(ton, TRUE, 20);
    EXPECT(tp, FALSE, 20);
    call(1000, TRUE, 20);
    EXPECT(ton, TRUE, 20);
    EXPECT(tp, FALSE, 20);
    EXPECT(tof, TRUE, 0);
    call(1010, FALSE, 20);
    EXPECT(ton, FALSE, 0);
    EXPECT(tp, FALSE, 0);
    EXPECT(tof, TRUE, 0);
    call(1020, FALSE, 20);
    EXPECT(tof, TRUE, 10);
    call(1030, FALSE, 20);
    EXPECT(tof, FALSE, 20);
    call(5000, FALSE, 20);
    EXPECT(tof, FALSE, 20); /* stays until IN rises */
    call(5010, TRUE, 20);
    EXPECT(tof, TRUE, 0);
}
END_TEST

START_TEST(test_a_second_call_in_a_scan_does_not_advance)
{
    fresh();
    for (int scan = 0; scan <= 10; scan++)
        for (int n = 0; n < 100; n++) {
            call(scan * 10, TRUE, 100);
            EXPECT(ton, scan == 10, scan * 10);
            EXPECT(tp, scan < 10, scan * 10);
        }
}
END_TEST

START_TEST(test_a_new_edge_starts_the_off_delay_anew_but_not_the_pulse)
{
    fresh();
    call(0, TRUE, 50);
    call(10, FALSE, 50);
    call(50, TRUE, 50);
    EXPECT(tof, TRUE, 0);
    EXPECT(tp, FALSE, 50); /* the edge in the call in which the pulse ends starts none */
    call(60, FALSE, 50);
    EXPECT(tp, FALSE, 0);
    call(70, TRUE, 50);
    EXPECT(tp, TRUE, 0);
    call(80, FALSE, 50);
    EXPECT(tp, TRUE, 10);
    call(90, TRUE, 50);
    EXPECT(tp, TRUE, 20);
    call(120, TRUE, 50);
    EXPECT(tp, FALSE, 50);
}
END_TEST

START_TEST(test_preset_of_0_or_less_acts_at_once)
{
    static const TIME presets[] = {0, -1, -DAY, INT64_MIN};
    for (int i = 0; i < 4; i++) {
        fresh();
        call(0, FALSE, presets[i]);
        call(10, TRUE, presets[i]);
        EXPECT(ton, TRUE, 0);
        EXPECT(tof, TRUE, 0);
        EXPECT(tp, FALSE, 0);
        call(20, FALSE, presets[i]);
        EXPECT(ton, FALSE, 0);
        EXPECT(tof, FALSE, 0);
        EXPECT(tp, FALSE, 0);
    }
}
END_TEST

START_TEST(test_a_preset_that_changes_is_followed_until_the_time_is_over)
{
    fresh();
    call(0, TRUE, 100);
    call(50, TRUE, 200);
    EXPECT(ton, FALSE, 50);
    call(150, TRUE, 200);
    EXPECT(ton, FALSE, 150);
    EXPECT(tp, TRUE, 150);
    call(160, TRUE, 120); /* over by now */
    EXPECT(ton, TRUE, 120);
    EXPECT(tp, FALSE, 120);
    call(170, TRUE, 1000);
    EXPECT(ton, TRUE, 120);
    EXPECT(tp, FALSE, 120);
    call(180, FALSE, 100);
    call(190, FALSE, 1000);
    EXPECT(tof, TRUE, 10);
    call(200, FALSE, 5);
    EXPECT(tof, FALSE, 5);
    call(210, FALSE, 1000);
    EXPECT(tof, FALSE, 5);
}
END_TEST

START_TEST(test_a_time_that_goes_back_begins_anew_and_ends)
{
    fresh();
    call(1000, TRUE, 100);
    call(500, TRUE, 100);
    EXPECT(ton, FALSE, 0);
    EXPECT(tp, TRUE, 0);
    call(599, TRUE, 100);
    EXPECT(ton, FALSE, 99);
    EXPECT(tp, TRUE, 99);
    call(600, TRUE, 100);
    EXPECT(ton, TRUE, 100);
    EXPECT(tp, FALSE, 100);
}
END_TEST

START_TEST(test_extremes_of_time)
{
    fresh();
    call(INT64_MIN, FALSE, INT64_MAX);
    call(INT64_MIN, TRUE, INT64_MAX);
    call(-2, TRUE, INT64_MAX);
    EXPECT(ton, FALSE, INT64_MAX - 1);
    EXPECT(tp, TRUE, INT64_MAX - 1);
    call(-1, TRUE, INT64_MAX);
    EXPECT(ton, TRUE, INT64_MAX);
    EXPECT(tp, FALSE, INT64_MAX);
    fresh();
    call(INT64_MIN, TRUE, INT64_MAX);
    call(INT64_MAX, TRUE, INT64_MAX); /* twice as long as a TIME can say */
    EXPECT(ton, TRUE, INT64_MAX);
    EXPECT(tp, FALSE, INT64_MAX);
    fresh();
    call(INT64_MAX - 10, TRUE, 10);
    call(INT64_MAX - 1, TRUE, 10);
    EXPECT(ton, FALSE, 9);
    call(INT64_MAX, TRUE, 10);
    EXPECT(ton, TRUE, 10);
}
END_TEST

START_TEST(test_years)
{
    events = 0;
    fresh();
    for (int day = 0; day < 150; day++) /* 411 years in days, more than two centuries on either side of 0 */
        step((day - 75) * INT64_C(1000) * DAY, day > 10 && day < 130, INT64_C(100) * 365 * DAY);
    EXPECT(ton, FALSE, 0);
    EXPECT(tof, TRUE, INT64_C(19000) * DAY);
    fresh();
    TIME now = 0;
    call(now, TRUE, INT64_C(30) * 365 * DAY); /* far beyond the 24 and 49 days of 32 bits, in scans of an hour */
    for (int hour = 1; hour < 30 * 365 * 24; hour++) {
        now += DAY / 24;
        call(now, TRUE, INT64_C(30) * 365 * DAY);
        EXPECT(ton, FALSE, now);
        EXPECT(tp, TRUE, now);
    }
    call(now + DAY / 24, TRUE, INT64_C(30) * 365 * DAY);
    EXPECT(ton, TRUE, INT64_C(30) * 365 * DAY);
    EXPECT(tp, FALSE, INT64_C(30) * 365 * DAY);
}
END_TEST

START_TEST(test_any_value_that_is_not_0_is_true)
{
    fresh();
    call(0, 2, 10);
    call(5, 0x80, 10); /* no new edge */
    EXPECT(ton, FALSE, 5);
    EXPECT(tp, TRUE, 5);
    call(10, 255, 10);
    EXPECT(ton, TRUE, 10);
    EXPECT(tof, TRUE, 0);
}
END_TEST

/* ---- all short sequences, and random ones ------------------------------------------------------------------------ */

START_TEST(test_every_sequence_of_ten_calls)
{
    for (int preset = -1; preset <= 5; preset++)
        for (unsigned bits = 0; bits < 1u << 10; bits++) {
            fresh();
            events = 0;
            for (int i = 0; i < 10; i++)
                step(i - 5, bits >> i & 1, preset);
        }
}
END_TEST

static uint64_t random_state;
static uint64_t next_random(void)
{
    return xorshift(&random_state);
}

START_TEST(test_random_sequences)
{
    const char *given = getenv("CM1E_TEST_SEED");
    random_state = given ? strtoull(given, NULL, 10) : 77003;
    printf("seed %llu\n", (unsigned long long)random_state);
    for (int run = 0; run < 3000; run++) {
        fresh();
        events = 0;
        const int size = (int)(next_random() % 56);
        TIME now = (TIME)(next_random() >> (1 + next_random() % 40)) - INT64_MAX / 2;
        TIME pt = (TIME)(next_random() >> 10) % 50;
        BOOL in = FALSE;
        while (events < HISTORY) {
            if (next_random() % 4 == 0)
                in = !in;
            if (next_random() % 8 == 0)
                pt = (TIME)(next_random() % 100) * (INT64_C(1) << size) - 5;
            const TIME advance = (TIME)(next_random() % 30) * (INT64_C(1) << size);
            if (__builtin_add_overflow(now, next_random() % 5 ? advance : 0, &now))
                break;
            step(now, in, pt);
        }
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("IEC timers");
    TCase *tcase = tcase_create("timers");
    tcase_add_test(tcase, test_first_call_with_in_false_shows_nothing);
    tcase_add_test(tcase, test_a_time_counts_from_the_edge);
    tcase_add_test(tcase, test_a_second_call_in_a_scan_does_not_advance);
    tcase_add_test(tcase, test_a_new_edge_starts_the_off_delay_anew_but_not_the_pulse);
    tcase_add_test(tcase, test_preset_of_0_or_less_acts_at_once);
    tcase_add_test(tcase, test_a_preset_that_changes_is_followed_until_the_time_is_over);
    tcase_add_test(tcase, test_a_time_that_goes_back_begins_anew_and_ends);
    tcase_add_test(tcase, test_extremes_of_time);
    tcase_add_test(tcase, test_years);
    tcase_add_test(tcase, test_any_value_that_is_not_0_is_true);
    tcase_add_test(tcase, test_every_sequence_of_ten_calls);
    tcase_add_test(tcase, test_random_sequences);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
