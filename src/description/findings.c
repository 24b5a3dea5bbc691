#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/text.h"
#include "description/check.h"

static const struct {
    const char *name;
    bool is_error;
} rules[CM1E_RULE_COUNT] = {
#define RULE_ROW(enumerator, name, is_error) {name, is_error},
    CM1E_RULES(RULE_ROW)
};

cm1e_findings_t *cm1e_findings_create(void)
{
    return calloc(1, sizeof(cm1e_findings_t));
}

void cm1e_findings_free(cm1e_findings_t *findings)
{
    if (!findings)
        return;
    cm1e_arena_free(&findings->arena);
    free(findings);
}

size_t cm1e_findings_count(const cm1e_findings_t *findings)
{
    return findings ? findings->list.count : 0;
}

const cm1e_finding_t *cm1e_findings_at(const cm1e_findings_t *findings, size_t n)
{
    return findings && n < findings->list.count ? &findings->list.at[n] : NULL;
}

static bool is_known(const cm1e_findings_t *findings, const char *rule, cm1e_place_t place, const char *text)
{
    for (size_t i = 0; i < findings->list.count; i++) {
        const cm1e_finding_t *known = &findings->list.at[i];
        if (known->line == place && known->rule == rule && strcmp(known->text, text) == 0)
            return true;
    }
    return false;
}

bool cm1e_findings_has(const cm1e_findings_t *findings, cm1e_rule_t rule, cm1e_place_t place)
{
    for (size_t i = 0; place != 0 && i < findings->list.count; i++)
        if (findings->list.at[i].line == place && findings->list.at[i].rule == rules[rule].name)
            return true;
    return false;
}

void cm1e_findings_add(cm1e_findings_t *findings, cm1e_rule_t rule, cm1e_place_t place, const char *format, ...)
{
    char text[1024];
    if (findings->list.count >= CM1E_FINDINGS_MAX)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    cm1e_text_clean(text);
    if (is_known(findings, rules[rule].name, place, text))
        return;
    const bool last = findings->list.count == CM1E_FINDINGS_MAX - 1;
    cm1e_finding_t *finding = CM1E_APPEND(&findings->arena, &findings->list);
    finding->rule = rules[rule].name;
    finding->is_error = rules[rule].is_error;
    finding->line = place;
    finding->text =
        cm1e_arena_format(&findings->arena, "%s%s", text, last ? " (There are more; the list ends here.)" : "");
}

static int by_line(const void *left, const void *right)
{
    const cm1e_finding_t *a = left, *b = right;
    if (a->line != b->line)
        return a->line < b->line ? -1 : 1;
    const int by_rule = strcmp(a->rule, b->rule);
    return by_rule != 0 ? by_rule : strcmp(a->text, b->text);
}

void cm1e_findings_sort(cm1e_findings_t *findings)
{
    if (findings->list.count > 0)
        qsort(findings->list.at, findings->list.count, sizeof findings->list.at[0], by_line);
}

cm1e_error_t cm1e_findings_give(cm1e_findings_t *findings, cm1e_error_t error, cm1e_findings_t **given,
                                cm1e_diag_t *diag)
{
    if (error == CM1E_OK && findings->arena.failed)
        error = cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    if (error != CM1E_OK) {
        cm1e_findings_free(findings);
        return error;
    }
    cm1e_findings_sort(findings);
    *given = findings;
    return CM1E_OK;
}
