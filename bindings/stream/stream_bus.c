#include "stream_bus.h"

#include <ctype.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cm1e/config.h>
#include <cm1e/io.h>
#include <cm1e/log.h>
#include <cm1e/scheduler.h>

#include "stream_axis.h"
#include "stream_curve.h"

enum { NOTICES = 64, POLL_NS = 20000000, TEXT_BYTES = CM1E_AXIS_ERROR_TEXT_BYTES + 400 };
static const int64_t least_timeout_ns = 20000000;
static const double counts_of_tolerance = 1000.0;

typedef struct stream_bus {
    stream_link_t *link;
    const stream_options_t *options;
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    int64_t timeout_ns, command_ns; /**< planned time of the cycle in which the last command came */
    stream_command_t command;
    stream_state_t state;
    curve_t curve;
    bool commanded;                 /**< at least one command came */
    stream_axis_t axes[STREAM_AXES];
    cm1e_io_t inputs[STREAM_SIGNALS], outputs[STREAM_SIGNALS];
    /* between the cycle and the thread that tells */
    stream_notice_t notices[NOTICES];
    _Atomic uint32_t noticed, told;
    uint32_t axis_notices[STREAM_AXES];
    _Atomic bool over;
} stream_bus_t;

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

static void note(stream_bus_t *s, uint32_t axis)
{
    const uint32_t at = atomic_load_explicit(&s->noticed, memory_order_relaxed);
    if (s->axes[axis].notices == s->axis_notices[axis] ||
        at - atomic_load_explicit(&s->told, memory_order_acquire) == NOTICES)
        return;
    s->axis_notices[axis] = s->axes[axis].notices;
    s->notices[at % NOTICES] = s->axes[axis].notice;
    s->notices[at % NOTICES].axis = axis;
    /* Only the cycle may look into an axis. This happens once in a fault, and needs some microseconds. */
    cm1e_axis_error_text(s->axes[axis].reference, s->notices[at % NOTICES].text, CM1E_AXIS_ERROR_TEXT_BYTES);
    atomic_store_explicit(&s->noticed, at + 1, memory_order_release);
}

/* Takes what the control has commanded since the last cycle. Whether its positions go on. */
static bool listen(stream_bus_t *s)
{
    const int64_t now_ns = cm1e_scheduler_time_ns(s->scheduler);
    while (stream_take_command(s->link, &s->command)) {
        curve_add(&s->curve, s->command.positions);
        s->command_ns = now_ns;
        s->commanded = true;
    }
    const bool silent = now_ns - s->command_ns > s->timeout_ns;
    const curve_step_t step = curve_step(&s->curve);
    s->state.lost = s->commanded && (silent || step == CURVE_BROKEN);
    return s->commanded && !silent && step == CURVE_GOES_ON;
}

static void move(stream_bus_t *s, uint32_t axis, bool alive)
{
    const stream_command_t *command = &s->command;
    const stream_wish_t wish = {
        .enable = !command->stop && (command->enable >> axis & 1),
        .reset = command->reset >> axis & 1,
        .home = command->home >> axis & 1,
        .stop = command->stop,
        .alive = alive,
        .rests = alive && curve_rests(&s->curve, axis),
        .position = alive ? curve_at(&s->curve, axis) : 0.0,
        .digital = alive ? command->digital[axis] : 0,
    };
    stream_axis_step(&s->axes[axis], &wish, &s->state.axes[axis]);
    note(s, axis);
}

/* Reads and writes the signals of slaves without a motor. Without a control the outputs are off. */
static void exchange(stream_bus_t *s, bool alive)
{
    for (uint32_t i = 0; i < s->link->input_count; i++)
        s->state.inputs[i] = cm1e_io_real(&s->inputs[i]);
    for (uint32_t i = 0; i < s->link->output_count; i++) {
        const double value = alive ? s->command.outputs[i] : 0.0;
        if (s->link->outputs[i].bit)
            (void)cm1e_io_set_bool(&s->outputs[i], value != 0.0);
        else if (cm1e_io_set_real(&s->outputs[i], value) != CM1E_OK) /* a type of whole numbers */
            (void)cm1e_io_set_real(&s->outputs[i], round(value));
    }
}

static void program(void *context)
{
    stream_bus_t *s = context;
    if (atomic_load_explicit(&s->link->quit, memory_order_relaxed))
        cm1e_scheduler_stop(s->scheduler);
    const bool alive = listen(s);
    for (uint32_t i = 0; i < s->link->axis_count; i++)
        move(s, i, alive);
    exchange(s, alive);
    s->state.cycles++;
    s->state.delay = s->curve.behind;
    s->state.lost_frames = cm1e_bus_counters(s->bus)->lost_frames;
    (void)stream_put_state(s->link, &s->state);
}

/* ---- what is told ------------------------------------------------------------------------------------------------ */

