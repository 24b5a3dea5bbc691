/**
 * @file request.h
 * What a client may ask for: a table of requests. Each is answered at once, or waits for a snapshot or a transfer.
 */
#ifndef CM1E_CONTROL_REQUEST_H
#define CM1E_CONTROL_REQUEST_H

#include <jansson.h>
#include <time.h>

#include "bus/errand.h"
#include "control/arguments.h"
#include "control/io_request.h"
#include "control/maintain.h"
#include "control/variable_request.h"

typedef struct control_file control_file_t;

/** Facts of a run, and what its clients have beyond one request. */
typedef struct control_run {
    view_t view;
    cm1e_control_mode_t control;
    control_file_t *files[CM1E_CONTROL_CLIENTS]; /**< file_request.h; NULL: the client has none */
    bool serves_own;           /**< connections of this process may do everything */
    char program[64];
    time_t since;
} control_run_t;

typedef enum request_state {
    REQUEST_NONE = 0, /**< the client is not waiting */
    REQUEST_SNAPSHOT,
    REQUEST_ORDER,    /**< until the cycle has decided on it */
    REQUEST_SDO,
    REQUEST_ERRAND,
} request_state_t;

/** The request of one client that is being worked on. */
typedef struct control_request control_request_t;
struct control_request {
    request_state_t state;
    uint32_t client;           /**< whose it is: its place, and its process */
    int pid;
    const char *name;          /**< of the request */
    json_t *id;                /**< what the client calls it; NULL: nothing */
    bool wanted;               /**< a snapshot was wanted after this request came, or the cycle has its order */
    uint32_t snapshot;         /**< SNAPSHOT: the number of the first one that counts */
    json_t *(*show)(const view_t *view); /**< SNAPSHOT: what of it */
    view_order_t *order;       /**< ORDER: what the cycle is to do, a part of one of those below */
    json_t *(*decided)(control_request_t *request, control_run_t *run); /**< ORDER: the reply; NULL: it goes on */
    int64_t begun_ns;
    cm1e_sdo_t sdo;
    uint8_t *data;             /**< of the transfer */
    view_write_t write;
    control_file_t *file;      /**< that is written; NULL: it is an object */
    cm1e_errand_t errand;
    maintain_order_t maintain;
    io_list_t *io;
    output_order_t output;
    variable_order_t variable;
};

/** A reply that refuses it. */
static inline json_t *refuse(const control_request_t *request, cm1e_error_t error, const char *text)
{
    return cm1e_request_refuse(request->id, error, 0, text);
}
/** A reply that refuses one of its members. */
static inline json_t *wrong(const control_request_t *request, const char *text)
{
    return refuse(request, CM1E_ERROR_INVALID_ARGUMENT, text);
}

/** Begins a request. Returns its reply, or NULL if it goes on: cm1e_request_continue(). */
json_t *cm1e_request_begin(control_request_t *request, control_run_t *run, const json_t *message, int64_t now_ns);
/** Returns the reply when there is one. `stopping`: the cycle does not run any more. */
json_t *cm1e_request_continue(control_request_t *request, control_run_t *run, int64_t now_ns, bool stopping);
/** The cycle decides whether the write begins. Returns NULL: the request goes on. */
json_t *cm1e_request_write(control_request_t *request, view_write_t write);
/** Frees what belongs to a request, which may be used again. */
void cm1e_request_clear(control_request_t *request);
/** The client is gone: what it holds ends, and its request is cleared. false: something of it is still on its way
 *  through the cycle; ask again. */
bool cm1e_request_leave(control_request_t *request, control_run_t *run, uint32_t client, bool stopping);

#endif
