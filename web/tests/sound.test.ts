import { describe, expect, it } from "vitest";
import { Ear, EARLY_MS, loudness, PAUSE_MS, wav } from "../src/talk/sound.ts";

describe("an ear", () => {
  it("hears where speech begins, and its end after a pause", () => {
    const ear = new Ear();
    const told: string[] = [];
    for (let ms = 0; ms < 400; ms += 40) told.push(ear.note(0.004, 40));
    for (let ms = 0; ms < 800; ms += 40) told.push(ear.note(0.1, 40));
    for (let ms = 0; ms < 300; ms += 40) told.push(ear.note(0.005, 40));
    for (let ms = 0; ms < 200; ms += 40) told.push(ear.note(0.1, 40));
    expect(told.filter((what) => what === "began")).toHaveLength(1);
    expect(told).not.toContain("ended");
    let waited = 0;
    while (ear.note(0.004, 40) !== "ended") waited += 40;
    expect(waited + 40).toBeGreaterThanOrEqual(PAUSE_MS);
    expect(waited).toBeLessThan(PAUSE_MS + 80);
  });
  it("tells when it may be the end, and takes it back", () => {
    const ear = new Ear();
    const say = (loud: number, ms: number): string[] => Array.from({ length: ms / 40 }, () => ear.note(loud, 40));
    say(0.1, 400);
    expect(say(0.004, 320)).toEqual([...Array(5).fill("speaking"), ...Array(3).fill("pausing")]);
    expect(new Set(say(0.1, 400))).toEqual(new Set(["speaking"]));
    const last = say(0.004, 520);
    expect(last[EARLY_MS / 40 - 1]).toBe("pausing");
    expect(last.indexOf("ended")).toBeGreaterThan(last.indexOf("pausing"));
  });
  it("takes neither a click nor a noisy room for speech", () => {
    const ear = new Ear();
    for (let i = 0; i < 100; i++) expect(ear.note(i % 10 === 0 ? 0.3 : 0.01, 40)).toBe("quiet");
  });
});

describe("a WAV file", () => {
  it("holds the samples with its head", async () => {
    const file = new DataView(await wav(new Float32Array([0, 0.5, -2]), 16_000).arrayBuffer());
    expect(file.byteLength).toBe(50);
    expect(file.getUint32(24, true)).toBe(16_000);
    expect([0, 1, 2].map((i) => file.getInt16(44 + i * 2, true))).toEqual([0, 16383, -32767]);
  });
  it("is as loud as its samples", () => {
    expect(loudness(new Float32Array([0.5, -0.5]))).toBeCloseTo(0.5);
    expect(loudness(new Float32Array())).toBe(0);
  });
});
