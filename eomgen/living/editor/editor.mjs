// The editor of the page: CodeMirror 6, the parts that a model file needs. Built into editor.js by `npm run build`.

import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { bracketMatching, HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";

const look = EditorView.theme({
    "&": { color: "var(--ink)", backgroundColor: "var(--paper)" },
    ".cm-scroller": { fontFamily: "ui-monospace, Menlo, Consolas, 'DejaVu Sans Mono', monospace", lineHeight: "1.5" },
    ".cm-content": { caretColor: "var(--ink)" },
    ".cm-cursor": { borderLeftColor: "var(--ink)" },
    ".cm-gutters": { backgroundColor: "var(--paper)", color: "var(--soft)", border: "0" },
    ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "var(--mark)" },
    "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "color-mix(in srgb, var(--link) 28%, transparent)" },
    ".cm-tooltip, .cm-panels": { backgroundColor: "var(--card)", color: "var(--ink)", borderColor: "var(--line)" },
    ".cm-tooltip-autocomplete > ul > li[aria-selected]": { backgroundColor: "var(--link)", color: "var(--paper)" },
});
const colours = HighlightStyle.define([
    { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
    { tag: tags.string, color: "var(--c2)" },
    { tag: tags.number, color: "var(--c4)" },
    { tag: [tags.propertyName, tags.atom], color: "var(--c0)" },
    { tag: [tags.bracket, tags.meta], color: "var(--c3)" },
]);

const TYPES = { table: "namespace", kind: "class", field: "property", name: "variable", function: "function", word: "constant" };

/** What `offers(text, offset)` gives for the place before the cursor; the offset counts characters. */
const completed = offers => async context => {
    const word = context.matchBefore(/[A-Za-z_][\w.]*'*/), before = context.matchBefore(/["[.=]\s?/);
    if (!word && !before && !context.explicit) return null;
    const text = context.state.doc.toString(), offset = Array.from(text.slice(0, context.pos)).length;
    const found = await offers(text, offset);
    const options = found.map(each => ({ label: each.label, type: TYPES[each.kind], detail: each.detail, info: each.about || undefined, apply: each.insert || each.label }));
    return options.length ? { from: word ? word.from : context.pos, options, validFor: /^[\w.]*'*$/ } : null;
};

/** An editor below `parent`: what `live.js` needs of it. */
window.eomgenEditor = (parent, changed, save, nonce, offers) => {
    const quiet = { now: false };
    const view = new EditorView({
        parent,
        state: EditorState.create({
            extensions: [
                EditorView.cspNonce.of(nonce), lineNumbers(), lintGutter(), history(), drawSelection(), bracketMatching(), closeBrackets(),
                highlightActiveLine(), highlightSelectionMatches(), StreamLanguage.define(toml), syntaxHighlighting(colours), look,
                autocompletion({ override: [completed(offers)] }),
                keymap.of([
                    { key: "Mod-s", preventDefault: true, run: () => { save(); return true; } },
                    ...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap,
                ]),
                EditorView.contentAttributes.of({ "aria-label": "The model", tabindex: "0" }),
                EditorView.updateListener.of(update => { if (update.docChanged && !quiet.now) changed(); }),
            ],
        }),
    });
    const place = (line, column) => {
        const { doc } = view.state, row = doc.line(Math.min(Math.max(line ?? 1, 1), doc.lines));
        const before = Array.from(row.text).slice(0, Math.max((column ?? 1) - 1, 0)).join("");  // columns count characters
        return Math.min(row.from + before.length, row.to);
    };
    const marked = severity => problem => {
        const from = place(problem.line, problem.column), width = /\^+/.exec(problem.excerpt ?? "")?.[0].length ?? 1;
        const to = Math.min(from + width, view.state.doc.lineAt(from).to);
        return { from, to, severity, message: problem.fix ? `${problem.what}\nfix: ${problem.fix}` : problem.what };
    };
    return {
        view,
        text: () => view.state.doc.toString(),
        set(text) {
            quiet.now = true;
            view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
            quiet.now = false;
        },
        mark(problems, warnings) {
            const here = list => list.filter(problem => problem.line);
            const found = [...here(problems).map(marked("error")), ...here(warnings).map(marked("warning"))];
            view.dispatch(setDiagnostics(view.state, found.sort((a, b) => a.from - b.from)));
        },
        go(line, column) {
            const at = place(line, column);
            view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
            view.focus();
        },
    };
};
