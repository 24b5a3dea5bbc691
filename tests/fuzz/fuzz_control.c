/* Requests of the control socket, down to what the cycle of a running program does with them: messages as the server reads
 * them, the handlers, orders, transfers, jogs, forced variables, recordings, files. The network is simulated, the time is
 * virtual; the cycle and the thread of the socket take turns.
 *
 * To start a network takes longer than most inputs. So a program runs on over some of them, in a thread of its own, which
 * waits between two inputs: no client is there, nothing moves. It ends early if anything may be left in a slave. A finding
 * that does not repeat alone needs the inputs before it: run the target with `-runs=0` on the corpus.
 *
 * An input: a first byte, whether others may do more than look; then lines. The first letter of a line is the client, the
 * second one how many cycles pass before; what follows is the text of the message. "-" instead of a text: the client
 * leaves. */
#include <jansson.h>
#include <math.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"
#include "control/message.h"
#include "control/request.h"
#include "fuzz.h"
#include "scheduler/variables.h"

enum { CLIENTS = 3, AXES = 2, FIRST_CYCLES = 5, MOST_CYCLES = 3000, LAST_CYCLES = 1500, REST_CYCLES = 20, PLACES = 31,
       PROGRAM_INPUTS = 16 };
#define AXIS_SPEED 10.0  /* u/s */
#define TOLERATED 1.05
#define HOMING_SPEED 60000.0 /* counts/s */

typedef struct client {
    control_request_t request;
    json_t *asked;           /**< id of the request that goes on */
    bool left, served;       /**< it leaves; it has sent anything since */
} client_t;

typedef struct run {
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    control_run_t control;
    pthread_t thread;
    sem_t begin, done;       /**< of an input */
    int inputs;              /**< of this program; 0: none runs */
    bool begun, quit;        /**< begun: it waits for its first input, or has got it */

    /* of an input */
    const uint8_t *at, *end;
    double begun_at[AXES];   /**< counts, where the shafts stood */
    bool may;                /**< others may do more than look */
    client_t clients[CLIENTS];
    int cycle, wait, last;   /**< last: cycle in which the last line was sent */
    int rest;                /**< cycles since all have left and nothing moves */
    bool homed, lasting;     /**< lasting: a slave may have something else than at first */
} run_t;

static run_t run_of_all;     /**< also for the window, whose opening knows the scheduler only */
static const uint32_t places[CLIENTS] = {0, 1, PLACES}; /**< of the clients among those of the server */

/* ---- the variables of the program -------------------------------------------------------------------------------- */

