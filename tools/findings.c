#include <stdio.h>

#include "cm1e/generate.h"
#include "command.h"
#include "files.h"

static int print_as_json(const char *path, const char *format, const cm1e_findings_t *findings, size_t errors)
{
    json_t *list = json_array();
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        json_array_append_new(list, json_pack("{s:s, s:s, s:i, s:s}", "rule", finding->rule, "severity",
                                              finding->is_error ? "error" : "warning", "line", (int)finding->line,
                                              "text", finding->text));
    }
    print_json(json_pack("{s:s, s:s, s:o}", "file", path, "format", format, "findings", list));
    return errors > 0 ? EXIT_FAILED : EXIT_OK;
}

int print_findings(const char *path, const char *format, const cm1e_findings_t *findings, bool json)
{
    const size_t count = cm1e_findings_count(findings);
    size_t errors = 0;
    for (size_t i = 0; i < count; i++)
        errors += cm1e_findings_at(findings, i)->is_error;
    if (json)
        return print_as_json(path, format, findings, errors);
    for (size_t i = 0; i < count; i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        printf("%s:%u: %s: %s [%s]\n", path, finding->line, finding->is_error ? "error" : "warning", finding->text,
               finding->rule);
    }
    printf("%s: %s, %zu error%s, %zu warning%s\n", path, format, errors, errors == 1 ? "" : "s", count - errors,
           count - errors == 1 ? "" : "s");
    return errors > 0 ? EXIT_FAILED : EXIT_OK;
}
