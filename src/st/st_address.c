/* Located variables: %IX3.0.5 is bit 5 of byte 0 of the inputs of slave 3. */
#include <stdlib.h>
#include <string.h>

#include "st/st_emit.h"

enum { MEMORY_BYTES = 65536 };

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
    if (type->ranged)
        return 0;
    if (type->kind == T_BOOL)
        return 1;
    const bool simple = cm1e_st_is_bits(type->kind) || cm1e_st_is_number(type->kind);
    return simple ? cm1e_st_bits(type->kind) : 0;
}

/* ---- memory ------------------------------------------------------------------------------------------------------ */

/** Structures, arrays and texts begin at a byte; everything else has the size of its letter. */
static bool fits_memory(const type_t *type, int bits)
{
    const bool whole = type->kind == T_ARRAY || type->kind == T_STRUCT || type->kind == T_STRING;
    if (whole)
        return bits == 8 && cm1e_st_can_be_kept(type);
    return bits == (cm1e_st_is_time(type->kind) ? 64 : bits_of_type(type));
}

/** %MW4 are the bytes 4 and 5 of a memory that all programs share; %MX4.3 is bit 3 of byte 4. */
static void check_memory(st_t *st, var_t *var, const char *at, int bits)
{
    const char *address = var->address->name;
    char *end;
    const unsigned long byte = strtoul(at, &end, 10), bit = bits == 1 && *end == '.' ? strtoul(end + 1, &end, 10) : 8;
    const type_t *type = var->type;
    const uint64_t size = bits == 1 ? 1 : type->size, alignment = bits == 1 || !type->alignment ? 1 : type->alignment;
    if (*end || byte >= MEMORY_BYTES || (bits == 1) != (bit < 8)) {
        cm1e_st_report(st, var->address->place, "an address of memory has its byte, 0 ... %d, and of a BOOL the bit: "
                       "%%MW4, %%MX4.3", MEMORY_BYTES - 1);
    } else if (!fits_memory(type, bits)) {
        cm1e_st_report(st, var->address->place, "%s has %d bit%s, and %s is %s", address, bits, bits == 1 ? "" : "s",
                       var->name, cm1e_st_type_name(type));
    } else if (byte % alignment != 0) {
        cm1e_st_report(st, var->address->place, "%s of type %s begins at a byte that is a multiple of %llu", address,
                       cm1e_st_type_name(type), (unsigned long long)alignment);
    } else {
        var->in_memory = true;
        var->memory_bit = bits == 1 ? (int)bit + 1 : 0;
        var->c_name = cm1e_st_format(st->arena, "st_memory[%lu]", byte);
        if (bits > 1)
            var->c_name = cm1e_st_format(st->arena, "(*(%s *)&%s)", cm1e_st_c_type(st, type), var->c_name);
        st->memory = byte + size > st->memory ? byte + size : st->memory;
    }
}

void cm1e_st_take_from_memory(st_t *st, expr_t *expr)
{
    var_t *var = expr->var && expr->var->section == V_EXTERNAL ? expr->var->global : expr->var;
    if (expr->kind != E_NAME || !var || !var->memory_bit)
        return;
    if (!var->memory_byte) {
        var->memory_byte = cm1e_st_take(st->arena, sizeof(var_t));
        *var->memory_byte = *var;
        var->memory_byte->type = st->elementary[T_BYTE];
        var->memory_byte->memory_bit = 0;
        var->memory_byte->unit = NULL;
    }
    expr_t *byte = cm1e_st_named(st, E_NAME, expr->place, NULL, var->name);
    byte->var = var->memory_byte;
    byte->type = st->elementary[T_BYTE];
    *expr = (expr_t){.kind = E_MEMBER, .place = expr->place, .depth = expr->depth, .a = byte, .bit = true,
                     .type = st->elementary[T_BOOL], .name = cm1e_st_format(st->arena, "%d", var->memory_bit - 1)};
}

/* ---- inputs and outputs ------------------------------------------------------------------------------------------ */

void cm1e_st_check_address(st_t *st, var_t *var)
{
    const char *address = var->address->name;
    const place_t place = var->address->place;
    const char area = capital(address[1]);
    const int letter = bits_of(capital(address[2])), bits = letter ? letter : 1;
    const char *at = address + (letter ? 3 : 2);
    unsigned long numbers[4] = {0};
    int count = 0;
    if (*at == '*') {
        cm1e_st_report(st, place, "an address with * is not supported: write the place, as in %%IX3.0.5");
        return;
    }
    if (area == 'M') {
        check_memory(st, var, at, bits);
        return;
    }
    for (char *end; count < 4 && *at; count++) {
        numbers[count] = strtoul(at, &end, 10);
        at = *end == '.' ? end + 1 : end;
    }
    if (*at || count != (bits == 1 ? 3 : 2) || numbers[0] < 1 || numbers[0] > 65535 || numbers[1] > 4095 ||
        numbers[2] > 7)
        cm1e_st_report(st, place, "an address has the slave (1 = first), the byte in its inputs or outputs, and of a "
                       "BOOL the bit: %%IX3.0.5, %%QW2.4");
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
