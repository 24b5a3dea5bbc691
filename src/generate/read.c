#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/generate.h"
#include "description/check.h"
#include "description/sii_image.h"
#include "generate/ec_extend.h"
#include "generate/eni.h"
#include "generate/esi.h"
#include "generate/file.h"
#include "generate/left_out.h"
#include "generate/xml_read.h"

static const struct {
    const char *root; /* element; NULL: no XML */
    const char *name;
} formats[] = {
    [CM1E_FILE_UNKNOWN] = {NULL, "unknown"},
    [CM1E_FILE_ESI] = {"EtherCATInfo", "ESI"},
    [CM1E_FILE_EC_EXTEND] = {"EtherCAT", "EC_EXTEND"},
    [CM1E_FILE_SII] = {NULL, "SII"},
    [CM1E_FILE_ENI] = {"EtherCATConfig", "ENI"},
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

const char *cm1e_file_format_name(cm1e_file_format_t format)
{
    return formats[(unsigned)format < FORMATS ? format : CM1E_FILE_UNKNOWN].name;
}

/* Where the name of the first element begins, behind comments, declarations and what else may stand before it; NULL:
 * there is no element. */
static const char *root_name(const char *text, size_t size)
{
    const char *const end = text + size;
    for (const char *at = text; (at = memchr(at, '<', (size_t)(end - at))) != NULL;) {
        const size_t rest = (size_t)(end - at);
        const char *closed;
        if (rest >= 4 && memcmp(at, "<!--", 4) == 0)
            closed = memmem(at, rest, "-->", 3);
        else if (rest >= 2 && (at[1] == '?' || at[1] == '!'))
            closed = memchr(at, '>', rest);
        else
            return at + 1;
        if (!closed)
            return NULL;
        at = closed;
    }
    return NULL;
}

static cm1e_file_format_t format_of_root(const char *name, size_t size)
{
    for (int format = 0; format < FORMATS; format++) {
        const size_t length = formats[format].root ? strlen(formats[format].root) : 0;
        if (length > 0 && length < size && memcmp(name, formats[format].root, length) == 0 &&
            (isspace((unsigned char)name[length]) || name[length] == '>' || name[length] == '/'))
            return (cm1e_file_format_t)format;
    }
    return CM1E_FILE_UNKNOWN;
}

static bool is_utf16(const uint8_t *bytes, size_t size)
{
    return size >= 2 && ((bytes[0] == 0xFF && bytes[1] == 0xFE) || (bytes[0] == 0xFE && bytes[1] == 0xFF));
}

/* An image is not a text (it contains zeros), and its checksum, or its size and version words, are those of an
 * image. */
static bool looks_like_sii(const uint8_t *bytes, size_t size)
{
    if (size < CM1E_SII_HEADER_BYTES || size % 2 != 0 || is_utf16(bytes, size) ||
        !memchr(bytes, 0, CM1E_SII_HEADER_BYTES))
        return false;
    const bool sized =
        bytes[CM1E_SII_KBIT + 1] == 0 && bytes[CM1E_SII_VERSION] == 1 && bytes[CM1E_SII_VERSION + 1] == 0;
    return sized || cm1e_sii_crc8(bytes, CM1E_SII_CONFIG_BYTES) == bytes[CM1E_SII_CHECKSUM];
}

static cm1e_file_format_t recognise_utf16(const void *bytes, size_t size)
{
    xmlDoc *doc = cm1e_xml_parse(bytes, size, NULL);
    const char *name = doc ? (const char *)xmlDocGetRootElement(doc)->name : "";
    char ended[32];
    snprintf(ended, sizeof ended, "%s>", name);
    const cm1e_file_format_t format = format_of_root(ended, strlen(ended));
    xmlFreeDoc(doc);
    return format;
}

cm1e_file_format_t cm1e_file_recognise(const void *bytes, size_t size)
{
    if (!bytes || size == 0)
        return CM1E_FILE_UNKNOWN;
    if (looks_like_sii(bytes, size))
        return CM1E_FILE_SII;
    if (is_utf16(bytes, size))
        return recognise_utf16(bytes, size);
    const char *name = root_name(bytes, size);
    return name ? format_of_root(name, size - (size_t)(name - (const char *)bytes)) : CM1E_FILE_UNKNOWN;
}

cm1e_error_t cm1e_file_not_recognised(cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0,
                         "this is no file of a known format: neither XML with the root element EtherCATInfo (ESI), "
                         "EtherCAT (EC_EXTEND) or EtherCATConfig (ENI), nor the image of an SII");
}

/* ---- check ------------------------------------------------------------------------------------------------------ */

static cm1e_error_t check_described(cm1e_findings_t *findings, cm1e_file_format_t format, const void *bytes,
                                    size_t size, cm1e_diag_t *diag)
{
    cm1e_description_file_t file = {0};
    const cm1e_error_t error = format == CM1E_FILE_ESI ? cm1e_esi_read(&file, bytes, size, diag)
                                                       : cm1e_sii_read(&file, bytes, size, findings, diag);
    if (error == CM1E_OK)
        cm1e_check_description(findings, &file);
    cm1e_description_file_free(&file);
    return error;
}

