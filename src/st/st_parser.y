/* The grammar of Structured Text (IEC 61131-3, 3rd edition, annex A). */
%define api.pure full
%define api.prefix {cm1e_st_yy}
%define api.location.type {place_t}
%define parse.error custom
%define parse.lac full
%locations
%parse-param {parsing_t *parsing}
%lex-param {parsing_t *parsing}
%code requires {
#include "st/st_parsing.h"
}
%code {
#include <ctype.h>
#include <string.h>

#define YYLLOC_DEFAULT(Current, Rhs, N) ((Current) = (N) ? YYRHSLOC(Rhs, 1) : YYRHSLOC(Rhs, 0))
#undef yylex
#define yylex(value, place, parsing) cm1e_st_yylex(value, place, (parsing)->scanner)
#define ST (parsing->st)
int cm1e_st_yylex(YYSTYPE *value, place_t *place, void *scanner);
static void yyerror(const YYLTYPE *place, parsing_t *parsing, const char *text);
}
%union {
    const char *text;
    expr_t *expr;
    arg_t *arg;
    stmt_t *stmt;
    type_t *type;
    var_t *var;
    args_t args;
    stmts_t stmts;
    branches_t branches;
    vars_t vars;
    int number;
}
%token <text> NAME "a name" LITERAL "a number" CHARACTERS "a text" WIDE_CHARACTERS "a WSTRING" QUALIFIED "a value of a type" ADDRESS "an address"
%token <text> TRUTH "TRUE" LATCH "S= or R="
%token IF "IF" THEN "THEN" ELSIF "ELSIF" ELSE "ELSE" END_IF "END_IF" CASE "CASE" OF "OF" END_CASE "END_CASE"
%token FOR "FOR" TO "TO" BY "BY" DO "DO" END_FOR "END_FOR" WHILE "WHILE" END_WHILE "END_WHILE"
%token REPEAT "REPEAT" UNTIL "UNTIL" END_REPEAT "END_REPEAT" EXIT "EXIT" CONTINUE "CONTINUE" RETURN "RETURN"
%token OR "OR" OR_ELSE "OR_ELSE" XOR "XOR" AND "AND" AND_THEN "AND_THEN" NOT "NOT" MOD "MOD" NULL_REF "NULL"
%token TYPE "TYPE" END_TYPE "END_TYPE" STRUCT "STRUCT" END_STRUCT "END_STRUCT" END_UNION "END_UNION" ARRAY "ARRAY" STRING "STRING"
%token WSTRING "WSTRING"
%token REF_TO "REF_TO" POINTER_TO "POINTER TO" REFERENCE_TO "REFERENCE TO"
%token FUNCTION "FUNCTION" END_FUNCTION "END_FUNCTION" FUNCTION_BLOCK "FUNCTION_BLOCK"
%token END_FUNCTION_BLOCK "END_FUNCTION_BLOCK" PROGRAM "PROGRAM" END_PROGRAM "END_PROGRAM"
%token VAR "VAR" VAR_INPUT "VAR_INPUT" VAR_OUTPUT "VAR_OUTPUT" VAR_IN_OUT "VAR_IN_OUT" VAR_TEMP "VAR_TEMP"
%token VAR_STAT "VAR_STAT" VAR_INST "VAR_INST"
%token VAR_GLOBAL "VAR_GLOBAL" VAR_EXTERNAL "VAR_EXTERNAL" END_VAR "END_VAR"
%token CONSTANT "CONSTANT" RETAIN "RETAIN" NON_RETAIN "NON_RETAIN" AT "AT"
%token METHOD "METHOD" END_METHOD "END_METHOD" ACTION "ACTION" END_ACTION "END_ACTION" PROPERTY "PROPERTY"
%token END_PROPERTY "END_PROPERTY" GET "GET" END_GET "END_GET" SET "SET" END_SET "END_SET" INTERFACE "INTERFACE"
%token END_INTERFACE "END_INTERFACE" EXTENDS "EXTENDS" IMPLEMENTS "IMPLEMENTS"
%token CLASS "CLASS" END_CLASS "END_CLASS"
%token NAMESPACE "NAMESPACE" END_NAMESPACE "END_NAMESPACE" USING "USING"
%token <text> MODIFIER "ABSTRACT"
%token CONFIGURATION "CONFIGURATION" END_CONFIGURATION "END_CONFIGURATION" RESOURCE "RESOURCE"
%token END_RESOURCE "END_RESOURCE" TASK "TASK" WITH "WITH"
%token ASSIGN ":=" REF_ASSIGN "REF=" SENDS "=>" LE "<=" GE ">=" NE "<>" POWER "**" RANGE ".."
%left OR OR_ELSE
%left XOR
%left AND AND_THEN
%left '=' NE
%left '<' '>' LE GE
%left '+' '-'
%left '*' '/' MOD
%left POWER
%precedence UNARY

