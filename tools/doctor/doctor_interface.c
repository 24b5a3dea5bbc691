/* The network interface, seen from the kernel: nothing is sent. */
#include <arpa/inet.h>
#include <dirent.h>
#include <errno.h>
#include <ifaddrs.h>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/text.h"
#include "doctor/doctor.h"

static const char group[] = "interface";
enum { TYPE_ETHERNET = 1 };

/** "eth0, eth1 (wireless)": what could have been meant. */
static void list_interfaces(const doctor_t *doctor, char *list, size_t size)
{
    char path[512];
    size_t used = 0;
    list[0] = '\0';
    snprintf(path, sizeof path, "%s/sys/class/net", doctor->root);
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder)) && used + 1 < size;) {
        char type[16];
        if (entry->d_name[0] == '.' ||
            !doctor_line(doctor, type, sizeof type, "/sys/class/net/%s/type", entry->d_name) ||
            strtol(type, NULL, 10) != TYPE_ETHERNET)
            continue;
        used +=
            (size_t)snprintf(list + used, size - used, "%s%s%s", used ? ", " : "", entry->d_name,
                             doctor_exists(doctor, "/sys/class/net/%s/phy80211", entry->d_name) ? " (wireless)" : "");
    }
    if (folder)
        closedir(folder);
}

static bool is_there(doctor_t *doctor, const char *name)
{
    char list[300], type[16];
    if (!strchr(name, '/') && doctor_line(doctor, type, sizeof type, "/sys/class/net/%s/type", name)) {
        if (strtol(type, NULL, 10) == TYPE_ETHERNET)
            return true;
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, name, "is not an Ethernet interface"),
                      "EtherCAT needs Ethernet frames.", "Choose the interface to which the slaves are connected.",
                      "%s", "");
        return false;
    }
    list_interfaces(doctor, list, sizeof list);
    doctor_advise(
        doctor_find(doctor, FINDING_PROBLEM, group, name, "does not exist. There are: %s", list[0] ? list : "none"),
        NULL, "Choose one of these, or look with `ip link` where the interface is.", "%s", "");
    return false;
}

static void look_at_kind(doctor_t *doctor, const char *name)
{
    char path[512], target[512] = "";
    snprintf(path, sizeof path, "%s/sys/class/net/%s/device/driver", doctor->root, name);
    const ssize_t length = readlink(path, target, sizeof target - 1);
    target[length > 0 ? length : 0] = '\0';
    const char *driver = strrchr(target, '/') ? strrchr(target, '/') + 1 : "none (virtual)";
    if (doctor_exists(doctor, "/sys/class/net/%s/phy80211", name) ||
        doctor_exists(doctor, "/sys/class/net/%s/wireless", name)) {
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, name, "is wireless"),
                      "EtherCAT runs on a cable: frames must come back within a cycle, unchanged.",
                      "Use an Ethernet port.", "%s", "");
        return;
    }
    static const char *const usb[] = {"asix", "ax88179_178a", "cdc_ncm", "cdc_ether", "r8152", "smsc95xx", "lan78xx"};
    for (size_t i = 0; i < sizeof usb / sizeof usb[0]; i++)
        if (strcmp(driver, usb[i]) == 0) {
            doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, name, "is connected by USB (driver %s)", driver),
                          "USB delays frames by up to a millisecond, and not always by the same time.",
                          "Use a port on PCI Express, or a cycle of 1 ms and `motion: drive`.", "%s", "");
            return;
        }
    doctor_find(doctor, FINDING_GOOD, group, name, "Ethernet, driver %s", driver);
}

