// Held against the answers in test_vectors.json: node --test
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { rhs } from "./cart_pole_rhs.mjs";

const expected = JSON.parse(readFileSync(new URL("test_vectors.json", import.meta.url), "utf8"));

test("cart_pole_rhs gives the values of its test vectors", () => {
    for (const [place, v] of expected.vectors.entries()) {
        const found = rhs(v.t, v.x, v.p, v.inputs);
        assert.equal(found.length, v.dx.length);
        const largest = Math.max(1, ...v.dx.map(Math.abs));
        v.dx.forEach((right, k) => assert.ok(
            right === null ? Number.isNaN(found[k]) : Math.abs(found[k] - right) <= v.tolerance*largest,
            `vector ${place}: dx[${k}] is ${found[k]}, not ${right}`,
        ));
    }
});
