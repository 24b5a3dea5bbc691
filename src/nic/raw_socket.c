#include "nic/raw_socket.h"

#include <arpa/inet.h>
#include <errno.h>
#include <linux/ethtool.h>
#include <linux/if_packet.h>
#include <linux/sockios.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "config/interface.h"
#include "core/program.h"
#include "nic/nic.h"

enum { ETHERTYPE_ETHERCAT = 0x88A4, RECEIVE_BUFFER = 1 << 20, DRAIN_LIMIT = 65536 };

#ifndef PACKET_IGNORE_OUTGOING
#define PACKET_IGNORE_OUTGOING 23 /* Linux 4.20 */
#endif

/** Names of the Ethernet interfaces there are, for the diagnosis. */
static void list_interfaces(char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    struct if_nameindex *all = if_nameindex();
    for (struct if_nameindex *i = all; i && i->if_index != 0 && used < size; i++)
        if (strcmp(i->if_name, "lo") != 0) {
            const int n = snprintf(text + used, size - used, "%s%s", used ? ", " : "", i->if_name);
            used += n > 0 ? (size_t)n : 0;
        }
    if (all)
        if_freenameindex(all);
    if (!text[0])
        snprintf(text, size, "none");
}

static cm1e_error_t check_interface(int fd, const char *name, cm1e_diag_t *diag)
{
    struct ifreq request = {0};
    memcpy(request.ifr_name, name, strlen(name));
    if (ioctl(fd, SIOCGIFHWADDR, &request) < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "Network interface \"%s\" cannot be asked for its kind: %s.", name,
                             strerror(errno));
    if (request.ifr_hwaddr.sa_family != ARPHRD_ETHER)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "Network interface \"%s\" is not Ethernet: EtherCAT needs an Ethernet interface.", name);
    if (ioctl(fd, SIOCGIFFLAGS, &request) < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "Network interface \"%s\" cannot be asked for its state: %s.",
                             name, strerror(errno));
    if (!(request.ifr_flags & IFF_UP))
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0,
                             "Network interface \"%s\" is down. Bring it up with: sudo ip link set %s up", name, name);
    return CM1E_OK;
}

/* The driver knows at once that the link is lost. The flags follow up to a second later, but do so for a link that
 * comes, too: the kernel sends nothing before. */
static bool says_no_link(int fd, const char *interface_name)
{
    struct ethtool_value link = {.cmd = ETHTOOL_GLINK};
    struct ifreq request = {.ifr_data = (void *)&link};
    memcpy(request.ifr_name, interface_name, cm1e_interface_length(interface_name));
    if (ioctl(fd, SIOCETHTOOL, &request) == 0 && link.data == 0)
        return true;
    return ioctl(fd, SIOCGIFFLAGS, &request) == 0 && !(request.ifr_flags & IFF_RUNNING);
}

bool cm1e_nic_lacks_link(const char *interface_name)
{
    if (cm1e_interface_length(interface_name) >= IFNAMSIZ)
        return false;
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const bool lacks = fd >= 0 && says_no_link(fd, interface_name);
    if (fd >= 0)
        close(fd);
    return lacks;
}

static cm1e_error_t no_socket(int why, cm1e_diag_t *diag)
{
    if (why != EPERM && why != EACCES)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "No packet socket: %s.", strerror(why));
    char cure[300];
    cm1e_program_cure(cure, sizeof cure, CM1E_PRIVILEGE_RAW);
    return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0,
                         "EtherCAT on a network interface needs the privilege CAP_NET_RAW. %s", cure);
}

/** Options that are useful, but not needed: a kernel without them still works. */
static void tune(int fd, int interface_index)
{
    const int on = 1, size = RECEIVE_BUFFER;
    /* Our own frames must not be received again. Older kernels mark them, see cm1e_raw_socket_receive(). */
    setsockopt(fd, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on);
    if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &size, sizeof size) < 0)
        setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
    /* Answers carry our made-up source address and whatever destination: take all. Ends with the socket. */
    const struct packet_mreq promiscuous = {.mr_ifindex = interface_index, .mr_type = PACKET_MR_PROMISC};
    setsockopt(fd, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &promiscuous, sizeof promiscuous);
}