static void look_at_link(doctor_t *doctor, const char *name)
{
    char flags[32], carrier[8], speed[16], duplex[16];
    doctor_line(doctor, flags, sizeof flags, "/sys/class/net/%s/flags", name);
    if (!(strtoul(flags, NULL, 0) & IFF_UP)) {
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "link", "%s is down", name), NULL, "Set it up.",
                      "ip link set %s up", name);
        return;
    }
    if (doctor_line(doctor, carrier, sizeof carrier, "/sys/class/net/%s/carrier", name) && carrier[0] == '0') {
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "link", "%s has no link", name),
                      "Nothing at the other end of the cable answers electrically.",
                      "Check that the cable is in the IN port of the first slave, and that the slave has its power.",
                      "%s", "");
        return;
    }
    doctor_line(doctor, speed, sizeof speed, "/sys/class/net/%s/speed", name);
    doctor_line(doctor, duplex, sizeof duplex, "/sys/class/net/%s/duplex", name);
    const long megabits = strtol(speed, NULL, 10);
    if ((megabits > 0 && megabits < 100) || strcmp(duplex, "half") == 0) {
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "link", "%ld Mbit/s, %s duplex", megabits, duplex),
                      "EtherCAT slaves run at 100 Mbit/s, full duplex.",
                      "Connect the first slave directly, without a hub or switch between them; replace the cable.",
                      "ethtool -s %s autoneg on", name);
        return;
    }
    if (megabits > 0)
        doctor_find(doctor, FINDING_GOOD, group, "link", "%ld Mbit/s, %s duplex", megabits, duplex);
    else
        doctor_find(doctor, FINDING_GOOD, group, "link", "up");
}

/* ---- who else uses it ------------------------------------------------------------------------------------------ */

static const char chatter[] =
    "The kernel sends its own frames (ARP, DHCP, neighbour discovery) between those of the bus: "
    "they delay cycles, and a slave may pass them on.";

static void look_at_bridge(doctor_t *doctor, const char *name)
{
    char path[512], target[256] = "";
    snprintf(path, sizeof path, "%s/sys/class/net/%s/master", doctor->root, name);
    const ssize_t length = readlink(path, target, sizeof target - 1);
    target[length > 0 ? length : 0] = '\0';
    if (length > 0)
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "bridge", "%s belongs to the bridge or bond %s", name,
                                  strrchr(target, '/') ? strrchr(target, '/') + 1 : target),
                      "A bridge takes the frames of the slaves, and sends frames of others to them.",
                      "Take the interface out.", "ip link set %s nomaster", name);
    if (doctor_exists(doctor, "/sys/class/net/%s/bridge", name))
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "bridge", "%s is a bridge", name),
                      "A bridge forwards frames to all of its ports.", "Use the port itself, outside a bridge.", "%s",
                      "");
}

static void look_at_addresses(doctor_t *doctor, const char *name)
{
    struct ifaddrs *all = NULL;
    char list[300] = "", text[INET6_ADDRSTRLEN];
    size_t used = 0;
    if (getifaddrs(&all) != 0)
        return;
    for (const struct ifaddrs *i = all; i && used + 1 < sizeof list; i = i->ifa_next) {
        if (!i->ifa_addr || strcmp(i->ifa_name, name) != 0)
            continue;
        const void *address = i->ifa_addr->sa_family == AF_INET
                                  ? (const void *)&((const struct sockaddr_in *)(const void *)i->ifa_addr)->sin_addr
                              : i->ifa_addr->sa_family == AF_INET6
                                  ? (const void *)&((const struct sockaddr_in6 *)(const void *)i->ifa_addr)->sin6_addr
                                  : NULL;
        if (address && inet_ntop(i->ifa_addr->sa_family, address, text, sizeof text))
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", text);
    }
    freeifaddrs(all);
    if (used == 0)
        doctor_find(doctor, FINDING_GOOD, group, "addresses", "none");
    else
        doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, "addresses", "%s has %s", name, list), chatter,
                      "Give the interface to the bus alone.",
                      "sysctl -w net.ipv6.conf.%s.disable_ipv6=1; ip address flush dev %s", name, name);
}

