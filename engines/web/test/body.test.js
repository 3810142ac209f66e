import assert from "node:assert/strict";
import { test } from "node:test";
import { BodyOf } from "../src/body.js";
import { at, flatDistance } from "../src/geometry.js";
import { World } from "../src/world.js";
import { ROOM, flat } from "./room.js";

const made = () => {
  const world = new World(ROOM);
  return { world, body: new BodyOf(world, flat) };
};

test("looking turns the body, and the neck has limits", () => {
  const { world, body } = made();
  assert.equal(body.look(at(-1.5, 1.5, 1)).code, "ok");
  assert.ok(Math.abs(world.stance.heading - Math.PI / 2) < 1e-9);
  const up = body.look(at(-1.5, 0, 2.4));
  assert.equal(up.code, "gaze_limited");
  assert.deepEqual(up.point, world.stance.gaze);
});

test("walking goes round the table and stops before it", () => {
  const { world, body } = made();
  const round = body.walk(at(1.6, 0, 0));
  assert.equal(round.code, "ok");
  assert.ok(round.walked_m > 3.2, `${round.walked_m}`);
  const into = body.walk(at(0.5, 0, 0));
  assert.equal(into.code, "stopped_short");
  assert.ok(flatDistance(world.stance.position, at(0.5, 0, 0)) >= 0.74);
  assert.equal(body.walk(world.stance.position).walked_m, 0);
});

test("picking walks closer, and one thing fits into the hand", async () => {
  const { world, body } = made();
  const taken = await body.pick(1);
  assert.deepEqual([taken.outcome, taken.code], ["done", "repositioned"]);
  assert.equal(world.body().held, 1);
  assert.deepEqual(world.body().held_box, world.object(1).box);
  assert.equal(world.object(1).support, null);
  const before = world.snapshot();
  assert.equal((await body.pick(2)).code, "hand_full");
  assert.equal(world.snapshot(), before);
});

test("what is held comes along, and stays in the room", async () => {
  const { world, body } = made();
  await body.pick(1);
  body.walk(at(-1.75, -1.75, 0));
  body.look(at(-2, -1.75, 1));
  const { center } = world.object(1).box;
  assert.ok(center.x >= -1.951 && center.y >= -1.951, JSON.stringify(center));
});

test("dropping finds the free place next to what lies there", async () => {
  const { world, body } = made();
  assert.equal((await body.drop(at(0, 0, 0))).code, "hand_empty");
  await body.pick(1);
  const beside = await body.drop(world.object(2).box.center);
  assert.deepEqual([beside.code, beside.support], ["placed_elsewhere", "table"]);
  assert.ok(flatDistance(beside.point, world.object(2).box.center) >= 0.11 - 1e-9);
  assert.equal(world.stance.held, null);
});

test("dropping on the floor, and where nothing is", async () => {
  const { world, body } = made();
  await body.pick(1);
  const before = world.snapshot();
  assert.equal((await body.drop(at(0, 0, 9))).code, "no_free_spot");
  assert.equal(world.snapshot(), before);
  const done = await body.drop(at(-1, 1, 0));
  assert.deepEqual([done.outcome, done.support], ["done", "floor"]);
});

test("what nobody can reach is refused with the nearest place", async () => {
  const { world, body } = made();
  world.object(1).box.center.z = 2.3;
  const high = await body.pick(1);
  assert.equal(high.code, "unreachable");
  assert.ok(body._ways().floor.canStand(high.point));
});
