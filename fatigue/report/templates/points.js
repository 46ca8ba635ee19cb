"use strict";
// Every point of the drawn welds, in columns: searched as they are, and only the rows that are seen are written.
(() => {
  const { allPoints, digits } = window.fatigue;
  const ROWS = 25;
  const BOTTOM = 1, NO_TOE = 2, BOUNDED = 4, WORST = 8, END = 16, CORNER = 32;
  const byId = (id) => document.getElementById(id);
  let points = null;

  const load = async () => {  // at the first use: nobody who does not search waits for it
    points = { ...await allPoints() };
    points.worstFirst = Array.from(points.node, (_, i) => i).sort((a, b) => (points.utilisation[b] || 0) - (points.utilisation[a] || 0));
    points.low = { welds: points.welds.map((w) => w.toLowerCase()), events: points.events.map((e) => e.toLowerCase()) };
    const names = points.welds.map((name, i) => [name, i]).sort((a, b) => a[0].localeCompare(b[0], undefined, { numeric: true }));
    points.alphabetic = [];
    names.forEach(([, i], rank) => { points.alphabetic[i] = rank; });
    points.doubtful = new Set(points.unverified);
  };

  // A word is found in the name of a weld or an event, is the number of a node, or begins the name of a face or place.
  const matcher = (word) => {
    const welds = points.low.welds.map((name) => name.includes(word));
    const events = points.low.events.map((name) => name.includes(word));
    const node = /^\d+$/.test(word) ? Number(word) : -1;
    const flags = [["bottom", BOTTOM], ["end", END], ["corner", CORNER]].filter(([name]) => name === word).reduce((all, [, bit]) => all | bit, 0);
    const top = word === "top";
    return (i) => points.node[i] === node || welds[points.weld[i]] || events[points.event[i]]
      || (points.flags[i] & flags) !== 0 || (top && !(points.flags[i] & BOTTOM));
  };
  const orders = {
    damage: null,  // as they come
    place: (a, b) => points.alphabetic[points.weld[a]] - points.alphabetic[points.weld[b]] || (points.flags[a] & BOTTOM) - (points.flags[b] & BOTTOM)
      || points.arc_length_mm[a] - points.arc_length_mm[b],
    node: (a, b) => points.node[a] - points.node[b],
    max_range_MPa: (a, b) => points.max_range_MPa[b] - points.max_range_MPa[a],
  };

  let found = [], at = 0;
  const search = async () => {
    if (!points) {
      try {
        await load();
      } catch {
        byId("no-search").hidden = false;
        return;
      }
    }
    const words = byId("find-points").value.toLowerCase().split(/\s+/).filter(Boolean).map(matcher);
    const least = Number(byId("from-utilisation").value) || 0;
    const mask = byId("only-worst").checked ? WORST : 0;
    found = [];
    for (const i of points.worstFirst) {
      if (least && !(points.utilisation[i] >= least)) continue;
      if (mask && !(points.flags[i] & mask)) continue;
      if (words.every((fits) => fits(i))) found.push(i);
    }
    const order = orders[byId("points-by").value];
    if (order) found.sort(order);
    at = 0;
    show();
  };

  const HEADS = [
    ["hot spot"], ["weld", ""], ["face", ""], ["along the line", "mm"], ["node"], ["life", "km"], ["life", "years"],
    ["utilisation"], ["load factor"], ["governing event", ""], ["largest range", "MPa"], ["Dirlik / rainflow damage"], ["place", ""],
  ];
  const isText = (head) => head[1] === "";
  const element = (name, text, className) => {
    const made = document.createElement(name);
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    return made;
  };
  const headings = () => {
    const row = element("tr");
    for (const head of HEADS) {
      const th = element("th", head[0], isText(head) ? "" : "n");
      th.scope = "col";
      if (head[1]) th.append(" ", element("span", `[${head[1]}]`, "unit"));
      row.append(th);
    }
    byId("found-points").tHead.replaceChildren(row);
  };
  const cells = (i) => {
    const flags = points.flags[i];
    const weld = points.welds[points.weld[i]];
    const life = points.target_km / points.utilisation[i];
    const doubt = points.doubtful.has(weld) ? " (unverified)" : "";
    const least = flags & BOUNDED ? "≥ " : "", most = flags & BOUNDED ? "≤ " : "";
    const place = [flags & END && "end", flags & CORNER && "corner", flags & NO_TOE && "no toe", flags & BOUNDED && "not counted: a bound"];
    return [
      points.hot_spot[i] ? String(points.hot_spot[i]) : "–", weld, flags & BOTTOM ? "bottom" : "top",
      digits(points.arc_length_mm[i]), String(points.node[i]), least + digits(life, 3) + doubt,
      least + digits(life / points.km_per_year, 3) + doubt, most + digits(points.utilisation[i]) + doubt,
      least + digits(points.load_factor[i]) + doubt, points.events[points.event[i]] ?? "–",
      most + digits(points.max_range_MPa[i]), digits(points.dirlik_ratio[i]), place.filter(Boolean).join(", ") || "–",
    ];
  };
  const show = () => {
    const rows = found.slice(at, at + ROWS).map((i) => {
      const row = element("tr");
      cells(i).forEach((text, column) => {
        const cell = element("td", undefined, isText(HEADS[column]) ? "" : "n");
        const inner = element("bdi");
        const page = HEADS[column][0] === "weld" && points.pages[text];
        if (page) {
          const link = element("a", undefined);
          link.href = "#" + page;
          inner.textContent = text;
          link.append(inner);
          cell.append(link);
        } else {
          inner.textContent = text;
          cell.append(inner);
        }
        row.append(cell);
      });
      return row;
    });
    byId("found-points").tBodies[0].replaceChildren(...rows);
    const whole = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
    byId("points-shown").textContent = found.length
      ? `${whole(at + 1)} to ${whole(at + rows.length)} of ${whole(found.length)} points` : "no point like this";
    byId("points-back").disabled = at === 0;
    byId("points-on").disabled = at + ROWS >= found.length;
  };

  const form = byId("all-points").querySelector("form");
  form.addEventListener("submit", (event) => event.preventDefault());
  let wait = 0;
  form.addEventListener("input", () => { clearTimeout(wait); wait = setTimeout(search, 120); });
  byId("points-back").addEventListener("click", () => { at = Math.max(0, at - ROWS); show(); });
  byId("points-on").addEventListener("click", () => { at += ROWS; show(); });
  headings();
  new IntersectionObserver((seen, watcher) => {
    if (seen.some((s) => s.isIntersecting)) { watcher.disconnect(); search(); }
  }, { rootMargin: "200px" }).observe(byId("all-points"));
})();
