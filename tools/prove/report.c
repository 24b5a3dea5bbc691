/* The report: JSON for programs, Markdown for people, lines on standard output. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cm1e/version.h"
#include "core/json_text.h"
#include "prove/prove.h"

static const char *const verdicts[] = {"agrees", "differs", "unknown", "not tried"};
enum { VERDICTS = sizeof verdicts / sizeof verdicts[0] };

static json_t *counts_of(const json_t *points)
{
    json_t *counts = json_object();
    for (int i = 0; i < VERDICTS; i++) {
        int count = 0;
        for (size_t n = 0; n < json_array_size(points); n++)
            count += strcmp(json_string_value(json_object_get(json_array_get(points, n), "verdict")), verdicts[i]) == 0;
        json_object_set_new(counts, verdicts[i], json_integer(count));
    }
    return counts;
}

static json_t *device_as_json(const prove_t *prove)
{
    const cm1e_slave_info_t *slave = prove->slave;
    return json_pack("{s:s, s:o, s:o, s:I, s:I, s:I, s:I, s:i, s:i, s:i, s:b}", "kind", prove->device->kind, "name",
                     cm1e_json_text(slave->name), "firmware", cm1e_json_text(slave->software_version), "vendor",
                     (json_int_t)slave->vendor_id, "product", (json_int_t)slave->product_code, "revision",
                     (json_int_t)slave->revision, "serial", (json_int_t)slave->serial_number, "position",
                     slave->position, "alias", slave->alias, "explicit_id", slave->explicit_id, "simulated",
                     is_simulated(prove->config));
}

json_t *prove_report(const prove_t *prove)
{
    char moment[32] = "";
    const time_t now = time(NULL);
    struct tm utc;
    if (gmtime_r(&now, &utc))
        strftime(moment, sizeof moment, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return json_pack("{s:s, s:s, s:o, s:o, s:O}", "cm1e", cm1e_version(), "time", moment, "device",
                     device_as_json(prove), "counts", counts_of(prove->results), "points", prove->results);
}

static long long number_of(const json_t *object, const char *key)
{
    return json_integer_value(json_object_get(object, key));
}

/* ---- Markdown ---------------------------------------------------------------------------------------------------- */

/** A cell of a table: no bars, no line ends. */
static void print_cell(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '|' || *text == '\n')
            fputs(*text == '|' ? "\\|" : " ", file);
        else
            fputc(*text, file);
}

static void print_differences(FILE *file, const json_t *point)
{
    const json_t *differences = json_object_get(point, "differences");
    if (json_array_size(differences) == 0)
        return;
    fprintf(file, "\n### %s: %s (%s)\n\n| thing | our table | device |\n|---|---|---|\n", text_of(point, "id"),
            text_of(point, "what"), text_of(point, "clause"));
    for (size_t i = 0; i < json_array_size(differences); i++) {
        const json_t *row = json_array_get(differences, i);
        fputs("| ", file);
        print_cell(file, text_of(row, "thing"));
        fputs(" | ", file);
        print_cell(file, text_of(row, "expected"));
        fputs(" | ", file);
        print_cell(file, text_of(row, "found"));
        fputs(" |\n", file);
    }
}

static void print_markdown(FILE *file, const json_t *report)
{
    const json_t *device = json_object_get(report, "device"), *points = json_object_get(report, "points");
    const json_t *counts = json_object_get(report, "counts");
    fprintf(file, "# Acceptance of a device\n\n`cm1e prove` of cm1e %s, %s%s.\n\n| | |\n|---|---|\n",
            text_of(report, "cm1e"), text_of(report, "time"),
            json_is_true(json_object_get(device, "simulated")) ? ", **on the simulated segment**" : "");
    fprintf(file, "| device | %s, firmware %s |\n| identity | vendor 0x%08llX, product 0x%08llX, revision 0x%08llX, "
                  "serial number 0x%08llX |\n| place | position %lld, alias %lld, explicit device ID %lld |\n",
            text_of(device, "name"), text_of(device, "firmware"), number_of(device, "vendor"),
            number_of(device, "product"), number_of(device, "revision"), number_of(device, "serial"),
            number_of(device, "position"), number_of(device, "alias"), number_of(device, "explicit_id"));
    fprintf(file, "| points | %lld agree, %lld differ, %lld unknown, %lld not tried |\n\n"
                  "| point | what | clause | read by | compared | verdict | note |\n|---|---|---|---|---|---|---|\n",
            number_of(counts, "agrees"), number_of(counts, "differs"), number_of(counts, "unknown"),
            number_of(counts, "not tried"));
    for (size_t i = 0; i < json_array_size(points); i++) {
        const json_t *point = json_array_get(points, i);
        fprintf(file, "| `%s` | %s | %s | %s | %lld | %s | ", text_of(point, "id"), text_of(point, "what"),
                text_of(point, "clause"), text_of(point, "how"), number_of(point, "compared"),
                text_of(point, "verdict"));
        print_cell(file, text_of(point, "note"));
        fputs(" |\n", file);
    }
    fputs("\n## Differences\n", file);
    if (number_of(counts, "differs") == 0)
        fputs("\nNone.\n", file);
    for (size_t i = 0; i < json_array_size(points); i++)
        print_differences(file, json_array_get(points, i));
}

char *prove_markdown(const json_t *report)
{
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (!file)
        return NULL;
    print_markdown(file, report);
    const bool good = !ferror(file);
    if (fclose(file) == 0 && good)
        return text;
    free(text);
    return NULL;
}

/* ---- standard output --------------------------------------------------------------------------------------------- */

void prove_print(const json_t *report)
{
    enum { SHOWN = 8 };
    const json_t *points = json_object_get(report, "points"), *counts = json_object_get(report, "counts");
    for (size_t i = 0; i < json_array_size(points); i++) {
        const json_t *point = json_array_get(points, i), *differences = json_object_get(point, "differences");
        const size_t count = json_array_size(differences);
        printf("%-9s %-18s %s (%s)%s%s\n", text_of(point, "verdict"), text_of(point, "id"), text_of(point, "what"),
               text_of(point, "clause"), text_of(point, "note")[0] ? ": " : "", text_of(point, "note"));
        for (size_t n = 0; n < count && n < SHOWN; n++) {
            const json_t *row = json_array_get(differences, n);
            printf("            %s: our table %s; the device %s\n", text_of(row, "thing"), text_of(row, "expected"),
                   text_of(row, "found"));
        }
        if (count > SHOWN)
            printf("            and %zu more\n", count - SHOWN);
    }
    printf("\n%lld agree, %lld differ, %lld unknown, %lld not tried\n", number_of(counts, "agrees"),
           number_of(counts, "differs"), number_of(counts, "unknown"), number_of(counts, "not tried"));
}
