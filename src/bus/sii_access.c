#include "cm1e/sii.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/eeprom.h"
#include "bus/sii_reader.h"
#include "core/bytes.h"
#include "core/in_task.h"
#include "core/sized.h"
#include "description/sii_image.h"

/* An EEPROM is addressed by words. */
enum {
    WORD_ALIAS = CM1E_SII_ALIAS / 2, WORD_CHECKSUM = CM1E_SII_CHECKSUM / 2, WORD_VENDOR = CM1E_SII_VENDOR / 2,
    WORD_PRODUCT = CM1E_SII_PRODUCT / 2, WORD_SERIAL = CM1E_SII_SERIAL / 2, WORD_SIZE = CM1E_SII_KBIT / 2,
    WORD_CATEGORIES = CM1E_SII_HEADER_BYTES / 2,
};
enum { LARGEST_KBIT = 4096, ERASED = 0xFFFF };

/** The EEPROM interface of one slave, taken for a while. */
typedef struct session {
    cm1e_bus_t *bus;
    uint16_t position;
    cm1e_eeprom_t eeprom;
    char label[CM1E_LABEL_LENGTH];
} session_t;

static uint16_t word_at(const uint8_t *image, uint32_t word) { return cm1e_get_u16(image + 2 * (size_t)word); }
static uint32_t dword_at(const uint8_t *image, uint32_t word) { return cm1e_get_u32(image + 2 * (size_t)word); }

/** Bytes of the EEPROM by word 0x3E; 0: not stated (erased, never written, or more than possible). */
static size_t stated_size(uint16_t word)
{
    return word == 0 || word == ERASED || word >= LARGEST_KBIT ? 0 : (word + (size_t)1) * CM1E_SII_BYTES_PER_KBIT;
}

static cm1e_error_t diagnose_eeprom(const session_t *session, const char *what, uint32_t word, cm1e_diag_t *diag)
{
    if (session->eeprom.lost)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_LOST, 0, "%s stopped answering at word 0x%04X of its SII: check its "
                             "power and the cables up to it.", session->label, (unsigned)word);
    return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "%s: its EEPROM %s at word 0x%04X.", session->label, what,
                         (unsigned)word);
}

static cm1e_error_t begin(session_t *session, cm1e_bus_t *bus, uint16_t position, cm1e_diag_t *diag)
{
    if (!bus)
        return cm1e_bus_missing("The SII of a slave", diag);
    if (bus->phase < BUS_OPEN || bus->phase >= BUS_OPERATING)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The SII of a slave needs an open bus that does not operate.");
    const cm1e_error_t attached = cm1e_bus_refuse_attached(bus, "Writing the SII of a slave", diag);
    if (attached != CM1E_OK)
        return attached;
    cm1e_bus_enter(bus);
    *session = (session_t){.bus = bus, .position = position, .eeprom = {.soem = bus->soem}};
    uint8_t type;
    const int count = cm1e_soem_transfer(bus->soem, COMMAND_BRD, 0, 0, &type, sizeof type);
    if (count <= 0)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_NO_SLAVES, 0, "No EtherCAT slave answers on %s.",
                             bus->config.interface_name);
    if (position < 1 || position > count)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; %d answer on %s.", position,
                             count, bus->config.interface_name);
    const cm1e_bus_slave_t *slave = bus->phase >= BUS_SCANNED ? cm1e_bus_at(bus, position) : NULL;
    session->eeprom.station = slave ? slave->facts.station : cm1e_soem_address(bus->soem, position);
    if (slave)
        cm1e_bus_label_first(bus, slave, session->label);
    else
        snprintf(session->label, sizeof session->label, "Slave %u", position);
    session->eeprom.lost = session->eeprom.station == 0;
    if (session->eeprom.lost || !cm1e_eeprom_take(&session->eeprom))
        return diagnose_eeprom(session, "cannot be taken", 0, diag);
    return CM1E_OK;
}

static cm1e_error_t read_words(session_t *session, uint8_t *image, size_t size, cm1e_diag_t *diag)
{
    uint8_t bytes[4];
    for (uint32_t word = 0; word < size / 2; word += 2) {
        const size_t place = 2 * (size_t)word, left = size - place;
        if (!cm1e_eeprom_read(&session->eeprom, word, bytes))
            return diagnose_eeprom(session, "cannot be read", word, diag);
        memcpy(image + place, bytes, left < sizeof bytes ? left : sizeof bytes);
    }
    return CM1E_OK;
}

static cm1e_error_t read_size(session_t *session, size_t *size, cm1e_diag_t *diag)
{
    uint8_t bytes[4];
    if (!cm1e_eeprom_read(&session->eeprom, WORD_SIZE, bytes))
        return diagnose_eeprom(session, "cannot be read", WORD_SIZE, diag);
    *size = stated_size(cm1e_get_u16(bytes));
    return CM1E_OK;
}

