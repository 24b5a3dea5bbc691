#include "control/file_request.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/arguments.h"

struct control_file {
    cm1e_foe_t foe;
    uint8_t *bytes;
    size_t used, room;
    bool handed; /**< to the cycle */
    char name[CM1E_FILE_NAME];
};

static bool is_under_way(const control_file_t *file) { return file->handed && !cm1e_foe_done(&file->foe); }

/** The file of this connection; NULL: no memory. */
static control_file_t *file_of(control_run_t *run, const control_request_t *request)
{
    control_file_t **file = &run->files[request->client];
    if (!*file)
        *file = calloc(1, sizeof **file);
    return *file;
}

static bool make_room(control_file_t *file, size_t room)
{
    size_t grown = file->room ? file->room : CM1E_FILE_PIECE;
    while (grown < room)
        grown *= 2;
    uint8_t *bytes = grown > file->room ? realloc(file->bytes, grown) : file->bytes;
    if (!bytes)
        return false;
    file->bytes = bytes;
    file->room = grown;
    return true;
}

/* ---- the bytes -------------------------------------------------------------------------------------------------- */

static json_t *get(const control_request_t *request, const control_file_t *file, size_t offset)
{
    const size_t left = file->used - offset;
    const size_t piece = left < CM1E_FILE_PIECE ? left : CM1E_FILE_PIECE;
    const uint8_t *bytes = file->bytes ? file->bytes + offset : NULL; /* NULL: there has been none yet */
    return cm1e_request_accept(request->id, "data", cm1e_show_bytes(bytes, piece));
}

static json_t *put(const control_request_t *request, control_file_t *file, size_t offset, const json_t *message)
{
    size_t length;
    if (offset + CM1E_FILE_PIECE > CM1E_FILE_MAX || !make_room(file, offset + CM1E_FILE_PIECE))
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for the file, which may have up to 64 MiB.");
    if (!cm1e_take_bytes(message, "data", file->bytes + offset, CM1E_FILE_PIECE, &length))
        return wrong(request, "\"data\" is expected to be at most 16384 bytes as hexadecimal digits.");
    file->used = offset + length;
    return cm1e_request_accept(request->id, "data", json_null());
}

json_t *cm1e_file_data(control_request_t *request, control_run_t *run, const json_t *message)
{
    json_int_t offset;
    control_file_t *file = file_of(run, request);
    if (!file)
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a file.");
    if (is_under_way(file))
        return refuse(request, CM1E_ERROR_BUSY, "The file of this connection is on its way.");
    if (!cm1e_take_number(message, "offset", 0, (json_int_t)file->used, 0, &offset))
        return wrong(request, "\"offset\" is expected to be within the bytes that are there, or at their end.");
    return json_object_get(message, "data") ? put(request, file, (size_t)offset, message)
                                            : get(request, file, (size_t)offset);
}

/* ---- the transfer ----------------------------------------------------------------------------------------------- */

/** NULL: the members are right, and in `file`. */
static const char *take(control_file_t *file, const json_t *message)
{
    json_int_t slave, password, timeout_ms, maximum;
    const json_t *write = json_object_get(message, "write");
    const char *name = json_string_value(json_object_get(message, "name"));
    if (!cm1e_take_number(message, "slave", 1, CM1E_MAX_SLAVES, 0, &slave))
        return "\"slave\" is expected to be the position of a slave, 1 = first.";
    if (!name || strlen(name) >= sizeof file->name)
        return "\"name\" is expected to be the name of the file in the slave, up to 255 bytes.";
    if (write && !json_is_boolean(write))
        return "\"write\" is expected to be true or false.";
    if (!cm1e_take_number(message, "password", 0, UINT32_MAX, 0, &password) ||
        !cm1e_take_number(message, "timeout_ms", 1, 600000, 5000, &timeout_ms) ||
        !cm1e_take_number(message, "maximum", 1, CM1E_FILE_MAX, 1 << 24, &maximum))
        return "\"password\" is expected to be 0 ... 4294967295, \"timeout_ms\" 1 ... 600000 and \"maximum\" 1 ... "
               "67108864.";
    snprintf(file->name, sizeof file->name, "%s", name);
    file->handed = false;
    file->foe = (cm1e_foe_t){.position = (uint16_t)slave, .writing = json_is_true(write), .name = file->name,
                             .options = {.password = (uint32_t)password, .answer_ns = timeout_ms * 1000000},
                             .room = (size_t)maximum};
    return NULL;
}

