#include "generate/xml_read.h"

#include <ctype.h>
#include <libxml/SAX2.h>
#include <libxml/parser.h>
#include <libxml/parserInternals.h>
#include <libxml/xpath.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char bom[] = "\xEF\xBB\xBF";
enum { MAX_DEPTH = 100, MAX_TAG_BYTES = 65536, LONGEST_NUMBER = 64 };

/* Limits of the parser beyond the rules of XML. */
typedef struct guard {
    size_t parts;        /* elements, attributes, comments so far */
    const char *refused; /* why, NULL: not refused */
    int line;
    /* The parser's first error; those behind it follow from it, and libxml2 itself keeps the last one. */
    int first_code, first_line;
    char first[256];
} guard_t;

static pthread_once_t once = PTHREAD_ONCE_INIT;

static void refuse(xmlParserCtxt *context, const char *why)
{
    guard_t *guard = context->_private;
    if (!guard->refused) {
        guard->refused = why;
        guard->line = context->input ? context->input->line : 0;
    }
    xmlStopParser(context);
}

/* False: there are too many by now. */
static bool count_parts(xmlParserCtxt *context, size_t parts)
{
    guard_t *guard = context->_private;
    guard->parts += parts;
    if (guard->parts <= CM1E_XML_MAX_PARTS)
        return true;
    refuse(context, "more elements than any such file has");
    return false;
}

/* A DTD can define entities and external files; none of the formats has one. */
static void on_dtd(void *context, const xmlChar *name, const xmlChar *external, const xmlChar *system)
{
    (void)name, (void)external, (void)system;
    refuse(context, "a DTD (<!DOCTYPE ...>) is not allowed here");
}

/* Keeps the line with the node: libxml2's own count ends at 65535. */
static void on_element(void *data, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri, int namespaces,
                       const xmlChar **namespace_list, int attributes, int defaulted, const xmlChar **attribute_list)
{
    xmlParserCtxt *context = data;
    if (context->nodeNr >= MAX_DEPTH)
        refuse(context, "elements within elements deeper than any such file has");
    else if (count_parts(context, 1 + (size_t)namespaces + (size_t)attributes)) {
        xmlSAX2StartElementNs(context, name, prefix, uri, namespaces, namespace_list, attributes, defaulted,
                              attribute_list);
        if (context->node && context->input)
            context->node->_private = (void *)(intptr_t)context->input->line;
    }
}

static void on_comment(void *context, const xmlChar *text)
{
    if (count_parts(context, 1))
        xmlSAX2Comment(context, text);
}

static void on_instruction(void *context, const xmlChar *target, const xmlChar *text)
{
    if (count_parts(context, 1))
        xmlSAX2ProcessingInstruction(context, target, text);
}

/* libxml2 reports some errors of encodings without a parser, which would print them. */
static void on_error(void *context, xmlError *error)
{
    (void)context, (void)error;
}

/* As XML's own handler of errors: `data` is the parser. */
static void on_parser_error(void *data, xmlError *error)
{
    guard_t *guard = ((xmlParserCtxt *)data)->_private;
    if (error->level < XML_ERR_ERROR || guard->first_code != 0)
        return;
    guard->first_code = error->code;
    guard->first_line = error->line;
    snprintf(guard->first, sizeof guard->first, "%s", error->message ? error->message : "");
    guard->first[strcspn(guard->first, "\n")] = '\0';
}

static const char *find(const char *text, size_t size, const char *what)
{
    return memmem(text, size, what, strlen(what));
}

static int lines_in(const char *text, size_t size)
{
    int lines = 0;
    for (size_t i = 0; i < size; i++)
        lines += text[i] == '\n';
    return lines;
}

/* Files of Trio's tools have comments before the XML declaration, where XML allows nothing. Returns where the document
 * begins. */
static size_t skip_before_declaration(const char *text, size_t size, bool is_utf8)
{
    size_t at = is_utf8 ? sizeof bom - 1 : 0;
    for (;;) {
        while (at < size && isspace((unsigned char)text[at]))
            at++;
        if (size - at < 4 || memcmp(text + at, "<!--", 4) != 0)
            break;
        const char *end = find(text + at + 4, size - at - 4, "-->");
        if (!end)
            break;
        at = (size_t)(end - text) + 3;
    }
    const bool declared = size - at >= 5 && memcmp(text + at, "<?xml", 5) == 0;
    return declared ? at : 0; /* no declaration behind them: they are where XML allows them */
}

