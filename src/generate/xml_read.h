/**
 * @file xml_read.h
 * Reading XML of strangers with libxml2: no network, no DTD, no entities of its own, bounded in size and number of
 * elements; what real files do is tolerated (a comment before the XML declaration, BOM, ISO-8859-1, CR LF). The first
 * error sticks and names its line, and the reading functions below go on harmlessly after it.
 */
#ifndef CM1E_GENERATE_XML_READ_H
#define CM1E_GENERATE_XML_READ_H

#include <libxml/tree.h>

#include "cm1e/error.h"
#include "description/description.h"

#define CM1E_XML_MAX_BYTES ((size_t)32 << 20)
#define CM1E_XML_MAX_PARTS 1500000 /**< elements, attributes and comments */

/** A tree without white space between elements; only for the functions below. NULL: `diag` says what is wrong in which
 *  line. Free it with xmlFreeDoc(). */
xmlDoc *cm1e_xml_parse(const void *bytes, size_t size, cm1e_diag_t *diag);

typedef struct cm1e_xml_reader {
    cm1e_arena_t *arena;  /**< where texts and bytes go */
    cm1e_diag_t *diag;    /**< takes the first error */
    bool failed;
} cm1e_xml_reader_t;

/** Puts "line n: ..." into the diag, CM1E_ERROR_FILE, unless there is an error already. */
void cm1e_xml_fail(cm1e_xml_reader_t *reader, const xmlNode *node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

cm1e_place_t cm1e_xml_line(const xmlNode *node);
bool cm1e_xml_is(const xmlNode *node, const char *name);
/** First child element of that name (NULL: of any name). NULL: none, or no parent. */
const xmlNode *cm1e_xml_child(const xmlNode *parent, const char *name);
/** Next sibling element of that name (NULL: of any name). */
const xmlNode *cm1e_xml_next(const xmlNode *node, const char *name);
/** As cm1e_xml_child(), and an error where there is none. */
const xmlNode *cm1e_xml_need(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name);

/** The text of an element without white space around it, in the arena; NULL: no such element. */
const char *cm1e_xml_text(cm1e_xml_reader_t *reader, const xmlNode *node);
/** The text of a child; `fallback` where there is no such child. */
const char *cm1e_xml_child_text(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name,
                                const char *fallback);
/** The text of the first comment before the root element; NULL: there is none. */
const char *cm1e_xml_comment(cm1e_xml_reader_t *reader, const xmlNode *root);
/** NULL: no such attribute. */
const char *cm1e_xml_attribute(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name);

/** A number: decimal with or without sign, #x1A or 0x1A. An error where it is none or outside [minimum, maximum];
 *  `fallback` then, and where there is no such element. */
int64_t cm1e_xml_number(cm1e_xml_reader_t *reader, const xmlNode *node, int64_t minimum, int64_t maximum,
                        int64_t fallback);
int64_t cm1e_xml_child_number(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, int64_t minimum,
                              int64_t maximum, int64_t fallback);
int64_t cm1e_xml_attribute_number(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, int64_t minimum,
                                  int64_t maximum, int64_t fallback);
/** A number with a point, in whatever country. False: it is none. */
bool cm1e_xml_real(const char *text, double *number);
/** xs:boolean: 0, 1, false, true (any case). */
bool cm1e_xml_attribute_flag(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, bool fallback);
bool cm1e_xml_child_flag(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, bool fallback);
/** xs:hexBinary; white space in it is tolerated. `data` NULL: no such element, or empty. */
cm1e_bytes_t cm1e_xml_hex(cm1e_xml_reader_t *reader, const xmlNode *node);

#endif
