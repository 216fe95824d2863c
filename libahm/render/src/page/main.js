"use strict";
// Starts the page with embedded data, or with a session.

// Requests to the session. Only one map is requested at a time. A newer request replaces it. While the source is dragged, the newer request
// waits instead, so that the picture follows.
Ahm.Server = class {
  constructor() {
    this.client = Array.from(crypto.getRandomValues(new Uint8Array(8)), (b) => b.toString(16).padStart(2, "0")).join("");
    this.number = 0;  // number of requested maps
    this.sent = 0;    // number of requests, which may arrive in a different order
  }

  async get(name) {
    const answer = await Ahm.transport.fetch(name, { cache: "no-store" });
    if (!answer.ok) throw new Error(await this.reason(answer));
    return answer;
  }

  async post(name, request, signal) {
    const body = JSON.stringify(Object.assign({ client: this.client, number: ++this.sent }, request));
    const answer = await Ahm.transport.fetch(name, { method: "POST", headers: { "Content-Type": "application/json" }, body: body, signal: signal });
    if (!answer.ok) throw Object.assign(new Error(await this.reason(answer)), { status: answer.status });
    return answer;
  }

  async reason(answer) {
    try {
      return (await answer.json()).error;
    } catch (error) {
      return "the server returned status " + answer.status;
    }
  }

  // Ends the running requests, as far as the transport can.
  cancel() {
    if (this.abort) this.abort.abort();
    if (Ahm.transport.cancel) Ahm.transport.cancel();
  }

  // Requests a map. Null if a newer request replaced this one.
  async map(name, request) {
    const number = ++this.number;
    if (this.abort) this.abort.abort();
    this.abort = new AbortController();
    try {
      const answer = await this.post(name, request, this.abort.signal), data = await answer.arrayBuffer();
      return number === this.number ? Ahm.decode(data) : null;
    } catch (error) {
      if (error.name === "AbortError" || error.status === 409 || number !== this.number) return null;
      throw error;
    }
  }
};

