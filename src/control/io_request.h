/**
 * @file io_request.h
 * The requests about signals: `io` lists all of them with their values, `output` sets one (guest_outputs.h).
 */
#ifndef CM1E_CONTROL_IO_REQUEST_H
#define CM1E_CONTROL_IO_REQUEST_H

#include <jansson.h>

#include "control/view.h"

enum { IO_AT_ONCE = 64 };

/** Values that the cycle reads, a few signals in one cycle. */
typedef struct io_values {
    view_order_t order;
    cm1e_io_t signals[IO_AT_ONCE];
    double reals[IO_AT_ONCE];
    int64_t integers[IO_AT_ONCE];
    cm1e_io_quality_t qualities[IO_AT_ONCE];
    uint32_t count;
} io_values_t;

/** A list that is being made. */
typedef struct io_list {
    io_values_t values;
    cm1e_io_info_t infos[IO_AT_ONCE]; /**< of these */
    cm1e_io_info_t last;              /**< position 0: none yet */
    bool complete;
    json_t *told;
} io_list_t;

/** An output that the cycle sets. */
typedef struct output_order {
    view_order_t order;
    uint32_t client;
    cm1e_io_t io;
    bool release;
    double value;
    int64_t keep_ns;
    output_refusal_t refusal;         /**< valid when decided */
} output_order_t;

/** Begins a list; NULL: no memory. */
io_list_t *cm1e_io_list_begin(void);
/** The next signals become an order for the cycle; false: there are no more, and `told` is complete. */
bool cm1e_io_list_next(io_list_t *list, const view_t *view);
/** Adds to `told` what the cycle has read. */
void cm1e_io_list_take(io_list_t *list, const view_t *view);
void cm1e_io_list_free(io_list_t *list);

/** Takes the members of a message; NULL: the order is complete. Else `text`, which says what is wrong, with `error`. */
const char *cm1e_output_take(output_order_t *order, view_t *view, const json_t *message, cm1e_error_t *error,
                             char *text, size_t size);
/** Why it was refused by the cycle, perhaps in `text`; NULL: it was not. */
const char *cm1e_output_refusal(const output_order_t *order, char *text, size_t size);

#endif
