/* Signals, slaves, simulator, log and trace of a session. */
#include <string.h>

#include "cm1e/plot.h"
#include "cm1e/trace.h"
#include "py_owner.h"

typedef struct find {
    const char *name;
    cm1e_io_t *io;
    cm1e_diag_t *diag;
} find_t;

static cm1e_error_t find_signal(cm1e_py_session_t *s, void *argument)
{
    const find_t *find = argument;
    return s->bus ? cm1e_io_find(s->bus, find->name, find->io, find->diag) : CM1E_ERROR_STATE;
}

cm1e_error_t cm1e_py_io_find(cm1e_py_session_t *session, const char *name, cm1e_io_t *io, cm1e_diag_t *diag)
{
    diag->text[0] = '\0';
    return py_owner_do(session, find_signal, &(find_t){name, io, diag});
}

typedef struct signal {
    const cm1e_io_t *io;
    cm1e_py_io_value_t *value;
    bool is_real, writes;
} signal_t;

static cm1e_error_t use_signal(cm1e_py_session_t *s, void *argument)
{
    const signal_t *signal = argument;
    cm1e_py_io_value_t *value = signal->value;
    if (!s->bus)
        return CM1E_ERROR_STATE;
    if (signal->writes)
        return signal->is_real ? cm1e_io_set_real(signal->io, value->real)
                               : cm1e_io_set_integer(signal->io, value->integer);
    value->quality = cm1e_io_quality(signal->io);
    value->integer = cm1e_io_integer(signal->io);
    value->real = cm1e_io_real(signal->io);
    return CM1E_OK;
}

cm1e_error_t cm1e_py_io_read(cm1e_py_session_t *session, const cm1e_io_t *io, cm1e_py_io_value_t *value)
{
    return py_owner_do(session, use_signal, &(signal_t){.io = io, .value = value});
}

cm1e_error_t cm1e_py_io_write_integer(cm1e_py_session_t *session, const cm1e_io_t *io, int64_t value)
{
    cm1e_py_io_value_t written = {.integer = value};
    return py_owner_do(session, use_signal, &(signal_t){.io = io, .value = &written, .writes = true});
}

cm1e_error_t cm1e_py_io_write_real(cm1e_py_session_t *session, const cm1e_io_t *io, double value)
{
    cm1e_py_io_value_t written = {.real = value};
    return py_owner_do(session, use_signal, &(signal_t){.io = io, .value = &written, .is_real = true, .writes = true});
}

typedef struct listed {
    uint32_t n;
    void *info;
} listed_t;

static cm1e_error_t list_signal(cm1e_py_session_t *s, void *argument)
{
    const listed_t *listed = argument;
    if (!s->bus)
        return CM1E_ERROR_STATE;
    return cm1e_io_at(s->bus, listed->n, listed->info) ? CM1E_OK : CM1E_ERROR_NOT_FOUND;
}

cm1e_error_t cm1e_py_io_at(cm1e_py_session_t *session, uint32_t n, cm1e_io_info_t *info)
{
    return py_owner_do(session, list_signal, &(listed_t){n, info});
}

static cm1e_error_t copy_slave(cm1e_py_session_t *s, void *argument)
{
    const listed_t *listed = argument;
    const cm1e_slave_info_t *slave = s->bus ? cm1e_bus_slave(s->bus, listed->n) : NULL;
    if (slave)
        *(cm1e_slave_info_t *)listed->info = *slave;
    return slave ? CM1E_OK : s->bus ? CM1E_ERROR_NOT_FOUND : CM1E_ERROR_STATE;
}

cm1e_error_t cm1e_py_slave(cm1e_py_session_t *session, uint32_t position, cm1e_slave_info_t *info)
{
    return py_owner_do(session, copy_slave, &(listed_t){position, info});
}

/* ---- SDO --------------------------------------------------------------------------------------------------------- */

typedef struct transfer {
    cm1e_sdo_t *sdo;
    cm1e_diag_t *diag;
    bool submitted;
} transfer_t;

static cm1e_error_t begin_transfer(cm1e_py_session_t *s, void *argument)
{
    transfer_t *transfer = argument;
    cm1e_sdo_t *sdo = transfer->sdo;
    if (!s->bus)
        return CM1E_ERROR_STATE;
    if (atomic_load(&s->running)) {
        transfer->submitted = true;
        return cm1e_sdo_submit(s->bus, sdo);
    }
    return sdo->write ? cm1e_sdo_write(s->bus, sdo->position, sdo->index, sdo->subindex, sdo->data, sdo->size,
                                       transfer->diag)
                      : cm1e_sdo_read(s->bus, sdo->position, sdo->index, sdo->subindex, sdo->data, &sdo->size,
                                      transfer->diag);
}

/** A transfer is finished by the cycle, also by the last one of the run: the bus cancels what waits when it stops. */
cm1e_error_t cm1e_py_sdo(cm1e_py_session_t *s, cm1e_sdo_t *sdo, cm1e_diag_t *diag)
{
    transfer_t transfer = {.sdo = sdo, .diag = diag};
    const cm1e_error_t error = py_owner_do(s, begin_transfer, &transfer);
    if (!transfer.submitted || error != CM1E_OK)
        return error;
    while (cm1e_sdo_state(sdo) == CM1E_SDO_BUSY)
        py_owner_let_a_cycle_pass(s);
    if (cm1e_sdo_state(sdo) == CM1E_SDO_DONE)
        return CM1E_OK;
    return cm1e_diag_set(diag, sdo->error, sdo->abort_code, "Object 0x%04X:%02X of slave %u: %s%s%s.", sdo->index,
                         sdo->subindex, sdo->position, cm1e_strerror(sdo->error), sdo->abort_code ? ": " : "",
                         sdo->abort_code ? cm1e_sdo_abort_text(sdo->abort_code) : "");
}

