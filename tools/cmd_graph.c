/** cm1e graph: how the slaves are wired, as a picture (DOT or SVG). */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "cm1e/topology.h"
#include "core/json_text.h"
#include "files.h"
#include "which_slave.h"

enum { KEY_SVG = 0x9C0 };
/** The picture, in pixels. */
enum { BOX_WIDTH = 230, BOX_HEIGHT = 76, GAP_X = 60, GAP_Y = 34, MARGIN = 20, LINE = 16, SHOWN_LETTERS = 38 };
enum { LINES = 4, LINE_BYTES = 160 };

typedef struct graph_options {
    common_options_t common;
    const char *svg;
} graph_options_t;

/** All that a picture shows. */
typedef struct graph {
    const cm1e_bus_t *bus;
    const cm1e_bus_config_t *config, *names; /* names: its axes, of the bus file or of the program that runs */
    uint32_t count;
    cm1e_slave_place_t places[CM1E_MAX_SLAVES];
    const char *second;   /* the interface at the other end of a ring; "": there is none */
    uint32_t from_second; /* slaves that only that interface reaches, because the ring is broken: the last ones */
    unsigned row[CM1E_MAX_SLAVES], column[CM1E_MAX_SLAVES], rows, columns; /* of the SVG */
} graph_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    graph_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_SVG:
        need_name(state, "--svg", arg);
        options->svg = arg;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- what is said of a slave ------------------------------------------------------------------------------------ */

/** A link whose port is closed: the slave sends frames back there, so nothing behind it is reached. */
static bool loops_back(const cm1e_slave_place_t *place, int port) { return place->link[port] && !place->open[port]; }

static const char *port_word(const cm1e_slave_place_t *place, int port)
{
    return loops_back(place, port) ? "loop" : place->open[port] ? "open" : "-";
}

static void ports_text(const cm1e_slave_place_t *place, char *text, size_t size)
{
    snprintf(text, size, "ports: 0 %s, 1 %s, 2 %s, 3 %s", port_word(place, 0), port_word(place, 1),
             port_word(place, 2), port_word(place, 3));
}

/** Position with the axis and the name of the slave, its state, its ports. Returns the number of lines. */
static int describe(const graph_t *graph, uint32_t i, char lines[LINES][LINE_BYTES])
{
    char state[48];
    const cm1e_slave_info_t *slave = cm1e_bus_slave(graph->bus, i + 1);
    const int axis = find_axis_at(graph->bus, graph->names, slave, 0);
    const char *name = slave->name[0] ? slave->name : "without a name";
    int n = 0;
    snprintf(lines[n++], LINE_BYTES, "%u: %s", slave->position, axis >= 0 ? graph->names->axes[axis].name : name);
    if (axis >= 0)
        snprintf(lines[n++], LINE_BYTES, "%s", name);
    snprintf(lines[n++], LINE_BYTES, "%s", al_state_name(slave->al_state, state, sizeof state));
    ports_text(&graph->places[i], lines[n++], LINE_BYTES);
    return n;
}

/** It is behind the break of a ring, at the cable that ends at the second interface. */
static bool is_from_second(const graph_t *graph, uint32_t i) { return i >= graph->count - graph->from_second; }

/** Of a slave that has none that is known, the one before it. */
static unsigned parent_of(const graph_t *graph, uint32_t i)
{
    const unsigned parent = graph->places[i].parent;
    return parent > 0 ? parent - 1u : i > 0 ? i - 1u : 0;
}

static bool is_troubled(const graph_t *graph, uint32_t i)
{
    const cm1e_slave_place_t *place = &graph->places[i];
    const bool lost = !place->known && !is_from_second(graph, i);
    bool loop = lost || (cm1e_bus_slave(graph->bus, i + 1)->al_state & CM1E_AL_ERROR);
    for (int port = 0; port < CM1E_PORTS; port++)
        loop = loop || loops_back(place, port);
    return loop;
}

/* ---- rings ------------------------------------------------------------------------------------------------------ */

/** The port of the last slave that leads to the second interface; -1: it has no link there. */
static int last_port(const graph_t *graph)
{
    const cm1e_slave_place_t *last = graph->count ? &graph->places[graph->count - 1] : NULL;
    for (int port = 1; last && port < CM1E_PORTS; port++)
        if (last->open[port] && last->next[port] == 0)
            return port;
    return -1;
}

