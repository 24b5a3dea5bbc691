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

void cm1e_program_cure(char *text, size_t size)
{
    static const struct { int capability; const char *name; } needed[] = {
        {CAP_NET_RAW, "CAP_NET_RAW"}, {CAP_SYS_NICE, "CAP_SYS_NICE"}, {CAP_IPC_LOCK, "CAP_IPC_LOCK"}};
    char path[160], lacking[64] = "";
    for (size_t i = 0, used = 0; i < sizeof needed / sizeof needed[0]; i++)
        if (prctl(PR_CAPBSET_READ, needed[i].capability) == 0)
            used += (size_t)snprintf(lacking + used, sizeof lacking - used, "%s %s", used ? "," : "",
                                     needed[i].name);
    cm1e_program_path(path, sizeof path);
    if (lacking[0])
        snprintf(text, size, "Not even root has%s in this container or service: start that with what it lacks "
                 "(docker run --network host --cap-add NET_RAW --cap-add SYS_NICE --cap-add IPC_LOCK)", lacking);
    else
        snprintf(text, size, "Start the program with sudo, or give it the privileges once: sudo setcap "
                 "cap_net_raw,cap_sys_nice,cap_ipc_lock+ep %s", path);
}
