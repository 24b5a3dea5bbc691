/* Located variables: %IX3.0.5 is bit 5 of byte 0 of the inputs of slave 3. */
#include <stdlib.h>
#include <string.h>

#include "st/st_parsing.h"

/** Bits that the letter of an address stands for; 0: none, and "X" may be left out. */
static int bits_of(char letter)
{
    static const char letters[] = "XBWDL";
    static const int bits[] = {1, 8, 16, 32, 64};
    const char *at = letter ? strchr(letters, letter) : NULL;
    return at ? bits[at - letters] : 0;
}

static char capital(char letter) { return (char)(letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter); }

static int bits_of_type(const type_t *type)
{
    if (type->kind == T_BOOL)
        return 1;
    const bool simple = cm1e_st_is_bits(type->kind) || cm1e_st_is_number(type->kind);
    return simple ? cm1e_st_bits(type->kind) : 0;
}

void cm1e_st_check_address(st_t *st, const var_t *var)
{
    const char *address = var->address->name;
    const place_t place = var->address->place;
    const char area = capital(address[1]);
    const int letter = bits_of(capital(address[2])), bits = letter ? letter : 1;
    const char *at = address + (letter ? 3 : 2);
    unsigned long numbers[4] = {0};
    int count = 0;
    if (area == 'M' || *at == '*') {
        cm1e_st_report(st, place, area == 'M' ? "%%M is not supported: a variable needs no address to be kept" :
                       "an address with * is not supported: write the place, as in %%IX3.0.5");
        return;
    }
    for (char *end; count < 4 && *at; count++) {
        numbers[count] = strtoul(at, &end, 10);
        at = *end == '.' ? end + 1 : end;
    }
    if (*at || count != (bits == 1 ? 3 : 2) || numbers[0] < 1 || numbers[0] > 65535 || numbers[1] > 4095 || numbers[2] > 7)
        cm1e_st_report(st, place, "an address has the slave (1 = first), the byte in its inputs or outputs, and of a BOOL the "
                       "bit: %%IX3.0.5, %%QW2.4");
    else if (bits_of_type(var->type) != bits)
        cm1e_st_report(st, place, "%s has %d bit%s, and %s is %s", address, bits, bits == 1 ? "" : "s", var->name,
                       cm1e_st_type_name(var->type));
}

/** RETAIN keeps values, not the state of blocks or where something is. */
bool cm1e_st_can_be_kept(const type_t *type)
{
    if (type->kind == T_ARRAY)
        return cm1e_st_can_be_kept(type->element);
    if (type->kind == T_STRUCT && !type->external) {
        for (const var_t *var = type->members; var; var = var->next)
            if (!cm1e_st_can_be_kept(var->type))
                return false;
        return true;
    }
    return type->kind <= T_DT || type->kind == T_STRING || type->kind == T_ENUM || type->kind == T_WRONG;
}
