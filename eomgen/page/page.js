// Formulas are copied as LaTeX, or as text that a model file reads.
"use strict";
for (const button of document.querySelectorAll("button[data-copy]")) {
  button.addEventListener("click", async () => {
    const text = button.dataset.copy;
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
    button.textContent = "copied";
    setTimeout(() => { button.textContent = word; }, 1000);
  });
}

// Files are packed inside the page; they are unpacked when they are asked for.
for (const link of document.querySelectorAll("a[data-name]")) {
  link.addEventListener("click", async (event) => {
    if (typeof DecompressionStream === "undefined") return;  // then the packed file is what there is
    event.preventDefault();
    const bytes = Uint8Array.from(atob(link.href.split(",")[1]), (c) => c.charCodeAt(0));
    const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    const whole = await new Response(plain, { headers: { "Content-Type": link.dataset.media } }).blob();
    const again = document.createElement("a");
    again.href = URL.createObjectURL(whole);
    again.download = link.dataset.name;
    again.click();
    setTimeout(() => URL.revokeObjectURL(again.href), 10000);
  });
}