/* ---- simulator --------------------------------------------------------------------------------------------------- */

typedef struct simulated {
    const char *line;
    char *answer;
    size_t size;
    uint32_t position;
    cm1e_sim_probe_t *probe;
} simulated_t;

static cm1e_error_t use_simulator(cm1e_py_session_t *s, void *argument)
{
    const simulated_t *simulated = argument;
    if (!s->bus)
        return CM1E_ERROR_STATE;
    if (simulated->line)
        return cm1e_bus_simulate(s->bus, simulated->line, simulated->answer, simulated->size);
    if (!cm1e_bus_segment(s->bus))
        return CM1E_ERROR_UNSUPPORTED;
    cm1e_sim_probe(cm1e_bus_segment(s->bus), simulated->position, simulated->probe);
    return CM1E_OK;
}

cm1e_error_t cm1e_py_simulate(cm1e_py_session_t *session, const char *line, char *answer, size_t size)
{
    answer[0] = '\0';
    return py_owner_do(session, use_simulator, &(simulated_t){.line = line, .answer = answer, .size = size});
}

cm1e_error_t cm1e_py_probe(cm1e_py_session_t *session, uint32_t position, cm1e_sim_probe_t *probe)
{
    return py_owner_do(session, use_simulator, &(simulated_t){.position = position, .probe = probe});
}

/* ---- what any thread may look at --------------------------------------------------------------------------------- */

static cm1e_error_t read_time(cm1e_py_session_t *s, void *time_ns)
{
    if (!s->bus)
        return CM1E_ERROR_STATE;
    *(int64_t *)time_ns = s->scheduler ? cm1e_scheduler_time_ns(s->scheduler) : 0;
    return CM1E_OK;
}

cm1e_error_t cm1e_py_time(cm1e_py_session_t *session, int64_t *time_ns)
{
    return py_owner_do(session, read_time, time_ns);
}

cm1e_error_t cm1e_py_statistics(cm1e_py_session_t *s, cm1e_scheduler_statistics_t *statistics)
{
    pthread_mutex_lock(&s->mutex);
    const cm1e_error_t error = s->scheduler ? CM1E_OK : CM1E_ERROR_STATE;
    if (error == CM1E_OK)
        cm1e_scheduler_statistics(s->scheduler, statistics);
    pthread_mutex_unlock(&s->mutex);
    return error;
}

cm1e_error_t cm1e_py_log(cm1e_py_session_t *s, uint64_t after, cm1e_log_event_t *event, char *text, size_t size)
{
    cm1e_error_t error = CM1E_ERROR_STATE;
    pthread_mutex_lock(&s->mutex);
    if (s->scheduler)
        error = cm1e_log_read(s->scheduler, after, event, 1, NULL) == 1 ? CM1E_OK : CM1E_ERROR_NOT_FOUND;
    if (error == CM1E_OK)
        cm1e_log_text(s->scheduler, event, text, size);
    pthread_mutex_unlock(&s->mutex);
    return error;
}

static cm1e_error_t write_trace(const cm1e_py_session_t *s, const char *format, const char *path, cm1e_diag_t *diag)
{
    static const struct {
        const char *format;
        cm1e_error_t (*write)(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag);
    } writers[] = {{"npy", cm1e_scheduler_write_npy}, {"csv", cm1e_scheduler_write_csv},
                   {"svg", cm1e_scheduler_write_svg}, {"html", cm1e_scheduler_write_html}};
    for (size_t i = 0; i < sizeof writers / sizeof writers[0]; i++)
        if (strcmp(writers[i].format, format) == 0)
            return writers[i].write(s->scheduler, path, diag);
    return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "\"%s\" is no format of a trace; there are npy, csv, svg "
                         "and html.", format);
}

cm1e_error_t cm1e_py_write_trace(cm1e_py_session_t *s, const char *format, const char *path, cm1e_diag_t *diag)
{
    cm1e_error_t error;
    pthread_mutex_lock(&s->mutex);
    if (!s->scheduler)
        error = cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "There is no trace: the bus was not started, or is closed.");
    else if (!s->waits)
        error = cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "In real time the trace can be had when the run has ended: stop "
                              "the bus first. Meanwhile attach to the program.");
    else
        error = write_trace(s, format, path, diag);
    pthread_mutex_unlock(&s->mutex);
    return error;
}

cm1e_error_t cm1e_py_trace_object(cm1e_py_session_t *s, const char *axis, uint16_t index, uint8_t subindex,
                                  cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    pthread_mutex_lock(&s->mutex);
    if (s->ran || s->traced_count == PY_TRACED || strlen(axis) >= sizeof s->traced[0].axis) {
        error = cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Objects are named before the bus is started, at most %d.",
                              PY_TRACED);
    } else {
        py_traced_t *traced = &s->traced[s->traced_count++];
        strcpy(traced->axis, axis);
        traced->index = index;
        traced->subindex = subindex;
    }
    pthread_mutex_unlock(&s->mutex);
    return error;
}