static void look_at_managers(doctor_t *doctor, const char *name)
{
    char index[16], path[512], line[256];
    bool managed = false;
    if (!doctor_line(doctor, index, sizeof index, "/sys/class/net/%s/ifindex", name))
        return;
    snprintf(path, sizeof path, "%s/run/NetworkManager/devices/%s", doctor->root, index);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        managed |= strncmp(line, "managed=true", 12) == 0;
    if (file)
        fclose(file);
    if (managed)
        doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, "NetworkManager", "it manages %s", name),
                      "It asks for addresses again and again, and may take the link down for a moment.",
                      "Make it leave the interface alone, for good.",
                      "printf '[keyfile]\\nunmanaged-devices=interface-name:%s\\n' > "
                      "/etc/NetworkManager/conf.d/90-ethercat-%s.conf; nmcli general reload",
                      name, name);
    if (doctor_line(doctor, line, sizeof line, "/run/systemd/netif/leases/%s", index))
        doctor_advise(
            doctor_find(doctor, FINDING_ADVICE, group, "systemd-networkd", "it has an address for %s by DHCP", name),
            chatter, "Make it leave the interface alone.",
            "printf '[Match]\\nName=%s\\n[Link]\\nUnmanaged=yes\\n' > /etc/systemd/network/00-ethercat-%s.network; "
            "networkctl reload",
            name, name);
}

/* ---- what the card does to frames ------------------------------------------------------------------------------ */

static bool ask_card(const char *name, void *question)
{
    struct ifreq request = {0};
    const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (handle < 0)
        return false;
    snprintf(request.ifr_name, sizeof request.ifr_name, "%s", name);
    request.ifr_data = question;
    const bool answered = ioctl(handle, SIOCETHTOOL, &request) == 0;
    close(handle);
    return answered;
}

static void look_at_coalescing(doctor_t *doctor, const char *name)
{
    struct ethtool_coalesce coalesce = {.cmd = ETHTOOL_GCOALESCE};
    if (!ask_card(name, &coalesce))
        return;
    if (coalesce.rx_coalesce_usecs == 0 && coalesce.rx_max_coalesced_frames <= 1 &&
        !coalesce.use_adaptive_rx_coalesce) {
        doctor_find(doctor, FINDING_GOOD, group, "interrupt coalescing", "off");
        return;
    }
    doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, "interrupt coalescing",
                              "the card waits %u us or %u frames%s "
                              "before it tells of a frame",
                              coalesce.rx_coalesce_usecs, coalesce.rx_max_coalesced_frames,
                              coalesce.use_adaptive_rx_coalesce ? ", adaptively," : ""),
                  "A frame that is back waits in the card, and the cycle for it.", "Switch it off.",
                  "ethtool -C %s adaptive-rx off rx-usecs 0 rx-frames 1 tx-usecs 0", name);
}

static void look_at_offloads(doctor_t *doctor, const char *name)
{
    struct ethtool_value gro = {.cmd = ETHTOOL_GGRO}, flags = {.cmd = ETHTOOL_GFLAGS};
    const bool has_gro = ask_card(name, &gro) && gro.data,
               has_lro = ask_card(name, &flags) && flags.data & ETH_FLAG_LRO;
    if (!has_gro && !has_lro)
        doctor_find(doctor, FINDING_GOOD, group, "offloads", "no received frames are merged");
    else
        doctor_advise(doctor_find(doctor, FINDING_NOTE, group, "offloads", "received frames may be merged (%s%s%s)",
                                  has_gro ? "GRO" : "", has_gro && has_lro ? ", " : "", has_lro ? "LRO" : ""),
                      "Of no use for EtherCAT; a driver may hold frames back for it.", "Switch it off.",
                      "ethtool -K %s gro off lro off", name);
}

/** A program can be in another network namespace than the one that /sys was mounted in. */
static bool is_out_of_sight(const doctor_t *doctor, const char *name)
{
    return !doctor->root[0] && if_nametoindex(name) != 0 && !doctor_exists(doctor, "/sys/class/net/%s", name);
}

bool doctor_look_at_interface(doctor_t *doctor, const char *name)
{
    if (is_out_of_sight(doctor, name)) {
        doctor_find(doctor, FINDING_NOTE, group, name,
                    "is in a network namespace that /sys does not show: its driver and "
                    "its link were not looked at");
        look_at_addresses(doctor, name);
        return true;
    }
    if (!is_there(doctor, name))
        return false;
    look_at_kind(doctor, name);
    look_at_link(doctor, name);
    look_at_bridge(doctor, name);
    look_at_addresses(doctor, name);
    look_at_managers(doctor, name);
    look_at_coalescing(doctor, name);
    look_at_offloads(doctor, name);
    doctor_look_at_interrupts(doctor, name);
    return true;
}
