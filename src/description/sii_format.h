/**
 * @file sii_format.h
 * Where what stands in the categories of an SII image (ETG.1000.6 tables 17 to 24); the fixed words before them are in
 * sii_image.h. For sii_read.c, sii_write.c, and the bus, which fetches only some of it (bus/sii_reader.c).
 */
#ifndef CM1E_DESCRIPTION_SII_FORMAT_H
#define CM1E_DESCRIPTION_SII_FORMAT_H

enum {
    SII_CATEGORY_STRINGS = 10, SII_CATEGORY_GENERAL = 30, SII_CATEGORY_FMMU = 40, SII_CATEGORY_SYNC_MANAGERS = 41,
    SII_CATEGORY_TXPDO = 50, SII_CATEGORY_RXPDO = 51, SII_CATEGORY_DC = 60,
};
enum { SII_CATEGORY_HEADER_BYTES = 4, SII_STRINGS_MAX = 255, SII_STRING_BYTES_MAX = 255 };

/** Word CM1E_SII_PROTOCOLS. */
enum {
    SII_PROTOCOL_AOE = 0x01, SII_PROTOCOL_EOE = 0x02, SII_PROTOCOL_COE = 0x04, SII_PROTOCOL_FOE = 0x08,
    SII_PROTOCOL_SOE = 0x10, SII_PROTOCOL_VOE = 0x20, SII_PROTOCOLS_ALL = 0x3F,
};

/** Category General. */
enum {
    GENERAL_GROUP = 0x00, GENERAL_ORDER = 0x02, GENERAL_NAME = 0x03, GENERAL_COE = 0x05, GENERAL_FOE = 0x06,
    GENERAL_EOE = 0x07, GENERAL_DRIVES = 0x09, GENERAL_FLAGS = 0x0B, GENERAL_GROUP_AGAIN = 0x0E, GENERAL_PORTS = 0x10,
    GENERAL_BYTES = 0x20,
};
enum {
    COE_SDO = 0x01, COE_SDO_INFO = 0x02, COE_PDO_ASSIGN = 0x04, COE_PDO_CONFIG = 0x08, COE_PDO_UPLOAD = 0x10,
    COE_COMPLETE_ACCESS = 0x20,
};
enum { FLAG_NO_LRW = 0x02, FLAG_DATA_LINK_LAYER = 0x04, FLAG_ID_IN_AL_STATUS = 0x08 };
/** The kind of port n is nibble n of GENERAL_PORTS: its letter in an ESI's Physics, by number. */
#define SII_PORT_LETTERS " Y KH"
enum { SII_PORTS = 4 };

enum { SYNC_MANAGER_BYTES = 8, PDO_BYTES = 8, PDO_ENTRY_BYTES = 8, DC_BYTES = 24, DC_NAME = 18,
       PDO_NOT_CARRIED = 0xFF };
/** Flags of a PDO. DEFAULT: a sync manager carries it. */
enum {
    PDO_MANDATORY = 0x0001, PDO_DEFAULT = 0x0002, PDO_FIXED = 0x0010, PDO_VIRTUAL = 0x0020,
    PDO_DEPENDS_ON_SLOT = 0x0200,
};
/** Bits of AssignActivate (registers 0x0980, 0x0981) that switch the signals on. */
enum { ACTIVATES_SYNC0 = 0x0200, ACTIVATES_SYNC1 = 0x0400 };

#endif
