/* AF_XDP, as the library has it behind `eth1,xdp`. */
#include <errno.h>
#include <net/if.h>
#include <stdio.h>

#include "nic/xdp_socket.h"
#include "socket_ways.h"

static void *open_xdp(unsigned interface_index)
{
    char name[IF_NAMESIZE];
    cm1e_xdp_socket_t *x = NULL;
    cm1e_diag_t why = {0};
    const cm1e_error_t error = if_indextoname(interface_index, name) ? cm1e_xdp_socket_open(&x, name, &why) : CM1E_ERROR_NOT_FOUND;
    if (error != CM1E_OK)
        fprintf(stderr, "%s\n", why.text);
    errno = error == CM1E_ERROR_PERMISSION ? EPERM : EOPNOTSUPP;
    return x;
}

static bool send_by_xdp(void *state, const uint8_t *frame, size_t length)
{
    way_calls++;
    return cm1e_xdp_socket_send(state, frame, length);
}

static size_t receive_by_xdp(void *state, uint8_t *frame)
{
    size_t length = cm1e_xdp_socket_receive(state, frame, WAY_FRAME_MAX);
    while (length == 0 && way_sleep(cm1e_xdp_socket_fd(state)))
        length = cm1e_xdp_socket_receive(state, frame, WAY_FRAME_MAX);
    return length;
}

static void close_xdp(void *state) { cm1e_xdp_socket_close(state); }

const way_t way_xdp = {"AF_XDP (the library's xdp)", open_xdp, send_by_xdp, receive_by_xdp, close_xdp};
