// What the server tells, as it is kept in messages.json by `python -m tools.page_messages`: all of it is understood.

import { expect, test } from "vitest";
import { Conversation } from "../src/mind/conversation.ts";
import type { EventMessage, Hello, Message, RunEvent } from "../src/protocol.ts";
import { readMessage } from "../src/reading.ts";
import { Track } from "../src/track/track.ts";
import told from "./messages.json" with { type: "json" };

const read = told.map((message) => readMessage(message) as Message);
const events = read.filter((message): message is EventMessage => message.type === "event");
const event = <T extends RunEvent["type"]>(type: T): Extract<RunEvent, { type: T }>[] =>
  events.map(({ event }) => event).filter((e): e is Extract<RunEvent, { type: T }> => e.type === type);

test("every message is known by its name", () => {
  expect(read.map((message) => message?.type)).toEqual(told.map(({ type }) => type));
  expect(events.map((message) => message.event.type)).toEqual(told.flatMap((message) => message.event?.type ?? []));
});

test("a pose is read whole", () => {
  const [first, second] = read;
  expect(first).toMatchObject({
    body: [0.5, -1, 0.25],
    pelvis: [0, 0, 0.93],
    joints: [0, 0, 0, 1],
    eyes: [0.1, -0.2],
    held: 45,
    things: { 45: [1, 0, 0.8, 0, 0, 0, 1] },
    gone: [7],
    lights: [0.8, 0.4],
  });
  expect(second).toMatchObject({ held: null, things: {} });
});

test("nothing of an event that the page shows is lost", () => {
  expect(event("started")[0]).toMatchObject({ instruction: "Pick up the cup" });
  expect(event("observed")[0]).toMatchObject({
    step: 1,
    width_px: 1920,
    height_px: 1080,
    objects: [{ tag: "Cup_45", position: { x: 1, y: 0, z: 0.8 }, box: [10, 20, 40, 60], pixels: 500 }],
    points: [{ tag: "P0", position: { x: 1, y: 1, z: 0 }, pixel: [960, 800.5] }],
    held: "Cup_45",
  });
  expect(event("thought")[0]).toMatchObject({
    note: "A cup.",
    calls: [{ id: "call-1", name: "Pick", arguments: { object: "Cup_45" }, note: "A cup.", confidence: 0.9 }],
    tokens: [900, 40],
    usd: 0.01,
    seconds: 1.5,
    messages: 3,
    state_text: "Holding: nothing",
  });
  expect(event("acted")[0]).toMatchObject({ call_id: "call-1", outcome: "corrected", code: "cancelled", text: "Corrected: stopped." });
  expect(event("left_out")[0]).toMatchObject({ call_id: "call-2", name: "Walk", why: "the user spoke" });
  expect(event("shown")[0]).toMatchObject({ width_px: 640, height_px: 480 });
  expect(event("vetoed")[0]).toMatchObject({ why: "Not that one." });
  expect(event("ended")[0]).toMatchObject({ steps: 2, reason: "stopped", why: "the user stopped it" });
  const pictures = events.filter(({ frame }) => frame);
  expect(pictures.map((message) => message.event.type)).toEqual(["observed", "shown"]);
});

test("status, questions and notices are read whole", () => {
  const [status, asked, notice] = read.slice(-3);
  expect(status).toMatchObject({ doing: "thinking", speed: 2, can_undo: true, spent: { input_tokens: 900, output_tokens: 40, usd: 0.01 } });
  expect(asked).toMatchObject({ note: "A cup.", calls: [{ name: "Pick", arguments: { object: "Cup_45" } }] });
  expect(notice).toMatchObject({ text: "Something is odd.", level: "warning" });
});

test("what people did, and what was lost, is told in words", () => {
  const hello = readMessage({ type: "hello", scene: { objects: [{ id: 45, tag: "Cup_45" }] } }) as Hello;
  const story = new Conversation(hello.scene);
  for (const message of events) story.add(message);
  const notes = story.items.flatMap((item) => (item.kind === "note" ? [item.text] : []));
  expect(notes).toEqual([
    "You objected: Not that one.",
    "You moved Cup 45",
    "Somebody took Cup 45 out of the room",
    "Somebody brought Cup 45 in",
    "Somebody changed a light",
    "Everything is back as it was before the last instruction",
    "An answer never came, and was asked for again",
    "Stopped by you: the user stopped it",
  ]);
});

test("a room gets darker where its lights are dimmed, and is as at first again", () => {
  const hello = readMessage({ type: "hello", joints: ["hips"], scene: {} }) as Hello;
  const track = new Track(hello);
  const bright = [[0.8, 0.4], [0.2, 0.4], [0.8, 0.4]];
  bright.forEach((lights, at) => track.add(readMessage({ ...told[0], n: at + 1, t: at, lights }) as Message));
  expect([0, 1, 2].map((t) => track.at(t)?.lights.toFixed(2))).toEqual(["1.00", "0.50", "1.00"]);
});
