/**
 * @file message.h
 * Messages of the control socket: four bytes with the length of what follows, most significant byte first, then one
 * JSON object in UTF-8. docs/CONTROL.md has the protocol.
 */
#ifndef CM1E_CONTROL_MESSAGE_H
#define CM1E_CONTROL_MESSAGE_H

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>

enum {
    CM1E_CONTROL_PROTOCOL = 1,
    CM1E_MESSAGE_HEADER = 4,
    CM1E_REQUEST_MAX = 1 << 16, /**< bytes of a request without its header */
    CM1E_REPLY_MAX = 1 << 22,
};

typedef enum cm1e_message_state {
    CM1E_MESSAGE_PART = 0, /**< more bytes are needed */
    CM1E_MESSAGE_WHOLE,
    CM1E_MESSAGE_TOO_LONG, /**< nothing that follows can be read */
    CM1E_MESSAGE_NOT_JSON, /**< not one JSON object */
} cm1e_message_state_t;

/** Reads the message at the beginning of `bytes`. WHOLE and NOT_JSON: `*used` bytes belong to it. WHOLE: `*message` is
 *  the caller's. NOT_JSON: `why` says what is wrong and where. */
cm1e_message_state_t cm1e_message_read(const uint8_t *bytes, size_t length, size_t maximum, json_t **message,
                                       size_t *used, char why[JSON_ERROR_TEXT_LENGTH]);
/** The bytes of a message, to be freed; takes the reference to `message`. NULL: no memory, or it is too long. */
uint8_t *cm1e_message_write(json_t *message, size_t *length);

#endif
