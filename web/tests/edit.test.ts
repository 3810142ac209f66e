import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { CALM_MS, Checking } from "../src/edit/checking.ts";
import { cornerAt, Draft, MOST_LIGHTS, placeOf } from "../src/edit/draft.ts";
import { along } from "../src/edit/orbit.ts";
import { saving } from "../src/edit/remote.ts";
import { type Catalog, type Finding, readCatalog, readScene, type SceneData, targetOf } from "../src/edit/scene.ts";
import { freeSpot, heightOf, levelAt, levels } from "../src/edit/support.ts";

const scene = (): SceneData =>
  readScene({
    name: "s",
    title: "A room",
    room: { asset: "room", x_min: -3, x_max: 3, y_min: -3, y_max: 3, height_m: 3 },
    agent: { position: [-2, 0], heading_deg: 0, gaze: [0, 0, 1] },
    lights: [{ position: [0, 0, 3], target: [0, 0, 0], diffuse: 0.5, shadow: true }],
    furniture: [{ name: "shelf", asset: "tall_shelf", position: [1, 0], yaw_deg: 0 }],
    objects: [
      { id: 3, asset: "cup", on: "shelf/top", position: [1.2, 0.1], yaw_deg: 10 },
      { id: 7, asset: "cup", on: "floor", position: [0, -1], yaw_deg: 0 },
    ],
    areas: [{ name: "corner", kind: "corner", min: [-3, -3], max: [-2, -2] }],
    ambient: 0.5,
    variation: 0,
  });

const catalog: Catalog = readCatalog({
  furniture: [
    {
      name: "tall_shelf",
      size: [1.2, 0.4, 2],
      surfaces: [
        { name: "lower", center: [0, 0, 0.9], half_size: [0.58, 0.18] },
        { name: "top", center: [0, 0, 1.9], half_size: [0.58, 0.18] },
      ],
    },
  ],
  objects: [{ name: "cup", size: [0.1, 0.1, 0.12], surfaces: [] }],
});

const cup = { kind: "objects", index: 0 } as const;
const shelf = { kind: "furniture", index: 0 } as const;

test("an object is placed, turned and removed, and each is undone and done again", () => {
  const begin = scene();
  const draft = new Draft(begin);
  draft.place(cup, [0.503, -0.2], "floor");
  expect(draft.data.objects[0]).toMatchObject({ position: [0.5, -0.2], on: "floor" });
  draft.turn(cup, 15);
  expect(draft.data.objects[0]?.yaw_deg).toBe(25);
  draft.remove(cup);
  expect(draft.data.objects.map(({ id }) => id)).toEqual([7]);
  draft.undo();
  draft.undo();
  draft.undo();
  expect(draft.data).toBe(begin);
  expect(draft.canUndo).toBe(false);
  draft.redo();
  draft.redo();
  draft.redo();
  expect(draft.data.objects).toHaveLength(1);
  draft.undo();
  draft.turn(cup, 15);
  expect(draft.canRedo).toBe(false);
});

test("turning goes round, to one direction for each", () => {
  const draft = new Draft(scene());
  for (let i = 0; i < 12; i++) draft.turn(cup, 15);
  expect(draft.data.objects[0]?.yaw_deg).toBe(-170);
  for (let i = 0; i < 12; i++) draft.turn(cup, 15);
  expect(draft.data.objects[0]?.yaw_deg).toBe(10);
});

test("what stands on furniture comes along, and comes to the floor when it is removed", () => {
  const draft = new Draft(scene());
  draft.place(shelf, [0, 1]);
  expect(draft.data.objects[0]?.position).toEqual([0.2, 1.1]);
  draft.turn(shelf, 90);
  expect(draft.data.objects[0]).toMatchObject({ position: [-0.1, 1.2], yaw_deg: 100 });
  expect(draft.data.objects[1]?.position).toEqual([0, -1]);
  draft.rename(0, "tall");
  expect(draft.data.objects[0]?.on).toBe("tall/top");
  draft.remove(shelf);
  expect(draft.data.objects[0]?.on).toBe("floor");
  draft.undo();
  expect(draft.data.objects[0]?.on).toBe("tall/top");
});

test("one drag is one edit", () => {
  const draft = new Draft(scene());
  for (const x of [0.1, 0.2, 0.3]) draft.place(cup, [x, 0], "floor", "drag");
  draft.settle();
  draft.place(cup, [0.4, 0], "floor", "drag");
  draft.undo();
  expect(placeOf(draft.data, cup)).toEqual([0.3, 0]);
  draft.undo();
  expect(draft.data).toEqual(scene());
});

test("what is added is selected, and has a number and a name of its own", () => {
  const draft = new Draft(scene());
  draft.addObject("cup", "floor", [0, 0]);
  expect(draft.data.objects[2]?.id).toBe(8);
  expect(draft.selected).toEqual({ kind: "objects", index: 2 });
  draft.addFurniture("shelf", [0, 0]);
  expect(draft.data.furniture[1]?.name).toBe("shelf 2");
  draft.addArea([1, 1]);
  expect(draft.data.areas[1]).toEqual({ name: "area", kind: "area", min: [0.5, 0.5], max: [1.5, 1.5] });
  draft.undo();
  expect(draft.selected).toBeNull();
});

test("she looks along when she is turned, and stays when all else is removed", () => {
  const draft = new Draft(scene());
  draft.turn({ kind: "agent", index: 0 }, 90);
  expect(draft.data.agent).toEqual({ position: [-2, 0], heading_deg: 90, gaze: [-2, 2, 1] });
  draft.remove({ kind: "agent", index: 0 });
  expect(draft.data.agent.position).toEqual([-2, 0]);
});