static cm1e_error_t no_interface(const char *name, cm1e_diag_t *diag)
{
    char list[256];
    list_interfaces(list, sizeof list);
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0,
                         "There is no network interface \"%s\". There are: %s. \"sim\" is the simulated segment.", name,
                         list);
}

static cm1e_error_t set_up(int fd, const char *name, unsigned index, int ethertype, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check_interface(fd, name, diag);
    if (error != CM1E_OK)
        return error;
    tune(fd, (int)index);
    const struct sockaddr_ll address = {.sll_family = AF_PACKET, .sll_protocol = htons((uint16_t)ethertype),
                                        .sll_ifindex = (int)index};
    if (bind(fd, (const struct sockaddr *)&address, sizeof address) < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The packet socket cannot be bound to \"%s\": %s.", name,
                             strerror(errno));
    return CM1E_OK;
}

static cm1e_error_t open_socket(int *fd, const char *interface_name, unsigned index, int ethertype, cm1e_diag_t *diag)
{
    /* Protocol 0: nothing is received before bind() names the interface. */
    *fd = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (*fd < 0)
        return no_socket(errno, diag);
    const cm1e_error_t error = set_up(*fd, interface_name, index, ethertype, diag);
    if (error != CM1E_OK)
        return error;
    uint8_t stale[64];
    for (int i = 0; i < DRAIN_LIMIT && cm1e_raw_socket_receive(*fd, stale, sizeof stale) != 0; i++)
        ;
    return CM1E_OK;
}

static cm1e_error_t open_locked(cm1e_raw_socket_t *made, const char *interface_name, int ethertype, cm1e_diag_t *diag)
{
    *made = CM1E_RAW_SOCKET_CLOSED;
    /* The name and the owner first: it needs no privilege to say that the interface is wrong or in use. */
    const unsigned index = strlen(interface_name) < IFNAMSIZ ? if_nametoindex(interface_name) : 0;
    if (index == 0)
        return no_interface(interface_name, diag);
    cm1e_error_t error = cm1e_interface_lock_take(&made->lock, interface_name, diag);
    if (error == CM1E_OK)
        error = open_socket(&made->fd, interface_name, index, ethertype, diag);
    if (error != CM1E_OK)
        cm1e_raw_socket_close(made);
    return error;
}

cm1e_error_t cm1e_raw_socket_open(cm1e_raw_socket_t *made, const char *interface_name, cm1e_diag_t *diag)
{
    return open_locked(made, interface_name, ETHERTYPE_ETHERCAT, diag);
}

cm1e_error_t cm1e_raw_socket_hold(cm1e_raw_socket_t *made, const char *interface_name, cm1e_diag_t *diag)
{
    return open_locked(made, interface_name, 0, diag);
}

void cm1e_raw_socket_close(cm1e_raw_socket_t *closed)
{
    if (closed->fd >= 0)
        close(closed->fd);
    closed->fd = -1;
    cm1e_interface_lock_release(&closed->lock); /* last: nothing of ours is sent any more */
}

int cm1e_raw_socket_receive(int fd, uint8_t *frame, size_t room)
{
    struct sockaddr_ll from = {0};
    for (int i = 0; i < DRAIN_LIMIT; i++) {
        socklen_t size = sizeof from;
        const ssize_t n = recvfrom(fd, frame, room, MSG_DONTWAIT | MSG_TRUNC, (struct sockaddr *)&from, &size);
        if (n < 0)
            return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? 0 : -1;
        if (from.sll_pkttype == PACKET_OUTGOING)
            continue;
        return (size_t)n > room ? (int)room : (int)n;
    }
    return 0;
}
