#include "manual.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/version.h"
#include "command.h"

/* ---- text in roff ------------------------------------------------------------------------------------------------ */

static void print_roff(const char *text)
{
    for (const char *at = text; *at; at++) {
        if (*at == '-')
            fputs("\\-", stdout);
        else if (*at == '\\')
            fputs("\\e", stdout);
        else if (*at == '\v')
            fputs("\n.PP\n", stdout);
        else if ((*at == '.' || *at == '\'') && (at == text || at[-1] == '\n'))
            printf("\\&%c", *at);
        else if (*at == '"')
            fputs("\\(dq", stdout);
        else
            putchar(*at);
    }
}

static bool is_letter(int key) { return key > 0 && key < 0x80 && isgraph(key); }

static bool man_option(const struct argp_option *option, void *context)
{
    (void)context;
    fputs(".TP\n\\fB", stdout);
    if (is_letter(option->key))
        printf("\\-%c\\fR%s\\fB", option->key, option->name ? ", " : "");
    if (option->name) {
        fputs("\\-\\-", stdout);
        print_roff(option->name);
    }
    fputs("\\fR", stdout);
    if (option->arg) {
        printf("%c\\fI", option->name ? '=' : ' ');
        print_roff(option->arg);
        fputs("\\fR", stdout);
    }
    putchar('\n');
    print_roff(option->doc ? option->doc : "");
    putchar('\n');
    return true;
}

static void man_end(void)
{
    puts(".SH EXIT STATUS");
    for (const exit_status_t *row = exit_statuses; row->meaning; row++) {
        printf(".TP\n\\fB%d\\fR\n", row->status);
        print_roff(row->meaning);
        putchar('\n');
    }
}

static void man_head(const char *name, const char *summary)
{
    printf(".TH \"%s\" 1 \"\" \"cm1e %s\" \"cm1e\"\n.SH NAME\n", name, cm1e_version());
    print_roff(name);
    fputs(" \\- ", stdout);
    print_roff(summary);
    puts("\n.SH SYNOPSIS");
}

static void man_command(const command_t *command)
{
    static const struct argp_option help = {"help", '?', NULL, 0, "Show the options", 0};
    static const struct argp_option usage = {"usage", 0, NULL, 0, "Show the options in short", 0};
    char name[40];
    snprintf(name, sizeof name, "cm1e-%s", command->name);
    man_head(name, command->summary);
    const char *args = command->argp->args_doc ? command->argp->args_doc : "";
    do {
        const int bytes = (int)strcspn(args, "\n");
        printf("\\fBcm1e %s\\fR [\\fIOPTION\\fR...] ", command->name);
        char line[200];
        snprintf(line, sizeof line, "%.*s", bytes, args);
        print_roff(line);
        puts("\n.br");
        args += bytes + (args[bytes] == '\n');
    } while (*args);
    puts(".SH DESCRIPTION");
    print_roff(command->argp->doc);
    puts("\n.SH OPTIONS");
    visit_options(command->argp, man_option, NULL);
    man_option(&help, NULL);
    man_option(&usage, NULL);
    man_end();
    puts(".SH SEE ALSO\n\\fBcm1e\\fR(1)");
}

static void man_program(void)
{
    man_head("cm1e", "drives servo motors over EtherCAT");
    puts("\\fBcm1e\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR...]\n.br\n"
         "\\fBcm1e\\fR \\-\\-help|\\-\\-version\n.SH DESCRIPTION");
    print_roff(PROGRAM_SUMMARY);
    puts("\n.PP\nThe interface \\fBsim\\fR is a simulated network in the process.\n.SH COMMANDS");
    for (int i = 0; i < command_count; i++) {
        printf(".TP\n\\fBcm1e\\-%s\\fR(1)\n", commands[i].name);
        print_roff(commands[i].summary);
        putchar('\n');
    }
    man_end();
}

/* ---- completion -------------------------------------------------------------------------------------------------- */

static bool bash_words(const struct argp_option *option, void *context)
{
    (void)context;
    if (option->name)
        printf(" --%s%s", option->name, option->arg ? "=" : "");
    if (is_letter(option->key))
        printf(" -%c", option->key);
    return true;
}

/** What the value of an option is: a list of words, or the shell function for its kind. */
static const char *kind_of(const struct argp_option *option)
{
    return strchr(option->arg, '|')               ? option->arg
           : strcmp(option->arg, "INTERFACE") == 0 ? "@interface"
           : strcmp(option->arg, "BUS-FILE") == 0  ? "@bus"
           : strcmp(option->arg, "FILE") == 0      ? "@file"
                                                   : "";
}

static bool bash_value(const struct argp_option *option, void *context)
{
    if (!option->arg)
        return true;
    printf("    ");
    if (is_letter(option->key))
        printf("%s:-%c%s", (const char *)context, option->key, option->name ? "|" : "");
    if (option->name)
        printf("%s:--%s", (const char *)context, option->name);
    printf(") kind='%s' ;;\n", kind_of(option));
    return true;
}

