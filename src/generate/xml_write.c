#include "generate/xml_write.h"

#include <libxml/parserInternals.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const xmlChar *xml(const char *text)
{
    return (const xmlChar *)text;
}

static void note(cm1e_xml_writer_t *writer, int result)
{
    if (result < 0)
        writer->failed = true;
}

void cm1e_xml_begin(cm1e_xml_writer_t *writer)
{
    *writer = (cm1e_xml_writer_t){.buffer = xmlBufferCreate()};
    writer->writer = writer->buffer ? xmlNewTextWriterMemory(writer->buffer, 0) : NULL;
    writer->failed = !writer->writer;
    if (writer->failed)
        return;
    /* Else each element copies the whole file. */
    xmlBufferSetAllocationScheme(writer->buffer, XML_BUFFER_ALLOC_DOUBLEIT);
    note(writer, xmlTextWriterSetIndent(writer->writer, 1));
    note(writer, xmlTextWriterSetIndentString(writer->writer, xml("  ")));
    note(writer, xmlTextWriterStartDocument(writer->writer, "1.0", "UTF-8", NULL));
}

cm1e_error_t cm1e_xml_finish(cm1e_xml_writer_t *writer, cm1e_file_t *file, cm1e_diag_t *diag)
{
    if (!writer->failed)
        note(writer, xmlTextWriterEndDocument(writer->writer));
    if (writer->writer)
        xmlFreeTextWriter(writer->writer);
    const size_t size = writer->buffer ? (size_t)xmlBufferLength(writer->buffer) : 0;
    uint8_t *bytes = writer->failed ? NULL : malloc(size + 1);
    if (bytes) {
        memcpy(bytes, xmlBufferContent(writer->buffer), size);
        bytes[size] = 0;
        file->bytes = bytes;
        file->size = size;
    }
    if (writer->buffer)
        xmlBufferFree(writer->buffer);
    *writer = (cm1e_xml_writer_t){0};
    return bytes ? CM1E_OK : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
}

void cm1e_xml_open(cm1e_xml_writer_t *writer, const char *name)
{
    if (!writer->failed)
        note(writer, xmlTextWriterStartElement(writer->writer, xml(name)));
}

void cm1e_xml_close(cm1e_xml_writer_t *writer)
{
    if (!writer->failed)
        note(writer, xmlTextWriterEndElement(writer->writer));
}

/* Bytes of the character at the beginning of a text, and which it is; what is no UTF-8 counts as ISO-8859-1. */
static int first_character(const unsigned char *text, bool is_utf8, int *character)
{
    int bytes = 4;
    *character = is_utf8 ? xmlGetUTF8Char(text, &bytes) : *text;
    return is_utf8 && *character >= 0 ? bytes : 1;
}

/* A text that XML can hold: UTF-8 without control characters and the like. Freed by the caller; NULL: no memory. */
static xmlChar *clean(const char *format, va_list arguments)
{
    char *text = NULL;
    if (vasprintf(&text, format, arguments) < 0)
        return NULL;
    const bool is_utf8 = xmlCheckUTF8(xml(text)) == 1;
    xmlChar *cleaned = xmlMalloc(2 * strlen(text) + 1), *to = cleaned;
    for (const unsigned char *from = (unsigned char *)text; cleaned && *from;) {
        int character;
        from += first_character(from, is_utf8, &character);
        if (character > 0 && IS_CHAR((unsigned)character))
            to += xmlCopyChar(0, to, character);
    }
    if (cleaned)
        *to = '\0';
    free(text);
    return cleaned;
}

/* `put` is how libxml2 writes the cleaned text. */
#define PUT(writer, format, put)                                                                                    \
    do {                                                                                                            \
        va_list arguments;                                                                                          \
        va_start(arguments, format);                                                                                \
        xmlChar *cleaned = (writer)->failed ? NULL : clean(format, arguments);                                      \
        va_end(arguments);                                                                                          \
        note(writer, cleaned ? (put) : -1);                                                                         \
        xmlFree(cleaned);                                                                                           \
    } while (0)

void cm1e_xml_put_attribute(cm1e_xml_writer_t *writer, const char *name, const char *format, ...)
{
    PUT(writer, format, xmlTextWriterWriteAttribute(writer->writer, xml(name), cleaned));
}

void cm1e_xml_put_text(cm1e_xml_writer_t *writer, const char *format, ...)
{
    PUT(writer, format, xmlTextWriterWriteString(writer->writer, cleaned));
}

void cm1e_xml_put(cm1e_xml_writer_t *writer, const char *name, const char *format, ...)
{
    PUT(writer, format, xmlTextWriterWriteElement(writer->writer, xml(name), cleaned));
}

void cm1e_xml_put_hex_text(cm1e_xml_writer_t *writer, cm1e_bytes_t bytes)
{
    if (!bytes.data || bytes.size == 0)
        return;
    char *digits = malloc(2 * bytes.size + 1);
    for (size_t i = 0; digits && i < bytes.size; i++)
        snprintf(digits + 2 * i, 3, "%02X", bytes.data[i]);
    if (digits)
        cm1e_xml_put_text(writer, "%s", digits);
    else
        writer->failed = true;
    free(digits);
}

void cm1e_xml_put_hex(cm1e_xml_writer_t *writer, const char *name, cm1e_bytes_t bytes)
{
    if (!bytes.data || bytes.size == 0)
        return;
    cm1e_xml_open(writer, name);
    cm1e_xml_put_hex_text(writer, bytes);
    cm1e_xml_close(writer);
}

static void put_comment(cm1e_xml_writer_t *writer, const char *format, ...)
{
    PUT(writer, format, xmlTextWriterWriteComment(writer->writer, cleaned));
}

void cm1e_xml_put_comment(cm1e_xml_writer_t *writer, const char *text)
{
    char *spaced = malloc(2 * strlen(text) + 1), *to = spaced;
    for (; spaced && *text; text++) {
        if (*text == '-' && to > spaced && to[-1] == '-')
            *to++ = ' ';
        *to++ = *text;
    }
    if (spaced) {
        *to = '\0';
        put_comment(writer, " %s ", spaced);
    } else {
        writer->failed = true;
    }
    free(spaced);
}
