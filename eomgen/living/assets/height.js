// Tells the page around this one how high it is, and where its sliders stand; takes what stood there before a save.
new ResizeObserver(() => parent.postMessage({ height: document.body.offsetHeight }, "*")).observe(document.body);
(() => {
  const player = document.querySelector(".eomgen-player")?.player;
  if (!player?.told.moves) return;
  const values = Object.fromEntries(player.told.sliders.map((each) => [each.name, each.value]));
  const tell = () => parent.postMessage({ values, given: player.given, t: player.t }, "*");
  addEventListener("message", (event) => {
    if (event.source !== parent || !event.data?.given) return;
    for (const [name, value] of Object.entries(event.data.given)) if (name in values) player.set(name, value);
    player.seek(event.data.t);
    tell();
  });
  for (const kind of ["change", "click", "pointerup"]) addEventListener(kind, () => setTimeout(tell, 50));
  tell();
})();
