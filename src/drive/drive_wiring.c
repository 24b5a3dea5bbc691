/* Signals of other slaves that belong to an axis: see drive_wiring.h. */
#include "drive/drive_wiring.h"

#include <stdlib.h>

static cm1e_error_t wrong(const cm1e_drive_t *drive, const char *name, const char *what, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Axis \"%s\": the signal \"%s\" %s", drive->config->name, name,
                         what);
}

/** Finds one signal; the text of a failure names the axis, too. */
static cm1e_error_t find(const cm1e_drive_t *drive, const char *name, bool output, cm1e_io_t *io, cm1e_diag_t *diag)
{
    cm1e_diag_t why = {0};
    const cm1e_error_t error = cm1e_io_find(drive->bus, name, io, &why);
    if (error != CM1E_OK)
        return cm1e_diag_set(diag, error, why.foreign_code, "Axis \"%s\": %s", drive->config->name, why.text);
    if (io->output == output)
        return CM1E_OK;
    return wrong(drive, name, output ? "is an input of its slave; an output is needed."
                                     : "is an output of its slave; an input is needed.", diag);
}

static cm1e_error_t find_bits(const cm1e_drive_t *drive, const char names[][CM1E_SIGNAL_LENGTH], unsigned count,
                              bool output, cm1e_io_t *ios, cm1e_diag_t *diag)
{
    for (unsigned i = 0; i < count; i++) {
        const cm1e_error_t error = find(drive, names[i], output, &ios[i], diag);
        if (error != CM1E_OK)
            return error;
        if (ios[i].bits != 1)
            return wrong(drive, names[i], "has more than one bit; a single bit is needed: give it a name of its own "
                         "under `slaves`.", diag);
    }
    return CM1E_OK;
}

static cm1e_error_t find_encoder(const cm1e_drive_t *drive, const char *name, cm1e_io_t *io, cm1e_diag_t *diag)
{
    const cm1e_error_t error = find(drive, name, false, io, diag);
    if (error != CM1E_OK)
        return error;
    const cm1e_io_type_t type = (cm1e_io_type_t)io->type;
    if (io->bits >= 2 && io->bits <= 64 && type != CM1E_IO_REAL && type != CM1E_IO_LREAL)
        return CM1E_OK;
    return wrong(drive, name, "is no counter: a whole number of 2 ... 64 bits is needed.", diag);
}

cm1e_error_t cm1e_drive_wire(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    const cm1e_wiring_config_t *config = &drive->config->wiring;
    if (config->input_count == 0 && config->output_count == 0 && config->encoder[0] == '\0')
        return CM1E_OK;
    cm1e_drive_wiring_t *wiring = calloc(1, sizeof *wiring);
    if (!wiring)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the signals of axis \"%s\".",
                             drive->config->name);
    drive->wiring = wiring;
    wiring->input_count = config->input_count;
    wiring->output_count = config->output_count;
    wiring->has_encoder = config->encoder[0] != '\0';
    cm1e_error_t error = find_bits(drive, config->inputs, config->input_count, false, wiring->inputs, diag);
    if (error == CM1E_OK)
        error = find_bits(drive, config->outputs, config->output_count, true, wiring->outputs, diag);
    if (error == CM1E_OK && wiring->has_encoder)
        error = find_encoder(drive, config->encoder, &wiring->encoder, diag);
    return error;
}

void cm1e_drive_wiring_read(cm1e_drive_t *drive)
{
    cm1e_drive_wiring_t *wiring = drive->wiring;
    for (unsigned i = 0; i < wiring->input_count; i++) {
        const uint8_t bit = (uint8_t)(1u << i);
        const cm1e_io_quality_t quality = cm1e_io_quality(&wiring->inputs[i]);
        const bool fresh = quality == CM1E_IO_GOOD, known = fresh || quality == CM1E_IO_STALE;
        wiring->fresh = (uint8_t)(fresh ? wiring->fresh | bit : wiring->fresh & ~bit);
        wiring->known = (uint8_t)(known ? wiring->known | bit : wiring->known & ~bit);
        if (fresh)
            wiring->values = (uint8_t)(cm1e_io_bool(&wiring->inputs[i]) ? wiring->values | bit : wiring->values & ~bit);
    }
}

bool cm1e_drive_wired_reached(const cm1e_drive_t *drive, int n)
{
    const cm1e_io_quality_t quality = cm1e_io_quality(&drive->wiring->outputs[n]);
    return quality == CM1E_IO_GOOD || quality == CM1E_IO_STALE;
}

bool cm1e_drive_wired_write(cm1e_drive_t *drive, int n, bool value, int64_t until_ns)
{
    cm1e_drive_wiring_t *wiring = drive->wiring;
    const uint8_t bit = (uint8_t)(1u << n);
    if (!cm1e_drive_wired_reached(drive, n) || cm1e_io_set_bool(&wiring->outputs[n], value) != CM1E_OK)
        return false;
    const bool holds = value && until_ns != INT64_MAX;
    wiring->held = (uint8_t)(holds ? wiring->held | bit : wiring->held & ~bit);
    wiring->until_ns[n] = until_ns;
    return true;
}

bool cm1e_drive_wired_output_value(const cm1e_drive_t *drive, int n)
{
    return cm1e_io_bool(&drive->wiring->outputs[n]);
}

void cm1e_drive_wired_expire(cm1e_drive_t *drive)
{
    cm1e_drive_wiring_t *wiring = drive->wiring;
    for (unsigned i = 0; i < wiring->output_count; i++) {
        if (!(wiring->held >> i & 1) || drive->now_ns < wiring->until_ns[i])
            continue;
        cm1e_io_set_bool(&wiring->outputs[i], false);
        wiring->held = (uint8_t)(wiring->held & ~(1u << i));
    }
}