static void say(const stream_bus_t *s, const char *sentence)
{
    if (s->options->say)
        s->options->say(s->options->context, sentence);
    else
        fprintf(stderr, "cm1e: %s\n", sentence);
}

static void tell_notices(stream_bus_t *s)
{
    char text[TEXT_BYTES];
    uint32_t told = atomic_load_explicit(&s->told, memory_order_relaxed);
    while (told != atomic_load_explicit(&s->noticed, memory_order_acquire)) {
        const stream_notice_t *notice = &s->notices[told % NOTICES];
        stream_notice_text(notice, s->link->axis_names[notice->axis], text, sizeof text);
        say(s, text);
        atomic_store_explicit(&s->told, ++told, memory_order_release);
    }
}

/* What is worth a line on the console: not every change of a state. */
static bool is_worth_telling(const cm1e_log_event_t *event)
{
    return event->kind != CM1E_LOG_STATE && event->kind != CM1E_LOG_COMMAND;
}

static uint64_t tell_events(stream_bus_t *s, uint64_t after)
{
    cm1e_log_event_t events[16];
    char text[TEXT_BYTES];
    size_t count;
    while ((count = cm1e_log_read(s->scheduler, after, events, sizeof events / sizeof events[0], NULL)) > 0) {
        for (size_t i = 0; i < count; i++)
            if (is_worth_telling(&events[i])) {
                cm1e_log_text(s->scheduler, &events[i], text, sizeof text);
                say(s, text);
            }
        after = events[count - 1].number;
    }
    return after;
}

static void *tell(void *context)
{
    stream_bus_t *s = context;
    const struct timespec pause = {.tv_nsec = POLL_NS};
    uint64_t after = 0;
    bool over;
    do {
        over = atomic_load(&s->over);
        after = tell_events(s, after);
        tell_notices(s);
        nanosleep(&pause, NULL);
    } while (!over);
    return NULL;
}

/* ---- the start --------------------------------------------------------------------------------------------------- */

/* A name as controls like it: a-z, 0-9, - and a point between slave and signal. */
static void plain_name(char *to, const char *name)
{
    size_t n = 0;
    for (; *name && n < STREAM_NAME - 1; name++) {
        const char c = (char)tolower((unsigned char)*name);
        const bool plain = isalnum((unsigned char)c) || c == '.';
        if (plain || (n > 0 && to[n - 1] != '-'))
            to[n++] = plain ? c : '-';
    }
    while (n > 0 && to[n - 1] == '-')
        n--;
    to[n] = '\0';
}

static void describe_signal(stream_bus_t *s, const cm1e_io_info_t *info)
{
    stream_link_t *link = s->link;
    uint32_t *count = info->output ? &link->output_count : &link->input_count;
    char name[2 * STREAM_NAME], use[200];
    cm1e_diag_t diag;
    if (info->of_axis || *count == STREAM_SIGNALS || info->type == CM1E_IO_BYTES ||
        (info->output && cm1e_io_use(s->bus, info, use, sizeof use)))
        return;
    stream_signal_t *signal = info->output ? &link->outputs[*count] : &link->inputs[*count];
    cm1e_io_t *io = info->output ? &s->outputs[*count] : &s->inputs[*count];
    if (cm1e_io_find_bits(s->bus, info->position, info->output, info->bit_offset, info->bits, info->type, io, &diag) !=
        CM1E_OK)
        return;
    snprintf(name, sizeof name, "%s.%s-%u", cm1e_bus_slave_name(s->bus, info->position),
             info->output ? "out" : "in", info->number);
    plain_name(signal->name, name);
    signal->bit = info->bits == 1;
    ++*count;
}

static cm1e_error_t describe_axis(stream_bus_t *s, const cm1e_axis_config_t *config, uint32_t n, cm1e_diag_t *diag)
{
    const AXIS_REF_t reference = cm1e_scheduler_axis(s->scheduler, n);
    const double cycle_s = (double)s->link->cycle_ns * 1e-9;
    const uint32_t outputs = config->channel ? STREAM_OUTPUTS : strcmp(config->device, "cia402") == 0 ? 0 : 1;
    double scale = config->counts_per_unit;
    if (config->modulo_range > 0.0 || config->motion == CM1E_MOTION_DRIVE)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "Axis \"%s\" cannot follow the positions of a control: "
                             "it needs `motion: host` and no `modulo_range` in the bus file.", config->name);
    if (scale == 0.0)
        scale = 50000.0 * (config->gear_numerator ? config->gear_numerator : 1) /
                (config->gear_denominator ? config->gear_denominator : 1) /
                (config->units_per_revolution > 0.0 ? config->units_per_revolution : 1.0);
    const double tolerance = s->options->tolerance > 0.0 ? s->options->tolerance : counts_of_tolerance / fabs(scale);
    plain_name(s->link->axis_names[n], config->name);
    s->link->digital_outputs[n] = outputs;
    stream_axis_init(&s->axes[n], reference, tolerance, cycle_s, outputs);
    return CM1E_OK;
}

