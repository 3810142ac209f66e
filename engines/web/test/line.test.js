import assert from "node:assert/strict";
import { test } from "node:test";
import { answered } from "../src/line.js";
import { FRAME, PageEngine, WIRE } from "../src/engine.js";

const asked = (method, params = {}) => JSON.stringify({ jsonrpc: "2.0", id: 7, method, params });
const engine = () => new PageEngine(null, async () => { throw new Error("scene x is not here."); });

test("an answer brings its binary messages after it", async () => {
  const two = { answer: async () => ({ result: { layers: 1 }, pictures: [1, 2] }) };
  const [text, ...pictures] = await answered(two, asked("capture"));
  assert.deepEqual(JSON.parse(text), { jsonrpc: "2.0", id: 7, result: { layers: 1 }, attachments: 2 });
  assert.deepEqual(pictures, [1, 2]);
});

test("a mistake is told, and the page lives on", async () => {
  for (const [message, why] of [
    ["no json", /JSON/], [asked("dance"), /no method dance/], [asked("state"), /ask for a scene first/],
    [asked("scene", { scene: "x" }), /scene x is not here/], [asked("constructor"), /no method/],
  ]) {
    const [text] = await answered(engine(), message);
    assert.match(JSON.parse(text).error.message, why);
  }
});

test("the hello names what cannot be done", () => {
  const hello = engine().hello("Page 1");
  assert.deepEqual([hello.wire, hello.frame], [WIRE, FRAME]);
  assert.equal(hello.abilities.events, false);
});
