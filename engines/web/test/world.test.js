import assert from "node:assert/strict";
import { test } from "node:test";
import { NO_OBJECT, idsOf, shownIn } from "../src/ids.js";
import { World } from "../src/world.js";
import { ROOM } from "./room.js";

test("a state goes back to where it was kept, and a reset to the start", () => {
  const world = new World(ROOM);
  const start = world.snapshot();
  world.stance = { ...world.stance, held: 1 };
  world.object(1).box.center.x = 1.5;
  world.object(1).support = null;
  const kept = world.snapshot();
  world.reset();
  assert.equal(world.snapshot(), start);
  world.restore(kept);
  assert.equal(world.snapshot(), kept);
  assert.equal(world.state().objects[0].held, true);
});

test("a damaged snapshot changes nothing", () => {
  const world = new World(ROOM);
  const kept = world.snapshot();
  const changed = (change) => {
    const told = JSON.parse(kept);
    change(told);
    return JSON.stringify(told);
  };
  const wrong = [
    "no snapshot", kept.slice(0, 90), "{}", "null", "[]",
    changed((told) => told.objects.pop()),
    changed((told) => delete told.objects[0].box.center),
    changed((told) => (told.objects[0] = null)),
    changed((told) => delete told.stance),
    changed((told) => (told.stance.held = 99)),
    changed((told) => (told.scene = "other")),
  ];
  for (const text of wrong) assert.throws(() => world.restore(text), /snapshot/, text);
  assert.equal(world.snapshot(), kept);
});

test("a scene of another format is refused", () => {
  assert.throws(() => new World({ ...ROOM, format: 2 }), /format 2/);
});

test("the answers hold what the wire has, and no more", () => {
  const world = new World(ROOM);
  assert.deepEqual(world.sceneAnswer().object_names, { 1: "Cup", 2: "Box" });
  assert.ok(!("solids" in world.sceneAnswer().furniture[0]));
  assert.ok(!("max_pitch_rad" in world.bodiesAnswer().bodies.agent));
  assert.ok(!("mesh" in world.state().objects[0]));
});

test("what is below says the level of a shelf", () => {
  const shelf = JSON.parse(JSON.stringify(ROOM));
  const [table] = shelf.furniture;
  table.surfaces = [0.2, 0.7].map((z, i) => ({ ...table.surfaces[0], support: `table/${i}`, center: { x: 0.5, y: 0, z } }));
  const world = new World(shelf);
  assert.equal(world.supportOf({ name: "table", z: 0.25 }), "table/0");
  assert.equal(world.supportOf({ name: "table", z: 0.69 }), "table/1");
  assert.equal(world.supportOf({ name: "floor", z: 0 }), "floor");
  assert.equal(world.supportOf({ name: "object 2", z: 0.8 }), "object 2");
  assert.equal(world.supportOf(null), null);
});

test("flat colours become ids, from the top", () => {
  const rgba = Uint8Array.from([0, 1, 2, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 7, 255]);
  const ids = idsOf(rgba, 2, 2);
  assert.deepEqual([...ids], [NO_OBJECT, 7, 258, NO_OBJECT]);
  assert.deepEqual(shownIn([ids]), [7, 258]);
});
