/* The simulated segment in this process: "sim", or "sim:<bus file>" for a segment as that file describes it. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "config/interface.h"
#include "nic/backend.h"
#include "nic/frame.h"
#include "nic/frame_queue.h"
#include "sim/segment_backend.h"

/** The wire on virtual time: 100 Mbit/s, and per slave the way through its controller and two PHYs, there and back. */
enum {
    NS_PER_BYTE = 80,
    FRAME_GAP_BYTES = 24, /* preamble 8, FCS 4, gap 12 */
    SHORTEST_FRAME = 60,
    NS_PER_SLAVE = 1200,
};

/** Virtual time of a thread: all segments that it has opened on virtual time share it, so one program can run several.
 *  The first begins it at 0, and it ends with the last. */
typedef struct shared_clock {
    struct shared_clock *next;
    cm1e_clock_t clock;
    pthread_t thread;
    int users;
} shared_clock_t;

static pthread_mutex_t clocks_lock = PTHREAD_MUTEX_INITIALIZER;
static shared_clock_t *clocks;

typedef struct sim {
    cm1e_sim_segment_t *segment;
    shared_clock_t *virtual_clock; /**< NULL: the clock of the machine */
    int64_t wire_free_ns[CM1E_NIC_PORTS]; /**< a port sends one frame after the other */
    frame_queue_t in_flight;
} sim_t;

static bool sim_matches(const char *name) { return cm1e_interface_is_simulated(name); }

/** The bus file in the name of the interface; NULL: it names none. */
static const char *bus_file(const char *name)
{
    const size_t prefix = sizeof CM1E_SIM_FILE_PREFIX - 1;
    return strncmp(name, CM1E_SIM_FILE_PREFIX, prefix) == 0 ? name + prefix : NULL;
}

static cm1e_error_t make_segment(sim_t *sim, const char *name, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    cm1e_bus_config_t other = {0}; /* the segment where it is described elsewhere, or not at all */
    cm1e_error_t error = CM1E_OK;
    const bool by_file = bus_file(name) != NULL, by_config = !by_file && config->axis_count + config->slave_count > 0;
    if (by_file)
        error = cm1e_bus_config_load(&other, bus_file(name), diag);
    else if (!by_config && (error = cm1e_bus_config_init(&other, CM1E_SIM_INTERFACE, 1)) != CM1E_OK)
        cm1e_diag_set(diag, error, 0, "No memory for the simulated segment.");
    if (error == CM1E_OK) {
        cm1e_diag_t why = {.error = CM1E_ERROR_NO_MEMORY};
        sim->segment = cm1e_sim_segment_create(by_config ? config : &other, &why);
        if (!sim->segment)
            error = cm1e_diag_set(diag, why.error != CM1E_OK ? why.error : CM1E_ERROR_NO_MEMORY, why.foreign_code, "%s",
                                  why.text[0] ? why.text : "No memory for the simulated segment.");
    }
    cm1e_bus_config_free(&other);
    return error;
}

/* ---- virtual time ------------------------------------------------------------------------------------------------ */

/** NULL: no memory. */
static shared_clock_t *take_clock(void)
{
    pthread_mutex_lock(&clocks_lock);
    shared_clock_t *shared = clocks;
    while (shared && !pthread_equal(shared->thread, pthread_self()))
        shared = shared->next;
    if (!shared) {
        shared = calloc(1, sizeof *shared);
        if (shared) {
            shared->thread = pthread_self();
            cm1e_clock_init_virtual(&shared->clock, 0);
            shared->next = clocks;
            clocks = shared;
        }
    }
    if (shared)
        shared->users++;
    pthread_mutex_unlock(&clocks_lock);
    return shared;
}

static void give_clock_back(shared_clock_t *shared)
{
    pthread_mutex_lock(&clocks_lock);
    if (shared && --shared->users == 0) {
        shared_clock_t **link = &clocks;
        while (*link != shared)
            link = &(*link)->next;
        *link = shared->next;
        free(shared);
    }
    pthread_mutex_unlock(&clocks_lock);
}

/* ---- the backend ------------------------------------------------------------------------------------------------- */

static cm1e_error_t sim_open(cm1e_nic_link_t *link, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    sim_t *sim = calloc(1, sizeof *sim);
    if (!sim)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the simulated network interface.");
    const cm1e_error_t error = make_segment(sim, link->interface_name, config, diag);
    if (error != CM1E_OK) {
        free(sim);
        return error;
    }
    if (config->virtual_time && !(sim->virtual_clock = take_clock())) {
        cm1e_sim_segment_destroy(sim->segment);
        free(sim);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the virtual time.");
    }
    link->state = sim;
    if (sim->virtual_clock)
        link->clock = &sim->virtual_clock->clock;
    if (link->ports > 1)
        cm1e_sim_segment_close_ring(sim->segment);
    return CM1E_OK;
}

