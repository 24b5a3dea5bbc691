/**
 * @file params.h
 * The parameters of a motor: the objects of its dictionary that are settings, by name or number.
 */
#ifndef CM1E_TOOLS_PARAMS_H
#define CM1E_TOOLS_PARAMS_H

#include "cm1e/bus.h"
#include "command.h"
#include "device/devices.h"

enum { PARAMS_MAX = 160, PARAM_NAME = 64 };

/** One parameter: its row of the table, and a value. */
typedef struct param {
    const cm1e_entry_t *entry;
    int64_t value;
    size_t line; /**< in a file; 0: none */
} param_t;

typedef struct params {
    size_t count;
    param_t at[PARAMS_MAX];
} params_t;

/** All parameters of a motor, in order of the dictionary; none where the tables of its device name no settings.
 *  `channel`: the connector of a motor behind a bridge, else 0. */
void params_of(const cm1e_slave_info_t *slave, unsigned channel, params_t *params);
/** The parameter may move its motor as soon as it is written, by an input that is on. */
bool param_can_move(const cm1e_entry_t *entry);

/** The parameter of a word: "K47", "h3", "Home offset", "home_offset", "0x60F6:1B", "60F6:1B", "0x60F6:27d". NULL and a
 *  complaint, with the word that may have been meant: there is none. */
const cm1e_entry_t *param_find(const params_t *params, const char *word);

/** "0x60F6:1B" */
const char *param_number(const cm1e_entry_t *entry, char text[16]);
/** "10 ... 100 %, in steps of 100" */
const char *param_range(const cm1e_entry_t *entry, char *text, size_t size);

/** A whole number within the range; false and a complaint otherwise. */
bool param_parse(const cm1e_entry_t *entry, const char *word, int64_t *value);

/** "K47=30"; false and a complaint otherwise. */
bool param_parse_setting(const params_t *params, const char *word, param_t *param);

bool param_read(cm1e_bus_t *bus, uint16_t position, const cm1e_entry_t *entry, int64_t *value, cm1e_diag_t *diag);
/** Writes and reads back. False, with the reason in `diag`: it was refused, or the value that is read back is not what
 *  the device makes of the written one (`kept`). */
bool param_write(cm1e_bus_t *bus, uint16_t position, param_t *param, cm1e_diag_t *diag);

/* ---- files ------------------------------------------------------------------------------------------------------- */

/** What a file says of the device that it is of. */
typedef struct params_head {
    char kind[24], name[32], firmware[32];
    uint32_t serial;
} params_head_t;

/** The file as text; the caller frees it. NULL: out of memory. */
char *params_as_yaml(const params_head_t *head, const params_t *params);

/** The head of a file suits; false, with a complaint: it does not. */
typedef bool (*params_judge_t)(const params_head_t *head, const void *context);

/** Reads a file, first its head, which `judge` accepts or not. False, after a complaint for each fault with its line, or
 *  that of `judge`. `known` are the parameters of the device. */
bool params_read_file(const char *path, const params_t *known, params_judge_t judge, const void *context,
                      params_t *params);

#endif
