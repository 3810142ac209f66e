import type { SkinnedMesh } from "three";
import { describe, expect, it } from "vitest";
import { Face, type Phoneme, shapesAt } from "../src/view/face.ts";

const HELLO: Phoneme[] = [["h", 0.1, 0.2], ["ɛ", 0.2, 0.35], ["l", 0.35, 0.45], ["oʊ", 0.45, 0.7], ["", 0.7, 0.9], ["m", 0.9, 1.0]];

function mesh(...names: string[]): SkinnedMesh {
  const morphTargetDictionary = Object.fromEntries(names.map((name, number) => [name, number]));
  return { morphTargetDictionary, morphTargetInfluences: names.map(() => 0) } as unknown as SkinnedMesh;
}

describe("lips", () => {
  it("open for a vowel, round for an o, and close for an m", () => {
    expect(shapesAt(HELLO, 0.25).jawOpen).toBeGreaterThan(0.3);
    expect(shapesAt(HELLO, 0.5).mouthFunnel).toBeGreaterThan(0.5);
    expect(shapesAt(HELLO, 0.93).jawOpen).toBe(0);
  });
  it("rest in a pause, before and after", () => {
    for (const t of [-1, 0, 0.75, 2]) expect(shapesAt(HELLO, t)).toEqual({});
  });
});

describe("a face", () => {
  it("follows what is said and comes to rest", () => {
    const head = mesh("jawOpen", "mouthFunnel");
    const face = new Face([head], () => 1);
    let t = 0.2;
    face.say(HELLO, () => t);
    for (let i = 0; i < 10; i++) face.update(0.03);
    expect(head.morphTargetInfluences?.[0]).toBeGreaterThan(0.25);
    t = 5;
    face.silence();
    for (let i = 0; i < 40; i++) face.update(0.03);
    expect(head.morphTargetInfluences).toEqual([0, 0]);
    expect(face.update(0.03)).toBe(false);
  });
  it("blinks now and then, both eyes, and opens them again", () => {
    const lids = mesh("eyeBlinkLeft", "eyeBlinkRight");
    const face = new Face([lids], () => 0);
    const seen: number[] = [];
    for (let i = 0; i < 200; i++) {
      face.update(0.02);
      const [left, right] = lids.morphTargetInfluences ?? [];
      expect(left).toBe(right);
      seen.push(left ?? 0);
    }
    expect(Math.max(...seen)).toBeGreaterThan(0.9);
    expect(seen.filter((shut) => shut > 0).length).toBeLessThan(20);
  });
  it("turns both eyes to one side, and lowers the lids with them", () => {
    const names = ["eyeLookOutLeft", "eyeLookInLeft", "eyeLookOutRight", "eyeLookInRight", "eyeLookDownLeft", "eyeBlinkLeft"];
    const eyes = mesh(...names);
    const face = new Face([eyes], () => 1);
    face.look(0.218, 0);
    expect(eyes.morphTargetInfluences?.map((value) => Number(value.toFixed(2)))).toEqual([0.5, 0, 0, 0.5, 0, 0]);
    face.look(-0.218, 0.436);
    face.update(0.02);
    expect(eyes.morphTargetInfluences?.map((value) => Number(value.toFixed(2)))).toEqual([0, 0.5, 0.5, 0, 1, 0.4]);
  });
  it("closes its lids as far as the body's motion says", () => {
    const lids = mesh("eyeBlinkLeft");
    const face = new Face([lids], () => 1);
    face.turnLids(0.36);
    expect(face.update(0.02)).toBe(true);
    expect(lids.morphTargetInfluences?.[0]).toBeCloseTo(0.5);
    // What does not move need not be drawn again.
    expect(face.update(0.02)).toBe(false);
    face.turnLids(0);
    face.update(0.02);
    expect(lids.morphTargetInfluences?.[0]).toBe(0);
  });
  it("shows that it listens", () => {
    const head = mesh("browInnerUp");
    const face = new Face([head], () => 1);
    face.heeds = "listening";
    for (let i = 0; i < 10; i++) face.update(0.03);
    expect(head.morphTargetInfluences?.[0]).toBeGreaterThan(0.4);
    face.heeds = "thinking";
    for (let i = 0; i < 40; i++) face.update(0.03);
    expect(head.morphTargetInfluences?.[0]).toBe(0);
  });
});