%type <expr> expr variable value constant_initial initial address label
%type <arg> argument member_init element_init setting
%type <args> arguments argument_list expr_list labels member_inits element_inits settings setting_list
%type <stmts> stmts stmts_of_block case_items body latches
%type <stmt> stmt
%type <branches> elsifs
%type <type> type array_of simple_type result base
%type <vars> names declarations declaration sections section enumerators members parts
%type <var> enumerator
%type <number> stars text_type qualifiers qualifier modifiers
%type <args> interface_names
%type <text> with dotted
%%
sources: %empty | sources source_item | sources ';';
source_item: type_section | function | function_block | class | program | globals | configuration | interface | using
    | NAMESPACE dotted { cm1e_st_begin_namespace(ST, @2, $2); } sources END_NAMESPACE { cm1e_st_end_namespace(ST); };
using: USING used ';';
used: dotted { cm1e_st_use_namespace(ST, @1, $1); } | used ',' dotted { cm1e_st_use_namespace(ST, @3, $3); };
dotted: NAME { $$ = $1; } | dotted '.' NAME { $$ = cm1e_st_format(ST->arena, "%s.%s", $1, $3); };

/* ---- types ---- */
type_section: TYPE type_declarations END_TYPE;
type_declarations: %empty | type_declarations type_declaration | type_declarations ';';
type_declaration: NAME ':' type initial ';' { cm1e_st_add_type(parsing, @1, $1, $3, $4); }
    | NAME ':' '(' enumerators ')' base initial ';' {
        type_t *type = cm1e_st_type_node(ST, T_ENUM, @1, $1);
        type->members = $4.first;
        type->element = $6;
        cm1e_st_add_type(parsing, @1, $1, type, $7); }
    | NAME ':' STRUCT members END_STRUCT {
        type_t *type = cm1e_st_type_node(ST, T_STRUCT, @1, $1);
        type->members = $4.first;
        cm1e_st_add_type(parsing, @1, $1, type, NULL); }
    | NAME ':' NAME members END_UNION { /* so is UNION */
        type_t *type = cm1e_st_type_node(ST, T_STRUCT, @1, $1);
        type->members = $4.first;
        type->overlay = true;
        if (strcasecmp($3, "UNION") != 0)
            cm1e_st_report(ST, @5, "END_UNION cannot stand here; a UNION begins with UNION");
        cm1e_st_add_type(parsing, @1, $1, type, NULL); }
    | NAME NAME dotted ':' STRUCT members END_STRUCT { /* EXTENDS is a name here */
        type_t *type = cm1e_st_type_node(ST, T_STRUCT, @1, $1);
        type->members = $6.first;
        type->base_name = $3;
        if (strcasecmp($2, "EXTENDS") != 0)
            cm1e_st_report(ST, @2, "\"%s\" cannot stand here; expected \":\" or EXTENDS", $2);
        cm1e_st_add_type(parsing, @1, $1, type, NULL); };
base: %empty { $$ = NULL; } | NAME { $$ = cm1e_st_type_node(ST, T_NONE, @1, $1); };
enumerators: enumerator { $$ = (vars_t){$1, $1}; } | enumerators ',' enumerator { $$ = $1; ST_APPEND($$, $3); };
enumerator: NAME { $$ = cm1e_st_var_name(parsing, @1, $1); $$->section = V_ENUMERATOR; }
    | NAME ASSIGN expr { $$ = cm1e_st_var_name(parsing, @1, $1); $$->section = V_ENUMERATOR; $$->initial = $3; };
members: begin_members declarations { $$ = $2; };
begin_members: %empty { parsing->section = V_MEMBER; parsing->qualifiers = 0; };

type: simple_type { $$ = $1; }
    | array_of type { $$ = $1; $$->element = $2; };
array_of: ARRAY '[' dimensions ']' OF { $$ = parsing->st->made; parsing->st->made = $$->next; $$->next = NULL; };
dimensions: dimension_first | dimensions ',' expr RANGE expr {
        type_t *type = parsing->st->made;
        if (type->dimension_count == ST_DIMENSIONS)
            cm1e_st_report(ST, @3, "an array has at most %d dimensions", ST_DIMENSIONS);
        else
            type->dimensions[type->dimension_count++] = (dimension_t){.low = $3, .high = $5}; };
dimension_first: expr RANGE expr {
        type_t *type = cm1e_st_type_node(ST, T_ARRAY, @1, NULL);
        type->dimensions[type->dimension_count++] = (dimension_t){.low = $1, .high = $3};
        type->next = parsing->st->made;
        parsing->st->made = type; };