Ahm.Viewer = class {
  constructor(surface, server) {
    this.element = (id) => document.getElementById(id);
    this.server = server;
    this.stage = new Ahm.Stage(this.element("canvas"), surface);
    this.panel = new Ahm.Panel(this.stage);
    this.tool = "map";
    this.picked = [];  // picked points of a path or a stroke
    this.source = null;  // source of the last map that starts at a point
    document.body.classList.toggle("still", !server);
    Ahm.transport.progress = (stage, fraction) => {
      if (this.busy) this.panel.say(stage + (fraction > 0 ? " " + Math.round(100 * fraction) + " %" : "") + " · Esc: cancel");
    };
    this.listen();
  }

  listen() {
    const canvas = this.element("canvas");
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", () => this.end_drag());
    canvas.addEventListener("pointerleave", () => { if (!this.dragging) this.panel.show_values(null); });
    window.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.stage.resize()).observe(this.element("stage"));
  }

  at(event) {
    const box = this.element("canvas").getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  press(event) {
    const [x, y] = this.at(event);
    this.element("stage").focus({ preventScroll: true });
    this.pressed = { x, y, button: event.button, id: event.pointerId };
    if (!this.server || event.button !== 0) return;
    const source = this.stage.source_position;
    const [sx, sy] = source ? this.stage.pixel(source.toArray()) : [-1e9, 0];
    const is_source = (this.tool === "map" || this.tool === "decal") && Math.hypot(x - sx, y - sy) < (event.pointerType === "touch" ? 26 : 13);
    if (!is_source && !this.is_drawing()) return;
    if (this.is_drawing() && !this.stage.pick(x, y)) return;
    this.dragging = true;
    this.picked = [];
    this.stage.controls.enabled = false;
    this.element("canvas").setPointerCapture(event.pointerId);
  }

  move(event) {
    this.pointer = this.at(event);
    if (this.pointing || (event.buttons !== 0 && !this.dragging)) return;
    this.pointing = true;  // at most once per frame
    requestAnimationFrame(() => {
      this.pointing = false;
      const hit = this.stage.pick(...this.pointer);
      this.panel.show_values(hit);
      if (this.dragging && hit) this.drag(hit);
    });
  }

  is_drawing() { return this.tool === "stroke" || this.tool === "whole"; }

  drag(hit) {
    if (this.is_drawing()) return this.add_to_stroke(hit);
    this.stage.set_source(hit.position, []);
    this.wanted = hit;
    if (!this.following) this.follow();
  }

  // Requests maps for the position of the dragged source, one after the other.
  async follow() {
    this.following = true;
    while (this.wanted) {
      const hit = this.wanted;
      this.wanted = null;
      await this.ask_map(hit.source);
    }
    this.following = false;
  }

  release(event) {
    const down = this.pressed, [x, y] = this.at(event);
    this.pressed = null;
    if (this.dragging) return this.end_drag();
    if (!this.server || !down || down.button !== 0 || Math.hypot(x - down.x, y - down.y) > 5) return;
    const hit = this.stage.pick(x, y);
    if (hit) this.click(hit);
  }

  end_drag() {
    if (!this.dragging) return;
    this.dragging = false;
    this.stage.controls.enabled = true;
    const drawn = this.picked.map((h) => h.source);
    if (this.tool === "stroke") this.ask_stroke(drawn);
    if (this.tool === "whole" && drawn.length > 1) {
      this.seed = drawn;
      this.ask_whole();
    }
  }

  click(hit) {
    if (this.tool === "path") return this.ask_path(hit);
    if (this.is_drawing() || this.tool === "isolines") return;
    this.wanted = null;
    return this.ask_map(hit.source);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /INPUT|SELECT|TEXTAREA/.test(event.target.tagName)) return;
    const step = 0.09, keys = {
      Escape: () => this.cancel(),
      r: () => this.stage.reset(), f: () => this.panel.next_field(), d: () => this.panel.set_dark(!this.stage.is_dark),
      ArrowLeft: () => this.stage.turn(-step, 0), ArrowRight: () => this.stage.turn(step, 0),
      ArrowUp: () => this.stage.turn(0, step), ArrowDown: () => this.stage.turn(0, -step),
      "+": () => this.stage.zoom(0.9), "=": () => this.stage.zoom(0.9), "-": () => this.stage.zoom(1 / 0.9)
    };
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    if (event.key.startsWith("Arrow") && event.target !== document.body && event.target !== this.element("stage")) return;
    event.preventDefault();
    act();
  }

  cancel() {
    if (!this.busy || !this.server) return;
    this.server.cancel();
    this.panel.say("cancelled");
  }

  // The following methods require the session.

  settings() {
    const text = (id) => this.element(id).value.trim(), number = (id) => {
      if (text(id) === "") return undefined;
      const x = Number(text(id));
      if (!(x > 0 && Number.isFinite(x))) throw new Error(id.replace(/_/g, "-") + ": '" + text(id) + "' is not a positive number");
      return x;
    };
    const out = { method: text("method"), radius: number("radius") ?? null };
    if (out.method === "heat") Object.assign(out, { variant: text("variant"), t_coef: number("t_coef") });
    if (text("u_axis") !== "") {
      out.u_axis = text("u_axis").split(/[\s,]+/).map(Number);
      if (out.u_axis.length !== 3 || !out.u_axis.every(Number.isFinite)) throw new Error("u axis: '" + text("u_axis") + "' is not a direction X,Y,Z");
    }
    return out;
  }

  async attempt(work) {
    this.busy = (this.busy || 0) + 1;
    try {
      await work();
    } catch (error) {
      // 409: a newer request replaced it. AbortError: `cancel` ended it.
      if (error.status !== 409 && error.name !== "AbortError") this.panel.say(error.message, true);
    } finally {
      this.busy--;
    }
  }

  ask_map(source) {
    return this.attempt(async () => {
      const request = Object.assign({ source: source }, this.settings()), begin = performance.now();
      const slow = setTimeout(() => this.panel.say("computing …"), 250);
      const map = await this.server.map("map", request).finally(() => clearTimeout(slow));
      if (!map) return;
      this.request = request;
      this.source = source;
      this.show(map, this.pattern === "polar" ? null : "polar", "map");
      if (this.tool === "decal") this.place_decal();
      if (this.tool === "coverage") await this.ask_coverage();
      this.time_of(begin);
    });
  }

  show(map, wanted, what) {
    this.pattern = map.pattern;
    this.made_map = { what: what, request: this.request };
    this.panel.show_map(map, wanted);
    if (this.server) this.offer(map.command, this.made_map);
  }

  // Shows the command line that reproduces the current result, and enables its export.
  // @param made  {what, request} of the result, for `export_made`
  offer(command, made) {
    const formats = this.formats[made.what] || [];
    this.element("command").textContent = command;
    if (!this.made || this.made.what !== made.what) this.element("format").replaceChildren(...formats.map((word) => new Option(word, word)));
    this.element("export").disabled = formats.length === 0;
    this.made = made;
  }

  time_of(begin) {
    this.panel.say(Math.round(performance.now() - begin) + " ms");
  }

  async ask_path(hit) {
    this.picked = this.picked.length === 1 ? [this.picked[0], hit] : [hit];
    this.stage.set_marks({ dots: this.picked.map((h) => h.position) });
    if (this.picked.length === 1) return this.panel.say("click the end of the path");
    await this.attempt(async () => {
      const [from, to] = this.picked;
      const answer = await (await this.server.post("path", { from: from.source, to: to.source })).json();
      this.stage.set_marks({ curve: answer.points, dots: [answer.points[0], answer.points[answer.points.length - 1]] });
      this.offer(answer.command, { what: "path", request: { from: from.source, to: to.source } });
      this.panel.say("path of length " + Ahm.number(this.panel.length_of(answer.length)));
    });
  }

  add_to_stroke(hit) {
    const last = this.picked[this.picked.length - 1], gap = 1.5 * this.stage.surface.spacing;
    if (last && Math.hypot(...hit.position.map((x, c) => x - last.position[c])) < gap) return;
    this.picked.push(hit);
    this.stage.set_marks({ curve: this.picked.map((h) => h.position) });
  }

  ask_stroke(points) {
    if (points.length < 2) return;
    return this.attempt(async () => {
      const begin = performance.now(), request = Object.assign({ points: points }, this.settings());
      this.panel.say("computing …");
      const map = await this.server.map("stroke", request);
      if (!map) return;
      this.request = request;
      this.show(map, "grid", "stroke");
      this.time_of(begin);
    });
  }

  // Repeats the last request with the current settings.
  ask_again() {
    if (!this.request || this.tool === "isolines") return;
    return this.request.points ? this.ask_stroke(this.request.points) : this.ask_map(this.request.source);
  }

  async ask_coverage() {
    const positive = (id) => Number(this.element(id).value);
    if (!this.request || !this.request.source) return;
    const request = Object.assign({}, this.request, {
      coverage_radius: positive("coverage_radius"), spacing: positive("coverage_spacing"), pattern: this.element("coverage_pattern").value
    });
    const answer = await (await this.server.post("coverage", request)).json();
    this.stage.set_marks({ curve: answer.points, pieces: answer.pieces });
    this.panel.say("");
    this.offer(answer.command, { what: "coverage", request: request });
    this.element("tool_hint").textContent = "length " + Ahm.number(this.panel.length_of(answer.length), 4) + ", " + (100 * answer.covered).toFixed(1) + " % on the surface";
  }

  // The tool path over the whole surface, from the drawn seed curve if there is one.
  ask_whole() {
    return this.attempt(async () => {
      const spacing = Number(Ahm.number(this.panel.length_of(Math.pow(2, Number(this.element("whole_spacing").value))), 2));
      this.element("whole_spacing_text").textContent = spacing;
      const request = { spacing: spacing, pattern: this.element("whole_pattern").value };
      if (this.seed) request.curve = this.seed;
      this.panel.say("computing …");
      const answer = await (await this.server.post("whole", request)).json(), scale = this.panel.length_of(1);
      if (this.tool !== "whole") return;
      this.stage.set_marks({ curve: answer.passes.points, pieces: answer.passes.pieces, links: answer.links });
      this.offer(answer.command, { what: "whole", request: request });
      const numbers = [answer.length * scale, answer.link_length * scale, answer.area * scale * scale].map((x) => Ahm.number(x, 4));
      this.element("tool_hint").textContent = "passes " + numbers[0] + ", links " + numbers[1] + " (blue), area " + numbers[2] + ", covered " + (100 * answer.covered).toFixed(1) + " %";
      this.panel.say("");
    });
  }

  // The isolines of a column of the input.
  ask_isolines() {
    return this.attempt(async () => {
      const request = { column: this.element("isolines_column").value, every: Number(this.element("isolines_every").value) };
      const answer = await (await this.server.post("isolines", request)).json();
      if (this.tool !== "isolines") return;
      this.stage.set_marks({ curve: answer.points, pieces: answer.pieces });
      this.offer(answer.command, { what: "isolines", request: request });
      this.element("tool_hint").textContent = answer.lines + (answer.lines === 1 ? " line" : " lines") + " of length " + Ahm.number(this.panel.length_of(answer.length), 4);
      this.panel.say("");
    });
  }

  // About ten levels between the smallest and the largest value of the column.
  offer_levels() {
    const column = this.columns[this.element("isolines_column").selectedIndex];
    this.element("isolines_every").value = Ahm.number((column.high - column.low) / 10, 1);
    return this.ask_isolines();
  }

  // Draws the image on the current map, which must start at a point.
  place_decal() {
    const width = this.stage.surface.scale ? 0.5 * Math.pow(2, Number(this.element("decal_size").value)) : 1;
    const turn = Number(this.element("decal_turn").value), { stage, decal } = this;
    this.element("decal_size_text").textContent = Ahm.number(this.panel.length_of(width), 3);
    this.element("decal_turn_text").textContent = turn + "°";
    const is_laid = this.tool === "decal" && decal && stage.map && stage.map.decal;
    stage.set_decal(is_laid ? decal.texture : null, width, turn * Math.PI / 180);
    if (!is_laid) return;
    const { width: w, height: h } = decal.texture.image, size = Ahm.number(this.panel.length_of(width * Math.max(1, h / w)), 4);
    const words = { "@IMAGE@": decal.name, "@SIZE@": size, "@ANGLE@": turn };
    const request = Object.assign({}, this.request, { size: Number(size), angle: turn, image: decal.file });
    this.offer(stage.map.decal.replace(/@[A-Z]+@/g, (word) => words[word]), { what: "decal", request: request });
  }

  load_decal(file) {
    if (!file) return;
    const image = new Image(), reader = new FileReader();
    image.onload = () => {
      const texture = new THREE.Texture(image), name = file.name;
      texture.generateMipmaps = false;
      texture.minFilter = THREE.LinearFilter;
      texture.needsUpdate = true;
      this.decal = { texture: texture, file: reader.result.replace(/^[^,]*,/, ""), name: /^[\w.-]+$/.test(name) ? name : "'" + name.replace(/'/g, "'\\''") + "'" };
      this.place_decal();
    };
    image.onerror = () => this.panel.say(file.name + " is not an image that this browser can read", true);
    reader.onload = () => { image.src = reader.result; };
    reader.onerror = () => this.panel.say(file.name + " cannot be read", true);
    reader.readAsDataURL(file);
  }

  set_tool(name) {
    this.tool = name;
    this.picked = [];
    for (const button of this.element("tool").children) button.setAttribute("aria-checked", button.dataset.tool === name);
    const hints = {
      map: "click a point, or drag the red point", path: "click two points for the shortest path between them",
      stroke: "draw a curve on the surface", decal: "choose an image; drag the red point to move it",
      coverage: "click a point for a tool path around it", whole: "draw a curve, to which the passes are parallel",
      isolines: "lines where a column of the input has a value"
    };
    this.element("tool_hint").textContent = hints[name];
    this.element("decal_options").hidden = name !== "decal";
    this.element("coverage_options").hidden = name !== "coverage";
    this.element("whole_options").hidden = name !== "whole";
    this.element("isolines_options").hidden = name !== "isolines";
    this.seed = null;
    this.stage.set_marks(this.stage.map || {});
    if (this.made_map) this.offer(this.stage.map.command, this.made_map);
    this.place_decal();
    if (name === "whole") this.ask_whole();
    if (name === "isolines") this.offer_levels();
    // Decals and coverage paths require a map that starts at a point.
    if ((name === "decal" || name === "coverage") && this.request && this.request.points) this.ask_map(this.source || this.request.points[0]);
    else if (name === "coverage") this.attempt(() => this.ask_coverage());
  }

  export_made() {
    return this.attempt(async () => {
      const { what, request } = this.made, format = this.element("format").value;
      const answer = await this.server.post("export", Object.assign({}, request, { what: what, format: format }));
      const link = document.createElement("a");
      link.href = URL.createObjectURL(await answer.blob());
      link.download = (what === "coverage" ? "path" : what) + "." + format;
      link.click();
      URL.revokeObjectURL(link.href);
      this.panel.say("saved " + link.download);
    });
  }

  async begin_live() {
    const info = await (await this.server.get("info")).json(), element = this.element;
    element("about").textContent = info.about;
    document.title = element("heading").textContent = this.stage.surface.title;
    const options = (id, words, usual) => {
      for (const word of words) element(id).add(new Option(word, word, word === usual, word === usual));
    };
    options("variant", info.variants, info.variant);
    this.formats = info.formats;
    this.columns = info.columns;
    options("isolines_column", info.columns.map((column) => column.name));
    element("isolines_column").addEventListener("change", () => this.offer_levels());
    element("isolines_every").addEventListener("change", () => this.ask_isolines());
    const surface = this.stage.surface;
    const covered = Math.min(0.4 * surface.scale, info.radius || Infinity);
    element("coverage_radius").value = Ahm.number(covered, 2);
    element("coverage_spacing").value = Ahm.number(0.1 * covered, 1);
    element("method").value = info.method;
    element("t_coef").value = info.t_coef;
    if (info.radius) element("radius").value = info.radius;
    for (const button of element("tool").children) button.addEventListener("click", () => this.set_tool(button.dataset.tool));
    element("method").querySelector("option:last-child").disabled = !info.has_faces;
    const method_changed = () => {
      for (const row of document.querySelectorAll(".heat")) row.hidden = element("method").value !== "heat";
      this.ask_again();
    };
    for (const id of ["method", "variant", "t_coef", "radius", "u_axis"]) element(id).addEventListener("change", method_changed);
    for (const id of ["coverage_radius", "coverage_spacing", "coverage_pattern"])
      element(id).addEventListener("change", () => this.attempt(() => this.ask_coverage()));
    for (const id of ["whole_spacing", "whole_pattern"]) element(id).addEventListener("change", () => this.ask_whole());
    element("whole_auto").addEventListener("click", () => { this.seed = null; this.ask_whole(); });
    for (const id of ["decal_size", "decal_turn"]) element(id).addEventListener("input", () => this.place_decal());
    element("decal_file").addEventListener("change", () => this.load_decal(element("decal_file").files[0]));
    element("export").addEventListener("click", () => this.export_made());
    this.set_tool("map");
    await this.ask_map(info.source || this.middle());
  }

  // The surface point at the center of the picture, or near it, as a source.
  middle() {
    const stage = this.stage, { width, height } = stage;
    for (let away = 0; away < 0.5; away += 0.05)
      for (let k = 0; k < 12; ++k) {
        const angle = k * Math.PI / 6, hit = stage.pick(width * (0.5 + away * Math.cos(angle)), height * (0.5 + away * Math.sin(angle)));
        if (hit) return hit.source;
      }
    return { row: stage.surface.points[0] };
  }
};

(async function () {
  const message = document.getElementById("message");
  try {
    let surface = Ahm.embedded("surface_data"), map = Ahm.embedded("map_data"), server = null;
    if (!surface) {
      server = new Ahm.Server();
      message.textContent = "loading …";
      surface = Ahm.decode(await (await server.get("surface")).arrayBuffer());
    }
    const viewer = window.ahm = new Ahm.Viewer(surface, server);
    message.textContent = "";
    viewer.panel.set_field("none");
    if (server) return await viewer.begin_live();
    document.getElementById("about").textContent = surface.rows.toLocaleString("en") + (surface.is_cloud ? " points" : " vertices");
    viewer.show(map, map.pattern);
  } catch (error) {
    document.getElementById("panel").hidden = !window.ahm;
    message.textContent = /WebGL/.test(error.message) ? "This page needs WebGL: " + error.message : error.message;
    throw error;
  }
})();