static cm1e_error_t describe(stream_bus_t *s, cm1e_diag_t *diag)
{
    const cm1e_bus_config_t *config = cm1e_bus_configuration(s->bus);
    cm1e_error_t error = CM1E_OK;
    cm1e_io_info_t info;
    if (config->axis_count > STREAM_AXES)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "The bus file has %u axes; up to %d are right.",
                             config->axis_count, STREAM_AXES);
    s->link->cycle_ns = config->cycle_time_ns;
    for (uint32_t i = 0; i < config->axis_count && error == CM1E_OK; i++)
        error = describe_axis(s, &config->axes[i], i, diag);
    for (uint32_t n = 0; cm1e_io_at(s->bus, n, &info); n++)
        describe_signal(s, &info);
    s->link->axis_count = config->axis_count;
    const int64_t period_ns = s->link->period_ns > 0 ? s->link->period_ns : s->link->cycle_ns;
    const int64_t ten_ns = 10 * period_ns, most_ns = ten_ns > least_timeout_ns ? ten_ns : least_timeout_ns;
    s->timeout_ns = s->options->timeout_ns > 0 ? s->options->timeout_ns : most_ns;
    curve_init(&s->curve, s->link->axis_count, (double)s->link->cycle_ns / (double)period_ns,
               s->options->delay_periods > 0.0 ? s->options->delay_periods : 4.0);
    return error;
}

/* With others no axis could ever be enabled, or an axis would be enabled wherever it is. */
static cm1e_error_t check_options(const stream_options_t *options, cm1e_diag_t *diag)
{
    const double delay = options->delay_periods, tolerance = options->tolerance;
    if (delay != 0.0 && !(delay >= CURVE_LEAST_DELAY && delay <= CURVE_MOST_DELAY))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the delay is %g periods; %d ... %d are right.", delay,
                             CURVE_LEAST_DELAY, CURVE_MOST_DELAY);
    if (!(tolerance >= 0.0 && isfinite(tolerance)))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the tolerance is %g; 0 or a finite number above it is right.",
                             tolerance);
    return CM1E_OK;
}

static cm1e_error_t open_bus(stream_bus_t *s, cm1e_diag_t *diag)
{
    const cm1e_scheduler_config_t scheduler = {.realtime_priority = s->options->realtime_priority,
                                               .cpu = s->options->cpu};
    const cm1e_task_config_t task = {.name = "control", .program = program, .context = s};
    cm1e_bus_config_t config;
    cm1e_error_t error = check_options(s->options, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_config_load(&config, s->options->bus_file, diag);
    if (error != CM1E_OK)
        return error;
    if (s->options->interface_name)
        snprintf(config.interface_name, sizeof config.interface_name, "%s", s->options->interface_name);
    error = cm1e_bus_open(&s->bus, &config, diag);
    cm1e_bus_config_free(&config); /* the bus has a copy */
    if (error == CM1E_OK)
        error = cm1e_bus_start(s->bus, diag);
    if (error == CM1E_OK)
        error = cm1e_scheduler_create(&s->scheduler, s->bus, &scheduler, diag);
    if (error == CM1E_OK)
        error = describe(s, diag);
    return error == CM1E_OK ? cm1e_scheduler_add_task(s->scheduler, &task, diag) : error;
}

static cm1e_error_t run(stream_bus_t *s, bool stop_on_signals, cm1e_diag_t *diag)
{
    pthread_t teller;
    if (stop_on_signals)
        cm1e_scheduler_stop_on_signals(s->scheduler);
    const bool tells = pthread_create(&teller, NULL, tell, s) == 0;
    atomic_store_explicit(&s->link->phase, STREAM_RUNNING, memory_order_release);
    const cm1e_error_t error = cm1e_scheduler_run(s->scheduler, 0, diag);
    atomic_store(&s->over, true);
    if (tells)
        pthread_join(teller, NULL);
    return error;
}

cm1e_error_t stream_bus_run(stream_link_t *link, const stream_options_t *options, bool stop_on_signals)
{
    cm1e_diag_t diag = {0};
    stream_bus_t *s = calloc(1, sizeof *s);
    cm1e_error_t error = CM1E_ERROR_NO_MEMORY;
    if (s) {
        s->link = link;
        s->options = options;
        error = open_bus(s, &diag);
        if (error == CM1E_OK)
            error = run(s, stop_on_signals, &diag);
        cm1e_scheduler_destroy(s->scheduler);
        (void)cm1e_bus_close(s->bus);
    }
    const char *why = error == CM1E_OK ? "The bus was stopped in order." : diag.text[0] ? diag.text
                                                                                       : cm1e_strerror(error);
    snprintf(link->text, sizeof link->text, "%s", why);
    atomic_store_explicit(&link->phase, STREAM_ENDED, memory_order_release);
    free(s);
    return error;
}
