#include "core/program.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
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
