#include "veth.h"

/** A user who is not root becomes root of a user namespace: programs started there keep their capabilities. */
static bool veth_become_root(void)
{
    const uid_t user = geteuid();
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0)
        return false;
    FILE *map = fopen("/proc/self/uid_map", "w");
    if (!map)
        return false;
    fprintf(map, "0 %u 1", (unsigned)user);
    return fclose(map) == 0;
}

bool veth_make(void)
{
    return (unshare(CLONE_NEWNET) == 0 || veth_become_root()) &&
           system("ip link add wire0 type veth peer name wire1 2>/dev/null && "
                  "ip link set wire0 up && ip link set wire1 up") == 0;
}