test("levels of furniture carry, wherever it stands", () => {
  const data = scene();
  const [piece] = data.furniture;
  if (piece) piece.yaw_deg = 90;
  expect(levels(data, catalog).map(({ support }) => support)).toEqual(["floor", "shelf/lower", "shelf/top"]);
  expect(levelAt(data, catalog, [1, 0.5, 1.91])?.support).toBe("shelf/top");
  expect(levelAt(data, catalog, [1.5, 0, 1.91])).toBeNull();
  expect(levelAt(data, catalog, [1.5, 0, 0])?.support).toBe("floor");
  expect(heightOf("shelf/lower", data, catalog)).toBe(0.9);
});

test("a new object meets no other one", () => {
  const data = scene();
  const top = levels(data, catalog).find(({ support }) => support === "shelf/top");
  if (!top) throw new Error("no level");
  const [x, y] = freeSpot(data, catalog, "cup", top, [1.2, 0.1]);
  expect(Math.hypot(x - 1.2, y - 0.1)).toBeGreaterThan(0.14);
  expect(Math.abs(y)).toBeLessThan(0.18);
});

test("arrows go along the walls, as the camera sees them", () => {
  expect(along(-Math.PI / 2, "ArrowUp")).toEqual([0, 1]);
  expect(along(-Math.PI / 2, "ArrowRight")).toEqual([1, 0]);
  expect(along(Math.PI + 0.3, "ArrowUp")).toEqual([1, 0]);
  expect(along(Math.PI, "ArrowLeft")).toEqual([0, 1]);
});

test("a finding leads to the thing that it names", () => {
  const data = scene();
  expect(targetOf("objects[1].position[0]", data)).toEqual({ kind: "objects", index: 1 });
  expect(targetOf("agent.position", data)).toEqual({ kind: "agent", index: 0 });
  expect(targetOf("objects[9]", data)).toBeNull();
  expect(targetOf("objects", data)).toBeNull();
  expect(targetOf("scene", data)).toBeNull();
});

test("what is sent is the whole scene, under the name of its file", () => {
  const data = scene();
  expect(saving(data, "mine", true)).toEqual({ name: "mine", replace: true, data: { ...data, name: "mine" } });
  expect(readScene(JSON.parse(JSON.stringify(data)))).toEqual(data);
});

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

const finding = (where: string): Finding => ({ severity: "error", where, problem: "outside", fix: "" });

test("the scene is checked once one is done, and old answers do not count", async () => {
  const draft = new Draft(scene());
  const asked: [SceneData, (found: Finding[]) => void][] = [];
  const checking = new Checking(draft, (data) => new Promise((answer) => asked.push([data, answer])));
  await vi.advanceTimersByTimeAsync(CALM_MS - 1);
  draft.place(cup, [9, 0]);
  draft.place(cup, [8, 0]);
  await vi.advanceTimersByTimeAsync(CALM_MS);
  expect(asked.map(([data]) => data)).toEqual([draft.data]);
  draft.place(cup, [1, 0]);
  asked[0]?.[1]([finding("objects[0]")]);
  await vi.advanceTimersByTimeAsync(CALM_MS);
  expect(checking.findings).toEqual([]);
  expect(checking.isBusy).toBe(true);
  asked[1]?.[1]([finding("objects[1]")]);
  await vi.advanceTimersByTimeAsync(0);
  expect(checking.findings).toEqual([finding("objects[1]")]);
  draft.select(cup);
  await vi.advanceTimersByTimeAsync(CALM_MS);
  expect(asked).toHaveLength(2);
});

test("that a check failed is told", async () => {
  const checking = new Checking(new Draft(scene()), () => Promise.reject(new Error("The server is gone.")));
  await vi.advanceTimersByTimeAsync(CALM_MS);
  expect(checking.problem).toBe("The server is gone.");
  expect(checking.isBusy).toBe(false);
});

test("lights are added, moved with what they shine at, and removed but for the last", () => {
  const draft = new Draft(scene());
  draft.addLight([1, 1]);
  expect(draft.selected).toEqual({ kind: "lights", index: 1 });
  expect(draft.data.lights[1]).toEqual({ position: [1, 1, 2.9], target: [1, 1, 0], diffuse: 0.3, shadow: false });
  draft.place({ kind: "lights", index: 1 }, [2, 1.5]);
  expect(draft.data.lights[1]).toMatchObject({ position: [2, 1.5, 2.9], target: [2, 1.5, 0] });
  draft.remove({ kind: "lights", index: 0 });
  draft.remove({ kind: "lights", index: 0 });
  expect(draft.data.lights).toHaveLength(1);
  draft.undo();
  expect(draft.data.lights).toHaveLength(2);
  for (let i = 0; i < 9; i++) draft.addLight([0, 0]);
  expect(draft.data.lights).toHaveLength(MOST_LIGHTS);
});

test("an area is reshaped by its corners, and never turned inside out", () => {
  const draft = new Draft(scene());
  const ref = { kind: "areas", index: 0 } as const;
  expect(cornerAt(draft.data, ref, [-2.05, -2.9], 0.16)).toEqual(["max", "min"]);
  expect(cornerAt(draft.data, ref, [-2.5, -2.5], 0.16)).toBeNull();
  expect(cornerAt(draft.data, cup, [-2, -2], 0.16)).toBeNull();
  draft.reshape(0, ["max", "min"], [-1, -2.5]);
  expect(draft.data.areas[0]).toMatchObject({ min: [-3, -2.5], max: [-1, -2] });
  draft.reshape(0, ["max", "max"], [-5, -5]);
  expect(draft.data.areas[0]).toMatchObject({ min: [-3, -2.5], max: [-2.9, -2.4] });
});