simple_type: dotted { $$ = cm1e_st_type_node(ST, T_NONE, @1, $1); }
    | dotted '(' expr RANGE expr ')' { $$ = cm1e_st_type_node(ST, T_NONE, @1, $1); $$->low = $3; $$->high = $5; }
    | text_type { $$ = cm1e_st_type_node(ST, T_STRING, @1, NULL); $$->wide = $1; }
    | text_type '[' expr ']' { $$ = cm1e_st_type_node(ST, T_STRING, @1, NULL); $$->wide = $1; $$->length_expr = $3; }
    | text_type '(' expr ')' { $$ = cm1e_st_type_node(ST, T_STRING, @1, NULL); $$->wide = $1; $$->length_expr = $3; }
    | REF_TO type { $$ = cm1e_st_type_node(ST, T_REF, @1, NULL); $$->element = $2; }
    | POINTER_TO type { $$ = cm1e_st_type_node(ST, T_REF, @1, NULL); $$->element = $2; }
    | REFERENCE_TO type { $$ = cm1e_st_type_node(ST, T_REF, @1, NULL); $$->element = $2; $$->automatic = true; };
text_type: STRING { $$ = 0; } | WSTRING { $$ = 1; };

/* ---- variables ---- */
initial: %empty { $$ = NULL; } | ASSIGN constant_initial { $$ = $2; }
    | REF_ASSIGN expr { /* REF= x is := REF(x) */
        args_t args = {0};
        arg_t *arg = cm1e_st_arg(ST, @2, NULL, $2);
        ST_APPEND(args, arg);
        $$ = cm1e_st_with_args(ST, E_CALL, @2, cm1e_st_named(ST, E_NAME, @2, NULL, "REF"), args);
    };
constant_initial: expr { $$ = $1; }
    | '[' element_inits ']' { $$ = cm1e_st_with_args(ST, E_ARRAY_INIT, @1, NULL, $2); }
    | '(' member_inits ')' { $$ = cm1e_st_with_args(ST, E_STRUCT_INIT, @1, NULL, $2); };
member_inits: member_init { $$ = (args_t){$1, $1}; } | member_inits ',' member_init { $$ = $1; ST_APPEND($$, $3); };
member_init: NAME ASSIGN constant_initial { $$ = cm1e_st_arg(ST, @1, $1, $3); };
element_inits: element_init { $$ = (args_t){$1, $1}; } | element_inits ',' element_init { $$ = $1; ST_APPEND($$, $3); };
element_init: constant_initial { $$ = cm1e_st_arg(ST, @1, NULL, $1); }
    | LITERAL '(' constant_initial ')' {
        expr_t *count = cm1e_st_literal(ST, @1, $1);
        $$ = cm1e_st_arg(ST, @1, NULL, cm1e_st_node(ST, E_REPEAT, @1, count, $3)); };
sections: %empty { $$ = (vars_t){0}; } | sections section { $$ = $1; ST_JOIN($$, $2); };
section: begin_section qualifiers_of_section declarations END_VAR { $$ = $3; };
begin_section: VAR { parsing->section = V_LOCAL; } | VAR_INPUT { parsing->section = V_INPUT; }
    | VAR_OUTPUT { parsing->section = V_OUTPUT; } | VAR_IN_OUT { parsing->section = V_IN_OUT; }
    | VAR_STAT { parsing->section = V_STATIC; } | VAR_INST { parsing->section = V_INSTANCE; }
    | VAR_TEMP { parsing->section = V_TEMP; } | VAR_EXTERNAL { parsing->section = V_EXTERNAL; };
qualifiers_of_section: qualifiers { parsing->qualifiers = $1; };
qualifiers: %empty { $$ = 0; } | qualifiers qualifier { $$ = $1 | $2; };
qualifier: MODIFIER { $$ = ($1[1] | 0x20) == 'u' ? Q_PUBLIC : 0; } | CONSTANT { $$ = Q_CONSTANT; } | RETAIN { $$ = Q_RETAIN; } | NON_RETAIN { $$ = Q_NON_RETAIN; };
declarations: %empty { $$ = (vars_t){0}; } | declarations declaration { $$ = $1; ST_JOIN($$, $2); };
declaration: names address ':' type initial ';' { $$ = cm1e_st_vars(parsing, $1, $2, $4, $5); }
    | names address ':' '(' enumerators ')' base initial ';' {
        $$ = cm1e_st_vars(parsing, $1, $2, cm1e_st_unnamed_enum(parsing, @4, $5, $7), $8); }
    | names address ':' ARRAY '[' stars ']' OF type ';' {
        type_t *type = cm1e_st_type_node(ST, T_ARRAY, @4, NULL);
        type->open = true;
        type->dimension_count = $6 < ST_DIMENSIONS ? $6 : ST_DIMENSIONS;
        type->element = $9;
        if (parsing->section != V_IN_OUT || $6 > ST_DIMENSIONS)
            cm1e_st_report(ST, @6, "ARRAY[*] is for VAR_IN_OUT, and has at most %d dimensions", ST_DIMENSIONS);
        $$ = cm1e_st_vars(parsing, $1, $2, type, NULL); }
    | names address ':' array_of dotted '[' element_inits ']' initial ';' { /* FB_Init of each element */
        $4->element = cm1e_st_type_node(ST, T_NONE, @5, $5);
        $$ = cm1e_st_vars(parsing, $1, $2, $4, $9);
        for (var_t *var = $1.first; var; var = var->next)
            var->init_elements = $7.first; }
    | names address ':' array_of dotted '(' member_inits ')' initial ';' {
        cm1e_st_report(ST, @6, "each element of an array has the inputs of its own FB_Init: ARRAY[1..2] OF %s[(%s := ...), "
                       "(%s := ...)]", $5, $7.first->name, $7.first->name);
        $$ = cm1e_st_vars(parsing, $1, $2, cm1e_st_type_node(ST, T_WRONG, @4, NULL), NULL); }
    | names address ':' type NAME ';' { $$ = cm1e_st_vars(parsing, $1, $2, $4, NULL);
        cm1e_st_edge(parsing, @5, $5, $1); }
    | names address ':' dotted '(' member_inits ')' initial ';' {
        $$ = cm1e_st_vars(parsing, $1, $2, cm1e_st_type_node(ST, T_NONE, @4, $4), $8);
        for (var_t *var = $1.first; var; var = var->next)
            var->init_args = $6.first; }
    | error ';' { $$ = (vars_t){0}; };