/* Where a tag is longer than any: libxml2 compares each attribute with each. `size`: nowhere. */
static size_t endless_tag(const char *text, size_t size)
{
    for (const char *at = text, *const end = text + size; (at = memchr(at, '<', (size_t)(end - at))) != NULL; at++) {
        const char *next = at + 1;
        while (next < end && *next == '\0') /* UTF-16 */
            next++;
        if (next < end && *next != '!' && *next != '?' && (size_t)(end - at) > MAX_TAG_BYTES &&
            !memchr(at, '>', MAX_TAG_BYTES))
            return (size_t)(at - text);
    }
    return size;
}

/* The comments that were skipped stand before the root then, where XML allows them: nothing of a file is lost. */
static void keep_comments(xmlDoc *doc, const char *text, size_t skipped)
{
    const char *const behind = text + skipped;
    for (const char *at = text; (at = find(at, (size_t)(behind - at), "<!--")) != NULL;) {
        const char *end = find(at + 4, (size_t)(behind - at) - 4, "-->");
        xmlChar *content = xmlStrndup((const xmlChar *)at + 4, (int)(end - at) - 4);
        xmlNode *comment = content ? xmlNewDocComment(doc, content) : NULL;
        if (comment)
            xmlAddPrevSibling(xmlDocGetRootElement(doc), comment);
        xmlFree(content);
        at = end + 3;
    }
}

static void report(cm1e_diag_t *diag, const guard_t *guard)
{
    if (guard->refused)
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "line %d: %s", guard->line, guard->refused);
    else
        cm1e_diag_set(diag, guard->first_code == XML_ERR_NO_MEMORY ? CM1E_ERROR_NO_MEMORY : CM1E_ERROR_FILE, 0,
                      "line %d: %s", guard->first_line > 0 ? guard->first_line : 1,
                      guard->first[0] ? guard->first : "no XML document");
}

/* A parser of its own for every document; `line` is the number of its first. */
static xmlDoc *parse(const char *text, size_t size, int line, bool is_utf8, cm1e_diag_t *diag)
{
    xmlParserCtxt *context = xmlCreateMemoryParserCtxt(text, (int)size);
    if (!context) {
        cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
        return NULL;
    }
    guard_t guard = {0};
    context->_private = &guard;
    context->sax->internalSubset = on_dtd;
    context->sax->startElementNs = on_element;
    context->sax->comment = on_comment;
    context->sax->processingInstruction = on_instruction;
    context->input->line = line;
    xmlCtxtUseOptions(context, XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_NOCDATA |
                                   XML_PARSE_NOBLANKS | XML_PARSE_COMPACT | (is_utf8 ? XML_PARSE_IGNORE_ENC : 0));
    context->sax->serror = on_parser_error;
    xmlParseDocument(context);
    xmlDoc *doc = context->myDoc;
    if (!context->wellFormed || guard.refused || !doc || !xmlDocGetRootElement(doc)) {
        report(diag, &guard);
        xmlFreeDoc(doc);
        doc = NULL;
    }
    xmlFreeParserCtxt(context);
    return doc;
}

xmlDoc *cm1e_xml_parse(const void *bytes, size_t size, cm1e_diag_t *diag)
{
    const char *text = bytes;
    if (size == 0 || size > CM1E_XML_MAX_BYTES) {
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "the file has %zu bytes; files of 1 to %zu are read", size,
                      CM1E_XML_MAX_BYTES);
        return NULL;
    }
    const size_t endless = endless_tag(text, size);
    if (endless < size) {
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "line %d: a tag without an end", 1 + lines_in(text, endless));
        return NULL;
    }
    const bool is_utf8 = size >= sizeof bom - 1 && memcmp(text, bom, sizeof bom - 1) == 0;
    const size_t skipped = skip_before_declaration(text, size, is_utf8);
    pthread_once(&once, xmlInitParser);
    const xmlStructuredErrorFunc handler = xmlStructuredError;
    void *handler_context = xmlStructuredErrorContext;
    xmlSetStructuredErrorFunc(NULL, on_error);
    xmlDoc *doc = parse(text + skipped, size - skipped, 1 + lines_in(text, skipped), is_utf8, diag);
    if (doc)
        keep_comments(doc, text, skipped);
    xmlSetStructuredErrorFunc(handler_context, handler);
    return doc;
}