static cm1e_error_t read_image(session_t *session, uint8_t *image, size_t *size, cm1e_diag_t *diag)
{
    const size_t room = *size;
    cm1e_error_t error = read_size(session, size, diag);
    if (error != CM1E_OK)
        return error;
    if (*size == 0)
        *size = CM1E_SII_SIZE;
    if (*size > room)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The SII of slave %u has %zu bytes, there is room "
                             "for %zu.", session->position, *size, room);
    return read_words(session, image, *size, diag);
}

/** Pieces of CM1E_ERRAND_BYTES, which divide every SII whose size is stated. */
static cm1e_error_t read_remote_piece(cm1e_bus_t *bus, uint16_t position, size_t place, cm1e_errand_t *errand,
                                      cm1e_diag_t *diag)
{
    *errand = (cm1e_errand_t){.kind = ERRAND_SII, .position = position, .place = (uint32_t)(place / 2),
                              .size = CM1E_ERRAND_BYTES};
    const cm1e_error_t error = cm1e_bus_errand_remote(bus, errand, diag);
    if (error != CM1E_OK || errand->error == CM1E_OK)
        return error;
    return cm1e_diag_set(diag, errand->error, 0, "Slave %u: its SII cannot be read at word 0x%04X: %s.", position,
                         (unsigned)errand->place, cm1e_strerror(errand->error));
}

static cm1e_error_t read_remote(cm1e_bus_t *bus, uint16_t position, uint8_t *image, size_t *size, cm1e_diag_t *diag)
{
    const size_t room = *size;
    cm1e_errand_t errand;
    for (size_t place = 0; place == 0 || place < *size; place += CM1E_ERRAND_BYTES) {
        const cm1e_error_t error = read_remote_piece(bus, position, place, &errand, diag);
        if (error != CM1E_OK)
            return error;
        if (place == 0)
            *size = stated_size(word_at(errand.data, WORD_SIZE));
        if (*size == 0)
            *size = CM1E_SII_SIZE;
        if (*size > room)
            return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The SII of slave %u has %zu bytes, there is "
                                 "room for %zu.", position, *size, room);
        memcpy(image + place, errand.data, *size - place < CM1E_ERRAND_BYTES ? *size - place : CM1E_ERRAND_BYTES);
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_sii_read_device(cm1e_bus_t *bus, uint16_t position, uint8_t *image, size_t *size, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_sii_read_device()", "", diag);
    session_t session;
    if (bus && bus->remote && size && image)
        return read_remote(bus, position, image, size, diag);
    if (!size || (!image && *size > 0))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_sii_read_device() needs a buffer and its size.");
    cm1e_error_t error = begin(&session, bus, position, diag);
    if (error != CM1E_OK)
        return error;
    error = read_image(&session, image, size, diag);
    cm1e_eeprom_give_back(&session.eeprom);
    return error;
}

/* ---- what may be written ---------------------------------------------------------------------------------------- */

typedef struct view {
    const uint8_t *image;
    size_t size;
} view_t;

/** false: not a word of it is there. Behind an odd end there is nothing, as in an empty memory. */
static bool read_from_image(void *context, uint16_t word, uint16_t count, uint8_t *bytes)
{
    const view_t *view = context;
    const size_t place = 2 * (size_t)word, wanted = 2 * (size_t)count;
    if (place + wanted > view->size + 2)
        return false;
    memset(bytes, 0xFF, wanted);
    memcpy(bytes, view->image + place, view->size - place < wanted ? view->size - place : wanted);
    return true;
}

static bool checksum_good(const uint8_t *image)
{
    return word_at(image, WORD_CHECKSUM) % 256 == cm1e_sii_crc8(image, 2 * WORD_CHECKSUM);
}

/** Checks an image without a slave. */
static cm1e_error_t check_image(const uint8_t *image, size_t size, const cm1e_sii_write_options_t *options,
                                cm1e_diag_t *diag)
{
    if (!image)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_sii_write_device() needs an image.");
    if (size < 2 * WORD_CATEGORIES || size % 2 || size > CM1E_SII_IMAGE_MAX)
        return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "%zu bytes are not an SII image, which has whole words and at "
                             "least 128 bytes.", size);
    cm1e_sii_t sii;
    view_t view = {image, size};
    const bool whole = cm1e_sii_read_header(&sii, read_from_image, &view) == SII_OK &&
                       cm1e_sii_read_categories(&sii, false, read_from_image, &view) == SII_OK;
    cm1e_sii_free(&sii);
    if (!whole)
        return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "The SII image is incomplete: its categories do not end within "
                             "its %zu bytes. A scan would stop at a slave with it.", size);
    if (!checksum_good(image) && !options->force_checksum)
        return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0,
                             "The checksum of the SII image is wrong: word 7 holds 0x%02X, words 0-6 give 0x%02X. A "
                             "slave does not load its configuration from such an SII.",
                             word_at(image, WORD_CHECKSUM) % 256, cm1e_sii_crc8(image, 2 * WORD_CHECKSUM));
    return CM1E_OK;
}