static cm1e_error_t check_ec_extend(cm1e_findings_t *findings, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    cm1e_ec_extend_t document = {0};
    const cm1e_error_t error = cm1e_ec_extend_read(&document, bytes, size, diag);
    if (error == CM1E_OK)
        cm1e_ec_extend_check(findings, &document);
    cm1e_ec_extend_free(&document);
    return error;
}

static cm1e_error_t check_eni(cm1e_findings_t *findings, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    cm1e_eni_t document = {0};
    const cm1e_error_t error = cm1e_eni_read(&document, bytes, size, diag);
    if (error == CM1E_OK)
        cm1e_eni_check(findings, &document);
    cm1e_eni_free(&document);
    return error;
}

cm1e_error_t cm1e_check_file(cm1e_findings_t **findings, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    if (!findings || (!bytes && size > 0))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_check_file() needs a place for the findings, "
                             "and the bytes of a file.");
    const cm1e_file_format_t format = cm1e_file_recognise(bytes, size);
    *findings = NULL;
    if (format == CM1E_FILE_UNKNOWN)
        return cm1e_file_not_recognised(diag);
    cm1e_findings_t *found = cm1e_findings_create();
    if (!found)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    const cm1e_error_t error = format == CM1E_FILE_EC_EXTEND ? check_ec_extend(found, bytes, size, diag)
                               : format == CM1E_FILE_ENI     ? check_eni(found, bytes, size, diag)
                                                             : check_described(found, format, bytes, size, diag);
    return cm1e_findings_give(found, error, findings, diag);
}

/* ---- written anew ----------------------------------------------------------------------------------------------- */

static cm1e_error_t rewrite_ec_extend(cm1e_file_t *file, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    cm1e_ec_extend_t document = {0};
    cm1e_error_t error = cm1e_ec_extend_read(&document, bytes, size, diag);
    if (error == CM1E_OK)
        error = cm1e_ec_extend_write(file, &document, diag);
    cm1e_ec_extend_free(&document);
    return error;
}

static cm1e_error_t rewrite_eni(cm1e_file_t *file, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    cm1e_eni_t document = {0};
    cm1e_error_t error = cm1e_eni_read(&document, bytes, size, diag);
    if (error == CM1E_OK)
        error = cm1e_eni_write(file, &document, diag);
    cm1e_eni_free(&document);
    return error;
}

static cm1e_error_t write_anew(cm1e_file_t *file, const void *bytes, size_t size, cm1e_file_format_t found,
                               cm1e_file_format_t format, size_t device, cm1e_diag_t *diag)
{
    const bool described = (found == CM1E_FILE_ESI || found == CM1E_FILE_SII);
    if (found == format && found == CM1E_FILE_EC_EXTEND)
        return rewrite_ec_extend(file, bytes, size, diag);
    if (found == format && found == CM1E_FILE_ENI)
        return rewrite_eni(file, bytes, size, diag);
    if (!described || (format != CM1E_FILE_ESI && format != CM1E_FILE_SII))
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0,
                             "%s cannot be written out of %s, which lacks what it needs; each format can be written "
                             "out of itself, and ESI and SII out of each other",
                             cm1e_file_format_name(format), cm1e_file_format_name(found));
    cm1e_description_file_t content = {0};
    cm1e_error_t error = found == CM1E_FILE_ESI ? cm1e_esi_read(&content, bytes, size, diag)
                                                : cm1e_sii_read(&content, bytes, size, NULL, diag);
    if (error == CM1E_OK && format == CM1E_FILE_SII && device >= content.devices.count)
        error = cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "there is no device %zu in the file; it has %zu",
                              device + 1, content.devices.count);
    if (error == CM1E_OK)
        error = format == CM1E_FILE_ESI ? cm1e_esi_write(file, &content, diag)
                                        : cm1e_file_of_sii(file, &content, device, diag);
    for (size_t i = 0; error == CM1E_OK && i < content.devices.count; i++)
        if (format == CM1E_FILE_ESI || i == device)
            cm1e_file_warn_of_eeprom(file, &content.devices.at[i]);
    cm1e_description_file_free(&content);
    return error;
}

cm1e_error_t cm1e_generate_from(cm1e_file_t *file, const void *bytes, size_t size, cm1e_file_format_t format,
                                size_t device, cm1e_diag_t *diag)
{
    if (!file || (!bytes && size > 0))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_generate_from() needs a place for the file, "
                             "and the bytes of another one.");
    const cm1e_file_format_t found = cm1e_file_recognise(bytes, size);
    *file = (cm1e_file_t){0};
    if (found == CM1E_FILE_UNKNOWN)
        return cm1e_file_not_recognised(diag);
    const cm1e_error_t error = write_anew(file, bytes, size, found, format, device, diag);
    if (error == CM1E_OK && found == format && formats[found].root)
        cm1e_warn_of_left_out(file, bytes, size);
    return error;
}
