/**
 * @file command.h
 * Common code of the subcommands of `cm1e`: options, configuration, output, the error line. Each subcommand is a file
 * cmd_<name>.c with one function of this type; it returns the exit status of the process.
 */
#ifndef CM1E_TOOLS_COMMAND_H
#define CM1E_TOOLS_COMMAND_H

#include <argp.h>
#include <jansson.h>
#include <stdbool.h>

#include "cm1e/bus.h"
#include "cm1e/config.h"

enum { EXIT_OK = 0, EXIT_FAILED = 1, EXIT_WRONG_USE = 2, AXIS_LINE_BYTES = 1280 };

/** Every command: X(name, its summary, words that its arguments begin with). Each has a source cmd_<name>.c with
 *  command_<name>() and the options argp_<name>. Help, man pages and completions follow from this list. */
#define COMMANDS(X)                                                                                                 \
    X(scan, "list the slaves of a network", "")                                                                     \
    X(status, "show state, error and measurements of every drive", "")                                              \
    X(monitor, "watch all axes on a screen, and act on one of them", "")                                             \
    X(trace, "record the signals of a running program", "")                                                          \
    X(sdo, "read or write an object of a slave", "read write list")                                                 \
    X(params, "list, read, write, back up and compare the parameters of a motor", "list get set backup restore diff")\
    X(log, "show what has happened to a running program's axes", "")                                                \
    X(cml, "send strings to a motor behind a Cool MUSCLE bridge", "")                                               \
    X(sii, "read, write or show the EEPROM of a slave", "read write decode")                                        \
    X(home, "home one axis", "")                                                                                    \
    X(move, "move one axis", "")                                                                                    \
    X(jog, "move one axis while a key is held", "")                                                                 \
    X(enable, "let one motor hold its position, until a key is pressed", "")                                        \
    X(tune, "measure how one axis follows, before and after a change of its parameters", "step ramp sine chirp")   \
    X(reset, "reset the errors of drives", "")                                                                      \
    X(recover, "let a running program take back a slave that waits", "")                                            \
    X(io, "show inputs and outputs, write outputs", "")                                                             \
    X(led, "find a motor by its LED", "")                                                                           \
    X(firmware, "write a new firmware into a motor", "update")                                                      \
    X(foe, "read or write a file of a slave", "read write")                                                         \
    X(alias, "show or write the alias of a slave", "")                                                              \
    X(states, "show the EtherCAT states of the slaves, or request one", "")                                         \
    X(reg, "read or write registers of a slave", "read write")                                                      \
    X(graph, "show how the slaves are wired", "")                                                                   \
    X(sim, "serve a simulated network on a network interface", "")                                                  \
    X(generate, "write files for other masters", "esi ec-extend sii eni")                                           \
    X(check, "check a file for other masters, or a bus file", "")                                                   \
    X(diff, "compare a file with the live devices that it describes", "")                                           \
    X(new, "make a project that builds and runs", "")                                                               \
    X(st, "check and build programs in Structured Text", "check build")                                              \
    X(run, "run a program in Structured Text", "")                                                                  \
    X(var, "show, write and force variables of a running program", "list get set force release")                    \
    X(init, "write a bus file from the network as it is", "")                                                       \
    X(prove, "compare a device with what the guide says of it", "")                                                 \
    X(doctor, "look at machine, interface and network, and say what to do", "")                                     \
    X(explain, "say what an error number or name means", "")

#define DECLARE(name, summary, words)              \
    int command_##name(int argc, char **argv);     \
    extern const struct argp argp_##name;
COMMANDS(DECLARE)
#undef DECLARE

typedef struct command {
    const char *name, *summary, *words;
    int (*run)(int argc, char **argv);
    const struct argp *argp;
} command_t;
extern const command_t commands[];
extern const int command_count;

/** The exit statuses of all commands; a description of NULL ends the list. */
typedef struct exit_status {
    int status;
    const char *meaning;
} exit_status_t;
extern const exit_status_t exit_statuses[];

/** argp_parse(), but an unknown long option is refused with the one that may have been meant. 0: parsed. */
int parse_options(const struct argp *argp, int argc, char **argv, void *options);

/** Calls `visit` for every option of a parser and of its children; false from it ends the walk. */
typedef bool (*option_visitor_t)(const struct argp_option *option, void *context);
bool visit_options(const struct argp *argp, option_visitor_t visit, void *context);

/** The number of `word` in "flat|mdp"; -1 and a complaint, with the word that may have been meant: it is none. */
int choose_word(const char *what, const char *word, const char *words);

/** For a parser of options: an empty name of a file is refused. `what`: "--svg", "the file". */
void need_name(struct argp_state *state, const char *what, const char *word);