stars: '*' { $$ = 1; } | stars ',' '*' { $$ = $1 + 1; };
names: NAME { var_t *var = cm1e_st_var_name(parsing, @1, $1); $$ = (vars_t){var, var}; }
    | names ',' NAME { var_t *var = cm1e_st_var_name(parsing, @3, $3); $$ = $1; ST_APPEND($$, var); };
address: %empty { $$ = NULL; } | AT ADDRESS { $$ = cm1e_st_named(ST, E_ADDRESS, @2, NULL, $2); };
globals: VAR_GLOBAL begin_globals qualifiers_of_section declarations END_VAR { cm1e_st_add_globals(ST, $4); };
begin_globals: %empty { parsing->section = V_GLOBAL; };

/* ---- units ---- */
result: %empty { $$ = NULL; } | ':' type { $$ = $2; };
function: FUNCTION NAME result sections stmts END_FUNCTION
    { cm1e_st_add_unit(parsing, U_FUNCTION, @2, $2, $3, $4, $5); };
function_block: FUNCTION_BLOCK begin_block modifiers NAME heritage parts body END_FUNCTION_BLOCK
    { cm1e_st_modify(&parsing->object, $3); cm1e_st_add_unit(parsing, U_BLOCK, @4, $4, NULL, $6, $7); };
class: CLASS begin_block modifiers NAME heritage parts END_CLASS
    { cm1e_st_modify(&parsing->object, $3); parsing->object.is_class = true;
      cm1e_st_add_unit(parsing, U_BLOCK, @4, $4, NULL, $6, (stmts_t){0}); };
program: PROGRAM begin_block NAME parts body END_PROGRAM
    { cm1e_st_add_unit(parsing, U_PROGRAM, @3, $3, NULL, $4, $5); };

/* ---- objects ---- */
begin_block: %empty { parsing->object = (object_t){0}; parsing->methods = NULL; };
modifiers: %empty { $$ = 0; } | modifiers MODIFIER { $$ = cm1e_st_with_modifier(parsing, @2, $1, $2); };
heritage: %empty | heritage EXTENDS interface_names {
        parsing->object.base_name = $3.first->name;
        if ($3.first->next)
            cm1e_st_report(ST, $3.first->next->place, "a function block extends one other; it implements several interfaces"); }
    | heritage IMPLEMENTS interface_names { parsing->object.interfaces = $3.first; };
interface_names: dotted { arg_t *arg = cm1e_st_arg(ST, @1, $1, NULL); $$ = (args_t){arg, arg}; }
    | interface_names ',' dotted { arg_t *arg = cm1e_st_arg(ST, @3, $3, NULL); $$ = $1; ST_APPEND($$, arg); };
/* Methods stand in front of the statements (IEC 61131-3), or behind them (TwinCAT). */
parts: %empty { $$ = (vars_t){0}; } | parts section { $$ = $1; ST_JOIN($$, $2); } | parts part { $$ = $1; };
body: %empty { $$ = (stmts_t){0}; } | stmts_of_block late_parts { $$ = $1; };
stmts_of_block: stmt { $$ = (stmts_t){0}; if ($1) ST_APPEND($$, $1); }
    | stmts_of_block stmt { $$ = $1; if ($2) ST_APPEND($$, $2); };
