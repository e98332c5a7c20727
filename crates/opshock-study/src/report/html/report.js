"use strict";
// Draws zoomable plots. Without this script the page has its table, static figures and point pages (by address).
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  document.documentElement.classList.add("js");
  const NS = "http://www.w3.org/2000/svg";
  const { layout, colours } = data, TEXT = "#222222", GRID = "#e4e4e4", WHITE = "#ffffff";
  const VERDICTS = { survives: "#0072b2", fails: "#d55e00", undecided: "#cc79a7" };
  const DASHES = ["", "7 4", "8 3 1.5 3", "1.5 3"];
  const series = [...new Set(data.points.map(p => p.series))];
  const shown = { series: new Set(series), signs: new Set(data.points.map(p => p.sign)) };
  const visible = p => shown.series.has(p.series) && shown.signs.has(p.sign);
  const element = (name, attributes, parent, text) => {
    const e = document.createElementNS(NS, name);
    for (const key in attributes) e.setAttribute(key, attributes[key]);
    if (text !== undefined) e.textContent = text;
    if (parent) parent.append(e);
    return e;
  };
  const html = (name, attributes, parent, text) => {
    const e = document.createElement(name);
    for (const key in attributes) e.setAttribute(key, attributes[key]);
    if (text !== undefined) e.textContent = text;
    if (parent) parent.append(e);
    return e;
  };
  const number = v => v === null || v === undefined ? "" : Number(v.toPrecision(4)).toString();

  // Round values some `count` apart on a linear axis; 1, 2, 5 on a logarithmic one.
  const ticks = (low, high, log, count) => {
    const found = [];
    if (log && high / low > 3) {
      for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); e++)
        for (const m of [1, 2, 3, 5, 7]) {
          const v = m * 10 ** e;
          if (v >= low && v <= high) found.push(v);
        }
      return found;
    }
    const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 2.5, 5, 10].map(m => m * power).find(s => s >= rough) ?? rough;
    for (let k = Math.ceil(low / step); k * step <= high * (1 + 1e-12); k++) found.push(Number((k * step).toPrecision(10)));
    return found;
  };

  // A plot with zoom by dragging, wheel and keys. Plots of one group share both axes, `link` shares the abscissa of groups.
  const plots = [];
  class Plot {
    constructor(cell, { label, title, x, y, group, link, draw }) {
      Object.assign(this, { cell, title, x: { ...x }, y: { ...y }, group, link, drawing: draw, L: 58, R: 12, T: title ? 28 : 10, B: 44 });
      this.full = { x: [...x.range], y: [...y.range] };
      this.svg = element("svg", { role: "group", tabindex: "0", "aria-label": label }, cell);
      this.svg.addEventListener("wheel", e => {
        if (!e.ctrlKey && document.activeElement !== this.svg) return;
        e.preventDefault();
        this.scale(e.deltaY < 0 ? 0.8 : 1.25, this.at(e));
      }, { passive: false });
      this.svg.addEventListener("dblclick", () => this.reset());
      this.svg.addEventListener("keydown", e => {
        const act = { "+": () => this.scale(0.7), "=": () => this.scale(0.7), "-": () => this.scale(1 / 0.7), "0": () => this.reset(),
          ArrowLeft: () => this.pan(-0.15, 0), ArrowRight: () => this.pan(0.15, 0), ArrowUp: () => this.pan(0, 0.15), ArrowDown: () => this.pan(0, -0.15) }[e.key];
        if (act && e.target === this.svg) { e.preventDefault(); act(); }
      });
      this.drag();
      plots.push(this);
      this.fit();
    }
    // A pixel of the drawing is one of the page, so that words keep their size on a narrow one.
    fit() {
      this.W = Math.max(260, Math.round(this.cell.clientWidth));
      this.H = Math.round(Math.min(420, Math.max(280, 0.6 * this.W)));
      this.svg.setAttribute("viewBox", `0 0 ${this.W} ${this.H}`);
      this.draw();
    }
    share(axis, v) { const [a, b] = axis.range; return axis.log ? Math.log(v / a) / Math.log(b / a) : (v - a) / (b - a); }
    value(axis, s) { const [a, b] = axis.range; return axis.log ? a * (b / a) ** s : a + s * (b - a); }
    px(v) { return this.L + this.share(this.x, v) * (this.W - this.L - this.R); }
    py(v) { return this.H - this.B - this.share(this.y, v) * (this.H - this.T - this.B); }
    at(e) {
      const box = this.svg.getBoundingClientRect();
      const clamp = s => Math.min(1, Math.max(0, s));
      return [clamp(((e.clientX - box.left) / box.width * this.W - this.L) / (this.W - this.L - this.R)),
        clamp(1 - ((e.clientY - box.top) / box.height * this.H - this.T) / (this.H - this.T - this.B))];
    }
    scale(factor, [sx, sy] = [0.5, 0.5]) { this.window([sx - sx * factor, sx + (1 - sx) * factor], [sy - sy * factor, sy + (1 - sy) * factor]); }
    pan(dx, dy) { this.window([dx, 1 + dx], [dy, 1 + dy]); }
    window([x0, x1], [y0, y1]) {
      this.x.range = [this.value(this.x, x0), this.value(this.x, x1)].sort((a, b) => a - b);
      this.y.range = [this.value(this.y, y0), this.value(this.y, y1)].sort((a, b) => a - b);
      this.spread();
    }
    reset() { this.x.range = [...this.full.x]; this.y.range = [...this.full.y]; this.spread(); }
    spread() {
      for (const other of plots) {
        const own = other.group === this.group;
        if (own) other.y.range = [...this.y.range];
        if (own || (this.link && other.link === this.link)) { other.x.range = [...this.x.range]; other.draw(); }
      }
    }
    drag() {
      let from = null, box = null;
      this.svg.addEventListener("pointerdown", e => { if (e.button === 0 && e.pointerType !== "touch") from = this.at(e); });
      this.svg.addEventListener("pointermove", e => {
        if (!from) return;
        const to = this.at(e), w = this.W - this.L - this.R, h = this.H - this.T - this.B;
        box?.remove();
        box = element("rect", { x: this.L + Math.min(from[0], to[0]) * w, y: this.T + (1 - Math.max(from[1], to[1])) * h,
          width: Math.abs(to[0] - from[0]) * w, height: Math.abs(to[1] - from[1]) * h, class: "box" }, this.svg);
      });
      addEventListener("pointerup", e => {
        if (!from) return;
        const to = this.at(e), start = from;
        from = null; box?.remove(); box = null;
        if (Math.abs(to[0] - start[0]) > 0.02 && Math.abs(to[1] - start[1]) > 0.02)
          this.window([start[0], to[0]].sort((a, b) => a - b), [start[1], to[1]].sort((a, b) => a - b));
      });
    }
    inside(x, y) { const a = this.share(this.x, x), b = this.share(this.y, y); return a >= -1e-9 && a <= 1 + 1e-9 && b >= -1e-9 && b <= 1 + 1e-9; }
    text(attributes, words) { return element("text", { "font-size": 12, fill: TEXT, ...attributes }, this.svg, words); }
    draw() {
      this.svg.replaceChildren();
      const room = this.W - this.L - this.R;
      for (const v of ticks(...this.y.range, this.y.log, 6)) {
        const y = this.py(v);
        element("line", { x1: this.L, x2: this.W - this.R, y1: y, y2: y, stroke: GRID }, this.svg);
        this.text({ x: this.L - 6, y: y + 4, "text-anchor": "end" }, number(v));
      }
      const [low, high] = this.x.range, words = this.x.words?.filter(([v]) => v >= low && v <= high);
      let free = -1e9;
      for (const [v, word] of words ?? ticks(low, high, this.x.log, Math.max(2, Math.floor(room / 70))).map(v => [v, number(v)])) {
        const x = this.px(v), half = 3.7 * word.length;
        element("line", { x1: x, x2: x, y1: this.T, y2: this.H - this.B, stroke: GRID }, this.svg);
        if (x - half < free) continue;
        this.text({ x, y: this.H - this.B + 17, "text-anchor": "middle" }, word);
        free = x + half + 4;
      }
      if (this.title) this.text({ x: this.L, y: 17, "font-size": 13 }, this.title);
      this.text({ x: this.L + room / 2, y: this.H - 8, "text-anchor": "middle" }, this.x.label);
      this.text({ transform: `translate(13 ${(this.T + this.H - this.B) / 2}) rotate(-90)`, "text-anchor": "middle" }, this.y.label);
      this.drawing(this);
    }
    line(values, colour, dash) {
      const d = [];
      let pen = "M";
      // Clipped by the plot's own frame: points far outside are cut by the clip path of the style.
      for (const [x, y] of values) {
        if (x === null || y === null) { pen = "M"; continue; }
        d.push(`${pen}${this.px(x).toFixed(1)} ${this.py(y).toFixed(1)}`);
        pen = "L";
      }
      const id = `clip-${plots.indexOf(this)}`;
      if (!this.svg.querySelector("clipPath"))
        element("rect", { x: this.L, y: this.T, width: this.W - this.L - this.R, height: this.H - this.T - this.B }, element("clipPath", { id }, this.svg));
      return element("path", { d: d.join(""), fill: "none", stroke: colour, "stroke-width": 1.8, "stroke-dasharray": dash ?? "", "clip-path": `url(#${id})` }, this.svg);
    }
    mark(x, y, { colour, open, point, note, style = 0, size = 4.5, dx = 0, bound = 0 }) {
      if (y === null || !this.inside(x, y)) return;
      const at = [this.px(x) + dx, this.py(y)], r = size, fill = open || bound ? WHITE : colour;
      const corners = [null, [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]], [[0, -1.25], [1.15, 0.85], [-1.15, 0.85]], [[0, -1.3], [1.3, 0], [0, 1.3], [-1.3, 0]]][style % 4];
      const path = points => "M" + points.map(([a, b]) => `${(at[0] + r * a).toFixed(1)} ${(at[1] + r * b).toFixed(1)}`).join("L") + "Z";
      if (bound) element("path", { d: path([[0, -1.5 * bound], [0, -4 * bound], [-1, -4 * bound], [0, -5.5 * bound], [1, -4 * bound], [0, -4 * bound]]), fill: WHITE, stroke: colour, "stroke-width": 1.4 }, this.svg);
      const paint = { fill, stroke: colour, "stroke-width": 1.5 };
      const mark = corners ? element("path", { d: path(corners), ...paint }, this.svg) : element("circle", { cx: at[0], cy: at[1], r, ...paint }, this.svg);
      mark.classList.add("mark");
      mark.dataset.point = point;
      mark.setAttribute("role", "link");
      mark.setAttribute("aria-label", note);
      element("title", {}, mark, note);
      mark.addEventListener("click", () => open_point(point));
      mark.addEventListener("mouseenter", () => light(point, true));
      mark.addEventListener("mouseleave", () => light(point, false));
    }
  }
  // The tools of a group of plots, above them.
  const toolbar = (host, group) => {
    const tools = html("p", { class: "tools" }), first = () => plots.find(p => p.group === group);
    for (const [text, act] of [["zoom in", () => first().scale(0.6)], ["zoom out", () => first().scale(1 / 0.6)], ["all", () => first().reset()], ["save picture (SVG)", () => save(group)]])
      html("button", { type: "button" }, tools, text).addEventListener("click", act);
    html("span", { class: "quiet" }, tools, " drag a box to zoom; keys + \u2212 0 and arrows; a click opens the point");
    host.before(tools);
  };
  // What a group shows now, as one file.
  const save = group => {
    const own = plots.filter(p => p.group === group), boxes = own.map(p => p.svg.getBoundingClientRect());
    const left = Math.min(...boxes.map(b => b.left)), top = Math.min(...boxes.map(b => b.top));
    const W = Math.max(...boxes.map(b => b.right)) - left, H = Math.max(...boxes.map(b => b.bottom)) - top;
    const all = element("svg", { viewBox: `0 0 ${W} ${H}`, width: W, height: H, "font-family": "DejaVu Sans, Verdana, sans-serif" });
    element("rect", { width: "100%", height: "100%", fill: WHITE }, all);
    own.forEach((p, k) => {
      const copy = p.svg.cloneNode(true);
      for (const [key, v] of Object.entries({ x: boxes[k].left - left, y: boxes[k].top - top, width: p.W, height: p.H })) copy.setAttribute(key, v);
      all.append(copy);
    });
    const address = URL.createObjectURL(new Blob([new XMLSerializer().serializeToString(all)], { type: "image/svg+xml" }));
    html("a", { href: address, download: `${group}.svg` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  };
  const light = (point, on) => {
    for (const e of document.querySelectorAll(`[data-point="${point}"]`)) e.classList.toggle("lit", on);
  };
  const open_point = point => { location.hash = `point-${point}`; };
  addEventListener("hashchange", () => {
    const page = document.getElementById(location.hash.slice(1));
    if (page?.classList.contains("page")) page.focus();
  });
  addEventListener("keydown", e => { if (e.key === "Escape" && location.hash.startsWith("#point-")) location.hash = "table"; });

  // Ranges.
  const span = (values, log, from) => {
    const known = values.filter(v => v !== null && v !== undefined && Number.isFinite(v) && (!log || v > 0));
    if (!known.length) return log ? [1, 10] : [0, 1];
    const low = from ?? Math.min(...known), high = Math.max(...known);
    if (low === high) return log ? [low / 1.5, low * 1.5] : [low - 0.5, low + 0.5];
    return log ? [low / 1.1, high * 1.1] : [from ?? low - 0.05 * (high - low), high + 0.05 * (high - low)];
  };
  const words = layout.words;
  const across = () => ({ label: layout.label, range: layout.range, log: false, words });
  const colour = p => colours[p.colour % colours.length];
  const groups = () => {
    const found = new Map();
    data.points.forEach((p, i) => {
      if (!visible(p)) return;
      const key = `${p.line} ${p.sign}`;
      if (!found.has(key)) found.set(key, []);
      found.get(key).push(i);
    });
    for (const list of found.values()) list.sort((a, b) => data.points[a].x - data.points[b].x);
    return [...found.values()];
  };

  const host = name => document.querySelector(`.plot[data-plot="${name}"]`);
  // What the plots share: series and signs.
  const controls = document.getElementById("controls");
  const box = (set, value, label, swatch) => {
    const wrap = html("label", {}, controls), input = html("input", { type: "checkbox", checked: "" }, wrap);
    if (swatch) element("rect", { width: 11, height: 11, fill: swatch }, element("svg", { width: 11, height: 11, "aria-hidden": "true" }, wrap));
    wrap.append(` ${label} `);
    input.addEventListener("change", () => { input.checked ? set.add(value) : set.delete(value); plots.forEach(p => p.draw()); });
  };
  series.forEach(s => box(shown.series, s, s, colour(data.points.find(p => p.series === s))));
  [...shown.signs].forEach(s => box(shown.signs, s, `sign ${s}`));

  layout.panels.forEach((panel, place) => new Plot(html("div", {}, host("critical")), {
    label: `Critical shock, ${panel.title}, zoomable`, title: panel.title, group: "critical", link: "abscissa", x: across(), y: layout.y,
    draw: plot => panel.lines.forEach((line, k) => {
      const own = line.marks.map(row => [row, data.points[row]]).filter(([, p]) => panel.worst ? shown.series.has(p.series) : visible(p));
      const paint = colours[line.colour % colours.length], dx = 5 * (k - (panel.lines.length - 1) / 2);
      const known = p => p.status === "above_range" ? null : p.crit;
      plot.line(own.map(([, p]) => [p.x, known(p)]), paint, DASHES[line.style % 4]).setAttribute("transform", `translate(${dx} 0)`);
      for (const [row, p] of own) {
        const y = p.crit, bound = { above_range: 1, below_range: -1 }[p.status] ?? 0;
        if (!bound && p.half !== null)
          plot.line([[p.x, Math.max(p.crit - p.half, 1e-3)], [p.x, p.crit + p.half]], paint).setAttribute("transform", `translate(${dx} 0)`);
        plot.mark(p.x, y, { colour: paint, open: p.reserved, point: row, style: line.style, dx, bound,
          note: `${panel.worst ? "lowest: " : ""}${p.name}: ${bound > 0 ? "more than " : bound ? "less than " : ""}${number(y)} G` });
      }
    }),
  }));
  // The first was as wide as the page while it was alone.
  plots.forEach(p => p.fit());
  toolbar(host("critical"), "critical");
  if (host("map")) {
    new Plot(host("map"), {
      label: "Outcome of every simulation, zoomable", group: "map", link: "abscissa", x: across(),
      y: { label: "Amplitude (G)", log: true, range: span(data.runs.map(r => r[1]), true) },
      draw: plot => {
        const nudge = 0.012 * (plot.full.x[1] - plot.full.x[0]);
        const keys = [...new Set(data.points.map(p => `${p.line} ${p.sign}`))];
        for (const list of groups()) plot.line(list.map(i => [data.points[i].x, data.points[i].crit]), colour(data.points[list[0]]), data.points[list[0]].sign === "-" ? "6 4" : "");
        for (const [i, g, verdict, h] of data.runs) {
          const p = data.points[i];
          if (!visible(p)) continue;
          const beside = Math.max(-4, Math.min(4, keys.indexOf(`${p.line} ${p.sign}`) - (keys.length - 1) / 2)) * nudge;
          plot.mark(p.x + beside, g, { colour: VERDICTS[verdict] ?? "#8c8c8c", open: verdict === "survives", style: verdict === "fails" ? 1 : 0, size: 3.2, point: i,
            note: `${p.name}, ${number(g)} G: ${verdict}${h === null ? "" : `, ${number(h)} nm`}` });
        }
      },
    });
    toolbar(host("map"), "map");
  }
  if (host("margin")) {
    new Plot(host("margin"), {
      label: "Smallest clearance against amplitude, zoomable", group: "margin",
      x: { label: "Amplitude (G)", log: true, range: span(data.runs.map(r => r[1]), true) },
      y: { label: "Smallest clearance (nm)", log: false, range: span(data.runs.map(r => r[3]), false) },
      draw: plot => {
        data.points.forEach((p, i) => {
          if (!visible(p)) return;
          const own = data.runs.filter(r => r[0] === i && r[3] !== null).sort((a, b) => a[1] - b[1]);
          plot.line(own.map(r => [r[1], r[3]]), colour(p), p.sign === "-" ? "6 4" : "");
          for (const [, g, verdict, h] of own) plot.mark(g, h, { colour: colour(p), open: verdict === "fails", size: 3, point: i, note: `${p.name}, ${number(g)} G: ${verdict}, ${number(h)} nm` });
        });
      },
    });
    toolbar(host("margin"), "margin");
  }
  let due = false;
  addEventListener("resize", () => {
    if (due) return;
    due = true;
    requestAnimationFrame(() => { due = false; plots.forEach(p => p.fit()); });
  });

  // Tables: sort, copy.
  for (const table of document.querySelectorAll("table.sortable")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => head.querySelector("button").addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach(other => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const key = row => {
        const cell = row.cells[column], value = cell.dataset.v ?? cell.textContent;
        const n = Number(value);
        return value === "" ? null : Number.isNaN(n) ? value : n;
      };
      const rows = [...table.tBodies[0].rows];
      rows.sort((a, b) => {
        const x = key(a), y = key(b);
        if (x === null || y === null) return (x === null) - (y === null);
        const order = typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y));
        return down ? -order : order;
      });
      table.tBodies[0].append(...rows);
    }));
  }
  document.getElementById("copy").addEventListener("click", async () => {
    const text = document.getElementById("csv").textContent, told = document.getElementById("copied");
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      // A page opened as a file may have no clipboard.
      const area = html("textarea", {}, document.body);
      area.value = text;
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    told.textContent = "copied";
  });

  // Two points side by side.
  const compare = document.getElementById("compare-tool"), picks = [0, Math.min(1, data.points.length - 1)];
  if (compare && data.points.length > 1) {
    const into = html("div", { class: "scroll", "aria-live": "polite" });
    const show = () => {
      const [a, b] = picks.map(i => data.points[i]);
      into.replaceChildren();
      const table = html("table", {}, into), head = html("tr", {}, html("thead", {}, table));
      for (const text of ["", a.name, b.name, "second over first"]) html("th", { scope: "col" }, head, text);
      const body = html("tbody", {}, table);
      const row = (name, key) => {
        const line = html("tr", {}, body);
        html("th", { scope: "row" }, line, name);
        for (const p of [a, b]) html("td", { class: "n" }, line, number(key(p)));
        const x = key(a), y = key(b);
        html("td", { class: "n" }, line, x && y ? `${((y / x - 1) * 100).toFixed(1)} %` : "");
      };
      row("critical shock (G)", p => p.crit);
      row("half-width of the uncertainty interval (G)", p => p.half);
      row("highest survivor (G)", p => p.survived);
      row("lowest failure (G)", p => p.failed);
      row("first touch (G)", p => p.touch);
      const both = [a, b].every(p => p.crit !== null && p.half !== null);
      if (both) {
        const apart = Math.abs(a.crit - b.crit) > a.half + b.half;
        html("p", {}, into, apart ? "The uncertainty intervals do not overlap: the difference is beyond them." : "The uncertainty intervals overlap: the difference is not beyond them.");
      }
    };
    picks.forEach((pick, k) => {
      const label = html("label", {}, compare, k ? "with " : "compare "), select = html("select", {}, label);
      data.points.forEach((p, i) => html("option", { value: i }, select, p.name));
      select.value = String(pick);
      select.addEventListener("change", () => { picks[k] = Number(select.value); show(); });
    });
    compare.append(into);
    show();
  }

  // Animation.
  const film = data.film, stage = document.getElementById("film-stage");
  if (film && stage) {
    const W = Math.min(900, Math.max(320, stage.clientWidth)), H = 290, svg = element("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": `Animation: ${film.label}` });
    const [ri, rs, rr, ro] = film.radii_mm, X = r => 60 + (r - ri) / (ro - ri) * (W - 110);
    const most = Math.max(film.gap_um, ...film.ramp_um.map(Math.abs), ...film.top_um.map(v => Math.abs(v + film.gap_um))) * 1.25;
    const Y = um => 150 - um / most * 120;
    element("rect", { x: 20, y: 60, width: 40, height: 180, fill: "#b0b0b0" }, svg);
    element("text", { x: 40, y: 256, "text-anchor": "middle", "font-size": 12, fill: TEXT }, svg, "clamp");
    const disk = element("path", { fill: "none", stroke: "#1a1a1a", "stroke-width": 4 }, svg);
    const arms = [0, 1].map(() => element("rect", { x: X(rr) - 14, width: 34, height: 12, fill: "#8c8c8c" }, svg));
    const slider = element("rect", { width: 30, height: 10, fill: "#0072b2" }, svg);
    const time = element("text", { x: 60, y: 24, "font-size": 12, fill: TEXT }, svg), words = html("p", {});
    const clock = html("input", { type: "range", min: 0, max: film.time_ms.length - 1, value: 0, "aria-label": "time of the shock" });
    const play = html("button", { type: "button" }, null, "play");
    const draw = () => {
      const k = Number(clock.value), s = film.slider_um[k], w = film.ramp_um[k];
      // A parabola and a cubic through clamp (with its slope), slider and ramp point.
      const a = rs - ri, b = rr - ri, q = s / (a * a), p = w / (b * b), c3 = (p - q) / (b - a), c2 = q - c3 * a;
      let d = "";
      for (let i = 0; i <= 60; i++) { const r = ri + (ro - ri) * i / 60, t = r - ri; d += `${i ? "L" : "M"}${X(r).toFixed(1)} ${Y(c2 * t * t + c3 * t * t * t).toFixed(1)}`; }
      disk.setAttribute("d", d);
      const force = film.force_n[k], h = film.clearance_nm[k], bear = film.asperity_mn[k] ?? null;
      arms[0].setAttribute("y", Y(film.gap_um + film.top_um[k]) - 12); arms[0].setAttribute("fill", force > 1e-3 ? "#d55e00" : "#8c8c8c");
      arms[1].setAttribute("y", Y(film.bottom_um[k] - film.gap_um)); arms[1].setAttribute("fill", force < -1e-3 ? "#d55e00" : "#8c8c8c");
      slider.setAttribute("x", X(rs) - 15); slider.setAttribute("y", Y(s) - 14 - (h === null ? 0 : Math.min(30, Math.max(-4, 2 * h))));
      slider.setAttribute("fill", h === null || (bear ?? 0) > 0.1 ? "#d55e00" : "#0072b2");
      time.textContent = `${film.time_ms[k].toFixed(3)} ms`;
      words.textContent = `disk under the slider ${s.toFixed(1)} \u00b5m, at the ramp ${w.toFixed(1)} \u00b5m, contact ${Math.abs(force).toFixed(2)} N, clearance ${h === null ? "touched" : h.toFixed(2) + " nm"}${bear === null ? "" : `, asperities bear ${bear.toFixed(1)} mN`}`;
    };
    let timer = null;
    play.addEventListener("click", () => {
      if (timer) { clearInterval(timer); timer = null; play.textContent = "play"; return; }
      play.textContent = "pause";
      timer = setInterval(() => {
        clock.value = (Number(clock.value) + 1) % film.time_ms.length;
        draw();
      }, 40);
    });
    clock.addEventListener("input", draw);
    stage.append(svg, words, play, clock);
    draw();
  }
  document.documentElement.dataset.ready = "yes";
})();