static cm1e_error_t check_state(session_t *session, cm1e_diag_t *diag)
{
    uint8_t status[2];
    session->eeprom.lost = cm1e_soem_transfer(session->bus->soem, COMMAND_FPRD, session->eeprom.station, REG_AL_STATUS,
                                              status, sizeof status) != 1;
    if (session->eeprom.lost)
        return diagnose_eeprom(session, "", 0, diag);
    const uint16_t state = status[0] & AL_STATE_MASK;
    if (state != CM1E_AL_INIT && state != CM1E_AL_PRE_OP)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "%s is in %s: its SII is written in Init or Pre-Operational.",
                             session->label, cm1e_al_state_text(cm1e_get_u16(status)));
    return CM1E_OK;
}

static cm1e_error_t check_identity(const session_t *session, const uint8_t *image, const uint8_t *present,
                                   const cm1e_sii_write_options_t *options, cm1e_diag_t *diag)
{
    const uint32_t vendor = dword_at(present, WORD_VENDOR), product = dword_at(present, WORD_PRODUCT);
    if (options->force_identity)
        return CM1E_OK;
    if (vendor != CM1E_VENDOR_ID || product != CM1E_PRODUCT_CODE)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0,
                             "%s is not a CM1-E: its SII holds vendor 0x%08X, product 0x%08X.", session->label,
                             (unsigned)vendor, (unsigned)product);
    if (dword_at(image, WORD_VENDOR) != vendor || dword_at(image, WORD_PRODUCT) != product)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0,
                             "The SII image is of another product: vendor 0x%08X, product 0x%08X; %s holds vendor "
                             "0x%08X, product 0x%08X.", (unsigned)dword_at(image, WORD_VENDOR),
                             (unsigned)dword_at(image, WORD_PRODUCT), session->label, (unsigned)vendor,
                             (unsigned)product);
    return CM1E_OK;
}

/** Compares words 0-6 without the alias. If those of the slave are not valid, there is nothing to protect. */
static cm1e_error_t check_configuration(const session_t *session, const uint8_t *image, const uint8_t *present,
                                        const cm1e_sii_write_options_t *options, cm1e_diag_t *diag)
{
    for (uint32_t word = 0; word < WORD_CHECKSUM && checksum_good(present) && !options->force_configuration; word++) {
        if (word == WORD_ALIAS || word_at(image, word) == word_at(present, word))
            continue;
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "%s: word %u of its configuration is 0x%04X, in the SII image 0x%04X. A wrong one can "
                             "make a slave unreachable; an image for it begins with words 0-6 of its own SII.",
                             session->label, (unsigned)word, word_at(present, word), word_at(image, word));
    }
    return CM1E_OK;
}

/** A CM1-E with both kinds of address has an internal error from its next power-on (UG 4.2.4). */
static cm1e_error_t check_alias(const session_t *session, const uint8_t *image, const uint8_t *present,
                                const cm1e_sii_write_options_t *options, cm1e_diag_t *diag)
{
    const cm1e_slave_info_t *slave = cm1e_bus_slave(session->bus, session->position);
    const uint16_t alias = word_at(image, WORD_ALIAS);
    if (!options->own_alias_and_serial || options->force_configuration || alias == 0 ||
        alias == word_at(present, WORD_ALIAS) || !slave || !slave->device || !slave->device->explicit_id ||
        slave->explicit_id == 0)
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                         "The rotary switches of %s are set (explicit device ID %u). With the alias %u too, it has an "
                         "internal error from its next power-on (UG 4.2.4): set both switches to 0 first, and switch "
                         "it off and on.", session->label, slave->explicit_id, alias);
}

static cm1e_error_t check_size(session_t *session, const uint8_t *image, size_t size, cm1e_diag_t *diag)
{
    size_t of_slave = 0;
    const size_t of_image = stated_size(word_at(image, WORD_SIZE));
    const cm1e_error_t error = read_size(session, &of_slave, diag);
    if (error != CM1E_OK)
        return error;
    const size_t limit = of_slave ? of_slave : of_image ? of_image : size;
    if (size > limit || of_image > limit)
        return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0,
                             "The SII image has %zu bytes and states an EEPROM of %zu; that of slave %u has %zu.",
                             size, of_image, session->position, limit);
    return CM1E_OK;
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