/** In a ring that is broken, the slaves behind the break are in a line, whose end is the second interface. */
static void find_ring(graph_t *graph)
{
    uint32_t first = 0;
    graph->second = graph->config->second_interface;
    while (first < graph->count && (graph->places[first].known || graph->places[first].parent > 0) && (first > 0 || graph->places[first].open[0]))
        first++;
    graph->from_second = graph->second[0] ? graph->count - first : 0;
}

/* ---- DOT -------------------------------------------------------------------------------------------------------- */

/** A text of a device inside quotes. */
static void print_quoted(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '"' || *text == '\\')
            fprintf(file, "\\%c", *text);
        else
            fputc((unsigned char)*text < ' ' ? ' ' : *text, file);
}

static void print_dot_slave(FILE *file, const graph_t *graph, uint32_t i)
{
    char lines[LINES][LINE_BYTES];
    const cm1e_slave_info_t *slave = cm1e_bus_slave(graph->bus, i + 1);
    const cm1e_slave_place_t *place = &graph->places[i];
    const int count = describe(graph, i, lines);
    fprintf(file, "  s%u [label=\"", slave->position);
    for (int n = 0; n < count; n++) {
        fputs(n ? "\\n" : "", file);
        print_quoted(file, lines[n]);
    }
    fprintf(file, "\"%s];\n", is_troubled(graph, i) ? ", color=red" : "");
    if (is_from_second(graph, i) && place->open[0])
        fprintf(file, "  s%u -> s%u [taillabel=\"1\", headlabel=\"0\"];\n", i, slave->position);
    else if (is_from_second(graph, i) && i > 0)
        fprintf(file, "  s%u -> s%u [style=dotted, color=red];\n", i, slave->position);
    else if (is_from_second(graph, i))
        fprintf(file, "  master -> s1 [style=dotted, color=red];\n");
    else if (!place->known && i > 0)
        fprintf(file, "  s%u -> s%u [style=dotted, color=red];\n", parent_of(graph, i) + 1, slave->position);
    else if (place->parent)
        fprintf(file, "  s%u -> s%u [taillabel=\"%u\", headlabel=\"%u\"];\n", place->parent, slave->position,
                place->parent_port, place->entry_port);
    else
        fprintf(file, "  master -> s%u [headlabel=\"%u\"%s];\n", slave->position, place->entry_port,
                place->known ? "" : ", style=dotted");
}

static void print_dot(FILE *file, const graph_t *graph)
{
    fprintf(file, "digraph network {\n  rankdir=LR;\n  node [shape=box];\n  master [label=\"");
    print_quoted(file, graph->config->interface_name);
    fprintf(file, "\"];\n");
    for (uint32_t i = 0; i < graph->count; i++)
        print_dot_slave(file, graph, i);
    if (graph->second[0] && graph->count > 0) {
        fprintf(file, "  second [label=\"");
        print_quoted(file, graph->second);
        fprintf(file, "\"];\n  s%u -> second [%s];\n", graph->count,
                last_port(graph) < 0 ? "style=dotted, color=red" : "");
    }
    fprintf(file, "}\n");
}

/* ---- SVG -------------------------------------------------------------------------------------------------------- */

/** A line goes to the right, a branch begins a new row. Port 1 is the way on, if there are several. */
static void place_boxes(graph_t *graph)
{
    graph->rows = graph->columns = graph->count > 0;
    for (uint32_t i = 0; i < graph->count; i++) {
        const cm1e_slave_place_t *place = &graph->places[i];
        const bool has_parent = place->parent > 0;
        const unsigned parent = parent_of(graph, i);
        bool goes_on = true;
        for (int port = 1; has_parent && port < CM1E_PORTS; port++) /* is another one of its slaves the way on? */
            goes_on = goes_on && (port == place->parent_port || graph->places[parent].next[port] == 0 ||
                                  place->parent_port == 1);
        graph->column[i] = i == 0 ? 0 : graph->column[parent] + 1;
        graph->row[i] = i == 0 ? 0 : goes_on ? graph->row[parent] : graph->rows++;
        graph->columns = graph->column[i] + 1 > graph->columns ? graph->column[i] + 1 : graph->columns;
    }
}

