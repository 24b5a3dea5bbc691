/* The trace as a page: charts with one time scale, cursors, events. `trace` is the data, written before this text;
 * dygraphs draws the curves. With `trace.live` the samples come later, from that address, and the last ones are
 * kept. */
"use strict";
(function () {
  const COLOURS = ["#1f5fbf", "#c2571a", "#2b8a3e", "#8e44ad", "#b8860b", "#0f8b8d", "#c0392b", "#5d6d7e"];
  const MARK = "#5a6570", ERROR = "#d5343b", OVERRUN = "#e67e22", LOST = "#b5179e", CURSOR_A = "#111", CURSOR_B = "#7a1fa2";
  const LABEL_WIDTH = 62, POINTS = 3000, EVENTS_SHOWN = 500;
  const live = trace.live !== undefined, LIVE_VALUES = 4e6, LIVE_SAMPLES = 120000, LIVE_EVENTS = 5000;

  /* ---- data ----------------------------------------------------------------------------------------------------- */

  function bytesOf(text) {
    return Uint8Array.from(atob(text), c => c.charCodeAt(0));
  }

  /* 4 bytes a value: its difference from `base`. */
  function valuesOf(column) {
    if (live)
      return new Float64Array(2 * kept);
    const buffer = bytesOf(column.data).buffer;
    return column.bytes === 8 ? new Float64Array(buffer) : Float64Array.from(new Float32Array(buffer), v => v + column.base);
  }

  /* A live page keeps so many samples, in arrays of twice that length. */
  const kept = Math.min(LIVE_SAMPLES, Math.floor(LIVE_VALUES / (trace.columns.length + 1)));
  const times = live ? new Float64Array(2 * kept) : new Float64Array(bytesOf(trace.times).buffer);
  const columns = trace.columns.map((column, i) =>
    ({...column, index: i, values: valuesOf(column), colour: COLOURS[0], shown: true}));
  const ofAxes = trace.axes.reduce((sum, axis) => sum + axis.count, 0); /* the first so many columns */
  let count = live ? 0 : times.length;
  let begin = count ? times[0] : 0, end = count ? Math.max(times[count - 1], begin + 1e-6) : 1;
  let from = begin, to = end;         /* the time shown */
  let coming = live;                  /* samples */
  let running = live;                 /* the time shown ends with the newest sample */
  let pointer = null, cursorA = null, cursorB = null;

  /* The last sample that is not after t. */
  function indexAt(t) {
    let low = 0, high = count - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= t)
        low = middle;
      else
        high = middle - 1;
    }
    return low;
  }

  function textOf(column, i) {
    const value = column.values[i];
    if (column.kind === "state")
      return trace.states[value] ? trace.states[value].name : String(value);
    if (column.kind === "error")
      return value === 0 ? "none" : trace.errors[value] || String(value);
    return column.program && !column.integer ? exactText(column, value) : numberText(value);
  }

  /* A variable of the program, with as few digits as name its value and no other of its type. */
  function exactText(column, value) {
    let text = String(value);
    for (let digits = 6; column.single && Number.isFinite(value) && digits <= 9; digits++) {
      text = String(Number(value.toPrecision(digits)));
      if (Math.fround(Number(text)) === value)
        break;
    }
    return text;
  }

  function numberText(value) {
    if (!Number.isFinite(value))
      return String(value);
    const size = Math.abs(value);
    return Number.isInteger(value) && size < 1e9 ? String(value) : size !== 0 && (size < 1e-3 || size >= 1e9)
      ? value.toExponential(4) : value.toFixed(5);
  }

  function timeText(t) {
    return t.toFixed(6).replace(/0{1,3}$/, "") + " s";
  }

  /* ---- events ----------------------------------------------------------------------------------------------------- */

  /* Events of the samples from `first` on. */
  function eventsOfCount(column, first, colour, one, many) {
    const found = [];
    for (let i = Math.max(1, first); i < count; i++) {
      const more = column.values[i] - column.values[i - 1];
      if (more > 0)
        found.push({t: times[i], text: more === 1 ? one : `${more} ${many}`, colour});
    }
    return found;
  }

  function eventsOfErrors(column, first) {
    const found = [];
    for (let i = first; i < count; i++)
      if (column.values[i] !== 0 && (i === 0 || column.values[i - 1] !== column.values[i]))
        found.push({t: times[i], text: `${column.name}: ${textOf(column, i)}`, colour: ERROR});
    return found;
  }

  function eventsFrom(first, marks) {
    let found = marks.map(mark => ({...mark, colour: MARK, mark: true}));
    for (const column of columns) {
      if (column.kind === "error")
        found = found.concat(eventsOfErrors(column, first));
      else if (column.name === "overruns")
        found = found.concat(eventsOfCount(column, first, OVERRUN, "overrun", "overruns"));
      else if (column.name === "lost frames")
        found = found.concat(eventsOfCount(column, first, LOST, "lost frame", "lost frames"));
    }
    return found.sort((a, b) => a.t - b.t);
  }

  let events = eventsFrom(0, trace.marks);

  /* A live page has the newest one at the top. */
  function showEvents() {
    const list = document.getElementById("events");
    list.replaceChildren();
    for (const event of live ? events.slice(-EVENTS_SHOWN).reverse() : events.slice(0, EVENTS_SHOWN)) {
      const item = document.createElement("li"), time = document.createElement("time");
      time.textContent = timeText(event.t);
      item.style.borderColor = event.colour;
      item.append(time, " " + event.text);
      item.addEventListener("click", () => {
        const half = Math.min((to - from) / 2, (end - begin) / 20);
        cursorA = event.t;
        look(event.t - half, event.t + half);
      });
      list.append(item);
    }
    if (events.length > EVENTS_SHOWN || events.length === 0) {
      const note = document.createElement("li");
      note.textContent = events.length ? `and ${events.length - EVENTS_SHOWN} more` : "none";
      list.append(note);
    }
  }

  /* ---- charts ----------------------------------------------------------------------------------------------------- */

  const charts = [];   /* {graph, columns} */
  const bands = [];    /* functions that draw one */
  const place = document.getElementById("charts");

  /* Samples of the time shown, with one more at each side; where they are too many, the smallest and the largest value of
   * each slice of time, so that no peak is lost. */
  function rowsOf(chart) {
    const first = Math.max(0, indexAt(from)), last = Math.min(count - 1, indexAt(to) + 1), rows = [];
    const step = Math.max(1, Math.ceil((last - first + 1) / POINTS));
    for (let i = first; i <= last; i += step) {
      if (step === 1) {
        rows.push([times[i], ...chart.columns.map(c => finite(c.values[i]))]);
        continue;
      }
      const stop = Math.min(i + step, last + 1);
      const ends = chart.columns.map(c => extremes(c.values, i, stop));
      rows.push([times[i], ...ends.map(e => e[0])], [times[stop - 1], ...ends.map(e => e[1])]);
    }
    return rows.length ? rows : [[from, ...chart.columns.map(() => null)]];
  }

  function finite(value) {
    return Number.isFinite(value) ? value : null;
  }

  /* The two in the order of time. */
  function extremes(values, i, stop) {
    let low = i, high = i;
    for (let k = i; k < stop; k++) {
      if (values[k] < values[low])
        low = k;
      if (values[k] > values[high])
        high = k;
    }
    return low <= high ? [finite(values[low]), finite(values[high])] : [finite(values[high]), finite(values[low])];
  }

  function line(context, area, x, colour, dash, width) {
    context.save();
    context.strokeStyle = colour;
    context.lineWidth = width || 1;
    context.setLineDash(dash || []);
    context.beginPath();
    context.moveTo(x, area.y);
    context.lineTo(x, area.y + area.h);
    context.stroke();
    context.restore();
  }

  function drawUnder(context, area, graph) {
    for (const event of events)
      if (event.t >= from && event.t <= to)
        line(context, area, graph.toDomXCoord(event.t), event.colour, [4, 3]);
    for (const [t, colour] of [[cursorA, CURSOR_A], [cursorB, CURSOR_B]])
      if (t !== null && t >= from && t <= to)
        line(context, area, graph.toDomXCoord(t), colour, [], 1.5);
  }

  function interaction() {
    const model = {...Dygraph.defaultInteractionModel};
    model.dblclick = showAll;
    model.wheel = (event, graph) => {
      const at = graph.toDataXCoord(graph.eventToDomCoords(event)[0]);
      zoom(event.deltaY > 0 ? 1.25 : 0.8, at);
      event.preventDefault();
    };
    return model;
  }

  function addChart(title, unit, shown, height, steps, timeAxis) {
    const element = document.createElement("div");
    const chart = {columns: shown, title};
    element.className = "chart";
    element.style.height = height + "px";
    place.append(element);
    shown.forEach((column, i) => { column.colour = COLOURS[i % COLOURS.length]; column.chart = chart; });
    chart.graph = new Dygraph(element, rowsOf(chart), {
      labels: ["time", ...shown.map(column => column.name)], colors: shown.map(column => column.colour),
      dateWindow: [from, to], ylabel: unit ? `${title} [${unit}]` : title, legend: "never", stepPlot: steps,
      strokeWidth: 1.2, highlightCircleSize: 3, connectSeparatedPoints: false, animatedZooms: false, yRangePad: 6,
      axes: {x: {axisLabelFormatter: (t, granularity, options, graph) => axisText(t, graph), pixelsPerLabel: 90,
                 drawAxis: timeAxis},
             y: {axisLabelWidth: LABEL_WIDTH, pixelsPerLabel: 24}},
      interactionModel: interaction(), underlayCallback: drawUnder,
      zoomCallback: (low, high) => look(low, high),
      drawCallback: (graph, first) => follow(graph, first),
      highlightCallback: (event, x) => { pointer = x; showValues(); },
      clickCallback: (event, x) => { setCursor(event.shiftKey, x); },
    });
    charts.push(chart);
  }

  /* Moving a chart with shift and drag changes its time without a zoomCallback; the others follow after it has drawn. */
  let following = false;

  function follow(graph, first) {
    const [low, high] = graph.xAxisRange();
    if (first || busy || following || (Math.abs(low - from) < 1e-9 && Math.abs(high - to) < 1e-9))
      return;
    following = true;
    requestAnimationFrame(() => {
      following = false;
      look(...graph.xAxisRange());
    });
  }

  function axisText(t, graph) {
    const [low, high] = graph ? graph.xAxisRange() : [from, to], span = high - low;
    return t.toFixed(span > 20 ? 0 : span > 2 ? 1 : span > 0.2 ? 2 : span > 0.02 ? 3 : span > 0.002 ? 4 : 6) + " s";
  }

  /* ---- bands: states of an axis, marks ------------------------------------------------------------------------------ */

  function addBand(height, draw) {
    const canvas = document.createElement("canvas");
    canvas.className = "band";
    canvas.style.height = height + "px";
    place.append(canvas);
    bands.push(() => {
      const area = charts.length ? charts[0].graph.getArea() : {x: 80, w: 400}, scale = window.devicePixelRatio || 1;
      canvas.width = canvas.clientWidth * scale;
      canvas.height = height * scale;
      const context = canvas.getContext("2d");
      context.scale(scale, scale);
      context.font = "11px system-ui, sans-serif";
      context.textBaseline = "middle";
      draw(context, {x: area.x, y: 0, w: area.w, h: height}, t => area.x + (t - from) / (to - from) * area.w);
    });
  }

  function addStateBand(column) {
    addBand(16, (context, area, xOf) => {
      const last = Math.min(count - 1, indexAt(to));
      for (let i = indexAt(from); i <= last;) {
        const value = column.values[i];
        let stop = i + 1;
        while (stop <= last && column.values[stop] === value)
          stop++;
        const x = Math.max(area.x, xOf(times[i]));
        const right = Math.min(area.x + area.w, stop < count ? xOf(times[stop]) : xOf(times[stop - 1]) + 1);
        const state = trace.states[value] || {name: String(value), colour: "#fff"};
        context.fillStyle = state.colour;
        context.fillRect(x, 1, Math.max(right - x, 1), area.h - 2);
        context.fillStyle = "#111";
        if (context.measureText(state.name).width + 8 < right - x)
          context.fillText(state.name, x + 4, area.h / 2);
        i = stop;
      }
    });
  }

  /* Texts of marks in as many rows as there is room for; one that would cover another is left to the list of events. */
  function addMarkBand() {
    const ROW = 13, ROWS = 3;
    addBand(ROW * ROWS, (context, area, xOf) => {
      const ends = new Array(ROWS).fill(-Infinity);
      for (const event of events.filter(e => (e.mark || e.colour === ERROR) && e.t >= from && e.t <= to)) {
        const width = context.measureText(event.text).width + 8;
        const x = Math.max(area.x, Math.min(xOf(event.t), area.x + area.w - width));
        const row = ends.findIndex(right => right <= x);
        if (row < 0 || width > area.w)
          continue;
        ends[row] = x + width;
        context.fillStyle = event.colour;
        context.fillText(event.text, x + 2, ROW * (ROWS - 1 - row) + ROW / 2);
      }
    });
  }

  /* ---- time shown, cursors ------------------------------------------------------------------------------------------ */

  let busy = false;

  function show(low, high) {
    const least = 1e-6, span = Math.min(Math.max(high - low, least), end - begin);
    from = Math.max(begin, Math.min(low, end - span));
    to = from + span;
    busy = true;
    for (const chart of charts)
      chart.graph.updateOptions({file: rowsOf(chart), dateWindow: [from, to]});
    busy = false;
    bands.forEach(draw => draw());
    showValues();
  }

  /* What a person wants to see, who does not want it to run away. */
  function look(low, high) {
    run(false);
    show(low, high);
  }

  /* While samples come, the newest ones. */
  function showAll() {
    run(true);
    show(begin, end);
  }

  function zoom(factor, at) {
    const centre = at === undefined || at === null ? (from + to) / 2 : at;
    look(centre - (centre - from) * factor, centre + (to - centre) * factor);
  }

  function setCursor(second, t) {
    if (second)
      cursorB = t;
    else
      cursorA = t;
    show(from, to);
  }

  document.addEventListener("keydown", event => {
    const move = (to - from) / 10;
    const keys = {
      "a": () => pointer !== null && setCursor(false, pointer), "b": () => pointer !== null && setCursor(true, pointer),
      "+": () => zoom(0.8, pointer), "-": () => zoom(1.25, pointer), "0": showAll, " ": () => run(!running),
      "ArrowLeft": () => look(from - move, to - move), "ArrowRight": () => look(from + move, to + move),
      "Escape": () => { cursorA = cursorB = null; show(from, to); },
    };
    if (keys[event.key] && !event.ctrlKey && !event.metaKey && !event.altKey) {
      keys[event.key]();
      event.preventDefault();
    }
  });
  window.addEventListener("resize", () => {
    charts.forEach(chart => chart.graph.resize());
    show(from, to);
  });

  /* ---- table of values ---------------------------------------------------------------------------------------------- */

  const rows = []; /* {column, cells} */

  function cell(row, text, name) {
    const element = document.createElement(name ? "th" : "td");
    element.textContent = text;
    row.append(element);
    return element;
  }

  function toggle(column, visible) {
    column.shown = visible;
    column.chart.graph.setVisibility(column.chart.columns.indexOf(column), visible);
  }

  function nameCell(row, column, name) {
    const element = cell(row, "");
    const label = document.createElement("label");
    element.className = "name";
    if (column.chart) {
      const box = document.createElement("input"), dash = document.createElement("span");
      box.type = "checkbox";
      box.checked = true;
      box.addEventListener("change", () => toggle(column, box.checked));
      dash.style.background = column.colour;
      label.append(box, dash);
    }
    label.append(column.unit ? `${name} [${column.unit}]` : name);
    element.append(label);
  }

  function groupRow(table, text) {
    const row = table.insertRow();
    row.className = "group";
    cell(row, text).colSpan = 7;
  }

  function makeTable() {
    const table = document.getElementById("values"), head = table.insertRow();
    cell(head, "signal", true).className = "name";
    for (const title of [live ? "now" : "pointer", "A", "B", "B - A", "min", "max"])
      cell(head, title, true);
    for (const column of columns) {
      const axis = trace.axes.find(a => column.index >= a.first && column.index < a.first + a.count);
      if (axis && column.index === axis.first)
        groupRow(table, axis.name);
      else if (!axis && column.index === ofAxes)
        groupRow(table, "signals");
      const row = table.insertRow();
      nameCell(row, column, axis ? column.name.slice(axis.name.length + 1) : column.name);
      rows.push({column, cells: [0, 1, 2, 3, 4, 5].map(() => cell(row, ""))});
    }
  }

  function rangeShown(column) {
    let low = Infinity, high = -Infinity;
    const last = indexAt(to);
    for (let i = indexAt(from); i <= last; i++) {
      const value = column.values[i];
      if (value < low)
        low = value;
      if (value > high)
        high = value;
    }
    return low <= high ? [numberText(low), numberText(high)] : ["", ""];
  }

  function showValues() {
    if (count === 0)
      return;
    const at = [pointer, cursorA, cursorB].map(t => t === null ? -1 : indexAt(t));
    if (running)
      at[0] = count - 1;
    for (const {column, cells} of rows) {
      const isNumber = column.kind !== "state" && column.kind !== "error";
      at.forEach((i, k) => { cells[k].textContent = i < 0 ? "" : textOf(column, i); });
      cells[3].textContent = isNumber && at[1] >= 0 && at[2] >= 0
        ? numberText(column.values[at[2]] - column.values[at[1]]) : "";
      const range = isNumber ? rangeShown(column) : ["", ""];
      cells[4].textContent = range[0];
      cells[5].textContent = range[1];
    }
    showTimes();
  }

  function showTimes() {
    const table = document.getElementById("cursors"), shown = [["pointer", pointer], ["A", cursorA], ["B", cursorB]];
    table.replaceChildren();
    const row = table.insertRow();
    for (const [name, t] of shown)
      cell(row, t === null ? `${name}: -` : `${name}: ${timeText(t)}`);
    const difference = cursorA !== null && cursorB !== null ? cursorB - cursorA : null;
    cell(row, difference === null ? "B - A: -" : `B - A: ${timeText(difference)}`
      + (difference !== 0 ? ` (${numberText(1 / Math.abs(difference))} Hz)` : ""));
  }

  /* ---- live ------------------------------------------------------------------------------------------------------ */

  let expected = 0, missed = 0;     /* number of the next sample, and of those that did not come */
  let pressed = false, planned = false, eventsChanged = false;

  function run(on) {
    running = on && coming;
    if (!live)
      return;
    document.getElementById("run").textContent = running ? "Pause" : "Run";
    document.querySelectorAll("#values th")[1].textContent = running ? "now" : "pointer";
    if (running)
      plan(0);
  }

  /* Room for so many more: the oldest samples go. */
  function makeRoom(more) {
    if (count + more <= times.length)
      return;
    const gone = Math.max(0, count - Math.max(0, kept - more));
    times.copyWithin(0, gone, count);
    columns.forEach(column => column.values.copyWithin(0, gone, count));
    count -= gone;
  }

  /* Samples lie one after the other: time, then a value per column. Those that are here already are left out: after a
   * break of the connection they may come again. */
  function take(message) {
    const data = new Float64Array(bytesOf(message.samples).buffer), width = columns.length + 1;
    const number = data.length / width, known = Math.max(0, Math.min(number, expected - message.number));
    const skipped = Math.max(known, number - kept), gap = message.number - expected, first = number - skipped;
    makeRoom(first);
    for (let k = skipped; k < number; k++, count++) {
      times[count] = data[k * width];
      columns.forEach((column, i) => { column.values[count] = data[k * width + 1 + i]; });
    }
    if (number === 0)
      return;
    const marks = known === 0 ? message.marks : [];
    if (expected > 0 && gap > 0) {
      missed += gap;
      marks.push({t: data[0], text: `${gap} samples did not reach this page`});
    }
    expected = Math.max(expected, message.number + number);
    begin = times[0];
    end = Math.max(times[count - 1], begin + 1e-6);
    addEvents(eventsFrom(count - first, marks));
  }

  function addEvents(found) {
    eventsChanged = eventsChanged || found.length > 0 || (events.length > 0 && events[0].t < begin);
    events = events.filter(event => event.t >= begin).concat(found).slice(-LIVE_EVENTS);
  }

  /* Draws when the browser has time for it; one that is slow draws less often, and still takes all samples. */
  function plan(wait) {
    if (planned)
      return;
    planned = true;
    setTimeout(() => requestAnimationFrame(draw), wait);
  }

  function draw() {
    const started = performance.now();
    about();
    if (eventsChanged)
      showEvents();
    eventsChanged = false;
    if (running && !pressed && count > 0)
      show(Math.max(begin, end - Number(document.getElementById("width").value)), end);
    if (!coming)
      document.body.dataset.ended = "true";
    planned = false;
    lastDrawing = performance.now() - started;
  }

  let lastDrawing = 0;

  function tell(text) {
    document.getElementById("connection").textContent = text;
  }

  function connect() {
    const source = new EventSource(trace.live);
    document.getElementById("live").hidden = false;
    document.getElementById("run").addEventListener("click", event => { run(!running); event.target.blur(); });
    document.getElementById("width").addEventListener("change", event => { run(true); event.target.blur(); });
    place.addEventListener("mousedown", () => { pressed = true; });
    window.addEventListener("mouseup", () => { pressed = false; });
    source.onopen = () => tell("");
    source.onerror = () => tell("The connection is lost. This page tries to connect again.");
    source.onmessage = event => { take(JSON.parse(event.data)); plan(2 * lastDrawing); };
    source.addEventListener("end", event => {
      source.close();
      tell(event.data);
      coming = false;
      document.getElementById("run").disabled = true;
      run(false);
      plan(0);
    });
  }

  /* ---- the page ------------------------------------------------------------------------------------------------------- */

  function heading(text) {
    const element = document.createElement("h3");
    element.textContent = text;
    place.append(element);
  }

  function addAxis(axis) {
    const mine = columns.slice(axis.first, axis.first + axis.count);
    heading(axis.name);
    addStateBand(mine.find(column => column.kind === "state"));
    const groups = new Map();
    for (const column of mine.filter(c => c.kind === "number"))
      groups.set(column.unit, [...(groups.get(column.unit) || []), column]);
    let left = groups.size;
    for (const [unit, group] of groups)
      addChart(group[group.length - 1].name.slice(axis.name.length + 1).replace(/^(set|actual) /, ""), unit, group,
               group.length > 1 ? 140 : 90, false, --left === 0);
  }

  /* Signals beside the axes: one chart for each unit, and one for each flag. */
  function addOthers(others) {
    const groups = new Map();
    for (const column of others.filter(c => c.kind === "number"))
      groups.set(column.unit || column.name, [...(groups.get(column.unit || column.name) || []), column]);
    if (others.length)
      heading("signals");
    for (const group of groups.values())
      addChart(group.length === 1 ? group[0].name : "", group[0].unit, group, 120, group.every(c => c.integer), true);
    for (const column of others.filter(c => c.kind === "flag"))
      addChart(column.name, "", [column], 50, true, false);
  }

  function about() {
    const all = (name) => { const c = columns.find(column => column.name === name); return c && count ? c.values[count - 1] : 0; };
    document.getElementById("about").textContent =
      count === 0 ? live ? "No sample has come yet." : "The trace is empty."
      : `${count} samples of ${columns.length} signals, ${timeText(begin)} to ${timeText(end)}, `
        + `${all("lost frames")} lost frames, ${all("overruns")} overruns.`
        + (missed ? ` ${missed} samples did not reach this page.` : "");
  }

  function start() {
    about();
    if (count > 0 || live) {
      addMarkBand();
      trace.axes.forEach(addAxis);
      addOthers(columns.slice(ofAxes).filter(c => c.program));
      addOthers(columns.slice(ofAxes).filter(c => !c.program && c.kind === "number"));
    }
    makeTable();
    showEvents();
    show(begin, end);
    if (live)
      connect();
    document.body.dataset.ready = String(charts.length);
  }

  start();
})();
