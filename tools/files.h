/**
 * @file files.h
 * Reads and writes whole files for the subcommands.
 */
#ifndef CM1E_TOOLS_FILES_H
#define CM1E_TOOLS_FILES_H

#include <argp.h>
#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/generate.h"

typedef struct input {
    uint8_t *bytes; /**< the caller frees it */
    size_t size;
} input_t;

/** Takes the argument FILE of a command that has just one: for the keys ARGP_KEY_ARG and ARGP_KEY_END of its parser. */
error_t parse_file_word(int key, char *arg, struct argp_state *state, const char **file);

/** Reads a whole file ("-": standard input); false and a complaint: it cannot be read, or is larger than any file that
 *  the library reads. */
bool read_input(const char *path, input_t *input);

/** Writes a whole file ("-": standard output) under a temporary name beside it, then renames it, so that no reader sees
 *  an incomplete file. False and a complaint: it cannot be written. */
bool write_output(const char *path, const void *bytes, size_t size);

/** Both names lead to one file, also one that does not exist yet. */
bool same_file(const char *left, const char *right);

/** The file may be written: `force`, or there is none of this name; false and a complaint: it would be written over. */
bool may_overwrite(const char *path, bool force);

/** Prints findings in the format of compilers, "FILE:LINE: error: text [rule]", and their number; or as JSON. Returns
 *  the exit status: EXIT_FAILED if one of them is an error. */
int print_findings(const char *path, const char *format, const cm1e_findings_t *findings, bool json);
/** "error" or "warning". */
const char *finding_severity(const cm1e_finding_t *finding);
/** The findings as a JSON array; `place` is the key of their lines. */
json_t *findings_as_list(const cm1e_findings_t *findings, const char *place);
/** The JSON object of print_findings(), and its exit status. */
json_t *findings_as_json(const char *path, const char *format, const cm1e_findings_t *findings);
int findings_status(const cm1e_findings_t *findings);

#endif