static void print_bash(void)
{
    puts("# Completion of cm1e for bash. Written by cm1e --describe: do not edit.\n_cm1e()\n{\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]} words='' "
         "kind=none\n  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" = 1 ]; then");
    printf("    COMPREPLY=($(compgen -W '--help --version");
    for (int i = 0; i < command_count; i++)
        printf(" %s", commands[i].name);
    puts("' -- \"$cur\"))\n    return\n  fi\n"
         "  # --option=value comes as three words\n"
         "  [ \"$cur\" = = ] && cur='' && prev=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  [ \"$prev\" = = ] && prev=${COMP_WORDS[COMP_CWORD-2]}\n"
         "  case $command:$prev in");
    for (int i = 0; i < command_count; i++) {
        char name[32];
        snprintf(name, sizeof name, "%s", commands[i].name);
        visit_options(commands[i].argp, bash_value, name);
    }
    puts("  esac\n"
         "  case $kind in\n"
         "    none) ;;\n"
         "    '') return ;;\n"
         "    @interface) COMPREPLY=($(compgen -W \"sim $(cd /sys/class/net 2>/dev/null && echo *)\" -- \"$cur\"))\n"
         "      return ;;\n"
         "    @bus) COMPREPLY=($(compgen -f -X '!*.y*ml' -- \"$cur\") $(compgen -d -- \"$cur\"))\n"
         "      compopt -o filenames 2>/dev/null; return ;;\n"
         "    @file) COMPREPLY=($(compgen -f -- \"$cur\")); compopt -o filenames 2>/dev/null; return ;;\n"
         "    *) COMPREPLY=($(compgen -W \"${kind//|/ }\" -- \"$cur\")); return ;;\n"
         "  esac\n"
         "  case $command in");
    for (int i = 0; i < command_count; i++) {
        printf("    %s) words='%s' options='--help --usage", commands[i].name, commands[i].words);
        visit_options(commands[i].argp, bash_words, NULL);
        puts("' ;;");
    }
    puts("    *) return ;;\n"
         "  esac\n"
         "  if [[ $cur == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"))\n"
         "    [[ ${#COMPREPLY[@]} = 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2>/dev/null\n"
         "  elif [ \"$COMP_CWORD\" = 2 ] && [ -n \"$words\" ]; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
         "  else\n"
         "    COMPREPLY=($(compgen -f -- \"$cur\")); compopt -o filenames 2>/dev/null\n"
         "  fi\n"
         "  return 0\n"
         "}\n"
         "complete -F _cm1e cm1e");
}

/* A text within '...[...]' of _arguments. */
static void print_zsh_text(const char *text)
{
    for (; *text; text++) {
        if (strchr("[]:\\", *text))
            putchar('\\');
        if (*text == '\'')
            fputs("'\\''", stdout);
        else
            putchar(*text);
    }
}

static void zsh_value(const struct argp_option *option)
{
    if (!option->arg)
        return;
    const char *kind = kind_of(option);
    fputs(":value:", stdout);
    if (strcmp(kind, "@interface") == 0)
        fputs("_cm1e_interfaces", stdout);
    else if (kind[0] == '@')
        fputs("_files", stdout);
    else if (kind[0]) {
        putchar('(');
        for (; *kind; kind++)
            putchar(*kind == '|' ? ' ' : *kind);
        putchar(')');
    }
}

static bool zsh_option(const struct argp_option *option, void *context)
{
    (void)context;
    for (int form = 0; form < 2; form++) {
        if (form == 0 ? !option->name : !is_letter(option->key))
            continue;
        fputs("        '*", stdout);
        if (form == 0)
            printf("--%s%s[", option->name, option->arg ? "=" : "");
        else
            printf("-%c%s[", option->key, option->arg ? "+" : "");
        print_zsh_text(option->doc ? option->doc : "");
        putchar(']');
        zsh_value(option);
        puts("' \\");
    }
    return true;
}

static void print_zsh(void)
{
    puts("#compdef cm1e\n# Completion of cm1e for zsh. Written by cm1e --describe: do not edit.\n"
         "_cm1e_interfaces() { compadd sim ${(f)\"$(cd /sys/class/net 2>/dev/null && print -l *)\"} }\n"
         "_cm1e() {\n  if (( CURRENT == 2 )); then\n    local -a list\n    list=(");
    for (int i = 0; i < command_count; i++) {
        printf("      '%s:", commands[i].name);
        print_zsh_text(commands[i].summary);
        puts("'");
    }
    puts("    )\n    _describe command list\n    return\n  fi\n  local command=$words[2]\n"
         "  shift words; (( CURRENT-- ))\n  case $command in");
    for (int i = 0; i < command_count; i++) {
        printf("    %s)\n      _arguments -s \\\n", commands[i].name);
        visit_options(commands[i].argp, zsh_option, NULL);
        puts("        '--help[Show the options]' \\\n        '--usage[Show the options in short]' \\");
        if (commands[i].words[0])
            printf("        '1:word:(%s)' \\\n", commands[i].words);
        puts("        '*:file:_files' ;;");
    }
    puts("  esac\n}\n_cm1e \"$@\"");
}

int describe(int word_count, char **words)
{
    const char *what = word_count > 0 ? words[0] : "";
    if (strcmp(what, "man") == 0 && word_count == 1) {
        man_program();
        return EXIT_OK;
    }
    for (int i = 0; i < command_count; i++) {
        if (strcmp(what, "man") == 0 && strcmp(words[1], commands[i].name) == 0) {
            man_command(&commands[i]);
            return EXIT_OK;
        }
        if (strcmp(what, "commands") == 0)
            puts(commands[i].name);
    }
    if (strcmp(what, "commands") == 0)
        return EXIT_OK;
    if (strcmp(what, "bash") == 0)
        print_bash();
    else if (strcmp(what, "zsh") == 0)
        print_zsh();
    else
        complain("--describe takes: commands, man, man COMMAND, bash, zsh");
    return strcmp(what, "bash") == 0 || strcmp(what, "zsh") == 0 ? EXIT_OK : EXIT_WRONG_USE;
}
