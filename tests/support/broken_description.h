/* A good description broken in one way: what tests of rules share. Every part of the good ones has a place of its own,
 * so that a test sees that a finding stands where the mistake is. */
#ifndef CM1E_TESTS_BROKEN_DESCRIPTION_H
#define CM1E_TESTS_BROKEN_DESCRIPTION_H

#include <stdio.h>
#include <string.h>

#include "description/check.h"
#include "description/describe.h"
#include "unity.h"

/* Breaks the first device of a file and says where the finding has to be. */
typedef cm1e_place_t (*break_t)(cm1e_description_file_t *file);

/* A rule, what breaks it, and the sentence that says so. */
typedef struct broken {
    cm1e_rule_t rule;
    break_t breaks;
    const char *text;
} broken_t;
/* tests/style/test_docs.py knows by this, or by the enumerator, which rules are proved. */
#define BREAKS(rule, function, text) {CM1E_RULE_##rule, function, text}

#define RULE_NAME_ROW(enumerator, name, is_error) [CM1E_RULE_##enumerator] = name,

/* ---- places ------------------------------------------------------------------------------------------------------ */

void number_places(cm1e_description_file_t *file);

/* ---- parts to break ---------------------------------------------------------------------------------------------- */

cm1e_described_object_t *object_in(cm1e_object_list_t *objects, uint16_t index);

cm1e_described_entry_t *entry_in(cm1e_object_list_t *objects, uint16_t index, uint8_t subindex);

cm1e_described_pdo_t *pdo_in(cm1e_pdo_list_t *pdos, uint16_t index);

cm1e_described_pdo_entry_t *pdo_entry_in(cm1e_pdo_list_t *pdos, uint16_t pdo_index, uint16_t index);

void set_default(cm1e_description_file_t *file, cm1e_described_entry_t *entry, int64_t value);

cm1e_init_command_t *add_command(cm1e_description_file_t *file, uint16_t index, uint8_t subindex,
                                 int64_t value, size_t bytes);

/* ---- judging ----------------------------------------------------------------------------------------------------- */

void print_findings(const cm1e_findings_t *findings);

void assert_one_finding(const cm1e_description_file_t *file, cm1e_rule_t rule, cm1e_place_t place,
                        const char *text);

void assert_no_finding(const cm1e_description_file_t *file);

/* A row of a table of broken descriptions against the good one it starts from. */
void assert_found(const broken_t *broken, void (*make_good)(cm1e_description_file_t *file));

#endif
