// The page follows the file: each entry of the state is shown when it comes. What is not there yet stays as it was, paler.
"use strict";
const token = new URLSearchParams(location.search).get("token") ?? "";
const at = (path, more = "") => `${path}?token=${encodeURIComponent(token)}${more}`;
const place = (id) => document.getElementById(id);
const made = (name, text = "", more = {}) => Object.assign(document.createElement(name), { textContent: text, ...more });
const state = {};
const PARTS = ["figure", "degrees_of_freedom", "equations", "answers", "motion", "reactions", "certificate"];

/** The box of a part below its heading. */
const inside = (part) => place(part).querySelector("div") ?? place(part);

function remark(part, words) {
  inside(part).replaceChildren(made("p", words, { className: "remark" }));
}

const shown = {
  figure(svg) { place("figure").innerHTML = svg; },
  degrees_of_freedom(count) {
    const words = count === 1 ? " degree of freedom" : " degrees of freedom";
    place("degrees_of_freedom").replaceChildren(made("b", String(count)), words);
  },
  equations(found) {
    if (found.remark) { place("equations").hidden = true; return; }
    const open = inside("equations").querySelector("details")?.open ?? false;
    inside("equations").innerHTML = found.html;
    inside("equations").querySelector("h3")?.remove();  // the section has it
    const steps = made("details", "", { open });
    steps.append(made("summary", "How they are found"));
    steps.insertAdjacentHTML("beforeend", found.derivation);
    inside("equations").append(steps);
  },
  answers(found) {
    place("answers").hidden = !found.html;
    inside("answers").innerHTML = found.html;
  },
  motion(found) {
    place("motion").hidden = !found.digest;
    if (!found.digest) return;
    let frame = inside("motion").querySelector("iframe");
    if (!frame) {
      frame = made("iframe", "", { title: "Motion" });
      frame.setAttribute("sandbox", "allow-scripts");
      inside("motion").replaceChildren(frame, made("p", "", { className: "remark" }));
    }
    if (frame.dataset.page !== found.digest) {
      frame.dataset.page = found.digest;
      frame.src = at("/motion", `&page=${found.digest}`);
    }
    inside("motion").querySelector("p").textContent = found.remark;
  },
  reactions(found) { inside("reactions").innerHTML = found.html; },
  certificate(found) { place("certificate").textContent = found.text; },
};

/** The parts: what is there, what is being made, and why one is not there. */
function showParts(changed) {
  for (const part of PARTS) {
    const section = place(part), value = state[part], why = state.why?.[part];
    if (value !== null && value !== undefined) {
      if (part in changed) {
        section.hidden = false;
        shown[part](value);
      }
      section.classList.toggle("old", !state.good || Boolean(why));
    } else if (why) {
      section.classList.remove("old");
      section.hidden = part === "answers" || part === "degrees_of_freedom";
      if (part === "certificate") section.textContent = ""; else if (part !== "figure") remark(part, `Not here: ${why}.`);
    } else {
      section.classList.add("old");
    }
  }
}

function showProblems() {
  const problems = state.problems.length ? state.problems : state.warnings, list = made("ol");
  for (const problem of problems) {
    const item = made("li"), head = problem.line ? `line ${problem.line}` : problem.where;
    if (head) {
      const button = problem.line && editor;
      const where = made(button ? "button" : "p", head, { className: "where" });
      if (button) { where.type = "button"; where.addEventListener("click", () => editor.go(problem.line, problem.column)); }
      item.append(where);
    }
    item.append(made("div", problem.what));
    if (problem.excerpt) item.append(made("pre", problem.excerpt));
    if (problem.fix) item.append(made("div", `fix: ${problem.fix}`, { className: "fix" }));
    list.append(item);
  }
  place("problems").hidden = !problems.length;
  place("problems").classList.toggle("mild", !state.problems.length);
  place("problems").replaceChildren(list);
  editor?.mark(state.problems, state.warnings);
}

function showStatus() {
  const [kind, words] = !state.good ? ["broken", "not a model yet: the last picture stays"]
    : state.working ? ["works", "working"]
    : state.problems.length ? ["broken", "something is wrong"] : ["there", "up to date"];
  place("status").dataset.state = kind;
  place("status").textContent = words;
  place("name").textContent = state.name || state.file;
  document.title = state.name || state.file;
  document.body.dataset.revision = state.working ? "" : state.revision;
}

const events = new EventSource(at("/events"));
events.onmessage = (event) => {
  const changed = JSON.parse(event.data), known = "revision" in state;
  Object.assign(state, changed);
  if (!known && state.editable) writing();
  if ("problems" in changed || "warnings" in changed) showProblems();
  showParts(changed);
  showStatus();
  if ("revision" in changed) following?.();
};
events.onerror = () => {
  place("status").dataset.state = "away";
  place("status").textContent = "eomgen has ended, or cannot be reached";
};

