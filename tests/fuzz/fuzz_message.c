#include <stdlib.h>
#include <string.h>

#include "control/message.h"
#include "fuzz.h"

/* A message of the control socket that can be read is written anew with the same meaning. */
bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    char why[JSON_ERROR_TEXT_LENGTH];
    json_t *message;
    size_t used = 0, length = 0;
    const cm1e_message_state_t state = cm1e_message_read(bytes, size, CM1E_REQUEST_MAX, &message, &used, why);
    if ((state == CM1E_MESSAGE_WHOLE) != (message != NULL) || used > size)
        fuzz_fail("state %d with %zu of %zu bytes", (int)state, used, size);
    if (state != CM1E_MESSAGE_WHOLE) {
        if (must)
            fuzz_fail("a message of ours cannot be read: %s", why);
        return false;
    }
    written->bytes = cm1e_message_write(message, &length);
    written->size = length;
    return written->bytes != NULL;
}

void fuzz_seeds(void)
{
    static const char *const requests[] = {
        "{\"request\":\"hello\",\"id\":1,\"protocol\":1}",
        "{\"request\":\"log\",\"after\":12}",
        "{\"request\":\"sdo_write\",\"slave\":2,\"index\":8705,\"subindex\":1,\"data\":\"11270000\"}",
    };
    for (size_t i = 0; i < sizeof requests / sizeof *requests; i++) {
        char name[] = "request0";
        size_t length;
        uint8_t *bytes = cm1e_message_write(json_loads(requests[i], 0, NULL), &length);
        name[7] = (char)('0' + i);
        if (!bytes)
            fuzz_fail("no memory");
        fuzz_seed(name, bytes, length);
        free(bytes);
    }
}