late_parts: %empty | late_parts part;
part: METHOD modifiers NAME result sections stmts END_METHOD { cm1e_st_add_method(parsing, @3, $3, $2, $4, $5, $6); }
    | ACTION NAME ':' stmts END_ACTION { cm1e_st_add_method(parsing, @2, $2, 0, NULL, (vars_t){0}, $4); }
    | PROPERTY modifiers NAME ':' type { parsing->property = $3; parsing->property_type = $5;
        parsing->property_modifiers = $2; } accessors END_PROPERTY;
accessors: %empty | accessors accessor;
accessor: GET sections stmts END_GET { cm1e_st_add_getter(parsing, @1, $2, $3); }
    | SET sections stmts END_SET { cm1e_st_add_setter(parsing, @1, $2, $3); };
interface: INTERFACE begin_block NAME interface_heritage interface_parts END_INTERFACE
    { cm1e_st_add_unit(parsing, U_INTERFACE, @3, $3, NULL, (vars_t){0}, (stmts_t){0}); };
interface_heritage: %empty | EXTENDS interface_names { parsing->object.interfaces = $2.first; };
interface_parts: %empty | interface_parts part;

/* ---- configuration ---- */
configuration: CONFIGURATION NAME { ST->tree.configuration = $2; ST->tree.configuration_place = @2; }
    configuration_items END_CONFIGURATION;
configuration_items: %empty | configuration_items configuration_item;
configuration_item: globals | resource | task | instance;
resource: RESOURCE NAME NAME NAME { /* ON is a name everywhere else: (Off, On) */
        if (strcasecmp($3, "ON") != 0)
            cm1e_st_report(ST, @3, "\"%s\" cannot stand here; expected ON", $3); }
    resource_items END_RESOURCE;
resource_items: %empty | resource_items resource_item;
resource_item: globals | task | instance;
task: TASK NAME '(' settings ')' ';' { cm1e_st_add_task(ST, @2, $2, $4); };
settings: %empty { $$ = (args_t){0}; } | setting_list { $$ = $1; };
setting_list: setting { $$ = (args_t){$1, $1}; } | setting_list ',' setting { $$ = $1; ST_APPEND($$, $3); };
setting: NAME ASSIGN expr { $$ = cm1e_st_arg(ST, @1, $1, $3); };
instance: PROGRAM qualifiers NAME with ':' NAME ';'
        { cm1e_st_add_instance(ST, @3, $3, $4, $6, (args_t){0}); }
    | PROGRAM qualifiers NAME with ':' NAME '(' arguments ')' ';'
        { cm1e_st_add_instance(ST, @3, $3, $4, $6, $8); };
with: %empty { $$ = NULL; } | WITH NAME { $$ = $2; };

/* ---- statements ---- */
stmts: %empty { $$ = (stmts_t){0}; } | stmts stmt { $$ = $1; if ($2) ST_APPEND($$, $2); };
stmt: ';' { $$ = NULL; }
    | error ';' { $$ = NULL; }
    | variable ASSIGN expr ';' { $$ = cm1e_st_stmt(ST, S_ASSIGN, @1, $3, (stmts_t){0}); $$->target = $1; }
    | variable REF_ASSIGN expr ';' { $$ = cm1e_st_stmt(ST, S_ASSIGN, @1, $3, (stmts_t){0}); $$->target = $1;
                                     $$->reference = true; }
    | latches expr ';' { $$ = cm1e_st_stmt(ST, S_IF, @1, NULL, (stmts_t){0}); $$->latch = true;
                         $$->branches = cm1e_st_branch(ST, @1, $2, $1.first); cm1e_st_deepen(ST, $$); }
    | variable ';' {
        cm1e_st_report(ST, @1, "this does nothing: expected \":=\" and a value, or \"(\" of a call");
        $$ = NULL; }
    | variable '(' arguments ')' ';' {
        expr_t *call = cm1e_st_with_args(ST, E_CALL, @1, $1, $3);
        $$ = cm1e_st_stmt(ST, S_CALL, @1, call, (stmts_t){0}); }
    | IF expr THEN stmts elsifs END_IF {
        $$ = cm1e_st_stmt(ST, S_IF, @1, NULL, (stmts_t){0});
        $$->branches = cm1e_st_branch(ST, @1, $2, $4.first);
        $$->branches->next = $5.first; cm1e_st_deepen(ST, $$); }
    | IF expr THEN stmts elsifs ELSE stmts END_IF {
        branch_t *otherwise = cm1e_st_branch(ST, @6, NULL, $7.first);
        $$ = cm1e_st_stmt(ST, S_IF, @1, NULL, (stmts_t){0});
        ST_APPEND($5, otherwise);
        $$->branches = cm1e_st_branch(ST, @1, $2, $4.first);
        $$->branches->next = $5.first; cm1e_st_deepen(ST, $$); }
    | CASE expr OF case_items END_CASE {
        $$ = cm1e_st_stmt(ST, S_CASE, @1, $2, (stmts_t){0});
        cm1e_st_group_case(ST, $$, $4, (stmts_t){0}, false, @5); }
    | CASE expr OF case_items ELSE stmts END_CASE {
        $$ = cm1e_st_stmt(ST, S_CASE, @1, $2, (stmts_t){0});
        cm1e_st_group_case(ST, $$, $4, $6, true, @5); }
    | FOR variable ASSIGN expr TO expr DO stmts END_FOR {
        $$ = cm1e_st_stmt(ST, S_FOR, @1, $4, $8); $$->target = $2; $$->to = $6; }
    | FOR variable ASSIGN expr TO expr BY expr DO stmts END_FOR {
        $$ = cm1e_st_stmt(ST, S_FOR, @1, $4, $10); $$->target = $2; $$->to = $6; $$->by = $8; }
    | WHILE expr DO stmts END_WHILE { $$ = cm1e_st_stmt(ST, S_WHILE, @1, $2, $4); }
    | REPEAT stmts UNTIL expr END_REPEAT { $$ = cm1e_st_stmt(ST, S_REPEAT, @1, $4, $2); }
    | EXIT ';' { $$ = cm1e_st_stmt(ST, S_EXIT, @1, NULL, (stmts_t){0}); }
    | CONTINUE ';' { $$ = cm1e_st_stmt(ST, S_CONTINUE, @1, NULL, (stmts_t){0}); }
    | RETURN ';' { $$ = cm1e_st_stmt(ST, S_RETURN, @1, NULL, (stmts_t){0}); };
