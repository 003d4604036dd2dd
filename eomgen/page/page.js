// Formulas that stand alone are carried as LaTeX, which is copied; packed are their MathML, which is shown, the text that
// their buttons copy, and large pictures.
"use strict";
const apart = (async () => JSON.parse(new TextDecoder().decode(await unzipped(document.getElementById("apart").innerHTML))))();
for (const button of document.querySelectorAll(".formula [data-copy='']")) {
  button.dataset.copy = Array.from(button.closest(".formula").querySelectorAll(".tex:not(.narrow *)"), (tex) => tex.textContent).join("\n");
}
(async () => {
  const { formulas, pictures } = await apart;
  document.querySelectorAll(".tex").forEach((tex, k) => { tex.outerHTML = formulas[k]; });
  for (const picture of document.querySelectorAll("svg[data-drawn]")) picture.innerHTML = pictures[picture.dataset.drawn];
  document.documentElement.dataset.typeset = "yes";
  document.getElementById(location.hash.slice(1))?.scrollIntoView();
})();

// Formulas are copied as LaTeX, or as text that a model file reads.
for (const button of document.querySelectorAll("button[data-copy], button[data-copied]")) {
  button.addEventListener("click", async () => {
    const text = button.dataset.copy ?? (await apart).copied[button.dataset.copied];
    try {
      await navigator.clipboard.writeText(text);
    } catch {  // a page that was opened as a file, in a browser that is strict
      const area = document.createElement("textarea");
      area.value = text;
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    const word = button.textContent;
    button.textContent = document.body.dataset.copied;
    setTimeout(() => { button.textContent = word; }, 1000);
  });
}

/** The text of a table: its header, then a line a row; the player computes the columns that are not carried. */
async function linesOf(names, content) {
  const end = content.indexOf(10), told = JSON.parse(new TextDecoder().decode(content.subarray(0, end)));
  const carried = unpackedColumns(told, content.subarray(end + 1));
  const root = document.getElementById("motion-player");
  for (let k = 0; root && !root.player && k < 100; k++) await new Promise((go) => setTimeout(go, 50));
  const columns = names.map((name) => (told.names.includes(name) ? carried[told.names.indexOf(name)] : root.player.column(name)));
  const word = (v) => (Number.isFinite(v) ? String(+v.toPrecision(12)) : v !== v ? "nan" : v > 0 ? "inf" : "-inf");
  const quoted = (name) => (/[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name);
  const lines = Array.from(columns[0], (_, i) => columns.map((column) => word(column[i])).join(","));
  return `${[names.map(quoted).join(","), ...lines].join("\n")}\n`;
}

/** The bytes of gzip, base64. */
async function unzipped(packed) {
  const stream = new Blob([bytesOf(packed)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** A file of gzip, base64, that eomgen/page/packing.py wrote. */
async function fileOf(packed) {
  const read = await unzipped(packed);
  let at = 0;
  const next = () => { let v = 0, size = 1, byte; do { byte = read[at++]; v += (byte & 127) * size; size *= 128; } while (byte > 127); return v; };
  const length = next(), end = at + length, copies = [];
  while (at < end) copies.push([next(), next(), next()]);
  const found = new Uint8Array(read.length - end + copies.reduce((sum, copy) => sum + copy[2], 0));
  let to = 0, from = end;
  for (const [fresh, back, size] of copies) {
    found.set(read.subarray(from, from + fresh), to);
    from += fresh;
    to += fresh;
    for (let k = 0; k < size; k++, to++) found[to] = found[to - back];
  }
  found.set(read.subarray(from), to);
  return found;
}

// Files are packed inside the page; they are unpacked when they are asked for.
for (const link of document.querySelectorAll("a[data-name]")) {
  link.addEventListener("click", async (event) => {
    event.preventDefault();
    const { packed, columns, media, name } = link.dataset, content = await fileOf(packed);
    const whole = new Blob([columns ? await linesOf(JSON.parse(columns), content) : content], { type: media });
    const again = document.createElement("a");
    again.href = URL.createObjectURL(whole);
    again.download = name;
    again.click();
    setTimeout(() => URL.revokeObjectURL(again.href), 10000);
  });
}
