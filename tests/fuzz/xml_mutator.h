/**
 * @file xml_mutator.h
 * Damages XML so that it mostly stays XML: elements left out, doubled, moved, renamed, texts and attributes exchanged.
 * Bytes changed at random hardly ever come past the parser, which is not what is tested. Include it once in the target
 * of an XML format.
 */
#ifndef CM1E_TESTS_XML_MUTATOR_H
#define CM1E_TESTS_XML_MUTATOR_H

#include <ctype.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "chance.h"

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);

/* Bytes `from` to `to` (excluded) of the file. */
typedef struct span {
    size_t from, to;
} span_t;

static const char *const interesting[] = {
    "", "0", "1", "2", "3", "7", "8", "16", "17", "32", "64", "-1", "127", "128", "255", "256", "65535", "65536",
    "2147483647", "2147483648", "4294967295", "4294967296", "9223372036854775808", "#x0", "#x1600", "#x1A00", "#x1C12",
    "#x1018",
    "#xFFFF", "#x10000", "#xFFFFFFFF", "0x7", "1.5", "-0.25e3", "true", "false", "ro", "rw", "wo", "T", "RT", "PS",
    "SO",
    "MBoxOut", "Outputs", "Inputs", "USINT", "UINT", "DINT", "BOOL", "BIT3", "REAL", "STRING(5)",
    "ARRAY [0..3] OF BYTE",
    "SubIndex 001", "SubIndex 002", "Elements", "[V] a", "]", "00", "FF", "0102", "010203040506070809", "a b", "&amp;",
    "\xC3\xA9", "<!--x-->",
};
static const char *const attributes[] = {
    " DependOnSlot=\"1\"", " Sm=\"2\"", " Sm=\"3\"", " Fixed=\"1\"", " Mandatory=\"1\"", " Default=\"1\"",
    " Factor=\"1\"",
    " LcId=\"1031\"", " ModuleIdent=\"#x219800\"", " AdaptAutomatically=\"1\"", " CompleteAccess=\"1\"",
    " SlotIndexIncrement=\"#x800\"", " WriteRestrictions=\"PreOP\"", " ModuleClass=\"a\"", " DefaultSize=\"128\"",
};
enum { INTERESTING = sizeof interesting / sizeof interesting[0] };
enum { ATTRIBUTES = sizeof attributes / sizeof attributes[0] };

static size_t find_byte(const uint8_t *data, size_t from, size_t to, char byte)
{
    const uint8_t *found = from < to ? memchr(data + from, byte, to - from) : NULL;
    return found ? (size_t)(found - data) : to;
}

/* A start tag at or behind a random place. */
static bool some_tag(const uint8_t *data, size_t size, span_t *tag)
{
    size_t at = size > 0 ? (size_t)(chance() % size) : 0;
    for (int around = 0; around < 2; around++, at = 0)
        while ((at = find_byte(data, at, size, '<')) + 1 < size) {
            if (isalpha(data[at + 1])) {
                *tag = (span_t){at, find_byte(data, at, size, '>') + 1};
                return tag->to <= size;
            }
            at++;
        }
    return false;
}

/* From a start tag to its end tag; false: it has none. `*text`: between the two. */
static bool whole_element(const uint8_t *data, size_t size, span_t tag, span_t *element, span_t *text)
{
    *element = tag;
    *text = (span_t){tag.to, tag.to};
    size_t depth = 1;
    if (data[tag.to - 2] == '/')
        return true;
    for (size_t at = tag.to; (at = find_byte(data, at, size, '<')) + 1 < size;) {
        const size_t end = find_byte(data, at, size, '>');
        if (end == size)
            return false;
        if (data[at + 1] == '/' && --depth == 0) {
            text->to = at;
            element->to = end + 1;
            return true;
        }
        depth += isalpha(data[at + 1]) && data[end - 1] != '/';
        at = end + 1;
    }
    return false;
}

