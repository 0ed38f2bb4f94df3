
"use strict";
// Values under the pointer, histories, sorting. Everything else works without.
for (const maps of document.querySelectorAll(".maps")) {
  const [width, height] = maps.dataset.size.split(",").map(Number);
  const stage = maps.querySelector(".stage"), value = maps.querySelector(".value");
  const tables = [];
  for (const image of stage.querySelectorAll("img[data-values]")) {
    const numbers = new Image();
    numbers.onload = () => {
      const canvas = document.createElement("canvas");
      canvas.width = width; canvas.height = height;
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(numbers, 0, 0);
      tables.push({ name: image.dataset.name, pixels: context.getImageData(0, 0, width, height).data });
      maps.dataset.ready = tables.length;
    };
    numbers.src = image.dataset.values;
  }
  const place = (event) => {
    const box = stage.getBoundingClientRect();
    const at = (v, from, size, count) => Math.min(count - 1, Math.max(0, Math.floor((v - from) / size * count)));
    return [at(event.clientX, box.left, box.width, width), at(event.clientY, box.top, box.height, height)];
  };
  const read = ([x, y]) => {
    const order = ["overdraw", "stencil operations", "HiZ kills", "bytes"];
    const i = 4 * (y * width + x);
    const known = [...tables].sort((a, b) => order.indexOf(a.name) - order.indexOf(b.name));
    return known.map((t) => t.name + " " + (t.pixels[i] * 65536 + t.pixels[i + 1] * 256 + t.pixels[i + 2]));
  };
  stage.addEventListener("pointermove", (event) => {
    const at = place(event);
    value.textContent = "pixel " + at.join(", ") + ": " + read(at).join(", ");
  });
  stage.addEventListener("click", (event) => {
    if (event.target.closest(".mark")) return;
    const at = place(event);
    const id = "s" + maps.dataset.section + "p" + at.join("-");
    if (document.getElementById(id)) { location.hash = id; return; }
    const command = maps.dataset.command + " --pixel " + at.join(",");
    const code = document.createElement("code");
    code.textContent = command;
    const copy = document.createElement("button");
    copy.textContent = "Copy";
    copy.onclick = () => navigator.clipboard?.writeText(command);
    value.replaceChildren("pixel " + at.join(", ") + ": its history is shown by ", code, " ", copy);
  });
}
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
  const number = (text) => text !== "" && isFinite(text);
  heads.forEach((head, column) => {
    const cells = [...body.rows].map((row) => row.cells[column]);
    if (cells.some((c) => c && c.textContent !== "" && !number(c.textContent))) {
      [head, ...cells].forEach((c) => c && c.classList.add("text"));
    }
    const button = document.createElement("button");
    button.textContent = head.textContent;
    head.replaceChildren(button);
    button.onclick = () => {
      const down = head.getAttribute("aria-sort") !== "descending";
      heads.forEach((h) => h.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const key = (row) => row.cells[column].textContent;
      const order = (a, b) => number(key(a)) && number(key(b)) ? key(a) - key(b) : key(a).localeCompare(key(b));
      body.append(...[...body.rows].sort((a, b) => down ? order(b, a) : order(a, b)));
    };
  });
}