void cm1e_xml_fail(cm1e_xml_reader_t *reader, const xmlNode *node, const char *format, ...)
{
    char text[400];
    va_list arguments;
    if (reader->failed)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    cm1e_diag_set(reader->diag, CM1E_ERROR_FILE, 0, "line %u: %s", (unsigned)cm1e_xml_line(node), text);
    reader->failed = true;
}

cm1e_place_t cm1e_xml_line(const xmlNode *node)
{
    return node && node->type == XML_ELEMENT_NODE ? (cm1e_place_t)(uintptr_t)node->_private : 0;
}

bool cm1e_xml_is(const xmlNode *node, const char *name)
{
    return node && node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0;
}

static const xmlNode *first_element(const xmlNode *node, const char *name)
{
    while (node && !(node->type == XML_ELEMENT_NODE && (!name || cm1e_xml_is(node, name))))
        node = node->next;
    return node;
}

const xmlNode *cm1e_xml_child(const xmlNode *parent, const char *name)
{
    return parent ? first_element(parent->children, name) : NULL;
}

const xmlNode *cm1e_xml_next(const xmlNode *node, const char *name)
{
    return node ? first_element(node->next, name) : NULL;
}

const xmlNode *cm1e_xml_need(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name)
{
    const xmlNode *child = cm1e_xml_child(parent, name);
    if (parent && !child)
        cm1e_xml_fail(reader, parent, "<%s> has no <%s>", (const char *)parent->name, name);
    return child;
}

/* The text of an element, or of an attribute, without white space around it, freed by the caller with `*content`. */
static const char *trimmed(xmlChar *content, size_t *length)
{
    const char *begin = content ? (const char *)content : "";
    while (isspace((unsigned char)*begin))
        begin++;
    *length = strlen(begin);
    while (*length > 0 && isspace((unsigned char)begin[*length - 1]))
        --*length;
    return begin;
}

/* Takes the content over. */
static const char *kept(cm1e_xml_reader_t *reader, xmlChar *content)
{
    size_t length;
    const char *begin = trimmed(content, &length);
    char *copy = cm1e_arena_take(reader->arena, length + 1);
    const bool copied = !reader->arena->failed;
    if (copied)
        memcpy(copy, begin, length);
    xmlFree(content);
    return copied ? copy : "";
}

/* Takes over the contents; a text that is too long for a number is cut, so that it is not a number. */
static const char *word(char text[LONGEST_NUMBER], xmlChar *content)
{
    size_t length;
    const char *begin = trimmed(content, &length);
    if (length < LONGEST_NUMBER)
        snprintf(text, LONGEST_NUMBER, "%.*s", (int)length, begin);
    else
        snprintf(text, LONGEST_NUMBER, "%.40s...", begin);
    xmlFree(content);
    return text;
}

static xmlChar *attribute(const xmlNode *node, const char *name)
{
    return node ? xmlGetNoNsProp(node, (const xmlChar *)name) : NULL;
}

const char *cm1e_xml_text(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    return node ? kept(reader, xmlNodeGetContent(node)) : NULL;
}

const char *cm1e_xml_child_text(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name,
                                const char *fallback)
{
    const xmlNode *child = cm1e_xml_child(parent, name);
    return child ? cm1e_xml_text(reader, child) : fallback;
}

const char *cm1e_xml_comment(cm1e_xml_reader_t *reader, const xmlNode *root)
{
    const xmlNode *found = NULL;
    for (const xmlNode *node = root->prev; node; node = node->prev)
        if (node->type == XML_COMMENT_NODE)
            found = node;
    return cm1e_xml_text(reader, found);
}

const char *cm1e_xml_attribute(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name)
{
    xmlChar *value = attribute(node, name);
    return value ? kept(reader, value) : NULL;
}

