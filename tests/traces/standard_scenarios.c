/* Scenarios of iec.h. */
#include "diagram.h"

enum { MS = 1000000 };

static void ton(void)
{
    TON_t timer = {.PT = 100 * MS};
    trace_begin_without_axis("TON", "PT = 100 ms. Too short; long enough; again.");
    trace_block("TON", "", &timer);
    trace_value("TON", &timer, "ET", "ms");
    UNTIL(600) {
        timer.IN = during(20, 90) || during(150, 350) || during(420, 580);
        TON(&timer);
    }
    trace_end();
}

static void tof(void)
{
    TOF_t timer = {.PT = 100 * MS};
    trace_begin_without_axis("TOF", "PT = 100 ms. Runs down; taken up again before that.");
    trace_block("TOF", "", &timer);
    trace_value("TOF", &timer, "ET", "ms");
    UNTIL(600) {
        timer.IN = during(20, 90) || during(280, 320) || during(380, 420);
        TOF(&timer);
    }
    trace_end();
}

static void tp(void)
{
    TP_t timer = {.PT = 100 * MS};
    trace_begin_without_axis("TP", "PT = 100 ms. A short and a long input, and edges while the pulse lasts.");
    trace_block("TP", "", &timer);
    trace_value("TP", &timer, "ET", "ms");
    UNTIL(600) {
        timer.IN = during(20, 50) || during(170, 340) || during(400, 420) || during(440, 460) || during(480, 580);
        TP(&timer);
    }
    trace_end();
}

static void r_trig(void)
{
    R_TRIG_t edge = {0};
    trace_begin_without_axis("R_TRIG", "CLK is TRUE at the first call: that counts as an edge.");
    trace_block("R_TRIG", "", &edge);
    UNTIL(40) {
        edge.CLK = during(0, 8) || during(16, 17) || during(24, 34);
        R_TRIG(&edge);
    }
    trace_end();
}

static void f_trig(void)
{
    F_TRIG_t edge = {0};
    trace_begin_without_axis("F_TRIG", "CLK is FALSE at the first call: that is no edge.");
    trace_block("F_TRIG", "", &edge);
    UNTIL(40) {
        edge.CLK = during(6, 12) || during(20, 21) || during(26, 34);
        F_TRIG(&edge);
    }
    trace_end();
}

static void sr(void)
{
    SR_t memory = {0};
    trace_begin_without_axis("SR", "Set and reset; with both TRUE set goes first.");
    trace_block("SR", "", &memory);
    UNTIL(40) {
        memory.S1 = during(4, 8) || during(20, 28);
        memory.R = during(13, 16) || during(23, 32);
        SR(&memory);
    }
    trace_end();
}

static void rs(void)
{
    RS_t memory = {0};
    trace_begin_without_axis("RS", "Set and reset; with both TRUE reset goes first.");
    trace_block("RS", "", &memory);
    UNTIL(40) {
        memory.S = during(4, 8) || during(20, 28);
        memory.R1 = during(13, 16) || during(23, 32);
        RS(&memory);
    }
    trace_end();
}

static BOOL clock_of(int period) { return (BOOL)(bench.scan % period >= period / 2); }

static void ctu(void)
{
    CTU_t counter = {.PV = 4};
    trace_begin_without_axis("CTU", "PV = 4. It counts past PV; R goes before CU.");
    trace_block("CTU", "", &counter);
    trace_value("CTU", &counter, "CV", "");
    UNTIL(80) {
        counter.CU = clock_of(8);
        counter.R = during(50, 62);
        CTU(&counter);
    }
    trace_end();
}

static void ctd(void)
{
    CTD_t counter = {.PV = 4};
    trace_begin_without_axis("CTD", "PV = 4, loaded by LD. It counts past 0.");
    trace_block("CTD", "", &counter);
    trace_value("CTD", &counter, "CV", "");
    UNTIL(80) {
        counter.CD = clock_of(8);
        counter.LD = during(5, 8) || during(66, 70);
        CTD(&counter);
    }
    trace_end();
}

static void ctud(void)
{
    CTUD_t counter = {.PV = 3};
    trace_begin_without_axis("CTUD", "PV = 3. Up, both at once (no change), down; R, then LD.");
    trace_block("CTUD", "", &counter);
    trace_value("CTUD", &counter, "CV", "");
    UNTIL(100) {
        counter.CU = clock_of(8) && bench.scan < 48;
        counter.CD = clock_of(8) && bench.scan >= 32;
        counter.R = during(76, 80);
        counter.LD = during(90, 94);
        CTUD(&counter);
    }
    trace_end();
}

const scenario_t standard_scenarios[] = {
    {"TON", ton},     {"TOF", tof}, {"TP", tp},   {"R_TRIG", r_trig}, {"F_TRIG", f_trig}, {"SR", sr},
    {"RS", rs},       {"CTU", ctu}, {"CTD", ctd}, {"CTUD", ctud},     {NULL, NULL},
};