static void print_xml(FILE *file, const char *text)
{
    for (int n = 0; *text && n < SHOWN_LETTERS; text++, n += ((unsigned char)*text & 0xC0) != 0x80)
        switch (*text) {
        case '<': fputs("&lt;", file); break;
        case '&': fputs("&amp;", file); break;
        default: fputc((unsigned char)*text < ' ' ? ' ' : *text, file);
        }
}

/** Left edge of a column and top of a row; column 0 is the computer. */
static int left_of(unsigned column) { return MARGIN + (int)column * (BOX_WIDTH + GAP_X); }
static int top_of(unsigned row) { return MARGIN + (int)row * (BOX_HEIGHT + GAP_Y); }

static void print_box(FILE *file, int x, int y, bool troubled, char lines[LINES][LINE_BYTES], int count)
{
    fprintf(file, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" rx=\"4\" fill=\"%s\" stroke=\"%s\"/>\n", x, y,
            BOX_WIDTH, BOX_HEIGHT, troubled ? "#fdecea" : "#f5f7fa", troubled ? "#c62828" : "#455a64");
    for (int i = 0; i < count; i++) {
        fprintf(file, "<text x=\"%d\" y=\"%d\"%s>", x + 8, y + LINE * (i + 1), i ? "" : " font-weight=\"bold\"");
        print_xml(file, lines[i]);
        fprintf(file, "</text>\n");
    }
}

/** A cable from the right side of a box to the left side of another, with the ports at both ends (-1: no port), on its
 *  last part, which belongs to no other cable. Broken: it is where one should be. */
typedef struct cable {
    unsigned from_column, from_row, column, row;
    int from_port, port;
    bool broken;
} cable_t;

static void print_cable(FILE *file, const cable_t *cable)
{
    const bool straight = cable->row == cable->from_row;
    const int from_x = left_of(cable->from_column) + BOX_WIDTH, from_y = top_of(cable->from_row) + BOX_HEIGHT / 2;
    const int x = left_of(cable->column), y = top_of(cable->row) + BOX_HEIGHT / 2, turn = from_x + GAP_X / 3;
    fprintf(file, "<polyline points=\"%d,%d %d,%d %d,%d %d,%d\" fill=\"none\" stroke=\"%s\"%s/>\n", from_x, from_y,
            turn, from_y, turn, y, x, y, cable->broken ? "#c62828" : "#455a64",
            cable->broken ? " stroke-dasharray=\"5 4\"" : "");
    if (cable->from_port >= 0)
        fprintf(file, "<text x=\"%d\" y=\"%d\">%d</text>\n", (straight ? from_x : turn) + 4, y - 4,
                cable->from_port);
    if (cable->port >= 0)
        fprintf(file, "<text x=\"%d\" y=\"%d\">%d</text>\n", x - 12, y - 4, cable->port);
    if (cable->broken)
        fprintf(file, "<text x=\"%d\" y=\"%d\" fill=\"#c62828\">broken</text>\n", from_x + 12, y - 4);
}

/** The cable by which a slave is reached. */
static cable_t cable_to(const graph_t *graph, uint32_t i)
{
    const cm1e_slave_place_t *place = &graph->places[i];
    const bool has_parent = i > 0 && place->known && place->parent > 0;
    const bool at_break = is_from_second(graph, i) && !place->open[0];
    const unsigned from = parent_of(graph, i);
    cable_t cable = {.from_column = i > 0 ? graph->column[from] + 1 : 0, .from_row = i > 0 ? graph->row[from] : 0,
                     .column = graph->column[i] + 1, .row = graph->row[i], .broken = i > 0 && !has_parent,
                     .from_port = has_parent ? place->parent_port : -1, .port = place->entry_port};
    if (is_from_second(graph, i)) {
        cable.broken = at_break;
        cable.from_port = at_break ? -1 : 1;
        cable.port = at_break ? -1 : 0;
    } else if (cable.broken) {
        cable.port = -1;
    }
    return cable;
}

static void print_svg_slave(FILE *file, const graph_t *graph, uint32_t i)
{
    char lines[LINES][LINE_BYTES];
    const int x = left_of(graph->column[i] + 1), y = top_of(graph->row[i]);
    const cable_t cable = cable_to(graph, i);
    print_cable(file, &cable);
    const int count = describe(graph, i, lines);
    print_box(file, x, y, is_troubled(graph, i), lines, count);
}

