import { expect, test } from "vitest";
import { readMessage } from "../src/reading.ts";

const HOSTILE: unknown[] = [
  null,
  7,
  "pose",
  [],
  {},
  { type: "nothing" },
  { type: "pose" },
  { type: "pose", body: "x", joints: {}, things: [1], gone: "all" },
  { type: "event" },
  { type: "event", event: { type: "observed", objects: 3, points: null, agent: [] } },
  { type: "event", event: { type: "thought", turn: { wishes: [null, { call: 5 }], reply: "no" } } },
  { type: "event", event: { type: "acted", feedback: null, arguments: "x" } },
  { type: "hello", scene: null, joints: 4, settings: "no" },
  { type: "status", doing: "__proto__", spent: [] },
  { type: "asked", calls: [null, "x"] },
  { type: "notice", text: { html: "<b>" }, level: "loud" },
];

test.each(HOSTILE)("what is wrong becomes empty and throws nothing: %j", (told) => {
  const message = readMessage(told);
  if (message) expect(Number.isFinite(message.t)).toBe(true);
});

test("a thought's note comes from the message, or else from its calls", () => {
  const turn = (text: string): unknown => ({
    type: "event",
    event: {
      type: "thought",
      step: 1,
      turn: {
        reply: { message: { text }, usage: { input_tokens: 5, output_tokens: 2 }, cost_usd: 0.01 },
        wishes: [{ call: { id: "a", name: "Pick" }, arguments: { object: "Cup_45" }, note: "A cup." }],
      },
    },
  });
  expect(readMessage(turn("Seen."))).toMatchObject({ event: { note: "Seen.", tokens: [5, 2], usd: 0.01 } });
  expect(readMessage(turn(""))).toMatchObject({ event: { note: "A cup.", calls: [{ id: "a", name: "Pick" }] } });
});

test("numbers that are none do not reach the picture", () => {
  const read = readMessage({ type: "pose", n: 1, t: 0, body: [NaN, "1", null], things: { "1": [1, 2] } });
  expect(read).toMatchObject({ body: [0, 0, 0], things: {} });
});