/** Whether the slave's own alias and serial number are valid: not if its header is invalid. */
static void keep_alias_and_serial(uint8_t *wanted, const uint8_t *present)
{
    if (!checksum_good(present))
        return;
    const bool good = checksum_good(wanted);
    memcpy(wanted + 2 * WORD_ALIAS, present + 2 * WORD_ALIAS, 2);
    memcpy(wanted + 2 * WORD_SERIAL, present + 2 * WORD_SERIAL, 4);
    if (good) /* a wrong checksum that was forced stays wrong */
        wanted[2 * WORD_CHECKSUM] = cm1e_sii_crc8(wanted, 2 * WORD_CHECKSUM);
}

static cm1e_error_t diagnose_write(const session_t *session, uint32_t word, const uint8_t *wanted, unsigned written,
                                   cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, session->eeprom.lost ? CM1E_ERROR_BUS_LOST : CM1E_ERROR_TIMEOUT, 0,
                         "%s: writing its SII stopped at word 0x%04X, which did not become 0x%04X: %s. %u words were "
                         "written before, so its SII is now neither the old nor the new one. Write the backup back "
                         "before the slave is switched off.", session->label, (unsigned)word, word_at(wanted, word),
                         session->eeprom.lost ? "the slave stopped answering" : "the EEPROM does not keep it (is it "
                         "protected against writing?)", written);
}

/** Writes the categories, then the header, then the words that the controller loads: if the writing stops, the slave
 *  can still be addressed, and its SII has a size. */
static cm1e_error_t write_words(session_t *session, const uint8_t *wanted, const uint8_t *present, size_t size,
                                cm1e_diag_t *diag)
{
    const struct {
        uint32_t from, to;
    } parts[] = {{WORD_CATEGORIES, (uint32_t)(size / 2)}, {WORD_VENDOR, WORD_CATEGORIES}, {0, WORD_VENDOR}};
    unsigned written = 0;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        for (uint32_t word = parts[i].from; word < parts[i].to; word++) {
            if (word_at(wanted, word) == word_at(present, word))
                continue;
            if (!cm1e_eeprom_write(&session->eeprom, word, word_at(wanted, word)))
                return diagnose_write(session, word, wanted, written, diag);
            written++;
        }
    return CM1E_OK;
}

static cm1e_error_t verify(session_t *session, const uint8_t *wanted, uint8_t *again, size_t size, cm1e_diag_t *diag)
{
    session->eeprom.group_bytes = 0;
    const cm1e_error_t error = read_words(session, again, size, diag);
    for (uint32_t word = 0; error == CM1E_OK && word < size / 2; word++)
        if (word_at(again, word) != word_at(wanted, word))
            return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0,
                                 "%s: its SII was written, but read back word 0x%04X holds 0x%04X in place of 0x%04X. "
                                 "Write the backup back before the slave is switched off.", session->label,
                                 (unsigned)word, word_at(again, word), word_at(wanted, word));
    return error;
}

static cm1e_error_t write_image(session_t *session, const uint8_t *image, uint8_t *wanted, uint8_t *present,
                                size_t size, const cm1e_sii_write_options_t *options, cm1e_diag_t *diag)
{
    cm1e_error_t error = check_state(session, diag);
    if (error == CM1E_OK)
        error = check_size(session, image, size, diag);
    if (error == CM1E_OK)
        error = read_words(session, present, size, diag);
    if (error == CM1E_OK)
        error = check_identity(session, image, present, options, diag);
    if (error == CM1E_OK)
        error = check_configuration(session, image, present, options, diag);
    if (error == CM1E_OK)
        error = check_alias(session, image, present, options, diag);
    if (error != CM1E_OK)
        return error;
    memcpy(wanted, image, size);
    if (!options->own_alias_and_serial)
        keep_alias_and_serial(wanted, present);
    error = write_words(session, wanted, present, size, diag);
    return error == CM1E_OK ? verify(session, wanted, present, size, diag) : error;
}

cm1e_error_t cm1e_sii_write_device_sized(cm1e_bus_t *bus, uint16_t position, const uint8_t *image, size_t size,
                                         const cm1e_sii_write_options_t *options, size_t options_size,
                                         cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_sii_write_device()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_sii_write_device()", diag);
    cm1e_sii_write_options_t own = {0};
    session_t session;
    if (options)
        cm1e_copy_sized(&own, sizeof own, options, options_size);
    cm1e_error_t error = check_image(image, size, &own, diag);
    if (error != CM1E_OK)
        return error;
    uint8_t *room = malloc(2 * size);
    if (!room)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory when writing an SII.");
    error = begin(&session, bus, position, diag);
    if (error == CM1E_OK) {
        error = write_image(&session, image, room, room + size, size, &own, diag);
        cm1e_eeprom_give_back(&session.eeprom);
    }
    free(room);
    return error;
}