/* A number beyond 64 bits is the nearest within. */
static bool parse_number(const char *text, int64_t *value)
{
    const bool hexadecimal = (text[0] == '#' || text[0] == '0') && (text[1] == 'x' || text[1] == 'X');
    const char *digits = hexadecimal ? text + 2 : text + (*text == '-' || *text == '+');
    char *end;
    if (!(hexadecimal ? isxdigit((unsigned char)*digits) : isdigit((unsigned char)*digits)))
        return false;
    *value = strtoll(hexadecimal ? digits : text, &end, hexadecimal ? 16 : 10);
    return *end == '\0';
}

static int64_t checked_number(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, const char *text,
                              int64_t minimum, int64_t maximum, int64_t fallback)
{
    int64_t value;
    if (!parse_number(text, &value))
        cm1e_xml_fail(reader, node, "%s is \"%.60s\", which is no number: 26, #x1A and 0x1A are", name, text);
    else if (value < minimum || value > maximum)
        cm1e_xml_fail(reader, node, "%s is %.60s, outside %lld ... %lld", name, text, (long long)minimum,
                      (long long)maximum);
    else
        return value;
    return fallback;
}

int64_t cm1e_xml_number(cm1e_xml_reader_t *reader, const xmlNode *node, int64_t minimum, int64_t maximum,
                        int64_t fallback)
{
    char text[LONGEST_NUMBER];
    if (!node)
        return fallback;
    return checked_number(reader, node, (const char *)node->name, word(text, xmlNodeGetContent(node)), minimum,
                          maximum, fallback);
}

int64_t cm1e_xml_child_number(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, int64_t minimum,
                              int64_t maximum, int64_t fallback)
{
    return cm1e_xml_number(reader, cm1e_xml_child(parent, name), minimum, maximum, fallback);
}

int64_t cm1e_xml_attribute_number(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, int64_t minimum,
                                  int64_t maximum, int64_t fallback)
{
    char text[LONGEST_NUMBER];
    xmlChar *value = attribute(node, name);
    return value ? checked_number(reader, node, name, word(text, value), minimum, maximum, fallback) : fallback;
}

bool cm1e_xml_real(const char *text, double *number)
{
    *number = xmlXPathCastStringToNumber((const xmlChar *)text);
    return !isnan(*number);
}

static bool parse_flag(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, const char *text,
                       bool fallback)
{
    if (strcmp(text, "1") == 0 || strcasecmp(text, "true") == 0)
        return true;
    if (strcmp(text, "0") == 0 || strcasecmp(text, "false") == 0)
        return false;
    cm1e_xml_fail(reader, node, "%s is \"%.60s\"; true, false, 1 and 0 are allowed", name, text);
    return fallback;
}

bool cm1e_xml_attribute_flag(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, bool fallback)
{
    char text[LONGEST_NUMBER];
    xmlChar *value = attribute(node, name);
    return value ? parse_flag(reader, node, name, word(text, value), fallback) : fallback;
}

bool cm1e_xml_child_flag(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, bool fallback)
{
    char text[LONGEST_NUMBER];
    const xmlNode *child = cm1e_xml_child(parent, name);
    return child ? parse_flag(reader, child, name, word(text, xmlNodeGetContent(child)), fallback) : fallback;
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

cm1e_bytes_t cm1e_xml_hex(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    const char *text = cm1e_xml_text(reader, node);
    uint8_t *bytes = text && *text ? cm1e_arena_take(reader->arena, strlen(text) / 2 + 1) : NULL;
    size_t digits = 0;
    if (!bytes || reader->arena->failed)
        return (cm1e_bytes_t){0};
    for (; *text; text++) {
        const int digit = hex_digit(*text);
        if (isspace((unsigned char)*text))
            continue;
        if (digit < 0) {
            cm1e_xml_fail(reader, node, "%s is not hexadecimal bytes: \"%.20s\"", (const char *)node->name, text);
            return (cm1e_bytes_t){0};
        }
        bytes[digits / 2] = (uint8_t)(bytes[digits / 2] << 4 | digit);
        digits++;
    }
    if (digits % 2) {
        cm1e_xml_fail(reader, node, "%s has an odd number of hexadecimal digits", (const char *)node->name);
        return (cm1e_bytes_t){0};
    }
    return (cm1e_bytes_t){bytes, digits / 2};
}
