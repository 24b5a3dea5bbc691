#include "st_located.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_output(const st_variable_t *variable) { return (variable->detail[1] | 0x20) == 'q'; }

static cm1e_io_type_t io_type(const st_variable_t *variable)
{
    static const cm1e_io_type_t types[] = {
        [ST_KIND_BOOL] = CM1E_IO_BOOL, [ST_KIND_SINT] = CM1E_IO_SINT, [ST_KIND_INT] = CM1E_IO_INT,
        [ST_KIND_DINT] = CM1E_IO_DINT, [ST_KIND_LINT] = CM1E_IO_LINT, [ST_KIND_USINT] = CM1E_IO_USINT,
        [ST_KIND_UINT] = CM1E_IO_UINT, [ST_KIND_UDINT] = CM1E_IO_UDINT, [ST_KIND_ULINT] = CM1E_IO_ULINT,
        [ST_KIND_REAL] = CM1E_IO_REAL, [ST_KIND_LREAL] = CM1E_IO_LREAL,
    };
    return types[variable->kind]; /* the translator lets no other through */
}

/** At least one of the bits has a meaning, or nobody knows what the slave has there. */
static bool is_mapped(const cm1e_bus_t *bus, unsigned slave, bool output, unsigned first, unsigned bits)
{
    cm1e_io_info_t info;
    bool any = false;
    for (uint32_t n = 0; cm1e_io_at(bus, n, &info); n++) {
        if (info.position != slave || info.output != output)
            continue;
        any = true;
        if (first < info.bit_offset + info.bits && info.bit_offset < first + bits)
            return true;
    }
    return !any;
}

static cm1e_error_t find(const st_variable_t *variable, cm1e_bus_t *bus, cm1e_io_t *io, cm1e_diag_t *diag)
{
    const char *at = variable->detail + 2;
    unsigned slave = 0, byte = 0, bit = 0;
    cm1e_diag_t why = {0};
    at += *at < '0' || *at > '9';
    sscanf(at, "%u.%u.%u", &slave, &byte, &bit);
    const uint16_t bits = variable->kind == ST_KIND_BOOL ? 1 : (uint16_t)(variable->size * 8);
    const cm1e_error_t error = cm1e_io_find_bits(bus, (uint16_t)slave, is_output(variable), byte * 8 + bit, bits,
                                                 io_type(variable), io, &why);
    if (error == CM1E_OK && is_mapped(bus, slave, is_output(variable), byte * 8 + bit, bits))
        return CM1E_OK;
    if (error == CM1E_OK)
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "%s AT %s: slave %u has only padding there, which means nothing; "
                             "`cm1e io` lists its signals", variable->name, variable->detail, slave);
    return cm1e_diag_set(diag, error, 0, "%s AT %s: %s", variable->name, variable->detail,
                         why.text[0] ? why.text : cm1e_strerror(error));
}

cm1e_error_t st_located_find(st_located_t *located, const st_list_t *variables, cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    located->variables = variables->first;
    located->signals = calloc(variables->count + 1, sizeof *located->signals);
    if (!located->signals)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "%s", cm1e_strerror(CM1E_ERROR_NO_MEMORY));
    for (uint32_t i = 0; i < variables->count && error == CM1E_OK; i++)
        error = find(&variables->first[i], bus, &located->signals[i], diag);
    located->count = error == CM1E_OK ? variables->count : 0;
    return error;
}

void st_located_free(st_located_t *located)
{
    free(located->signals);
    *located = (st_located_t){0};
}

void st_located_read(const st_located_t *located)
{
    for (uint32_t i = 0; i < located->count; i++) {
        const st_variable_t *variable = &located->variables[i];
        if (is_output(variable) || cm1e_io_quality(&located->signals[i]) == CM1E_IO_INVALID)
            continue;
        if (variable->kind == ST_KIND_BOOL)
            *(uint8_t *)variable->data = cm1e_io_bool(&located->signals[i]);
        else
            cm1e_io_bytes(&located->signals[i], variable->data, variable->size);
    }
}

void st_located_write(const st_located_t *located)
{
    for (uint32_t i = 0; i < located->count; i++) {
        const st_variable_t *variable = &located->variables[i];
        if (!is_output(variable))
            continue;
        if (variable->kind == ST_KIND_BOOL)
            cm1e_io_set_bool(&located->signals[i], *(const uint8_t *)variable->data != 0);
        else
            cm1e_io_set_bytes(&located->signals[i], variable->data, variable->size);
    }
}
