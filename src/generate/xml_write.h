/**
 * @file xml_write.h
 * Writing XML with libxml2: UTF-8, two spaces an indent, one element a line, the same bytes every time. The first error
 * sticks; cm1e_xml_finish() reports it.
 */
#ifndef CM1E_GENERATE_XML_WRITE_H
#define CM1E_GENERATE_XML_WRITE_H

#include <libxml/xmlwriter.h>

#include "cm1e/generate.h"
#include "description/description.h"

typedef struct cm1e_xml_writer {
    xmlBuffer *buffer;
    xmlTextWriter *writer;
    bool failed;
} cm1e_xml_writer_t;

/** Begins a document, with its XML declaration. */
void cm1e_xml_begin(cm1e_xml_writer_t *writer);
/** Ends it and hands over the bytes; CM1E_ERROR_NO_MEMORY where something failed. Frees the writer in any case. */
cm1e_error_t cm1e_xml_finish(cm1e_xml_writer_t *writer, cm1e_file_t *file, cm1e_diag_t *diag);

void cm1e_xml_open(cm1e_xml_writer_t *writer, const char *name);
void cm1e_xml_close(cm1e_xml_writer_t *writer);
/** An attribute of the element just opened. Bytes that are no UTF-8 count as ISO-8859-1; control characters are left
 *  out: XML has no way to write them. */
void cm1e_xml_put_attribute(cm1e_xml_writer_t *writer, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/** Text of the element just opened. */
void cm1e_xml_put_text(cm1e_xml_writer_t *writer, const char *format, ...) __attribute__((format(printf, 2, 3)));
/** An element with a text: <name>text</name>. */
void cm1e_xml_put(cm1e_xml_writer_t *writer, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/** xs:hexBinary as the text of the element just opened. */
void cm1e_xml_put_hex_text(cm1e_xml_writer_t *writer, cm1e_bytes_t bytes);
/** An element with xs:hexBinary; nothing is written where there are no bytes. */
void cm1e_xml_put_hex(cm1e_xml_writer_t *writer, const char *name, cm1e_bytes_t bytes);
/** A comment; "--" in it, which XML forbids, becomes "- -". */
void cm1e_xml_put_comment(cm1e_xml_writer_t *writer, const char *text);

#endif
