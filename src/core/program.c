#include "core/program.h"

#include <errno.h>
#include <linux/capability.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

enum { COMMAND_LINE = 512 };

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

void cm1e_program_name(char *text, size_t size)
{
    char line[COMMAND_LINE] = "";
    FILE *file = fopen("/proc/self/cmdline", "r");
    const size_t length = file ? fread(line, 1, sizeof line - 2, file) : 0;
    if (file)
        fclose(file);
    line[length] = line[length + 1] = 0;
    const char *word = line + strlen(line) + 1;
    const bool named = word < line + length && word[0] && word[0] != '-';
    snprintf(text, size, "%.23s%s%.22s", line[0] ? base_name(line) : program_invocation_short_name, named ? " " : "",
             named ? base_name(word) : "");
    for (char *c = text; *c; c++)
        *c = *c >= ' ' && *c <= '~' ? *c : '?';
}

void cm1e_program_path(char *path, size_t size)
{
    const ssize_t length = readlink("/proc/self/exe", path, size - 1);
    if (length > 0 && (size_t)length < size - 1)
        path[length] = '\0';
    else
        snprintf(path, size, "<program>");
}

static const struct { int number; const char *name; } privileges[] = {
    {CAP_NET_RAW, "cap_net_raw"}, {CAP_SYS_NICE, "cap_sys_nice"}, {CAP_IPC_LOCK, "cap_ipc_lock"}};
enum { PRIVILEGES = sizeof privileges / sizeof privileges[0] };
_Static_assert(CM1E_PRIVILEGE_RAW == UINT64_C(1) << CAP_NET_RAW && CM1E_PRIVILEGE_LOCK == UINT64_C(1) << CAP_IPC_LOCK &&
               CM1E_PRIVILEGE_PRIORITY == UINT64_C(1) << CAP_SYS_NICE, "numbers of the kernel");

void cm1e_program_privileges(char text[CM1E_PRIVILEGES_TEXT], uint64_t set)
{
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < PRIVILEGES; i++)
        if (set >> privileges[i].number & 1)
            used += (size_t)snprintf(text + used, CM1E_PRIVILEGES_TEXT - used, "%s%s", used ? "," : "",
                                     privileges[i].name);
}

void cm1e_program_cure(char *text, size_t size, uint64_t needed)
{
    char path[160], names[CM1E_PRIVILEGES_TEXT];
    uint64_t permitted = 0;
    for (int i = 0; i < PRIVILEGES; i++)
        if (prctl(PR_CAPBSET_READ, privileges[i].number) != 0)
            permitted |= UINT64_C(1) << privileges[i].number;
    const uint64_t lacking = needed & ~permitted;
    cm1e_program_path(path, sizeof path);
    cm1e_program_privileges(names, lacking ? lacking : permitted);
    if (lacking)
        snprintf(text, size, "Not even root has %s in this container or service: start that with it (docker run "
                 "--network host --cap-add NET_RAW --cap-add SYS_NICE --cap-add IPC_LOCK; CapabilityBoundingSet of "
                 "systemd)", names);
    else
        snprintf(text, size, "Start the program with sudo, or give it the privileges once: sudo setcap %s+ep %s", names,
                 path);
}