// The page of the motion says how high it is, and where its sliders stand: a new one begins where the last one was, but
// for values that the file has changed meanwhile.
let held = { page: "", values: {}, given: {}, t: 0 };
addEventListener("message", (event) => {
  const frame = document.querySelector("#motion iframe"), { height, values, given, t } = event.data ?? {};
  if (!frame || event.source !== frame.contentWindow) return;
  if (Number(height) > 0) frame.style.height = `${Math.min(Number(height), 2400) + 4}px`;
  if (!values) return;
  if (held.page !== frame.dataset.page) {
    const kept = Object.fromEntries(Object.entries(held.given).filter(([name]) => values[name] === held.values[name]));
    if (Object.keys(kept).length || held.t) frame.contentWindow.postMessage({ given: kept, t: held.t }, "*");
    held = { page: frame.dataset.page, values, given: kept, t: held.t };
  } else held = { page: held.page, values, given, t };
});

// Formulas are copied as LaTeX, or as text that a model file reads.
document.addEventListener("click", async (event) => {
  const button = event.target.closest("button[data-copy]");
  if (!button) return;
  const tex = [...button.closest(".formula").querySelectorAll("annotation")].map((each) => each.textContent).join("\n");
  await navigator.clipboard.writeText(button.dataset.copy || tex);
  const word = button.textContent;
  button.textContent = "copied";
  setTimeout(() => { button.textContent = word; }, 1000);
});

// -- writing: a pane with the file, which is saved when one says so, and never over what somebody else wrote --------

let editor = null, following = null;

/** A plain text area, where the editor is not there. */
function plainEditor(parent, changed) {
  const area = made("textarea", "", { spellcheck: false });
  area.setAttribute("aria-label", "The model");
  parent.append(area);
  area.addEventListener("input", changed);
  return {
    text: () => area.value,
    set: (text) => { area.value = text; },
    mark: () => {},
    go: (line) => {
      const start = area.value.split("\n").slice(0, line - 1).join("\n").length + (line > 1);
      area.focus();
      area.setSelectionRange(start, start);
    },
  };
}

async function writing() {
  const note = (words, bad = false) => { place("note").textContent = words; place("note").classList.toggle("bad", bad); };
  let read = { text: "", sha256: "" };
  const isOpen = () => editor.text() !== read.text;
  const looked = () => { place("save").disabled = !isOpen(); if (isOpen()) note("not saved"); else note(""); };
  const meanwhile = (there) => { for (const id of ["reload", "overwrite"]) place(id).hidden = !there; };
  const taken = async () => (await fetch(at("/model"))).json();

  async function save() {
    const text = editor.text();
    const body = JSON.stringify({ text, sha256: read.sha256 });
    const answer = await fetch(at("/model"), { method: "POST", headers: { "Content-Type": "application/json" }, body });
    const told = await answer.json();
    if (answer.ok) { read = { text, sha256: told.sha256 }; meanwhile(false); looked(); note("saved"); return; }
    meanwhile(answer.status === 409);
    note(told.what, true);
  }

  place("writing").hidden = false;
  document.body.classList.add("edits");
  const make = window.eomgenEditor ?? plainEditor;
  const offers = async (text, offset) => {
    const body = JSON.stringify({ text, offset });
    const answer = await fetch(at("/offers"), { method: "POST", headers: { "Content-Type": "application/json" }, body });
    return answer.ok ? (await answer.json()).offers : [];
  };
  editor = make(place("editor"), looked, save, document.querySelector("script[nonce]").nonce, offers);
  read = await taken();
  editor.set(read.text);
  looked();
  showProblems();
  place("save").addEventListener("click", save);
  place("reload").addEventListener("click", async () => { read = await taken(); editor.set(read.text); meanwhile(false); looked(); });
  place("overwrite").addEventListener("click", async () => { read = { ...(await taken()), text: "" }; await save(); });
  following = async () => {
    const now = await taken();
    if (now.sha256 === read.sha256) return;
    if (isOpen()) { meanwhile(true); note("the file changed meanwhile", true); return; }
    read = now;
    editor.set(read.text);
    looked();
  };
  document.addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key === "s" && !event.defaultPrevented) { event.preventDefault(); save(); }
  });
  addEventListener("beforeunload", (event) => { if (isOpen()) event.preventDefault(); });
  const list = place("examples");
  for (const name of (await (await fetch(at("/examples"))).json()).examples) list.append(made("option", name, { value: name }));
  list.addEventListener("change", async () => {
    if (!list.value || (isOpen() && !confirm("What is not saved is lost. Go on?"))) { list.value = ""; return; }
    editor.set((await (await fetch(at("/examples", `&name=${encodeURIComponent(list.value)}`))).json()).text);
    list.value = "";
    looked();
  });
}
