/**
 * @file fuzz.h
 * What the fuzz targets share. A target is one file fuzz_<format>.c with fuzz_rewrite() and fuzz_seeds(); CMake finds
 * it (preset `fuzz`), scripts/fuzz runs all of them. An input that can be read goes through the checker and through
 * write, read, write: the second time must give the same bytes. fuzz_frames.c has no format: it rewrites nothing.
 */
#ifndef CM1E_TESTS_FUZZ_H
#define CM1E_TESTS_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "cm1e/generate.h"
#include "description/check.h"

/** Every target's: reads the format, checks it, writes it anew. False: it cannot be read or written, and `written` holds
 *  nothing. `must`: our own writer wrote it, so that this would be a finding. */
bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must);

/** Every target's: hands its good files to fuzz_seed(), made by our own writers. */
void fuzz_seeds(void);
void fuzz_seed(const char *name, const void *bytes, size_t size);
/** Hands a file of the project to it, by its path from the root. */
void fuzz_seed_file(const char *path);
/** The input as a file, for readers that take a path: valid until the next call. */
const char *fuzz_file(const uint8_t *bytes, size_t size);
/** A text for a user says something, within its line. */
void fuzz_use_text(const char *text);

/** Device options that between them show everything that a description can hold: model, firmware, mapping ... */
const cm1e_device_options_t *fuzz_devices(size_t *count);

/** The next bytes of an input as a number, least significant first; behind its end 0. */
unsigned fuzz_take(const uint8_t **at, const uint8_t *end, unsigned bytes);
/** Any double: what no program should give (NaN, infinity, denormal, huge), plain numbers, or eight bytes as they are. */
double fuzz_take_real(const uint8_t **at, const uint8_t *end);

/** A finding: says what is wrong, and ends the program so that libFuzzer keeps the input. */
_Noreturn void fuzz_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
/** Empty ones, for fuzz_use_findings(). */
cm1e_findings_t *fuzz_findings(void);
/** Sorts findings, reads every byte of each, and frees them. */
void fuzz_use_findings(cm1e_findings_t *findings);

#endif
