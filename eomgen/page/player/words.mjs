// What the page says by itself, in the language that it was told.

let words = {}, comma = false;

export function speak(told) { ({ words = {}, comma = false } = told); }

/** A number as the language writes it. */
export const decimal = text => (comma ? String(text).replace(/(\d)\.(?=\d)/g, "$1,") : String(text));

/** A sentence in the language, with values for its {1}, {2}. */
export const say = (text, ...values) => (words[text] ?? text).replace(/\{(\d)\}/g, (_, k) => decimal(values[k - 1]));
