"use strict";
// The panel next to the picture: what the picture shows, and the values under the pointer. Uses the stage, but no server.
Ahm.Panel = class {
  constructor(stage) {
    this.stage = stage;
    this.element = (id) => document.getElementById(id);
    this.length_of = (x) => x * stage.surface.scale;
    const element = this.element;
    element("field").addEventListener("change", () => this.set_field(element("field").value));
    element("ring").addEventListener("input", () => this.set_ring());
    element("hatch").addEventListener("change", () => this.set_hatch());
    element("reset").addEventListener("click", () => stage.reset());
    element("copy_spec").addEventListener("click", () => this.copy("spec"));
    element("copy_command").addEventListener("click", () => this.copy("command"));
    this.set_dark(window.matchMedia("(prefers-color-scheme: dark)").matches);
  }

  set_dark(is_dark) {
    document.documentElement.classList.toggle("dark", is_dark);
    this.stage.set_dark(is_dark);
  }

  // Enables the fields that the data supports. Selects the first one if the current field is disabled.
  offer_fields() {
    const { map, surface } = this.stage, select = this.element("field");
    const has = {
      polar: map && map.uv && map.pattern !== "cells", grid: map && map.uv && map.pattern !== "cells",
      cells: map && map.pattern === "cells", distance: map && (map.distance || map.uv), spread: map && map.spread,
      quality: map && map.quality, normals: true, colors: !!surface.colors, none: true
    };
    for (const option of select.options) option.hidden = option.disabled = !has[option.value];
    if (!has[select.value]) select.value = Array.from(select.options).find((o) => !o.disabled).value;
    return has;
  }

  // @param wanted  the new field; null: keep the current field
  show_map(map, wanted) {
    const stage = this.stage;
    stage.map = map;
    if (wanted) this.element("field").value = wanted;
    this.offer_fields();
    stage.field = this.element("field").value;
    if (!this.base_ring || wanted) this.base_ring = map.ring_width, this.element("ring").value = 0;
    stage.set_map(map);
    this.element("spec").textContent = map.spec || "";
    this.element("source_section").hidden = !map.spec;
    this.set_ring();
    this.show_values(this.hit);
  }

  set_field(name) {
    this.element("field").value = name;
    this.offer_fields();
    this.stage.set_field(this.element("field").value);
    this.set_ring();
  }

  next_field() {
    const select = this.element("field"), n = select.options.length;
    let k = select.selectedIndex;
    do k = (k + 1) % n; while (select.options[k].disabled);
    this.set_field(select.options[k].value);
  }

  set_ring() {
    const stage = this.stage, width = (this.base_ring || 1) * Math.pow(2, Number(this.element("ring").value));
    stage.set_ring(width);
    this.element("ring_name").textContent = stage.field === "grid" ? "square width" : "ring width";
    this.element("ring_text").textContent = Ahm.number(this.length_of(width), 3);
    for (const id of ["axis_u", "axis_v"]) this.element(id).style.display = stage.has_wheel() ? "" : "none";
    this.label_bar(width);
  }

  set_hatch() {
    this.stage.uniforms.hatch.value = this.element("hatch").checked ? 1 : 0;
    this.stage.redraw();
  }

  // Labels the color bar with about six numbers, at its lines.
  label_bar(width) {
    const numbers = this.element("bar"), stage = this.stage;
    numbers.textContent = "";
    if (!stage.has_bar()) return;
    const largest = stage.uniforms.largest_value.value, is_share = stage.field === "quality";
    let step = stage.field === "distance" ? width : largest / 5;
    step *= Math.max(1, Math.ceil(largest / step / 6));
    for (let x = 0; x <= largest * (1 + 1e-6); x += step) {
      const label = document.createElement("div");
      label.textContent = Ahm.number(is_share ? x : this.length_of(x), 3);
      label.style.bottom = Ahm.bar.bottom + Ahm.bar.height * x / largest + "px";
      label.style.left = Ahm.bar.left + Ahm.bar.width + "px";
      numbers.appendChild(label);
    }
  }

  // Displays the values of a row. @param hit  the point under the pointer; null: none
  show_values(hit) {
    this.hit = hit;
    const { map, surface } = this.stage, put = (id, ...numbers) => this.put(this.element("at_" + id), numbers);
    const names = ["row", "status", "position", "u", "v", "distance", "spread"];
    if (!hit) return names.forEach((name) => put(name, "–"));
    const k = hit.vertex, row = hit.row, p = surface.positions;
    const of = (array, index) => (map && map[array] ? this.length_of(map[array][index]) : "–");
    put("row", String(row));
    put("position", ...[0, 1, 2].map((c) => surface.center[c] + surface.scale * p[3 * k + c]));
    put("status", map && map.status ? Ahm.statuses[map.status[row]] : "–");
    put("u", map && map.pattern !== "cells" ? of("uv", 2 * row) : "–");
    put("v", map && map.pattern !== "cells" ? of("uv", 2 * row + 1) : "–");
    put("distance", of("distance", row));
    put("spread", of("spread", row));
  }

  // Sets the text of an element: strings unchanged, numbers with up to six digits if they fit. The tooltip shows nine digits.
  put(element, values) {
    const text = (digits) => values.map((x) => typeof x === "string" ? x : Ahm.number(x, digits)).join(" ");
    element.title = text(9);
    for (let digits = 6; digits >= 2; --digits) {
      element.textContent = text(digits);
      if (element.scrollWidth <= element.clientWidth) break;
    }
  }

  async copy(id) {
    const text = this.element(id).textContent;
    try {
      await navigator.clipboard.writeText(text);
      this.say("copied");
    } catch (error) {
      const selection = window.getSelection();
      selection.selectAllChildren(this.element(id));
      this.say(document.execCommand("copy") ? "copied" : "press Ctrl+C to copy");
    }
  }

  say(text, is_error) {
    const status = this.element("status");
    status.textContent = text || "";
    status.classList.toggle("error", !!is_error);
  }
};
