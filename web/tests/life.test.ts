import { Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { type Bearing, Life, lookedAt, wished } from "../src/view/life.ts";

const STILL = new Quaternion();
const STRAIGHT = { yaw: 0, pitch: 0 };
const BESIDE = new Vector3(2, 1.2, 0.1);

function after(life: Life, seconds: number, bearing: Bearing, viewer = BESIDE): number {
  for (let t = 0; t < seconds - 1e-9; t += 0.02) life.update(0.02, bearing, viewer, STRAIGHT);
  return life.neck.angleTo(STILL) + life.head.angleTo(STILL);
}

describe("her bearing", () => {
  it("turns to whom she listens to, within 200 ms, and tilts her head", () => {
    const life = new Life(() => false);
    const whole = Math.hypot(wished("listening", BESIDE).yaw);
    expect(after(life, 0.2, "listening")).toBeGreaterThan(0.9 * whole);
    expect(wished("listening", BESIDE).roll).toBeGreaterThan(0.05);
  });
  it("looks aside and up when she thinks, within 200 ms", () => {
    const life = new Life(() => false);
    const ahead = new Vector3(2, 0, 0);
    expect(after(life, 0.2, "thinking", ahead)).toBeGreaterThan(0.2);
    expect(wished("thinking", ahead).pitch).toBeLessThan(0);
  });
  it("leaves the head to the motion while she does something", () => {
    const life = new Life(() => false);
    after(life, 1, "listening");
    expect(after(life, 2, "busy")).toBeLessThan(0.002);
    expect(life.update(0.02, "busy", BESIDE, STRAIGHT)).toBe(false);
  });
  it("does not twist her neck for somebody behind her", () => {
    const behind = wished("listening", new Vector3(-2, 0.3, 0));
    expect(Math.abs(behind.yaw)).toBeLessThan(0.01);
    const high = wished("listening", new Vector3(0.5, 0, 3));
    expect(Math.abs(high.pitch)).toBeLessThan(0.5);
    expect(Math.abs(wished("listening", new Vector3(0.1, 2, 0)).yaw)).toBeLessThan(0.9);
  });
  it("comes to rest, so that nothing is drawn anew, unless she breathes", () => {
    const still = new Life(() => false);
    after(still, 2, "idle");
    expect(still.update(0.02, "idle", BESIDE, STRAIGHT)).toBe(false);
    expect(still.update(0.02, "idle", BESIDE.clone().addScalar(1e-5), STRAIGHT)).toBe(false);
    const alive = new Life(() => true, () => 0.9);
    after(alive, 2, "idle");
    expect(alive.update(0.02, "idle", BESIDE, STRAIGHT)).toBe(true);
    expect(alive.chest.angleTo(STILL)).toBeGreaterThan(0.01);
  });
  it("lets her eyes step to and fro, while the head rests", () => {
    let turn = 0;
    const life = new Life(() => true, () => (turn++ * 0.37) % 1);
    const seen = new Set<string>();
    for (let i = 0; i < 300; i++) {
      life.update(0.02, "idle", new Vector3(2, 0, 0), STRAIGHT);
      seen.add(life.eyes.yaw.toFixed(2));
      expect(Math.abs(life.eyes.yaw)).toBeLessThan(0.06);
    }
    expect(seen.size).toBeGreaterThan(4);
    expect(life.head.angleTo(STILL)).toBeLessThan(0.01);
  });
  it("has her eyes on whoever speaks before her head is there", () => {
    const life = new Life(() => false);
    const aim = lookedAt("listening", BESIDE, STRAIGHT).yaw;
    after(life, 0.06, "listening");
    expect(life.eyes.yaw).toBeGreaterThan(0.2);
    const early = life.eyes.yaw;
    after(life, 1, "listening");
    expect(life.eyes.yaw).toBeLessThan(early / 4);
    expect(aim).toBeCloseTo(Math.atan2(BESIDE.y, BESIDE.x));
  });
  it("has her eyes where the motion has them while she does something, and nothing else is turned", () => {
    const life = new Life(() => false);
    const gaze = { yaw: 0.2, pitch: -0.1 };
    for (let i = 0; i < 20; i++) {
      life.update(0.02, "busy", BESIDE, gaze);
      expect(life.isTurned).toBe(false);
    }
    expect(life.eyes.yaw).toBeCloseTo(0.2, 2);
    expect(life.eyes.pitch).toBeCloseTo(-0.1, 2);
    life.update(0.02, "listening", BESIDE, gaze);
    expect(life.isTurned).toBe(true);
  });
  it("looks with her eyes where her head does not quite go", () => {
    const life = new Life(() => false);
    after(life, 2, "idle");
    expect(life.eyes.yaw).toBeGreaterThan(0.05);
    after(life, 2, "busy");
    expect(Math.hypot(life.eyes.yaw, life.eyes.pitch)).toBeLessThan(0.002);
  });
});
