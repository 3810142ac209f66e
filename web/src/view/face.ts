// Her face: lips follow what she says, she blinks, and her brows rise when she listens.

import type { SkinnedMesh } from "three";

/** A speech sound, and when it begins and ends in seconds. */
export type Phoneme = readonly [symbol: string, start: number, end: number];
/** How far each shape of the face is gone into, 0 to 1, by its ARKit name. */
export type Shapes = Readonly<Record<string, number>>;

const VISEMES: readonly (readonly [RegExp, Shapes])[] = [
  [/^[mbp]/, { jawOpen: 0 }],
  [/^[fv]/, { mouthRollLower: 0.9, jawOpen: 0.06 }],
  [/^[wuʊy]/, { mouthPucker: 0.85, jawOpen: 0.14 }],
  [/^[oɔɒ]/, { mouthFunnel: 0.75, jawOpen: 0.32 }],
  [/^[aɑæʌɐ]/, { jawOpen: 0.6 }],
  [/^[eɛəɜɝɚ]/, { jawOpen: 0.34, mouthSmileLeft: 0.12, mouthSmileRight: 0.12 }],
  [/^[iɪj]/, { jawOpen: 0.16, mouthSmileLeft: 0.35, mouthSmileRight: 0.35 }],
  [/^[ʃʒrɹ]/, { mouthFunnel: 0.5, jawOpen: 0.12 }],
  [/^./u, { jawOpen: 0.15 }],
];
/** Lips are on their way to a sound before it is heard. */
const AHEAD_S = 0.05;
/** Share of the way that a shape goes in a second, as a rate. */
const EASE = 16;
const BLINK_S = 0.16;
const NEXT_BLINK_S: readonly [number, number] = [2.2, 6];
const LISTENING: Shapes = { browInnerUp: 0.45, mouthSmileLeft: 0.16, mouthSmileRight: 0.16 };
/** Turn of the joint of the eyelids that closes the eyes, radians. */
const LIDS_CLOSED = 0.72;
/** Turn of an eye where a shape of a look is gone into as a whole, radians. */
const LOOK = (25 * Math.PI) / 180;
/** How far the lids go down with eyes that look down. */
const LIDS_FOLLOW = 0.4;
const LEAST = 0.004;

/** The shapes of the mouth at a moment of what is said. */
export function shapesAt(phonemes: readonly Phoneme[], seconds: number): Shapes {
  const at = seconds + AHEAD_S;
  const now = phonemes.find(([, start, end]) => start <= at && at < end);
  if (!now?.[0]) return {};
  return VISEMES.find(([sound]) => sound.test(now[0]))?.[1] ?? {};
}

export class Face {
  private readonly now = new Map<string, number>();
  private phonemes: readonly Phoneme[] = [];
  private clock: (() => number) | null = null;
  /** What she gives to him who speaks to her: her ear, and then a thought to what he said. */
  heeds: "listening" | "thinking" | null = null;
  private lids = 0;
  private lowered = 0;
  private shut = 0;
  private blinkAt: number;
  private time = 0;

  constructor(
    private readonly meshes: readonly SkinnedMesh[],
    private readonly random: () => number = Math.random,
  ) {
    this.blinkAt = this.pause();
  }

  /** Let the lips follow. The clock tells how far the sound is, in seconds. */
  say(phonemes: readonly Phoneme[], clock: () => number): void {
    this.phonemes = phonemes;
    this.clock = clock;
  }

  silence(): void {
    this.phonemes = [];
    this.clock = null;
  }

  /** The joint of the eyelids is turned so far, radians: shown by the lids' own shape. */
  turnLids(angle: number): void {
    this.lids = Math.min(1, Math.max(0, angle / LIDS_CLOSED));
  }

  /** The eyes are turned so far from straight ahead, radians: left and down. */
  look(yaw: number, pitch: number): void {
    const [left, down] = [yaw / LOOK, pitch / LOOK];
    const turns = { Up: [-down, -down], Down: [down, down], Out: [left, -left], In: [-left, left] };
    for (const [way, [ofLeft = 0, ofRight = 0]] of Object.entries(turns)) {
      this.put(`eyeLook${way}Left`, Math.min(1, Math.max(0, ofLeft)));
      this.put(`eyeLook${way}Right`, Math.min(1, Math.max(0, ofRight)));
    }
    this.lowered = LIDS_FOLLOW * Math.min(1, Math.max(0, down));
  }

  /** Go on; returns whether anything moved. */
  update(seconds: number): boolean {
    this.time += seconds;
    const wished: Record<string, number> = { ...(this.heeds === "listening" ? LISTENING : {}) };
    if (this.clock) Object.assign(wished, shapesAt(this.phonemes, this.clock()));
    const share = 1 - Math.exp(-EASE * seconds);
    let moved = false;
    for (const name of new Set([...this.now.keys(), ...Object.keys(wished)])) {
      const before = this.now.get(name) ?? 0;
      const goal = wished[name] ?? 0;
      const after = Math.abs(goal - before) < LEAST ? goal : before + (goal - before) * share;
      if (after !== before) moved = true;
      this.now.set(name, after);
      this.put(name, after);
    }
    return this.blink() || moved;
  }

  private blink(): boolean {
    const since = this.time - this.blinkAt;
    if (since > BLINK_S) this.blinkAt = this.time + this.pause();
    const own = since < 0 || since > BLINK_S ? 0 : Math.sin((Math.PI * since) / BLINK_S);
    const shut = Math.max(own, this.lids, this.lowered);
    const moved = shut !== this.shut;
    this.shut = shut;
    for (const side of ["eyeBlinkLeft", "eyeBlinkRight"]) this.put(side, shut);
    return moved;
  }

  private pause(): number {
    const [least, most] = NEXT_BLINK_S;
    return least + (most - least) * this.random();
  }

  private put(name: string, value: number): void {
    for (const mesh of this.meshes) {
      const number = mesh.morphTargetDictionary?.[name];
      if (number !== undefined && mesh.morphTargetInfluences) mesh.morphTargetInfluences[number] = value;
    }
  }
}