/* Puts other bytes in the place of some; 0: that would be too long. */
static size_t put(uint8_t *data, size_t size, size_t max_size, span_t place, const uint8_t *bytes, size_t count)
{
    const size_t result = size - (place.to - place.from) + count;
    if (result > max_size)
        return 0;
    memmove(data + place.from + count, data + place.to, size - place.to);
    memcpy(data + place.from, bytes, count);
    return result;
}

static span_t name_in(const uint8_t *data, span_t tag)
{
    span_t name = {tag.from + 1, tag.from + 1};
    while (name.to < tag.to && (isalnum(data[name.to]) || data[name.to] == '_'))
        name.to++;
    return name;
}

/* The value of some attribute of a tag. */
static bool some_value(const uint8_t *data, span_t tag, span_t *value)
{
    unsigned quotes = 0;
    for (size_t at = tag.from; at < tag.to; at++)
        quotes += data[at] == '"';
    if (quotes < 2)
        return false;
    unsigned which = 2 * (unsigned)pick((int)(quotes / 2));
    size_t at = tag.from;
    for (; data[at] != '"' || which-- > 0; at++)
        ;
    *value = (span_t){at + 1, find_byte(data, at + 1, tag.to, '"')};
    return value->to < tag.to;
}

enum { LEAVE_OUT, DOUBLE, MOVE, RENAME, TEXT, TEXT_OF_ANOTHER, VALUE, ATTRIBUTE, OPERATIONS };

/* `copy` is another copy of the file. */
static size_t mutate(uint8_t *data, size_t size, size_t max_size, const uint8_t *copy)
{
    span_t tag, element, text, other, other_element, other_text, value;
    const char *word = interesting[pick(INTERESTING)], *attribute = attributes[pick(ATTRIBUTES)];
    if (!some_tag(data, size, &tag) || !whole_element(data, size, tag, &element, &text) ||
        !some_tag(data, size, &other) || !whole_element(data, size, other, &other_element, &other_text))
        return 0;
    switch (pick(OPERATIONS)) {
    case LEAVE_OUT: return put(data, size, max_size, element, copy, 0);
    case DOUBLE:
        return put(data, size, max_size, (span_t){element.to, element.to}, copy + element.from,
                   element.to - element.from);
    case MOVE:
        return put(data, size, max_size, (span_t){element.from, element.from}, copy + other_element.from,
                   other_element.to - other_element.from);
    case RENAME: {
        const span_t name = name_in(data, tag), new_name = name_in(data, other);
        const size_t count = new_name.to - new_name.from;
        if (text.to < element.to && data[element.to - 1] == '>' && element.to - text.to > 3)
            size = put(data, size, max_size, (span_t){text.to + 2, element.to - 1}, copy + new_name.from, count);
        return size ? put(data, size, max_size, name, copy + new_name.from, count) : 0;
    }
    case TEXT: return put(data, size, max_size, text, (const uint8_t *)word, strlen(word));
    case TEXT_OF_ANOTHER:
        return put(data, size, max_size, text, copy + other_text.from, other_text.to - other_text.from);
    case VALUE:
        return some_value(data, tag, &value)
                   ? put(data, size, max_size, value, (const uint8_t *)word, strlen(word)) : 0;
    default: {
        const size_t at = name_in(data, tag).to;
        return put(data, size, max_size, (span_t){at, at}, (const uint8_t *)attribute, strlen(attribute));
    }
    }
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    chance_seed(seed);
    if (one_in(6))
        return LLVMFuzzerMutate(data, size, max_size);
    for (int times = 1 + pick(3); times > 0; times--) {
        uint8_t *copy = malloc(size + 1);
        if (!copy)
            return size;
        memcpy(copy, data, size);
        const size_t mutated = mutate(data, size, max_size, copy);
        if (mutated == 0)
            memcpy(data, copy, size);
        else
            size = mutated;
        free(copy);
    }
    return size;
}

#endif