/** Options that most subcommands take: a child parser to be listed in a subcommand's argp. */
typedef struct common_options {
    const char *interface_name; /**< -i */
    const char *bus_file;       /**< -b */
    const char *network;        /**< --network: of a bus file with several buses */
    const char *pcap_file;      /**< --pcap */
    bool json;                  /**< --json */
    const char *attach;         /**< --attach, of commands that have attach_children (attach.h) */
} common_options_t;
extern const struct argp common_argp;
extern const struct argp_child common_children[]; /**< of a command that opens the network by itself */
/** At ARGP_KEY_INIT of a command with common_children or attach_children: they write into `options`. Returns 0. */
error_t give_options(struct argp_state *state, common_options_t *options);

/** Loads the configuration of the options: the bus file, with the interface of -i in place of its own. Without a bus
 *  file no axes are expected. Of several buses it loads the one that is meant (choose_bus.h). After an error it
 *  complains on standard error and returns false. */
bool load_configuration(const common_options_t *options, cm1e_bus_config_t *config);

/** Reads the bus file of a simulated segment, so that it is refused like that of the network, before anything is opened.
 *  CM1E_OK also if the interface is no "sim:FILE". */
cm1e_error_t check_segment(const char *interface_name, cm1e_diag_t *diag);

/** As load_configuration(), but without a bus file the network is scanned and every CM1-E found becomes an axis with
 *  default settings (unit: revolution). A scan does not show K37 of a motor behind a bridge: if there is a bridge, the
 *  function complains and prints a bus file to be completed. Returns the exit status. */
int load_axes(const common_options_t *options, cm1e_bus_config_t *config);

/** Opens the network of a configuration and scans it. Returns the exit status; *bus is NULL, and it has complained, if
 *  that is not EXIT_OK. */
int open_scanned(const cm1e_bus_config_t *config, cm1e_bus_t **bus);

/** Closes the bus. Returns the exit status: EXIT_FAILED, with a complaint, if frames are missing in the pcap file. */
int close_bus(cm1e_bus_t *bus, const common_options_t *options, int status);

/** The interface is a simulated segment. */
bool is_simulated(const cm1e_bus_config_t *config);
/** " (simulated)" or "". */
const char *simulated_mark(const cm1e_bus_config_t *config);
/** A line on standard output that no real device answered, if so. */
void tell_simulated(const cm1e_bus_config_t *config);

/** Finds an axis of the configuration by name or number (1 = first); -1 and a complaint: there is none. */
int find_axis(const cm1e_bus_config_t *config, const char *word);

/** A whole decimal or 0x number within [minimum, maximum]; false and a complaint that names `what` otherwise. */
bool parse_number(const char *word, const char *what, long long minimum, long long maximum, long long *value);
/** An object as the field writes it, hexadecimal with or without 0x: "0x60F6:1B", "607C" (sub-index 0). Complains of nothing. */
bool read_object(const char *word, uint16_t *index, uint8_t *subindex);
/** A finite decimal number; false and a complaint otherwise. */
bool parse_real(const char *word, const char *what, double *value);
/** As parse_real(), above 0. */
bool parse_positive(const char *word, const char *what, double *value);
/** As parse_real(), above 0 and up to `longest` seconds. */
bool parse_seconds(const char *word, int longest, double *value);

/** A negative value looks like an option, so such a word is moved to the end, behind a "--". Words behind a "--" of the
 *  user are not moved. `sheltered` has room for MAX_WORDS + 2. Returns their number; -1 and a complaint: too many. */
int shelter_negative_value(int argc, char **argv, char **sheltered);
enum { MAX_WORDS = 32 };

/** Prints "cm1e <command>: <text of diag>" on standard error and returns EXIT_FAILED. */
int fail(const cm1e_diag_t *diag);
/** The same, but returns EXIT_WRONG_USE for a word or number that the user gave. For what is refused before anything was
 *  done. */
int fail_at_once(const cm1e_diag_t *diag);
void complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** Writes what is wrong with an axis, each thing once. `what` is the text of the error, `details` are the sentences about
 *  the axis, which may say it too. */
void describe_error(char *line, size_t size, const char *name, const char *what, const char *details);
/** Complains of that. */
void complain_of_axis(const char *name, const char *what, const char *details);

/** The text that a member of an object has; "" if it has none. */
const char *text_of(const json_t *object, const char *name);
/** The width of a column for printf(), which counts bytes: a letter of `text` may have several. */
int in_bytes(int width, const char *text);

/** Prints a JSON value on standard output with a final newline, and releases it. */
void print_json(json_t *value);

/** For a parser of options: JSON is wanted. Returns true. A command that then fails without a result prints its
 *  complaints as JSON. */
bool want_json(void);

/** What was complained of as {"error": text}, where --json is given and nothing has been printed as JSON. */
void print_json_of_failure(void);

/** The name of an AL state: "Pre-Operational"; with the error flag "Pre-Operational + error". Static or in `buffer`. */
const char *al_state_name(uint16_t al_state, char *buffer, size_t size);

#endif