latches: variable LATCH '=' { $$ = (stmts_t){0}; stmt_t *stmt = cm1e_st_latch(ST, @1, $1, $2); ST_APPEND($$, stmt); }
    | latches variable LATCH '=' { $$ = $1; stmt_t *stmt = cm1e_st_latch(ST, @2, $2, $3); ST_APPEND($$, stmt); };
elsifs: %empty { $$ = (branches_t){0}; } | elsifs ELSIF expr THEN stmts {
        branch_t *branch = cm1e_st_branch(ST, @2, $3, $5.first);
        $$ = $1; ST_APPEND($$, branch); };
case_items: %empty { $$ = (stmts_t){0}; }
    | case_items stmt { $$ = $1; if ($2) ST_APPEND($$, $2); }
    | case_items labels ':' {
        stmt_t *mark = cm1e_st_stmt(ST, S_LABEL, @2, NULL, (stmts_t){0});
        mark->branches = cm1e_st_branch(ST, @2, NULL, NULL);
        mark->branches->labels = $2.first;
        $$ = $1; ST_APPEND($$, mark); };
labels: label { arg_t *arg = cm1e_st_arg(ST, @1, NULL, $1); $$ = (args_t){arg, arg}; }
    | labels ',' label { arg_t *arg = cm1e_st_arg(ST, @3, NULL, $3); $$ = $1; ST_APPEND($$, arg); };
label: expr { $$ = $1; } | expr RANGE expr { $$ = cm1e_st_node(ST, E_REPEAT, @1, $1, $3); };

/* ---- expressions ---- */
variable: NAME { $$ = cm1e_st_named(ST, E_NAME, @1, NULL, $1); }
    | LATCH { $$ = cm1e_st_named(ST, E_NAME, @1, NULL, $1); } /* a variable "s" that is compared */
    | ADDRESS { $$ = cm1e_st_named(ST, E_ADDRESS, @1, NULL, $1); }
    | variable '.' NAME { $$ = cm1e_st_named(ST, E_MEMBER, @3, $1, $3); }
    | variable '.' LATCH { $$ = cm1e_st_named(ST, E_MEMBER, @3, $1, $3); }
    | variable '.' LITERAL { $$ = cm1e_st_named(ST, E_MEMBER, @3, $1, $3); $$->bit = true; }
    | variable '[' expr_list ']' { $$ = cm1e_st_with_args(ST, E_INDEX, @1, $1, $3); }
    | variable '^' { $$ = cm1e_st_node(ST, E_DEREF, @1, $1, NULL); };
value: LITERAL { $$ = cm1e_st_literal(ST, @1, $1); }
    | TRUTH { $$ = cm1e_st_literal(ST, @1, $1); }
    | NULL_REF { $$ = cm1e_st_literal(ST, @1, "NULL"); }
    | CHARACTERS { $$ = cm1e_st_string_literal(ST, @1, $1); }
    | WIDE_CHARACTERS { $$ = cm1e_st_wide_literal(ST, @1, $1); }
    | QUALIFIED { $$ = cm1e_st_qualified(ST, @1, $1); }
    | variable '.' QUALIFIED { $$ = cm1e_st_qualified_in(ST, @3, $1, $3); };
