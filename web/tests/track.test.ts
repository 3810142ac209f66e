import { expect, test } from "vitest";
import type { Hello, Message, Placed } from "../src/protocol.ts";
import { readMessage } from "../src/reading.ts";
import { Player } from "../src/track/player.ts";
import { Track } from "../src/track/track.ts";

const hello = (live = false): Hello =>
  readMessage({ type: "hello", n: 0, t: 0, live, joints: ["pelvis"], scene: {}, body: {} }) as Hello;

const pose = (n: number, t: number, x: number, more: object = {}): Message =>
  readMessage({ type: "pose", n, t, body: [x, 0, 0], pelvis: [0, 0, 1], joints: [0, 0, 0, 1], held: null, things: {}, ...more }) as Message;

function walked(live = false): Track {
  const track = new Track(hello(live));
  track.add(pose(1, 0, 0, { things: { "4": [0, 0, 1, 0, 0, 0, 1] } }));
  track.add(pose(2, 0.1, 0.2));
  track.add(pose(3, 0.2, 0.4, { joints: [0, 0, 1, 0], things: { "4": [1, 0, 1, 0, 0, 0, 1] } }));
  return track;
}

test("between two samples a body is on the straight way", () => {
  expect(walked().at(0.05)?.body[0]).toBeCloseTo(0.1);
  expect(walked().at(9)?.body[0]).toBeCloseTo(0.4);
  expect(walked().at(-1)?.body[0]).toBe(0);
});

test("rotations turn at an even rate and stay unit", () => {
  const joints = walked().at(0.15)?.joints ?? [];
  expect(joints[2]).toBeCloseTo(Math.SQRT1_2);
  expect(joints[3]).toBeCloseTo(Math.SQRT1_2);
});

test("a thing rests until the sample before it moved", () => {
  const place = (t: number): Placed | undefined => walked().at(t)?.things.get(4);
  expect(place(0.1)?.[0]).toBe(0);
  expect(place(0.15)?.[0]).toBeCloseTo(0.5);
  expect(place(0.2)?.[0]).toBe(1);
});

test("a body that was put elsewhere does not glide there", () => {
  const track = walked();
  track.add(pose(4, 0.3, 3));
  expect(track.at(0.29)?.body[0]).toBeCloseTo(0.4);
  expect(track.at(0.3)?.body[0]).toBe(3);
});

test("over a pause one stands still until just before the next sample", () => {
  const track = walked();
  track.add(pose(4, 5.2, 0.6));
  expect(track.at(3)?.body[0]).toBeCloseTo(0.4);
});

test("what is known is not taken twice", () => {
  const track = walked();
  expect(track.add(pose(3, 0.2, 9))).toBe(false);
  expect(track.poses).toHaveLength(3);
});

test("headings turn the short way", () => {
  const track = new Track(hello());
  track.add(pose(1, 0, 0, { body: [0, 0, 3.1] }));
  track.add(pose(2, 0.1, 0, { body: [0, 0, -3.1] }));
  expect(Math.abs(track.at(0.05)?.body[2] ?? 0)).toBeCloseTo(Math.PI);
});

test("a replay plays at its speed, ends, and starts again", () => {
  const player = new Player(walked());
  player.setSpeed(2);
  player.advance(0.05);
  expect(player.time).toBeCloseTo(0.1);
  player.advance(1);
  expect(player.time).toBe(0.2);
  expect(player.playing).toBe(false);
  player.toggle();
  expect(player.time).toBe(0);
  expect(player.playing).toBe(true);
});

test("a live track is followed close behind its end", () => {
  const track = walked(true);
  const player = new Player(track);
  for (let i = 0; i < 60; i++) {
    track.add(pose(10 + i, 0.2 + i / 30, 0.4));
    player.advance(1 / 30);
    expect(player.time).toBeLessThanOrEqual(track.end);
  }
  expect(track.end - player.time).toBeLessThan(0.3);
});

test("scrubbing back leaves the end, catching up returns to it", () => {
  const player = new Player(walked(true));
  player.seek(0.05);
  expect(player.following).toBe(false);
  player.advance(1);
  expect(player.time).toBe(0.05);
  player.catchUp();
  expect(player.following).toBe(true);
});
