import { expect, test } from "vitest";
import { Conversation, isQuestion, type TurnItem } from "../src/mind/conversation.ts";
import { memoryWords } from "../src/mind/memory.ts";
import { callCode, callWords, clock, spentWords, spoken } from "../src/mind/words.ts";
import type { EventMessage, Hello, RunEvent } from "../src/protocol.ts";
import { readMessage } from "../src/reading.ts";

const told = (t: number, event: object, frame = ""): EventMessage =>
  readMessage({ type: "event", n: 1, t, event, frame }) as EventMessage;

const thought = (t: number, text: string, calls: object[]): EventMessage =>
  told(t, { type: "thought", step: 1, turn: { reply: { message: { text }, usage: {} }, wishes: calls } });

const scene = (readMessage({
  type: "hello",
  scene: {
    furniture: [{ name: "dining table", center: [0, -3, 0.39], size: [1, 2, 0.78] }],
    objects: [{ id: 4, tag: "Cup_4" }],
  },
}) as Hello).scene;

test("a call is settled by the feedback on it", () => {
  const story = new Conversation(scene);
  story.add(told(0, { type: "started", instruction: "Take the cup" }));
  story.add(told(0.1, { type: "observed", step: 0, objects: [] }, "a.jpg"));
  story.add(thought(1, "There it is.", [{ call: { id: "c1", name: "Pick" }, arguments: { object: "Cup_45" } }]));
  story.add(told(3, { type: "acted", call_id: "c1", name: "Pick", feedback: { outcome: "done", code: "ok", text: "Done." } }));
  story.add(told(4, { type: "ended", reason: "answered", answer: "I have it." }));
  expect(story.items.map((item) => item.kind)).toEqual(["said", "turn", "answer"]);
  const turn = story.items[1] as TurnItem;
  expect(turn.deeds).toMatchObject([{ outcome: "done", text: "Done." }]);
  expect(turn.seen?.frame).toBe("a.jpg");
});

test("a call that nobody asked for is shown too, and one that was left out", () => {
  const story = new Conversation(scene);
  story.add(thought(1, "", [{ call: { id: "c1", name: "Walk" }, arguments: {} }]));
  story.add(told(2, { type: "left_out", call_id: "c1", name: "Walk", why: "One call a turn." }));
  story.add(told(2, { type: "acted", call_id: "x", name: "Look", arguments: {}, feedback: { outcome: "refused" } }));
  expect((story.items[0] as TurnItem).deeds.map((deed) => deed.outcome)).toEqual(["left_out", "refused"]);
});

test("an answer that asks is a question", () => {
  const story = new Conversation(scene);
  story.add(told(1, { type: "ended", reason: "answered", answer: "Which cup do you mean?" }));
  expect(story.items[0]?.kind).toBe("question");
  expect(isQuestion("Done.")).toBe(false);
});

test("what the user did is in the story", () => {
  const story = new Conversation(scene);
  const events: object[] = [
    { type: "happened", event: { type: "object_moved", object_id: 4 }, by_user: true },
    { type: "happened", event: { type: "object_taken", object_id: 5 } },
    { type: "vetoed", why: "not that one" },
    { type: "restored" },
    { type: "ended", reason: "stopped", answer: "", why: "the user stopped it" },
  ];
  for (const event of events) story.add(told(1, event));
  expect(story.items.map((item) => item.kind === "turn" || item.text)).toEqual([
    "You moved Cup 4",
    "Somebody took something out of the room",
    "You objected: not that one",
    "Everything is back as it was before the last instruction",
    "Stopped by you: the user stopped it",
  ]);
});

test("unknown events change nothing", () => {
  const story = new Conversation(scene);
  story.add(told(1, { type: "stood" } as unknown as RunEvent));
  expect(story.items).toEqual([]);
});

test("calls in words", () => {
  expect(callWords("Pick", { object: "PeanutButter_8" }, scene)).toBe("Pick up Peanut Butter 8");
  expect(callWords("Drop", { object: "Cup_45", x: 0.1, y: -3, z: 0.8 }, scene)).toBe("Put Cup 45 down on the dining table");
  expect(callWords("Drop", { object: "Cup_45", x: 2, y: 2, z: 0 }, scene)).toBe("Put Cup 45 down on the floor");
  expect(callCode("Walk", { x: 1, y: -0.001, z: 0 })).toBe("Walk(1.00, 0.00, 0.00)");
  expect(spoken("22")).toBe("22");
});

test("what is not known is not shown as nothing", () => {
  expect(spentWords([1200, 30], null)).toBe("1,200 tokens in, 30 out");
  expect(spentWords([1200, 30], 0.5)).toBe("1,200 tokens in, 30 out, $0.50");
  expect(clock(75.9)).toBe("1:15");
});

test("a turn keeps the state that was read, and says how far back she remembers", () => {
  const story = new Conversation(scene);
  story.add(told(1, { type: "thought", step: 1, messages: 5, state_text: "# State", turn: { reply: { message: { text: "" }, usage: {} }, wishes: [] } }));
  const turn = story.items[0] as TurnItem;
  expect(turn.state).toBe("# State");
  expect(memoryWords(turn, 50)).toBe("She read 5 messages. At most the last 50 steps are kept.");
  expect(memoryWords(null, 50)).toBe("She has not thought yet.");
});