static void sim_close(cm1e_nic_link_t *link)
{
    sim_t *sim = link->state;
    cm1e_sim_segment_destroy(sim->segment);
    give_clock_back(sim->virtual_clock);
    free(sim);
}

/** The time at which the answer is back. On real time it is back at once, because there is no wire. */
static int64_t arrival(cm1e_nic_link_t *link, int port, size_t length, int64_t now_ns)
{
    sim_t *sim = link->state;
    if (!sim->virtual_clock)
        return now_ns;
    const size_t bytes = (length < SHORTEST_FRAME ? SHORTEST_FRAME : length) + FRAME_GAP_BYTES;
    int64_t start = now_ns > sim->wire_free_ns[port] ? now_ns : sim->wire_free_ns[port];
    sim->wire_free_ns[port] = start + (int64_t)bytes * NS_PER_BYTE;
    return sim->wire_free_ns[port] + (int64_t)cm1e_sim_segment_slave_count(sim->segment) * NS_PER_SLAVE;
}

static bool sim_send(cm1e_nic_link_t *link, int port, const uint8_t *frame, size_t length)
{
    sim_t *sim = link->state;
    queued_frame_t *place = cm1e_frame_queue_place(&sim->in_flight);
    if (!place) {
        /* No one takes the answers: the oldest gives its place to the newest. */
        cm1e_frame_queue_remove_first(&sim->in_flight);
        place = cm1e_frame_queue_place(&sim->in_flight);
    }
    memcpy(place->bytes, frame, length);
    place->length = length;
    const int64_t now_ns = cm1e_clock_now(link->clock);
    const int out = cm1e_sim_segment_process(sim->segment, port, place->bytes, length, now_ns);
    if (out < 0 || out >= link->ports)
        return true;
    int64_t delay_ns = 0;
    switch (cm1e_sim_segment_next_frame_fault(sim->segment, &delay_ns)) {
    case CM1E_FRAME_OK:
        break;
    case CM1E_FRAME_LOSE:
        return true;
    case CM1E_FRAME_CORRUPT:
        cm1e_frame_corrupt(place->bytes, length);
        break;
    case CM1E_FRAME_DELAY:
        break;
    }
    place->port = out;
    const int64_t arrival_ns = arrival(link, port, length, now_ns);
    cm1e_frame_queue_insert(&sim->in_flight, place, arrival_ns + (delay_ns > 0 ? delay_ns : 0));
    return true;
}

/** Waits for the time. On a real clock, a sleep until a time in the past costs a system call. */
static void wait_until(cm1e_clock_t *clock, int64_t time_ns)
{
    if (time_ns > cm1e_clock_now(clock))
        cm1e_clock_sleep_until(clock, time_ns);
}

static size_t sim_receive(cm1e_nic_link_t *link, int *port, uint8_t *frame, int64_t deadline_ns)
{
    sim_t *sim = link->state;
    queued_frame_t *first = frame_queue_first(&sim->in_flight);
    const bool in_time = first && (first->ready_ns <= deadline_ns || first->ready_ns <= cm1e_clock_now(link->clock));
    if (!in_time) {
        /* Nothing can come while this thread, which owns the segment, sleeps. */
        wait_until(link->clock, deadline_ns);
        cm1e_sim_segment_advance(sim->segment, cm1e_clock_now(link->clock));
        return 0;
    }
    wait_until(link->clock, first->ready_ns);
    const size_t length = first->length;
    *port = first->port;
    memcpy(frame, first->bytes, length);
    cm1e_frame_queue_remove_first(&sim->in_flight);
    return length;
}

static const cm1e_nic_backend_t backend_sim = {"sim", sim_matches, sim_open, sim_send, sim_receive, sim_close};

void cm1e_sim_register(void) { cm1e_nic_register(&backend_sim); }

/* Runs before main(). The target cm1e::sim has the linker ask for cm1e_sim_register(), which brings this object. */
__attribute__((constructor)) static void register_at_start(void) { cm1e_sim_register(); }

cm1e_sim_segment_t *cm1e_sim_segment_of(const cm1e_nic_t *nic)
{
    const sim_t *sim = cm1e_nic_state_of(nic, &backend_sim);
    return sim ? sim->segment : NULL;
}

void cm1e_sim_replace_segment(cm1e_nic_t *nic, cm1e_sim_segment_t *segment)
{
    sim_t *sim = cm1e_nic_state_of(nic, &backend_sim);
    cm1e_sim_segment_destroy(sim->segment);
    sim->segment = segment;
}
