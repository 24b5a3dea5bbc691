/**
 * @file esi_judge.h
 * An ESI under test (Unity): written, asked by XPath, validated by ETG's schemas. One test program includes it once.
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

static cm1e_description_file_t description;
static cm1e_file_t file;
static cm1e_diag_t diag;
static xmlDoc *document;

void setUp(void)
{
    description = (cm1e_description_file_t){0};
    file = (cm1e_file_t){0};
    diag = (cm1e_diag_t){0};
    document = NULL;
}

void tearDown(void)
{
    xmlFreeDoc(document);
    cm1e_file_free(&file);
    cm1e_description_file_free(&description);
}

static void write_file(void)
{
    cm1e_file_free(&file);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_esi_write(&file, &description, &diag), diag.text);
    xmlFreeDoc(document);
    document = xmlReadMemory((const char *)file.bytes, (int)file.size, "esi", NULL, XML_PARSE_NONET);
    TEST_ASSERT_NOT_NULL(document);
}

/* ---- asking the document ---------------------------------------------------------------------------------------- */

static xmlXPathObject *ask(const char *format, va_list arguments)
{
    char query[512];
    vsnprintf(query, sizeof query, format, arguments);
    xmlXPathContext *context = xmlXPathNewContext(document);
    xmlXPathObject *answer = xmlXPathEvalExpression(BAD_CAST query, context);
    xmlXPathFreeContext(context);
    TEST_ASSERT_NOT_NULL_MESSAGE(answer, query);
    return answer;
}

/* How many nodes there are. */
__attribute__((format(printf, 1, 2))) static inline int count(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    xmlXPathObject *answer = ask(format, arguments);
    va_end(arguments);
    const int nodes = answer->nodesetval ? answer->nodesetval->nodeNr : 0;
    xmlXPathFreeObject(answer);
    return nodes;
}

/* The text of the one node that is meant; "?" where there is none, "??" where there are several. */
__attribute__((format(printf, 1, 2))) static inline const char *text(const char *format, ...)
{
    static char texts[8][256];
    static unsigned turn;
    char *into = texts[turn++ % 8];
    va_list arguments;
    va_start(arguments, format);
    xmlXPathObject *answer = ask(format, arguments);
    va_end(arguments);
    const int nodes = answer->nodesetval ? answer->nodesetval->nodeNr : 0;
    xmlChar *content = nodes == 1 ? xmlNodeGetContent(answer->nodesetval->nodeTab[0]) : NULL;
    snprintf(into, sizeof texts[0], "%s", content ? (const char *)content : nodes == 0 ? "?" : "??");
    xmlFree(content);
    xmlXPathFreeObject(answer);
    return into;
}

static inline int number(const char *said) { return said[0] == '#' ? (int)strtol(said + 2, NULL, 16) : atoi(said); }

#define DEVICE "/EtherCATInfo/Descriptions/Devices/Device"
#define MODULE "/EtherCATInfo/Descriptions/Modules/Module"
#define DICTIONARY DEVICE "/Profile/Dictionary"

/* ---- ETG's schemas ---------------------------------------------------------------------------------------------- */

static xmlSchema *schema;

static void note_error(void *context, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(context, 512, format, arguments);
    va_end(arguments);
}

/* ETG's terms forbid to hand them on with the project: where there are none, the tests that need them say so. */
static void load_schema(void)
{
    const char *folder = getenv("CM1E_ESI_SCHEMAS");
    char path[512];
    snprintf(path, sizeof path, "%s/EtherCATInfo.xsd", folder ? folder : CM1E_SOURCE_DIR "/../shared/schemas");
    if (access(path, R_OK) != 0)
        return;
    xmlSchemaParserCtxt *context = xmlSchemaNewParserCtxt(path);
    schema = xmlSchemaParse(context);
    xmlSchemaFreeParserCtxt(context);
}

static void free_schema(void)
{
    xmlSchemaFree(schema);
    xmlCleanupParser();
}

/* "": valid; otherwise the last error. */
static const char *schema_error(void)
{
    static char error[512];
    error[0] = '\0';
    xmlSchemaValidCtxt *context = xmlSchemaNewValidCtxt(schema);
    xmlSchemaSetValidErrors(context, note_error, note_error, error);
    const int result = xmlSchemaValidateDoc(context, document);
    xmlSchemaFreeValidCtxt(context);
    return result == 0 ? "" : error[0] ? error : "not valid";
}

#endif
