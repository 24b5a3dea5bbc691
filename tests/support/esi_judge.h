/**
 * @file esi_judge.h
 * An ESI under test (Unity): written, asked by XPath, validated by ETG's schemas.
 */
#ifndef CM1E_TEST_ESI_JUDGE_H
#define CM1E_TEST_ESI_JUDGE_H

#include <libxml/parser.h>
#include <libxml/xmlschemas.h>
#include <libxml/xpath.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "description/describe.h"
#include "generate/esi.h"
#include "unity.h"

extern cm1e_description_file_t description;
extern cm1e_file_t file;
extern cm1e_diag_t diag;
extern xmlDoc *document;

void write_file(void);

/* ---- asking the document ---------------------------------------------------------------------------------------- */

/* How many nodes there are. */
__attribute__((format(printf, 1, 2))) int count(const char *format, ...);

/* The text of the one node that is meant; "?" where there is none, "??" where there are several. */
__attribute__((format(printf, 1, 2))) const char *text(const char *format, ...);
int number(const char *said);

#define DEVICE "/EtherCATInfo/Descriptions/Devices/Device"
#define MODULE "/EtherCATInfo/Descriptions/Modules/Module"
#define DICTIONARY DEVICE "/Profile/Dictionary"

/* ---- ETG's schemas ---------------------------------------------------------------------------------------------- */

extern xmlSchema *schema;

/* ETG's terms forbid to hand them on with the project: where there are none, the tests that need them say so. */
void load_schema(void);
void free_schema(void);

/* "": valid; otherwise the last error. */
const char *schema_error(void);

#endif