/** A computer at an end of the network. */
static void print_svg_computer(FILE *file, unsigned column, unsigned row, const char *interface_name)
{
    char lines[LINES][LINE_BYTES] = {"this computer"};
    snprintf(lines[1], LINE_BYTES, "%s", interface_name);
    print_box(file, left_of(column), top_of(row), false, lines, interface_name[0] ? 2 : 1);
}

static void print_svg_second(FILE *file, const graph_t *graph)
{
    const uint32_t last = graph->count - 1;
    const int port = last_port(graph);
    const cable_t cable = {.from_column = graph->column[last] + 1, .from_row = graph->row[last],
                           .column = graph->column[last] + 2, .row = graph->row[last], .from_port = port, .port = -1,
                           .broken = port < 0};
    print_cable(file, &cable);
    print_svg_computer(file, graph->column[last] + 2, graph->row[last], graph->second);
}

static void print_svg(FILE *file, const graph_t *graph)
{
    const bool ring = graph->second[0] && graph->count > 0;
    const int width = left_of(graph->columns + (ring ? 2 : 1)) - GAP_X + MARGIN;
    const int height = top_of(graph->rows ? graph->rows : 1) - GAP_Y + MARGIN;
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
            "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            width, height, width, height);
    print_svg_computer(file, 0, 0, graph->config->interface_name);
    for (uint32_t i = 0; i < graph->count; i++)
        print_svg_slave(file, graph, i);
    if (ring)
        print_svg_second(file, graph);
    fprintf(file, "</svg>\n");
}

/* ---- the command ------------------------------------------------------------------------------------------------ */

static void show_json(const graph_t *graph)
{
    json_t *all = json_array();
    for (uint32_t i = 0; i < graph->count; i++) {
        const cm1e_slave_place_t *place = &graph->places[i];
        json_t *ports = json_array();
        for (int port = 0; port < CM1E_PORTS; port++)
            json_array_append_new(ports, json_pack("{s:b, s:b, s:i}", "link", place->link[port], "open",
                                                   place->open[port], "slave", place->next[port]));
        json_array_append_new(all, json_pack("{s:i, s:o, s:b, s:i, s:i, s:i, s:o}", "position", (int)i + 1, "name",
                                             cm1e_json_text(cm1e_bus_slave(graph->bus, i + 1)->name), "known",
                                             place->known, "parent", place->parent, "parent_port",
                                             place->parent_port, "entry_port", place->entry_port, "ports", ports));
    }
    print_json(all);
}

/** The picture as a file, complete or not at all. */
static int write_svg(const graph_t *graph, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file)
        print_svg(file, graph);
    const bool made = file && fclose(file) == 0;
    const bool good = made && write_output(path, text, size);
    if (!made)
        complain("no memory for the picture");
    free(text);
    return good ? EXIT_OK : EXIT_FAILED;
}

static int show(graph_t *graph, const graph_options_t *options)
{
    find_ring(graph);
    place_boxes(graph);
    if (options->svg)
        return write_svg(graph, options->svg);
    if (options->common.json)
        show_json(graph);
    else
        print_dot(stdout, graph);
    return EXIT_OK;
}

static int show_network(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *options, uint16_t position)
{
    static graph_t graph;
    const graph_options_t *graph_options = options;
    cm1e_diag_t diag = {0};
    (void)position;
    graph = (graph_t){.bus = bus, .config = config, .names = axes_to_name(&graph_options->common, config),
                      .count = cm1e_bus_slave_count(bus)};
    return cm1e_bus_topology(bus, graph.places, CM1E_MAX_SLAVES, &diag) == CM1E_OK ? show(&graph, options)
                                                                                     : fail(&diag);
}

static const struct argp_option table[] = {
    {"svg", KEY_SVG, "FILE", 0, "Write a picture; -: to standard output", 0},
    {0}};
const struct argp argp_graph = {
    table, parse, NULL,
    "Shows how the slaves are wired, with the states of their ports: as DOT of Graphviz, or as a picture with --svg. A "
    "port with a link that is closed (\"loop\") sends frames back: what is behind it is not reached. Where a program "
    "runs the network, it is asked.", attach_children, NULL, NULL};

int command_graph(int argc, char **argv)
{
    graph_options_t options = {.svg = NULL};
    if (parse_options(&argp_graph, argc, argv, &options))
        return EXIT_WRONG_USE;
    return look_at_network(&options.common, NULL, show_network, &options);
}
