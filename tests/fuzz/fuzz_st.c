#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "st/st.h"

/* A program that is good becomes C; one that is not has an error with a text and a place. Nothing is written anew. */
bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    char *text = NULL;
    size_t length = 0;
    const bool blocks = memmem(bytes, size, "MC_", 3) || memmem(bytes, size, "TON", 3);
    st_t *st = blocks ? cm1e_st_new() : cm1e_st_new_bare(); /* to read the interface of the blocks takes long */
    (void)written;
    (void)must;
    if (!st)
        fuzz_fail("no memory");
    cm1e_st_add_text(st, "source.st", (const char *)bytes, size);
    const bool good = cm1e_st_check(st);
    FILE *file = open_memstream(&text, &length);
    if (!file)
        fuzz_fail("no memory");
    if (good)
        cm1e_st_emit(st, file, "source.so");
    for (unsigned i = 0; i < cm1e_st_errors(st); i++) {
        const st_error_t error = cm1e_st_error(st, i);
        if (strcmp(error.file, "source.st") != 0 || error.line == 0 || error.column == 0 || !error.text[0])
            fuzz_fail("an error without a place or a text: %s:%u:%u: %s", error.file, error.line, error.column, error.text);
        cm1e_st_print_error(st, i, file);
    }
    fclose(file);
    if (good != (cm1e_st_errors(st) == 0) || length == 0)
        fuzz_fail("neither C nor an error");
    free(text);
    cm1e_st_free(st);
    return false;
}

void fuzz_seeds(void)
{
    static const char *const sources[] = {
        "TYPE C : (Red, Green := 5); P : STRUCT x, y : INT := 7; a : ARRAY[0..2] OF REAL := [1.5, 2(2)]; END_STRUCT; END_TYPE",
        "FUNCTION F : INT VAR_INPUT v : INT; END_VAR VAR_OUTPUT o : INT; END_VAR F := 2 * v; o := F; END_FUNCTION\n"
        "PROGRAM Main VAR i : INT; s : STRING(9) := 'a$N'; END_VAR i := F(v := 3, o => i); s := CONCAT(s, 'b'); END_PROGRAM",
        "VAR_GLOBAL X : AXIS_REF; END_VAR VAR_GLOBAL CONSTANT N : INT := 3; END_VAR\n"
        "PROGRAM Main VAR p : MC_Power; t : TON; a : ARRAY[1..N] OF BYTE; i : INT; END_VAR\n"
        "p(Axis := X, Enable := TRUE); t(IN := p.Status, PT := T#1s500ms, Q => a[1].3);\n"
        "FOR i := 1 TO N BY 2 DO IF i > 1 THEN EXIT; ELSIF i = 0 THEN CONTINUE; ELSE a[i] := 16#FF; END_IF END_FOR\n"
        "CASE i OF 1, 3..5: i := -i; ELSE RETURN; END_CASE WHILE i < 3 DO i := i + 1; END_WHILE\n"
        "REPEAT i := i MOD 2; UNTIL TRUE END_REPEAT END_PROGRAM",
        "NAMESPACE A.B USING C; CLASS ABSTRACT K VAR PUBLIC w : WSTRING[4] := \"a$0042\"; END_VAR METHOD M : INT (0..9)\n"
        "M := THIS.n; END_METHOD END_CLASS END_NAMESPACE FUNCTION_BLOCK E EXTENDS A.B.D VAR_INPUT u : BOOL R_EDGE; END_VAR\n"
        "METHOD FB_Init VAR_INPUT n : INT; END_VAR END_METHOD END_FUNCTION_BLOCK\n"
        "PROGRAM P VAR e : E(n := 3); es : ARRAY[1..2] OF E[(n := 1), (n := 2)];\n"
        "m AT %MX1.2 : BOOL; c : A.B.K; END_VAR m := c.M() = A.B.H#One; END_PROGRAM\n"
        "CONFIGURATION C RESOURCE R ON PC TASK t(SINGLE := p.m); PROGRAM p WITH t : P; END_RESOURCE END_CONFIGURATION",
        "CONFIGURATION C RESOURCE R ON PC TASK t(INTERVAL := T#10ms, PRIORITY := 1); PROGRAM a WITH t : Main; END_RESOURCE\n"
        "END_CONFIGURATION PROGRAM Main VAR RETAIN d AT %QX1.0.0 : BOOL; END_VAR (* (* *) *) // x\nEND_PROGRAM",
        "FUNCTION_BLOCK B VAR_IN_OUT v : LREAL; END_VAR VAR r : REF_TO LREAL; END_VAR v := SEL(r = NULL, 1.0, r^) ** 2;\n"
        "v := LIMIT(0.0, SQRT(ABS(v)), 10.0) + INT_TO_LREAL(3) / 2E0; END_FUNCTION_BLOCK",
    };
    char name[24];
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) {
        snprintf(name, sizeof name, "source_%zu.st", i);
        fuzz_seed(name, sources[i], strlen(sources[i]));
    }
}