/** Bytes that are written, or room for what is read. */
static bool give_bytes(control_file_t *file)
{
    cm1e_foe_t *foe = &file->foe;
    if (!make_room(file, foe->writing ? 1 : foe->room))
        return false;
    foe->from = foe->writing ? file->bytes : NULL;
    foe->to = foe->writing ? NULL : file->bytes;
    foe->size = foe->writing ? file->used : 0;
    if (!foe->writing)
        file->used = 0;
    return true;
}

static json_t *handed_in(const control_request_t *request, control_file_t *file, cm1e_error_t error)
{
    file->handed = error == CM1E_OK;
    if (error == CM1E_ERROR_BUSY)
        return refuse(request, error, "Another file is on its way: one at a time for the whole network.");
    return error == CM1E_OK ? cm1e_request_accept(request->id, "file_begin", json_null())
                            : refuse(request, error, cm1e_strerror(error));
}

json_t *cm1e_file_begin(control_request_t *request, control_run_t *run, const json_t *message)
{
    cm1e_diag_t diag = {0};
    control_file_t *file = file_of(run, request);
    if (!file)
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a file.");
    if (is_under_way(file))
        return refuse(request, CM1E_ERROR_BUSY, "The file of this connection is on its way.");
    const char *bad = take(file, message);
    if (bad)
        return wrong(request, bad);
    if (!give_bytes(file))
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a file of this size.");
    if (cm1e_foe_check(run->view.bus, &file->foe, &diag) != CM1E_OK)
        return refuse(request, diag.error, diag.text);
    if (!file->foe.writing)
        return handed_in(request, file, cm1e_foe_submit(run->view.bus, &file->foe, NULL));
    request->file = file;
    return cm1e_request_write(request, (view_write_t){.file = &file->foe});
}

json_t *cm1e_file_decided(const control_request_t *request)
{
    return handed_in(request, request->file, request->write.result);
}

json_t *cm1e_file_look(control_request_t *request, control_run_t *run, const json_t *message)
{
    cm1e_diag_t diag = {0};
    control_file_t *file = run->files[request->client];
    if (!file || !file->handed)
        return refuse(request, CM1E_ERROR_STATE, "This connection has no file on its way: \"file_begin\".");
    if (json_is_true(json_object_get(message, "stop")))
        cm1e_foe_cancel(&file->foe);
    const bool ended = cm1e_foe_done(&file->foe);
    const size_t done = __atomic_load_n(&file->foe.done, __ATOMIC_RELAXED);
    if (ended && !file->foe.writing)
        file->used = done;
    if (ended && cm1e_foe_result_of(&file->foe, &diag) != CM1E_OK)
        return cm1e_request_refuse(request->id, diag.error, diag.foreign_code, diag.text);
    return cm1e_request_accept(request->id, "file", json_pack("{s:I, s:I, s:b}", "done", (json_int_t)done, "size",
                                             (json_int_t)file->foe.size, "ended", ended));
}

bool cm1e_file_leave(control_run_t *run, uint32_t client)
{
    control_file_t *file = run->files[client];
    if (!file)
        return true;
    if (is_under_way(file)) {
        cm1e_foe_cancel(&file->foe);
        return false;
    }
    free(file->bytes);
    free(file);
    run->files[client] = NULL;
    return true;
}
