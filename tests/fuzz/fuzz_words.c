/* Words of the command line and of files: numbers, times, values of variables. A word either is a finite value within its
 * range, or is complained of. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz_complain.h"
#include "variable_value.h"

static void expect(bool good, unsigned before, const char *what)
{
    if (good == (complaints > before))
        fuzz_fail(good ? "%s: a complaint of a good word" : "%s: refused without a complaint", what);
}

static void use_numbers(const char *word)
{
    long long whole;
    double real;
    unsigned before = complaints;
    bool good = parse_number(word, "it", -10, 1000, &whole);
    expect(good, before, "a whole number");
    if (good && (whole < -10 || whole > 1000))
        fuzz_fail("%lld", whole);
    before = complaints;
    good = parse_real(word, "it", &real);
    expect(good, before, "a number");
    if (good && !isfinite(real))
        fuzz_fail("%g", real);
    before = complaints;
    good = parse_positive(word, "it", &real);
    expect(good, before, "a number above 0");
    before = complaints;
    good = parse_seconds(word, 100, &real);
    expect(good, before, "a time");
    if (good && !(real > 0 && real <= 100))
        fuzz_fail("%g s", real);
}

static const struct { const char *type, *declared; bool enumeration; } kinds[] = {
    {"INT", "INT", false}, {"LINT", "TIME", false}, {"ULINT", "LWORD", false}, {"BOOL", "BOOL", false},
    {"REAL", "REAL", false}, {"STRING", "STRING[6]", false}, {"DINT", "E", true},
};

static void use_value(const char *type, const char *declared, bool enumeration, const char *word)
{
    const unsigned before = complaints;
    json_t *row = json_pack("{s:s, s:s, s:s, s:s}", "name", "Main.v", "type", type, "declared", declared, "unit",
                            strcmp(declared, "TIME") == 0 ? "ns" : "");
    if (enumeration)
        json_object_set_new(row, "enumerator", json_null());
    json_t *value = variable_value(row, word);
    expect(value != NULL, before, "a value of a variable");
    if (value && !json_is_boolean(value) && !json_is_number(value) && !json_is_string(value))
        fuzz_fail("a value is no number, truth value or text");
    json_decref(value);
    json_decref(row);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    char *word = malloc(size + 1);
    if (!word)
        fuzz_fail("no memory");
    if (size > 0)
        memcpy(word, bytes, size);
    word[size] = 0;
    use_numbers(word);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        use_value(kinds[i].type, kinds[i].declared, kinds[i].enumeration, word);
    free(word);
    return false;
}

void fuzz_seeds(void)
{
    static const char *const words[] = {"TRUE", "-0x1F", "1e3", "nan", "'te$Nxt'", "\"w\"", "1,5", "inf", "1e999", "-7", "T#1m5s",
                                        "16#FF", "DT#2024-02-29-1:2:3", "E.A"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        char name[16];
        snprintf(name, sizeof name, "word_%zu", i);
        fuzz_seed(name, words[i], strlen(words[i]));
    }
}
