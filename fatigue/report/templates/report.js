"use strict";
(() => {
  const read = (id) => JSON.parse(document.getElementById(id).textContent);
  const config = read("plot-config");
  const template = read("plot-template");
  const PAPER = { wide: [920, 0.74], half: [480, 0.69] }; // width drawn [px] and scale on A4
  let onPaper = location.hash === "#print";

  // plotly.js is text until the page has been painted: taking it in costs more than all the rest.
  const start = () => {
    if (window.Plotly) return;
    const script = document.createElement("script");
    script.textContent = document.getElementById("plotly-source").textContent;
    document.head.append(script);
  };

  // Figures are numbered as they are seen: some are on the screen only, others on paper only.
  const number = (unseen) => {
    let n = 0;
    document.querySelectorAll("figure").forEach((figure) => {
      const label = figure.querySelector("figcaption b");
      if (label && !figure.closest(unseen)) label.textContent = label.textContent.replace(/\d+/, () => String(++n));
    });
  };

  // Figures are drawn when they come into view, all at once for paper.
  const forPaper = (plot) => !plot.closest(".screen");
  const fit = (plot) => {
    const figure = plot.closest("figure");
    const [width, zoom] = PAPER[figure.parentElement.classList.contains("pair") && !figure.classList.contains("wide") ? "half" : "wide"];
    plot.style.zoom = zoom;
    return width;
  };
  const draw = (plot) => {
    if (plot.dataset.drawn) return;
    plot.dataset.drawn = "yes";
    const { data, layout } = read("json-" + plot.dataset.figure);
    layout.template = template;
    if (onPaper) layout.width = fit(plot);
    Plotly.newPlot(plot, data, layout, onPaper ? { ...config, staticPlot: true } : config);
    if (plot.dataset.figure === "scene") probe(plot);
  };
  const plots = [...document.querySelectorAll(".plot")];
  const watcher = new IntersectionObserver(
    (seen) => seen.filter((s) => s.isIntersecting).forEach((s) => draw(s.target)),
    { rootMargin: "400px" },
  );

  // Points of the scene: what they can be coloured by, and what is shown of the one under the pointer.
  const digits = (x, most = 3) => {  // as wording.number does
    if (Number.isNaN(x)) return "–";
    if (x > 1e12) return "> 1e12";
    if (x === 0) return "0";
    const size = Math.abs(x);
    if (size < 1e-3 || size >= 1e9) return x.toExponential(most - 1).replace("e+", "e").replaceAll("-", "−");
    if (size >= 1e4) return String(Math.round(Number(x.toPrecision(most)))).replace(/\B(?=(\d{3})+$)/g, "\u202f");
    return x.toPrecision(most).replaceAll("-", "−");
  };
  // All points of the drawn welds in columns: inflated once, when something of the page first asks for them.
  const inflate = async ({ heads, deflate }) => {
    const packed = Uint8Array.from(atob(deflate), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const types = { u1: Uint8Array, u2: Uint16Array, i4: Int32Array, f4: Float32Array, f8: Float64Array };
    const columns = {};
    let from = 0;
    for (const [name, type, count] of heads) {
      const column = new types[type](count);
      const size = column.BYTES_PER_ELEMENT;
      const raw = new Uint8Array(column.buffer);
      for (let plane = 0; plane < size; plane += 1) for (let i = 0; i < count; i += 1) raw[i * size + plane] = bytes[from++];
      columns[name] = column;
    }
    return columns;
  };
  let inflated = null;
  const allPoints = () => {
    const load = async () => {
      const { heads, deflate, ...points } = read("points-data");
      return Object.assign(points, await inflate({ heads, deflate }));
    };
    inflated ??= load();
    return inflated;
  };
  window.fatigue = { allPoints, digits };  // for the scripts behind this one

  async function probe(plot) {
    const all = await allPoints();
    let row = 0;
    const drawn = Array.from(all.drawn_steps, (step) => (row += step));
    const points = { ...all };
    for (const name of ["node", "weld", "event", "flags", "arc_length_mm", "utilisation", "load_factor", "dirlik_ratio", "max_range_MPa"]) {
      points[name] = drawn.map((i) => all[name][i]);
    }
    points.bottom = points.flags.map((flags) => flags & 1);
    points.life_km = points.utilisation.map((u) => points.target_km / u);
    const trace = plot.data.findIndex((t) => t.name === "weld lines");
    const original = { scale: plot.data[trace].marker.colorscale };
    let kept = null;
    const colourings = {
      life: (i) => Math.log10(Math.min(points.life_km[i], 1e12)),
      utilisation: (i) => Math.log10(Math.max(points.target_km / points.life_km[i], 1e-4)),
      ratio: (i) => Math.log10(points.dirlik_ratio[i]),
      event: (i) => points.event[i],
    };
    const decades = (from, to) => {
      const at = Array.from({ length: to - from + 1 }, (_, i) => from + i);
      return { tickvals: at, ticktext: at.map((d) => "1e" + d) };
    };
    const target = Math.floor(Math.log10(points.target_km));
    const events = points.events.map((_, i) => i);
    const steps = events.flatMap((i) => [[i / events.length, points.colours[i]], [(i + 1) / events.length, points.colours[i]]]);
    const scales = {
      life: { title: "life [km]", cmin: target - 1, cmax: target + 4, scale: original.scale, ...decades(target - 1, target + 4) },
      utilisation: { title: "utilisation [-]", cmin: -3, cmax: 1, scale: original.scale, reverse: true, ...decades(-3, 1) },
      ratio: {
        title: "damage Dirlik / rainflow [-]", cmin: -0.5, cmax: 0.5, scale: "PuOr",
        tickvals: [0.33, 0.5, 1, 2, 3].map(Math.log10), ticktext: ["1/3", "1/2", "1", "2", "3"],
      },
      event: {
        title: "governing event", cmin: -0.5, cmax: events.length - 0.5, scale: steps.length ? steps : original.scale,
        tickvals: events, ticktext: points.events.map((e) => (e.length > 24 ? e.slice(0, 23) + "…" : e).replace(/&/g, "&amp;").replace(/</g, "&lt;")),
      },
    };
    const colour = (by) => {
      const values = Array.from(points.node, (_, i) => colourings[by](i));
      const s = scales[by];
      const common = { color: [values], cmin: s.cmin, cmax: s.cmax, colorscale: [s.scale], reversescale: !!s.reverse };
      const update = {};
      for (const part of ["line", "marker"]) for (const [key, value] of Object.entries(common)) update[`${part}.${key}`] = value;
      update["marker.colorbar.title.text"] = s.title;
      update["marker.colorbar.tickvals"] = [s.tickvals];
      update["marker.colorbar.ticktext"] = [s.ticktext];
      Plotly.restyle(plot, update, [trace]);
    };
    document.querySelectorAll("input[name=colour]").forEach((input) => input.addEventListener("change", () => colour(input.value)));

    const list = document.getElementById("probe");
    const link = document.getElementById("probe-link");
    const show = (i) => {
      const weld = points.welds[points.weld[i]];
      const facts = [
        ["weld", weld],
        ["node", points.node[i]],
        ["face", points.bottom[i] ? "bottom" : "top"],
        ["arc length", digits(points.arc_length_mm[i]) + " mm"],
        ["life", digits(points.life_km[i], 3) + " km"],
        ["", digits(points.life_km[i] / points.km_per_year, 3) + " years"],
        ["utilisation", digits(points.target_km / points.life_km[i])],
        ["load factor", digits(points.load_factor[i])],
        ["Dirlik / rainflow", digits(points.dirlik_ratio[i])],
        ["largest range", digits(points.max_range_MPa[i]) + " MPa"],
        ["governing event", points.events[points.event[i]] ?? "–"],
      ];
      list.replaceChildren(
        ...facts.flatMap(([name, value]) => {
          const [dt, dd] = [document.createElement("dt"), document.createElement("dd")];
          dt.textContent = name;
          dd.textContent = value;
          return [dt, dd];
        }),
      );
      link.replaceChildren();
      if (points.pages[weld]) {
        const a = document.createElement("a");
        a.href = "#" + points.pages[weld];
        a.textContent = "Show this weld in detail";
        link.append(a);
      }
    };
    const station = (event) => {
      const point = event.points.find((p) => p.curveNumber === trace);
      return point ? point.pointNumber : -1;
    };
    plot.on("plotly_hover", (event) => { if (kept === null && station(event) >= 0) show(station(event)); });
    plot.on("plotly_click", (event) => { const i = station(event); if (i >= 0) { kept = i; show(i); } });
    plot.probe = show;
  }

  // Tables sort by any column and filter by any text in a row.
  const value = (cell) => (cell.dataset.v === undefined ? cell.textContent : Number(cell.dataset.v));
  const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), undefined, { numeric: true }));
  document.querySelectorAll(".table table").forEach((table) => {
    const body = table.tBodies[0];
    if (body.rows.length < 2) return;
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending";
        [...table.tHead.rows[0].cells].forEach((h) => h.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        const rows = [...body.rows].map((row) => [value(row.cells[column]), row]);
        rows.sort((a, b) => (down ? compare(b[0], a[0]) : compare(a[0], b[0])));
        body.append(...rows.map(([, row]) => row));
      });
    });
  });
  document.querySelectorAll("[data-filter]").forEach((box) => {
    const rows = [...box.querySelectorAll("tbody tr")];
    const line = document.createElement("div");
    line.className = "filter";
    const [label, input, count] = ["label", "input", "span"].map((name) => document.createElement(name));
    label.textContent = box.dataset.filter;
    input.type = "search";
    input.id = "filter-" + box.querySelector("table").id;
    label.htmlFor = input.id;
    count.className = "quiet";
    count.setAttribute("role", "status");
    input.addEventListener("input", () => {
      const wanted = input.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      rows.forEach((row) => {
        const text = row.textContent.toLowerCase();
        row.hidden = !wanted.every((word) => text.includes(word));
        shown += !row.hidden;
      });
      count.textContent = wanted.length ? `${shown} of ${rows.length}` : "";
    });
    line.append(label, input, count);
    box.prepend(line);
  });

  // A link to a weld opens it; paper shows all of them.
  const open = () => {
    const target = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
    const details = target && target.closest("details");
    if (details) {
      details.open = true;
      target.scrollIntoView();
    }
  };
  addEventListener("hashchange", open);
  const prepare = () => {
    start();
    onPaper = true;
    number(".screen");
    document.querySelectorAll("details").forEach((d) => { d.open = true; });
    plots.filter(forPaper).forEach((plot) => (plot.dataset.drawn ? Plotly.relayout(plot, { width: fit(plot) }) : draw(plot)));
  };
  addEventListener("beforeprint", () => { if (!onPaper) prepare(); });
  addEventListener("afterprint", () => {
    onPaper = false;
    number(".paper");
    plots.filter((plot) => plot.dataset.drawn).forEach((plot) => {
      plot.style.zoom = "";
      Plotly.relayout(plot, { width: null, autosize: true });
    });
  });
  if (onPaper) prepare();
  else {
    number(".paper");
    open();
    requestAnimationFrame(() => setTimeout(() => {
      start();
      plots.forEach((plot) => watcher.observe(plot));
    }));
  }
})();
