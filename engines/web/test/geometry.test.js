import assert from "node:assert/strict";
import { test } from "node:test";
import { at, blocks, corners, direction, distanceTo, gap, solidAround, turned, wrapAngle, yawOf } from "../src/geometry.js";
import { fromPage, toPage, turnFromPage, turnToPage } from "../src/frame.js";

const near = (a, b) => assert.ok(Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z) < 1e-9, `${JSON.stringify(a)} ${JSON.stringify(b)}`);
const quarter = { w: Math.SQRT1_2, x: 0, y: 0, z: Math.SQRT1_2 };

test("a quarter turn takes X to Y", () => {
  near(turned(quarter, at(1, 0, 0)), at(0, 1, 0));
  assert.ok(Math.abs(yawOf(quarter) - Math.PI / 2) < 1e-12);
});

test("angles are wrapped to (-pi, pi]", () => {
  assert.equal(wrapAngle(Math.PI), Math.PI);
  assert.ok(Math.abs(wrapAngle(3 * Math.PI) - Math.PI) < 1e-9);
  assert.ok(Math.abs(wrapAngle(-4) - (2 * Math.PI - 4)) < 1e-9);
});

test("the page's frame and back", () => {
  const [x, y, z] = toPage(at(1, 2, 3));
  assert.deepEqual([x, y, z], [1, 3, -2]);
  near(fromPage({ x, y, z }), at(1, 2, 3));
  const [qx, qy, qz, w] = turnToPage({ w: 0.5, x: 0.1, y: 0.2, z: 0.3 });
  assert.deepEqual(turnFromPage({ x: qx, y: qy, z: qz, w }), { w: 0.5, x: 0.1, y: 0.2, z: 0.3 });
});

test("the prism around a turned box", () => {
  const solid = solidAround({ center: at(1, 1, 1), size: at(0.4, 0.2, 0.6), orientation: quarter });
  assert.ok(Math.abs(solid.half_x - 0.2) < 1e-9 && Math.abs(solid.half_y - 0.1) < 1e-9);
  assert.ok(Math.abs(solid.z_min - 0.7) < 1e-9 && Math.abs(solid.z_max - 1.3) < 1e-9);
  assert.ok(Math.abs(distanceTo(solid, 1, 1.5) - 0.3) < 1e-9);
  assert.equal(distanceTo(solid, 1, 1.1), 0);
  assert.equal(corners({ center: at(0, 0, 0), size: at(1, 1, 1), orientation: quarter }).length, 8);
});

test("gaps of prisms, and lines that they block", () => {
  const one = { x: 0, y: 0, half_x: 0.5, half_y: 0.5, yaw_rad: 0, z_min: 0, z_max: 1 };
  assert.ok(Math.abs(gap(one, 1.2, 0, one) - 0.2) < 1e-9);
  assert.ok(gap(one, 0.2, 0, one) < 0);
  assert.ok(gap({ ...one, yaw_rad: Math.PI / 4 }, 1.1, 0, one) < 0);
  assert.ok(blocks(one, at(-2, 0, 0.5), at(2, 0, 0.5)));
  assert.ok(!blocks(one, at(-2, 0, 1.5), at(2, 0, 1.5)));
  assert.ok(!blocks(one, at(-2, 0, 0.5), at(-1, 0, 0.5)));
  near(direction(0, Math.PI / 2), at(0, 0, 1));
});