expr: variable { $$ = $1; }
    | value { $$ = $1; }
    | variable '(' arguments ')' { $$ = cm1e_st_with_args(ST, E_CALL, @1, $1, $3); }
    | '(' expr ')' { $$ = $2; }
    | expr OR expr { $$ = cm1e_st_operation(ST, OP_OR, @2, $1, $3); }
    | expr OR_ELSE expr { $$ = cm1e_st_operation(ST, OP_OR_ELSE, @2, $1, $3); }
    | expr XOR expr { $$ = cm1e_st_operation(ST, OP_XOR, @2, $1, $3); }
    | expr AND expr { $$ = cm1e_st_operation(ST, OP_AND, @2, $1, $3); }
    | expr AND_THEN expr { $$ = cm1e_st_operation(ST, OP_AND_THEN, @2, $1, $3); }
    | expr '=' expr { $$ = cm1e_st_operation(ST, OP_EQ, @2, $1, $3); }
    | expr NE expr { $$ = cm1e_st_operation(ST, OP_NE, @2, $1, $3); }
    | expr '<' expr { $$ = cm1e_st_operation(ST, OP_LT, @2, $1, $3); }
    | expr '>' expr { $$ = cm1e_st_operation(ST, OP_GT, @2, $1, $3); }
    | expr LE expr { $$ = cm1e_st_operation(ST, OP_LE, @2, $1, $3); }
    | expr GE expr { $$ = cm1e_st_operation(ST, OP_GE, @2, $1, $3); }
    | expr '+' expr { $$ = cm1e_st_operation(ST, OP_ADD, @2, $1, $3); }
    | expr '-' expr { $$ = cm1e_st_operation(ST, OP_SUB, @2, $1, $3); }
    | expr '*' expr { $$ = cm1e_st_operation(ST, OP_MUL, @2, $1, $3); }
    | expr '/' expr { $$ = cm1e_st_operation(ST, OP_DIV, @2, $1, $3); }
    | expr MOD expr { $$ = cm1e_st_operation(ST, OP_MOD, @2, $1, $3); }
    | expr POWER expr { $$ = cm1e_st_operation(ST, OP_POWER, @2, $1, $3); }
    | '-' expr %prec UNARY { $$ = cm1e_st_operation(ST, OP_NEGATE, @1, $2, NULL); }
    | '+' expr %prec UNARY { $$ = $2; }
    | NOT expr %prec UNARY { $$ = cm1e_st_operation(ST, OP_NOT, @1, $2, NULL); };
expr_list: expr { arg_t *arg = cm1e_st_arg(ST, @1, NULL, $1); $$ = (args_t){arg, arg}; }
    | expr_list ',' expr { arg_t *arg = cm1e_st_arg(ST, @3, NULL, $3); $$ = $1; ST_APPEND($$, arg); };
arguments: %empty { $$ = (args_t){0}; } | argument_list { $$ = $1; };
argument_list: argument { $$ = (args_t){$1, $1}; } | argument_list ',' argument { $$ = $1; ST_APPEND($$, $3); };
argument: expr { $$ = cm1e_st_arg(ST, @1, NULL, $1); }
    | NAME ASSIGN expr { $$ = cm1e_st_arg(ST, @1, $1, $3); }
    | NAME ASSIGN { $$ = cm1e_st_arg(ST, @1, $1, NULL); }
    | NAME SENDS { $$ = cm1e_st_arg(ST, @1, $1, NULL); $$->output = true; }
    | NAME SENDS variable { $$ = cm1e_st_arg(ST, @1, $1, $3); $$->output = true; }
    | NOT NAME SENDS variable { $$ = cm1e_st_arg(ST, @2, $2, $4); $$->output = $$->inverted = true; };
%%
enum { SHOWN = 6 };

/** The word that may be missing where many could stand: it ends what is there. NULL: none of these could. */
static const char *missing_word(const yysymbol_kind_t *expected, int count)
{
    for (int i = 0; i < count; i++)
        switch (expected[i]) {
        case YYSYMBOL_THEN: return "THEN";
        case YYSYMBOL_DO: return "DO";
        case YYSYMBOL_OF: return "OF";
        case YYSYMBOL_TO: return "TO";
        case YYSYMBOL_END_REPEAT: return "END_REPEAT";
        default:
            if (strcmp(yysymbol_name(expected[i]), "';'") == 0)
                return ";";
        }
    return NULL;
}

/** "expected X, Y or Z": the words that could stand here. Of many only the one that may be missing is worth a word. */
static void expectations(const yypcontext_t *context, char *text, size_t size)
{
    yysymbol_kind_t expected[YYNTOKENS];
    const int all = yypcontext_expected_tokens(context, expected, YYNTOKENS);
    int count = 0;
    for (int i = 0; i < all; i++) /* S and R in front of "=" are names, or of no interest */
        if (expected[i] != YYSYMBOL_LATCH)
            expected[count++] = expected[i];
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < count && count <= SHOWN && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i == 0 ? "; expected " : i == count - 1 ? " or " : ", ",
                                 yysymbol_name(expected[i]));
    const char *missing = count > SHOWN ? missing_word(expected, count) : NULL;
    if (missing)
        snprintf(text, size, "; is a \"%s\" missing before it?", missing);
}

