/* Edges, bistables and counters of IEC 61131-3: every state with every input, and random sequences against a model. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "cm1e/iec.h"
#include "quick_check.h"

#define EXPECT(condition, ...)                                                                                         \
    do                                                                                                                 \
        if (!(condition)) /* an assertion of Check that holds costs a system call */                                   \
            ck_abort_msg(#condition ": " __VA_ARGS__);                                                                 \
    while (0)

/* ---- edges ------------------------------------------------------------------------------------------------------- */

START_TEST(test_edges_of_every_sequence_of_twelve_calls)
{
    for (unsigned bits = 0; bits < 1u << 12; bits++) {
        R_TRIG_t rising = {0};
        F_TRIG_t falling = {0};
        BOOL before = FALSE; /* so is an input before the first call: no falling edge there */
        for (int i = 0; i < 12; i++) {
            const BOOL now = bits >> i & 1;
            rising.CLK = falling.CLK = now ? (BOOL)(1 + (bits + (unsigned)i) % 255) : FALSE;
            R_TRIG(&rising);
            F_TRIG(&falling);
            EXPECT(rising.Q == (now && !before), "bits %x call %d", bits, i);
            EXPECT(falling.Q == (!now && before), "bits %x call %d", bits, i);
            before = now;
        }
    }
}
END_TEST

/* ---- bistables --------------------------------------------------------------------------------------------------- */

START_TEST(test_bistables_over_all_states_and_inputs)
{
    for (unsigned n = 0; n < 8; n++) {
        const BOOL set = n & 1, reset = n >> 1 & 1, before = n >> 2 & 1;
        SR_t sr = {.S1 = set, .R = reset, .Q1 = before};
        RS_t rs = {.S = set, .R1 = reset, .Q1 = before};
        SR(&sr);
        RS(&rs);
        ck_assert_int_eq(sr.Q1, set ? TRUE : reset ? FALSE : before);
        ck_assert_int_eq(rs.Q1, reset ? FALSE : set ? TRUE : before);
    }
}
END_TEST

/* ---- counters ---------------------------------------------------------------------------------------------------- */

/* Five pulses from the first call on, PV 2. */
START_TEST(test_counting_goes_past_pv_and_no_edge_is_lost)
{
    CTU_t up = {.PV = 2};
    CTD_t down = {.PV = 2, .LD = TRUE};
    CTD(&down);
    down.LD = FALSE;
    ck_assert_int_eq(down.CV, 2);
    for (int i = 0; i < 10; i++) {
        up.CU = down.CD = !(i & 1);
        CTU(&up);
        CTD(&down);
        ck_assert_int_eq(up.CV, i / 2 + 1);
        ck_assert_int_eq(up.Q, up.CV >= 2);
        ck_assert_int_eq(down.CV, 2 - (i / 2 + 1));
        ck_assert_int_eq(down.Q, down.CV <= 0);
    }
}
END_TEST

START_TEST(test_counters_stop_at_the_ends_of_the_type)
{
    CTU_t up = {.CV = INT16_MAX - 1, .PV = INT16_MAX};
    CTD_t down = {.CV = INT16_MIN + 1};
    CTUD_t both = {.PV = INT16_MIN};
    for (int i = 0; i < 8; i++) {
        up.CU = down.CD = !(i & 1);
        CTU(&up);
        CTD(&down);
        ck_assert_int_eq(up.CV, INT16_MAX);
        ck_assert_int_eq(up.Q, TRUE);
        ck_assert_int_eq(down.CV, INT16_MIN);
    }
    both.CV = INT16_MAX;
    both.CU = TRUE;
    CTUD(&both);
    ck_assert_int_eq(both.CV, INT16_MAX);
    both.CV = INT16_MIN;
    both.CD = TRUE;
    CTUD(&both);
    ck_assert_int_eq(both.CV, INT16_MIN);
    ck_assert(both.QU && both.QD);
}
END_TEST

START_TEST(test_reset_and_load_go_first_and_use_the_edge_up)
{
    CTU_t up = {.CV = 7, .PV = 3, .R = TRUE, .CU = TRUE};
    CTU(&up);
    ck_assert(up.CV == 0 && !up.Q);
    up.R = FALSE;
    CTU(&up); /* CU is still TRUE: its edge came during R */
    ck_assert_int_eq(up.CV, 0);
    CTUD_t both = {.CV = 7, .PV = 3, .R = TRUE, .LD = TRUE, .CU = TRUE};
    CTUD(&both);
    ck_assert(both.CV == 0 && !both.QU && both.QD);
    both.R = FALSE;
    CTUD(&both);
    ck_assert(both.CV == 3 && both.QU && !both.QD);
    both.LD = FALSE;
    CTUD(&both);
    ck_assert_int_eq(both.CV, 3);
}
END_TEST

/* What the standard's text says, with numbers that cannot overflow. */
static int counted(int cv, int pv, bool r, bool ld, bool up, bool down)
{
    if (r)
        return 0;
    if (ld)
        return pv;
    cv += up == down ? 0 : up ? 1 : -1;
    return cv > INT16_MAX ? INT16_MAX : cv < INT16_MIN ? INT16_MIN : cv;
}

START_TEST(test_counters_over_all_states_and_inputs)
{
    static const INT values[] = {INT16_MIN, INT16_MIN + 1, -1, 0, 1, 2, INT16_MAX - 1, INT16_MAX};
    for (unsigned n = 0; n < 1u << 12; n++) {
        const INT cv = values[n & 7], pv = values[n >> 3 & 7];
        const BOOL cu = n >> 6 & 1, cd = n >> 7 & 1, r = n >> 8 & 1, ld = n >> 9 & 1;
        const BOOL cu_before = n >> 10 & 1, cd_before = n >> 11 & 1;
        CTUD_t both = {.CV = cv, .PV = pv, .CU = cu, .CD = cd, .R = r, .LD = ld,
                       .Private = {.first = cu_before, .second = cd_before}};
        CTU_t up = {.CV = cv, .PV = pv, .CU = cu, .R = r, .Private = {.first = cu_before}};
        CTD_t down = {.CV = cv, .PV = pv, .CD = cd, .LD = ld, .Private = {.first = cd_before}};
        CTUD(&both);
        CTU(&up);
        CTD(&down);
        const bool more = cu && !cu_before, less = cd && !cd_before;
        EXPECT(both.CV == counted(cv, pv, r, ld, more, less), "case %x", n);
        EXPECT(both.QU == (both.CV >= pv) && both.QD == (both.CV <= 0), "case %x", n);
        EXPECT(up.CV == counted(cv, pv, r, false, more, false), "case %x", n);
        EXPECT(up.Q == (up.CV >= pv), "case %x", n);
        EXPECT(down.CV == counted(cv, pv, false, ld, false, less), "case %x", n);
        EXPECT(down.Q == (down.CV <= 0), "case %x", n);
    }
}
END_TEST

START_TEST(test_random_counting)
{
    const char *given = getenv("CM1E_TEST_SEED");
    unsigned seed = given ? (unsigned)strtoul(given, NULL, 10) : 4711u;
    printf("seed %u\n", seed);
    srand(seed);
    CTUD_t both = {0};
    bool cu_before = false, cd_before = false;
    int cv = 0;
    for (int n = 0; n < 1000000; n++) {
        const unsigned bits = (unsigned)rand();
        both.CU = bits & 1;
        both.CD = (bits & 6) == 0;
        both.R = (bits >> 3 & 0x7FFF) == 0;
        both.LD = (bits >> 3 & 0x7FFF) == 1;
        if (both.LD)
            both.PV = (INT)(bits >> 12);
        CTUD(&both);
        cv = counted(cv, both.PV, both.R, both.LD, both.CU && !cu_before, both.CD && !cd_before);
        cu_before = both.CU;
        cd_before = both.CD;
        EXPECT(both.CV == cv, "seed %u, call %d", seed, n);
    }
}
END_TEST

/* ---- names ------------------------------------------------------------------------------------------------------- */

/* An application may have symbols as short as these: the linker knows ours by another name. */
#define OWN(NAME, NUMBER)                                                                                              \
    int own_##NAME(void) __asm__(#NAME);                                                                               \
    int own_##NAME(void) { return NUMBER; }
OWN(TON, 1) OWN(TOF, 2) OWN(TP, 3) OWN(R_TRIG, 4) OWN(F_TRIG, 5)
OWN(SR, 6) OWN(RS, 7) OWN(CTU, 8) OWN(CTD, 9) OWN(CTUD, 10)

START_TEST(test_names_do_not_collide_with_an_application_s_own)
{
    ck_assert_int_eq(own_TON() + own_TOF() + own_TP() + own_R_TRIG() + own_F_TRIG(), 15);
    ck_assert_int_eq(own_SR() + own_RS() + own_CTU() + own_CTD() + own_CTUD(), 40);
    TON_t on = {.IN = TRUE};
    TOF_t off = {.IN = TRUE};
    TP_t pulse = {.IN = TRUE, .PT = 1};
    SR_t set = {.S1 = TRUE};
    TON(&on);
    TOF(&off);
    TP(&pulse);
    SR(&set);
    ck_assert(on.Q && off.Q && pulse.Q && set.Q1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("IEC blocks");
    TCase *tcase = tcase_create("blocks");
    tcase_add_test(tcase, test_edges_of_every_sequence_of_twelve_calls);
    tcase_add_test(tcase, test_bistables_over_all_states_and_inputs);
    tcase_add_test(tcase, test_counting_goes_past_pv_and_no_edge_is_lost);
    tcase_add_test(tcase, test_counters_stop_at_the_ends_of_the_type);
    tcase_add_test(tcase, test_reset_and_load_go_first_and_use_the_edge_up);
    tcase_add_test(tcase, test_counters_over_all_states_and_inputs);
    tcase_add_test(tcase, test_random_counting);
    tcase_add_test(tcase, test_names_do_not_collide_with_an_application_s_own);
    suite_add_tcase(suite, tcase);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
