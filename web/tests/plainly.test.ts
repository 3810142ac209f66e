import { BoxGeometry, type BufferGeometry, Group, Mesh, MeshStandardMaterial, PlaneGeometry } from "three";
import { expect, test } from "vitest";
import { Plainly, type Standing } from "../src/edit/plainly.ts";

const ROOM = { x_min: -2, x_max: 2, y_min: -2, y_max: 2, height_m: 2.5 };

function piece(shape: BufferGeometry, kind: Standing["kind"], x = 0, z = 0): Standing {
  const node = new Group().add(new Mesh(shape, new MeshStandardMaterial()));
  node.position.set(x, 0, z);
  return { node, kind };
}

const light = ({ node }: Standing): number => {
  const { array } = (node.children[0] as Mesh).geometry.getAttribute("light");
  return Array.from(array).reduce((sum, value, i) => (i % 4 === 3 ? sum : sum + value), 0);
};

test("what is put under a table is darker as soon as nothing moves, and bright again without the table", () => {
  const floor = piece(new PlaneGeometry(0.3, 0.3), "walls");
  const table = piece(new BoxGeometry(1.2, 1.2, 0.08), "furniture", 1.4, 0.75);
  let standing = [floor, table];
  let count = 0;
  const plainly = new Plainly(ROOM, () => standing, () => count++);
  for (const { node } of standing) plainly.dress(node);
  plainly.relight();
  const bright = light(floor);
  table.node.position.x = 0;
  plainly.relight();
  expect(light(floor)).toBeLessThan(0.88 * bright);
  standing = [floor];
  plainly.relight();
  expect(light(floor)).toBeGreaterThanOrEqual(bright);
  expect(count).toBe(3);
  plainly.close();
});

test("two of a kind share their shape and not their light", () => {
  const shape = new BoxGeometry(0.3, 0.3, 0.3);
  const standing = [piece(shape, "object", -1.5, 0.15), piece(shape, "object", 0, 2)];
  const plainly = new Plainly(ROOM, () => standing, () => undefined);
  for (const { node } of standing) plainly.dress(node);
  expect(light(standing[0] as Standing)).not.toBe(light(standing[1] as Standing));
  plainly.close();
});