/** The end that is missing, if `found` ends what is around an IF, a loop or a CASE that is open; NULL: it does not. */
static const char *missing_end(const yypcontext_t *context, yysymbol_kind_t found)
{
    yysymbol_kind_t expected[YYNTOKENS];
    const int count = yypcontext_expected_tokens(context, expected, YYNTOKENS);
    const bool ends = found == YYSYMBOL_YYEOF || found == YYSYMBOL_UNTIL ||
                      strncmp(yysymbol_name(found), "END_", 4) == 0;
    for (int i = 0; i < count && ends; i++)
        switch (expected[i]) {
        case YYSYMBOL_END_IF: return "an IF before it has no END_IF";
        case YYSYMBOL_END_CASE: return "a CASE before it has no END_CASE";
        case YYSYMBOL_END_FOR: return "a FOR before it has no END_FOR";
        case YYSYMBOL_END_WHILE: return "a WHILE before it has no END_WHILE";
        case YYSYMBOL_UNTIL: return "a REPEAT before it has no UNTIL";
        default: break;
        }
    return NULL;
}

static bool is_expected(const yypcontext_t *context, yysymbol_kind_t symbol)
{
    yysymbol_kind_t expected[YYNTOKENS];
    const int count = yypcontext_expected_tokens(context, expected, YYNTOKENS);
    bool is = false;
    for (int i = 0; i < count; i++)
        is |= expected[i] == symbol;
    return is;
}

/** An expression could go on here. */
static bool is_behind_expression(const yypcontext_t *context) { return is_expected(context, YYSYMBOL_MOD); }

static int yyreport_syntax_error(const yypcontext_t *context, parsing_t *parsing)
{
    char text[300];
    const yysymbol_kind_t found = yypcontext_token(context);
    if (cm1e_st_unsupported(parsing, *yypcontext_location(context)))
        return 0;
    expectations(context, text, sizeof text);
    const char *missing = missing_end(context, found);
    if (missing)
        snprintf(text, sizeof text, "; %s", missing);
    if (strcmp(parsing->last, "=") == 0)
        snprintf(text, sizeof text, strcmp(parsing->before, "=") == 0 ? "; values are compared by one \"=\""
                                                                     : "; a value is assigned by \":=\"");
    if (strcmp(parsing->last, ":=") == 0 && is_behind_expression(context))
        snprintf(text, sizeof text, "; values are compared by \"=\", and an assignment is a statement of its own");
    if (strcmp(parsing->last, "*") == 0 && strcmp(parsing->before, "[") == 0)
        snprintf(text, sizeof text, "; ARRAY[*] is for variables of VAR_IN_OUT only");
    if (strcmp(parsing->last, "&") == 0 && strcmp(parsing->before, "&") == 0)
        snprintf(text, sizeof text, "; AND is a single \"&\"");
    if (strncasecmp(parsing->last, "VAR", 3) == 0 && strcmp(parsing->before, ";") == 0)
        snprintf(text, sizeof text, "; variables are declared in front of the statements");
    if (strlen(parsing->last) == 1 && strchr("+-*/", parsing->last[0]) && is_expected(context, YYSYMBOL_ASSIGN))
        snprintf(text, sizeof text, "; a value is assigned by \":=\", as in x := x + 1");
    if (strcasecmp(parsing->last, "THEN") == 0)
        snprintf(text, sizeof text, "; THEN is that of IF or ELSIF");
    if (strcasecmp(parsing->before, "ELSEIF") == 0)
        snprintf(text, sizeof text, "; a further condition begins with ELSIF");
    if (isalpha((unsigned char)parsing->last[0]) && is_expected(context, YYSYMBOL_END_VAR))
        snprintf(text, sizeof text, "; expected END_VAR, or a name, which no word of the language is");
    if (strcasecmp(parsing->before, "END") == 0)
        snprintf(text, sizeof text, "; what ends a statement is one word, as END_IF");
    if (strcmp(parsing->last, ",") == 0 && isdigit((unsigned char)parsing->before[0]) && is_behind_expression(context))
        snprintf(text, sizeof text, "; a number has a point, as 1.5, and a list of values stands in [ ]");
    if (found == YYSYMBOL_YYEOF)
        cm1e_st_report(ST, *yypcontext_location(context), "the source ends here, before something is complete%s", text);
    else
        cm1e_st_report(ST, *yypcontext_location(context), "\"%s\" cannot stand here%s", parsing->last, text);
    return 0;
}

static void yyerror(const YYLTYPE *place, parsing_t *parsing, const char *text)
{
    (void)text; /* only "memory exhausted" comes here: the stack of the parser is full */
    cm1e_st_report(ST, *place, "this is nested too deeply");
}
