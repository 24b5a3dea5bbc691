#include "esi_judge.h"

cm1e_description_file_t description;
cm1e_file_t file;
cm1e_diag_t diag;
xmlDoc *document;

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

void write_file(void)
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

int count(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    xmlXPathObject *answer = ask(format, arguments);
    va_end(arguments);
    const int nodes = answer->nodesetval ? answer->nodesetval->nodeNr : 0;
    xmlXPathFreeObject(answer);
    return nodes;
}

const char *text(const char *format, ...)
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

int number(const char *said) { return said[0] == '#' ? (int)strtol(said + 2, NULL, 16) : atoi(said); }

/* ---- ETG's schemas ---------------------------------------------------------------------------------------------- */

xmlSchema *schema;

static void note_error(void *context, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(context, 512, format, arguments);
    va_end(arguments);
}

void load_schema(void)
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

void free_schema(void)
{
    xmlSchemaFree(schema);
    xmlCleanupParser();
}

const char *schema_error(void)
{
    static char error[512];
    error[0] = '\0';
    xmlSchemaValidCtxt *context = xmlSchemaNewValidCtxt(schema);
    xmlSchemaSetValidErrors(context, note_error, note_error, error);
    const int result = xmlSchemaValidateDoc(context, document);
    xmlSchemaFreeValidCtxt(context);
    return result == 0 ? "" : error[0] ? error : "not valid";
}
