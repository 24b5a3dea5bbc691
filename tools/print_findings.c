#include <stdio.h>

#include "cm1e/generate.h"
#include "command.h"
#include "core/json_text.h"
#include "files.h"

const char *finding_severity(const cm1e_finding_t *finding) { return finding->is_error ? "error" : "warning"; }

json_t *findings_as_list(const cm1e_findings_t *findings, const char *place)
{
    json_t *list = json_array();
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        json_array_append_new(list, json_pack("{s:s, s:s, s:i, s:s}", "rule", finding->rule, "severity",
                                              finding_severity(finding), place, (int)finding->line, "text",
                                              finding->text));
    }
    return list;
}

json_t *findings_as_json(const char *path, const char *format, const cm1e_findings_t *findings)
{
    return json_pack("{s:o, s:s, s:o}", "file", cm1e_json_text(path), "format", format, "findings",
                     findings_as_list(findings, "line"));
}

static size_t count_errors(const cm1e_findings_t *findings)
{
    size_t errors = 0;
    for (size_t i = 0; i < cm1e_findings_count(findings); i++)
        errors += cm1e_findings_at(findings, i)->is_error;
    return errors;
}

int findings_status(const cm1e_findings_t *findings) { return count_errors(findings) > 0 ? EXIT_FAILED : EXIT_OK; }

int print_findings(const char *path, const char *format, const cm1e_findings_t *findings, bool json)
{
    const size_t count = cm1e_findings_count(findings), errors = count_errors(findings);
    if (json) {
        print_json(findings_as_json(path, format, findings));
        return findings_status(findings);
    }
    for (size_t i = 0; i < count; i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        printf("%s:%u: %s: %s [%s]\n", path, finding->line, finding_severity(finding), finding->text,
               finding->rule);
    }
    printf("%s: %s, %zu error%s, %zu warning%s\n", path, format, errors, errors == 1 ? "" : "s", count - errors,
           count - errors == 1 ? "" : "s");
    return findings_status(findings);
}