static struct {
    uint8_t truth, bits;
    int16_t small;
    uint64_t large;
    float real;
    double wide;
    char text[12];
    uint16_t letters[8];
} own;
static const variable_t rows[] = {
    {.name = "Main.start", .unit = "", .declared = "BOOL", .type = CM1E_TRACE_BOOL, .data = &own.truth, .bytes = 1},
    {.name = "Main.bits.3", .unit = "", .declared = "BOOL", .type = CM1E_TRACE_BOOL, .data = &own.bits, .bytes = 1, .bit = 4},
    {.name = "Main.small", .unit = "", .declared = "INT (-5..7)", .type = CM1E_TRACE_INT, .data = &own.small, .bytes = 2,
     .ranged = true, .first = -5, .last = 7},
    {.name = "Main.large", .unit = "", .declared = "ULINT", .type = CM1E_TRACE_ULINT, .data = &own.large, .bytes = 8},
    {.name = "Main.table[1].real", .unit = "mm", .declared = "REAL", .type = CM1E_TRACE_REAL, .data = &own.real, .bytes = 4},
    {.name = "Main.wide", .unit = "", .declared = "LREAL", .type = CM1E_TRACE_LREAL, .data = &own.wide, .bytes = 8},
    {.name = "Main.text", .unit = "", .declared = "STRING[11]", .form = VARIABLE_STRING, .data = own.text, .bytes = 12},
    {.name = "Main.letters", .unit = "", .declared = "WSTRING[7]", .form = VARIABLE_WSTRING, .data = own.letters, .bytes = 16},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

static void judge_variables(const run_t *run)
{
    if (own.truth > 1 || (own.bits & ~8u) || own.small < -5 || own.small > 7 || !isfinite(own.real) ||
        !isfinite(own.wide) || !memchr(own.text, 0, sizeof own.text) || own.letters[7])
        fuzz_fail("a variable has a value that it cannot have: %u %u %d %g %g", own.truth, own.bits, own.small,
                  (double)own.real, own.wide);
    if (!run->may && (own.truth || own.small || own.large || own.wide != 0 || own.text[0]))
        fuzz_fail("a variable is written by somebody who may only look");
}

/* ---- the motors -------------------------------------------------------------------------------------------------- */

static void judge_motors(const run_t *run)
{
    for (uint32_t i = 0; i < AXES; i++) {
        cm1e_sim_probe_t probe;
        cm1e_sim_probe_channel(cm1e_bus_segment(run->bus), i + 1, 0, &probe);
        const double speed = fabs(probe.velocity_counts_per_s);
        const double most = AXIS_SPEED * 1000 * TOLERATED + 300 + (run->homed ? HOMING_SPEED : 0);
        if (!isfinite(speed) || speed > most)
            fuzz_fail("the shaft of axis %u turns at %g counts/s", i + 1, probe.velocity_counts_per_s);
        if (!run->may && (probe.torque_on || fabs(probe.position_counts - run->begun_at[i]) > 1))
            fuzz_fail("axis %u is moved by somebody who may only look", i + 1);
    }
}

/** Whatever the clients held ended with them. `must`: it is time. */
static bool is_at_rest(const run_t *run, bool must)
{
    bool rest = run->control.view.maintained.count == 0 && run->control.view.outputs.count == 0;
    if (must && !rest)
        fuzz_fail("all have left, and axes or outputs are held");
    for (uint32_t i = 0; i < AXES; i++) {
        cm1e_sim_probe_t probe;
        cm1e_sim_probe_channel(cm1e_bus_segment(run->bus), i + 1, 0, &probe);
        const bool turns = fabs(probe.velocity_counts_per_s) > 1 || probe.torque_on;
        if (must && turns)
            fuzz_fail("all have left, and the shaft of axis %u turns at %g counts/s, torque %d", i + 1,
                      probe.velocity_counts_per_s, probe.torque_on);
        rest = rest && !turns;
    }
    for (uint32_t n = 0; n < CLIENTS; n++)
        rest = rest && !run->clients[n].left;
    return rest;
}

/* ---- the server -------------------------------------------------------------------------------------------------- */

static void judge_reply(client_t *client, json_t *reply)
{
    const json_t *ok = json_object_get(reply, "ok"), *error = json_object_get(reply, "error");
    size_t length = 0;
    if (!json_is_boolean(ok) || json_is_true(ok) == (error != NULL))
        fuzz_fail("a reply says neither yes nor no");
    if (error) {
        const char *text = json_string_value(json_object_get(error, "text"));
        fuzz_use_text(text ? text : "");
        if (json_integer_value(json_object_get(error, "code")) == CM1E_OK)
            fuzz_fail("refused without an error: %s", text);
    }
    const json_t *id = json_object_get(reply, "id");
    if (client->asked ? !id || !json_equal(id, client->asked) : id && !json_is_null(id))
        fuzz_fail("a reply has another id than its request");
    free(cm1e_message_write(reply, &length));
    if (length == 0 || length > CM1E_REPLY_MAX)
        fuzz_fail("a reply of %zu bytes", length);
    json_decref(client->asked);
    client->asked = NULL;
    client->request.state = REQUEST_NONE;
    cm1e_request_clear(&client->request);
}

static void leave(run_t *run, uint32_t n, bool stopped)
{
    client_t *client = &run->clients[n];
    client->left = !cm1e_request_leave(&client->request, &run->control, places[n], stopped);
    if (client->left)
        return;
    json_decref(client->asked);
    *client = (client_t){0};
}

static void ask(run_t *run, client_t *client, uint32_t place, const uint8_t *text, size_t length, int64_t now_ns)
{
    uint8_t bytes[CM1E_MESSAGE_HEADER + 4096];
    char why[JSON_ERROR_TEXT_LENGTH];
    json_t *message;
    size_t used = 0;
    if (length > sizeof bytes - CM1E_MESSAGE_HEADER)
        return;
    memcpy(bytes, (uint8_t[]){0, 0, (uint8_t)(length >> 8), (uint8_t)length}, CM1E_MESSAGE_HEADER);
    memcpy(bytes + CM1E_MESSAGE_HEADER, text, length);
    if (cm1e_message_read(bytes, CM1E_MESSAGE_HEADER + length, CM1E_REQUEST_MAX, &message, &used, why) !=
        CM1E_MESSAGE_WHOLE)
        return;
    const char *name = json_string_value(json_object_get(message, "request"));
    run->homed = run->homed || (name && strcmp(name, "home") == 0);
    run->lasting = run->lasting || (name && (strcmp(name, "sdo_write") == 0 || strcmp(name, "recover") == 0 ||
                                             strncmp(name, "file", 4) == 0));
    client->asked = json_incref(json_object_get(message, "id"));
    client->served = true;
    client->request.client = place;
    json_t *reply = cm1e_request_begin(&client->request, &run->control, message, now_ns);
    json_decref(message);
    if (reply)
        judge_reply(client, reply);
}

/** The next line, if its client is free and its cycles have passed; false: there is none any more. */
static bool next_line(run_t *run, int64_t now_ns)
{
    const uint8_t *end = run->at < run->end ? memchr(run->at, '\n', (size_t)(run->end - run->at)) : run->end;
    end = end ? end : run->end;
    if (run->at >= run->end)
        return false;
    const size_t length = (size_t)(end - run->at);
    const uint32_t n = run->at[0] % CLIENTS;
    client_t *client = &run->clients[n];
    if (run->wait < 0)
        run->wait = length > 1 ? run->at[1] % 64 : 0;
    if (client->request.state != REQUEST_NONE || client->left || run->wait-- > 0)
        return true;
    if (length > 2 && run->at[2] == '-')
        leave(run, n, false);
    else if (length > 2)
        ask(run, client, places[n], run->at + 2, length - 2, now_ns);
    run->at = end + (end < run->end);
    run->wait = -1;
    run->last = run->cycle;
    return run->at < run->end;
}

static void serve(run_t *run, bool stopping)
{
    const int64_t now_ns = cm1e_scheduler_time_ns(run->scheduler);
    for (uint32_t n = 0; n < CLIENTS; n++) {
        client_t *client = &run->clients[n];
        json_t *reply = client->request.state == REQUEST_NONE
                            ? NULL : cm1e_request_continue(&client->request, &run->control, now_ns, stopping);
        if (reply)
            judge_reply(client, reply);
        if (client->left)
            leave(run, n, stopping);
    }
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

static void *open_window(cm1e_scheduler_t *scheduler, uint32_t bus, cm1e_window_told_t *told)
{
    (void)told;
    if (cm1e_view_init(&run_of_all.control.view, scheduler, bus) != CM1E_OK)
        fuzz_fail("no memory");
    return &run_of_all;
}

/** libFuzzer's timer interrupts it. */
static void wait_on(sem_t *semaphore)
{
    while (sem_wait(semaphore) != 0)
        ;
}

/** The last input is over; waits for another one. */
static void wait_for_input(run_t *run)
{
    if (run->begun)
        sem_post(&run->done);
    run->begun = true;
    wait_on(&run->begin);
    if (run->quit)
        cm1e_scheduler_stop(run->scheduler);
}

/** true: the input is over. */
static bool play_input(run_t *run)
{
    run->cycle++;
    serve(run, false);
    const bool more = run->cycle < MOST_CYCLES && next_line(run, cm1e_scheduler_time_ns(run->scheduler));
    if (more || run->cycle < FIRST_CYCLES)
        return false;
    for (uint32_t n = 0; n < CLIENTS && run->cycle < run->last + LAST_CYCLES; n++)
        leave(run, n, false);
    run->rest = is_at_rest(run, run->cycle == run->last + LAST_CYCLES) ? run->rest + 1 : 0;
    return run->rest == REST_CYCLES || run->cycle >= run->last + LAST_CYCLES;
}

/** After the work of a cycle: what the cycle has for the others, then the thread, then the judge. */
static void look(void *window)
{
    run_t *run = window;
    cm1e_view_cycle(&run->control.view);
    judge_motors(run);
    judge_variables(run);
    if (!run->quit && (!run->begun || play_input(run)))
        wait_for_input(run);
}

/** The bus has stopped: every transfer has ended. */
static void close_window(void *window)
{
    run_t *run = window;
    for (uint32_t n = 0; n < CLIENTS; n++)
        leave(run, n, true);
    for (int tries = 0; tries < 10; tries++)
        serve(run, true);
    for (uint32_t n = 0; n < CLIENTS; n++)
        if (run->clients[n].left)
            fuzz_fail("a client cannot leave although the program has ended");
    cm1e_view_free(&run->control.view);
}

static const cm1e_window_t window = {open_window, look, close_window};

static void program(void *context)
{
    run_t *run = context;
    cm1e_scheduler_apply_forced(run->scheduler);
}

/** Two CM1-E and terminals. */
static void open_bus(run_t *run)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    if (cm1e_bus_config_init(&config, "sim", AXES) != CM1E_OK)
        fuzz_fail("no memory");
    config.virtual_time = true;
    config.sim_gaps = CM1E_SIM_IO_TERMINAL;
    for (uint16_t i = 0; i < AXES; i++) {
        config.axes[i].address = (uint16_t)(i + 1);
        config.axes[i].counts_per_unit = 1000;
        config.axes[i].max_velocity = AXIS_SPEED;
        config.axes[i].homing = (cm1e_homing_config_t){.method = -2, .velocity = 10, .acceleration = 1000, .torque = 30,
                                                       .timeout_s = 1};
        snprintf(config.axes[i].name, sizeof config.axes[i].name, "%c", 'X' + i);
    }
    cm1e_slave_config_t *terminals = cm1e_bus_config_add_slave(&config, "io");
    if (!terminals)
        fuzz_fail("no memory");
    terminals->address = AXES + 1;
    terminals->sim.kind = CM1E_SIM_SLAVE_DIGITAL;
    terminals->sim.outputs = terminals->sim.inputs = 4;
    if (cm1e_bus_open(&run->bus, &config, &diag) != CM1E_OK || cm1e_bus_start(run->bus, &diag) != CM1E_OK ||
        cm1e_scheduler_create(&run->scheduler, run->bus, NULL, &diag) != CM1E_OK)
        fuzz_fail("no run: %s", diag.text);
    cm1e_bus_config_free(&config);
}

static void *run_program(void *context)
{
    run_t *run = context;
    cm1e_diag_t diag = {0};
    if (cm1e_scheduler_run(run->scheduler, 0, &diag) != CM1E_OK)
        fuzz_fail("the run ends with \"%s\"", diag.text);
    return NULL;
}

static void begin_program(run_t *run)
{
    cm1e_diag_t diag = {0};
    *run = (run_t){.control = {.program = "fuzz"}};
    cm1e_scheduler_register_window(&window);
    open_bus(run);
    cm1e_scheduler_set_variables(run->scheduler, rows, ROWS);
    const cm1e_task_config_t task = {.program = program, .context = run};
    if (cm1e_scheduler_add_task(run->scheduler, &task, &diag) != CM1E_OK)
        fuzz_fail("no task: %s", diag.text);
    if (sem_init(&run->begin, 0, 0) != 0 || sem_init(&run->done, 0, 0) != 0 ||
        pthread_create(&run->thread, NULL, run_program, run) != 0)
        fuzz_fail("no thread");
}

static void end_program(run_t *run)
{
    run->quit = true;
    sem_post(&run->begin);
    pthread_join(run->thread, NULL);
    cm1e_scheduler_destroy(run->scheduler);
    cm1e_bus_close(run->bus);
    run->inputs = 0;
}

static bool is_as_at_first(const run_t *run)
{
    bool same = !run->lasting && cm1e_bus_health(run->bus) == CM1E_OK;
    for (uint32_t i = 0; i < AXES; i++) {
        cm1e_axis_info_t info;
        (void)cm1e_axis_read(cm1e_scheduler_axis(run->scheduler, i), &info);
        same = same && info.state == CM1E_AXIS_DISABLED && !info.homed;
    }
    return same;
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    if (size == 0)
        return false;
    run_t *run = &run_of_all;
    memset(&own, 0, sizeof own); /* first: a program that begins is judged at once */
    if (run->inputs == 0)
        begin_program(run);
    memset(run->clients, 0, sizeof run->clients);
    run->at = bytes + 1;
    run->end = bytes + size;
    run->may = bytes[0] % 8 != 0;
    run->control.control = run->may ? CM1E_CONTROL_MAINTAIN : CM1E_CONTROL_OBSERVE;
    for (uint32_t i = 0; i < AXES; i++) {
        cm1e_sim_probe_t probe;
        cm1e_sim_probe_channel(cm1e_bus_segment(run->bus), i + 1, 0, &probe);
        run->begun_at[i] = probe.position_counts;
    }
    run->cycle = run->last = run->rest = 0;
    run->wait = -1;
    run->homed = run->lasting = false;
    run->inputs++;
    sem_post(&run->begin);
    wait_on(&run->done);
    if (run->inputs == PROGRAM_INPUTS || !is_as_at_first(run))
        end_program(run);
    return false;
}

void fuzz_seeds(void)
{
    static const char *const texts[] = {
        "10 {\"request\":\"hello\",\"id\":1,\"protocol\":1}\n01{\"request\":\"axes\"}\n01{\"request\":\"slaves\"}\n"
        "10{\"request\":\"statistics\"}\n10{\"request\":\"log\",\"after\":2}\n20{\"request\":\"io\"}",
        "10{\"request\":\"sdo_read\",\"slave\":1,\"index\":4120,\"subindex\":1,\"size\":4,\"timeout_ms\":50}\n"
        "11{\"request\":\"sdo_write\",\"slave\":2,\"index\":24707,\"data\":\"e8030000\",\"complete_access\":false}\n"
        "12{\"request\":\"sdo_info\",\"slave\":1,\"kind\":3,\"index\":4120}\n"
        "11{\"request\":\"sdo_info\",\"slave\":1,\"kind\":1,\"index\":0}\n"
        "10{\"request\":\"sii_read\",\"slave\":1,\"word\":8,\"size\":16}\n"
        "10{\"request\":\"registers\",\"slave\":3,\"address\":304,\"size\":2}",
        "10{\"request\":\"enable\",\"axis\":1,\"keep_ms\":2000}\n1?{\"request\":\"jog\",\"axis\":1,\"velocity\":-3.5,"
        "\"acceleration\":20,\"keep_ms\":200}\n1 {\"request\":\"jog\",\"axis\":1,\"velocity\":9}\n"
        "1 {\"request\":\"stop\",\"axis\":1}\n1 {\"request\":\"disable\",\"axis\":1}",
        "10{\"request\":\"enable\",\"axis\":2}\n1?{\"request\":\"home\",\"axis\":2,\"keep_ms\":1000}\n"
        "1 {\"request\":\"keep\"}\n2 {\"request\":\"reset\",\"axis\":2}\n1 -\n1 {\"request\":\"enable\",\"axis\":1}",
        "10{\"request\":\"variables\",\"from\":0,\"forced\":false}\n10{\"request\":\"variable\",\"name\":\"main.small\","
        "\"value\":7,\"force\":true,\"keep_ms\":500}\n11{\"request\":\"variable\",\"name\":\"Main.text\",\"value\":\"ab\"}\n"
        "11{\"request\":\"variable\",\"name\":\"Main.letters\",\"value\":\"\\u00e4\\ud83d\\ude00\"}\n"
        "11{\"request\":\"variable\",\"name\":\"Main.wide\",\"value\":1e300}\n"
        "11{\"request\":\"variable\",\"name\":\"Main.small\",\"value\":null}\n21{\"request\":\"variables\",\"forced\":true}",
        "10{\"request\":\"record\",\"every\":2,\"variables\":[\"Main\"],\"objects\":[{\"axis\":1,\"index\":24676,"
        "\"subindex\":0}]}\n1:{\"request\":\"samples\"}\n2:{\"request\":\"record\"}\n2 {\"request\":\"samples\"}\n1 -",
        "10{\"request\":\"output\",\"name\":\"3.output 1\",\"value\":1,\"keep_ms\":300}\n"
        "20{\"request\":\"output\",\"name\":\"io.output 1\",\"value\":null}\n10{\"request\":\"recover\",\"slave\":3}\n"
        "10{\"request\":\"output\",\"name\":\"3.output 2\",\"value\":0.5}",
        "10{\"request\":\"file_data\",\"offset\":0,\"data\":\"00112233\"}\n10{\"request\":\"file_begin\",\"slave\":1,"
        "\"name\":\"fw\",\"write\":true,\"password\":0,\"timeout_ms\":100}\n1:{\"request\":\"file\"}\n"
        "10{\"request\":\"file_begin\",\"slave\":1,\"name\":\"fw\",\"write\":false}\n1 {\"request\":\"file\"}",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char name[] = "client0", *whole;
        name[6] = (char)('0' + i);
        for (unsigned may = 0; may < 2; may++) {
            whole = malloc(strlen(texts[i]) + 2);
            if (!whole)
                fuzz_fail("no memory");
            sprintf(whole, "%c%s", may ? '1' : '0', texts[i]);
            name[0] = may ? 'm' : 'o';
            fuzz_seed(name, whole, strlen(whole));
            free(whole);
        }
    }
}
