// Held against the answers in test_vectors.json: node --test
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { reactions } from "./double_pendulum_reactions.mjs";

const expected = JSON.parse(readFileSync(new URL("test_vectors.json", import.meta.url), "utf8"));

test("double_pendulum_reactions gives the values of its test vectors", () => {
    for (const [place, v] of expected["reactions"].vectors.entries()) {
        const found = reactions(v.t, v.x, v.p, v.inputs);
        assert.equal(found.length, v.out.length);
        const largest = Math.max(1, ...v.out.map(Math.abs));
        v.out.forEach((right, k) => assert.ok(
            right === null ? Number.isNaN(found[k]) : Math.abs(found[k] - right) <= v.tolerance*largest,
            `vector ${place}: out[${k}] is ${found[k]}, not ${right}`,
        ));
    }
});
