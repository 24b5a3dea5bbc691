/**
 * @file slave_bench.h
 * Any block of the block table on up to four axes of one bus, slaves and masters: axes_bench.h with its witness of
 * every set-point below, block_judge.h with its judgement of every call above.
 *
 *     slaves_begin(3);                    axes 0 ... 2 in Standstill
 *     about(0, 1);                        what is made now is about axis 0; its masters are axis 1
 *     make(&gear, "MC_GearIn");
 *     trigger(&gear, true);
 *     cycles(100);
 */
#ifndef CM1E_TESTS_SLAVE_BENCH_H
#define CM1E_TESTS_SLAVE_BENCH_H

#include "block_judge.h"

#include "axes_bench.h"

/** In which order the blocks are called in a cycle. */
typedef enum call_order { ORDER_MADE = 0, ORDER_BACKWARDS, ORDER_MIXED, ORDERS } call_order_t;
extern call_order_t call_order;

void cycle(void);
void cycles(int count);

#define CYCLE_UNTIL(condition)                                                                                       \
    do {                                                                                                             \
        int left = 20000;                                                                                            \
        do                                                                                                           \
            cycle();                                                                                                 \
        while (!(condition) && --left);                                                                              \
        MUST(left > 0, "line %d: never " #condition ", axis 0 is in %s: %s", __LINE__,                               \
             cm1e_axis_state_name(axes_state(0)), axes_text(0));                                                     \
    } while (0)

/** What is made from now on is about axis `n`, and names axis `master` where it names one; below 0: none. */
void about(int n, int master);
void made_about(int n, int master, instance_t *fb, const char *name);
void make_and_start(int n, int master, instance_t *fb, const char *name);
void expect_error(const instance_t *fb, cm1e_error_t error);
void slaves_begin(int count);

/** An axis is turned by nobody's block. */
void turn(int n, double velocity);

#endif
