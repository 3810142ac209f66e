// Talking with her: a microphone that listens until there is a pause, and her voice.

import { hear, speak } from "../server.ts";
import type { Phoneme } from "../view/face.ts";
import { Ear, loudness, RATE, wav } from "./sound.ts";

const LOOK_MS = 40;
/** Two seconds: so long a picture may take to draw before a part of what is said is lost. */
const KEPT_SAMPLES = 32768;
/** So much before speech was noticed belongs to it. */
const BEFORE_S = 0.3;
const LONGEST_S = 30;

export interface Listener {
  /** Somebody began to speak. */
  began: () => void;
  /** He is done; the text comes. */
  ended: () => void;
  heard: (text: string) => void;
  failed: (why: string) => void;
}

/** Browsers give a microphone to pages of this machine, or over HTTPS, alone. */
export const canListen = (): boolean => isSecureContext && Boolean(navigator.mediaDevices) && "AudioContext" in window;

/** Listens again and again, until it is closed. */
export class Microphone {
  private readonly ear = new Ear();
  private chunks: Float32Array[] = [];
  private timer = 0;
  private speaks = false;
  /** What is understood of what was said so far, asked for when it may be all. */
  private early: Promise<string> | null = null;

  private constructor(
    private readonly context: AudioContext,
    private readonly stream: MediaStream,
    private readonly listener: Listener,
  ) {
    const analyser = context.createAnalyser();
    analyser.fftSize = KEPT_SAMPLES;
    context.createMediaStreamSource(stream).connect(analyser);
    const fresh = new Float32Array(analyser.fftSize);
    let last = context.currentTime;
    this.timer = window.setInterval(() => {
      const now = context.currentTime;
      const count = Math.min(fresh.length, Math.round((now - last) * context.sampleRate));
      if (count <= 0) return;
      analyser.getFloatTimeDomainData(fresh);
      this.note(fresh.slice(fresh.length - count), (now - last) * 1000);
      last = now;
    }, LOOK_MS);
  }

  static async open(listener: Listener): Promise<Microphone> {
    const audio = { echoCancellation: true, noiseSuppression: true, channelCount: 1 };
    const stream = await navigator.mediaDevices.getUserMedia({ audio });
    const context = new AudioContext({ sampleRate: RATE });
    await context.resume();
    return new Microphone(context, stream, listener);
  }

  private note(samples: Float32Array, ms: number): void {
    this.chunks.push(samples);
    const told = this.ear.note(loudness(samples), ms);
    if (told === "began") {
      this.speaks = true;
      this.listener.began();
    }
    const seconds = this.chunks.reduce((sum, chunk) => sum + chunk.length, 0) / this.context.sampleRate;
    if (!this.speaks) {
      if (seconds > BEFORE_S) this.chunks.shift();
    } else if (told === "ended" || seconds > LONGEST_S) {
      this.speaks = false;
      this.finish();
    } else if (told === "speaking") {
      this.early = null;
    } else if (told === "pausing" && !this.early) {
      this.early = this.understood();
      // Only if it is all, its fault is one.
      this.early.catch(() => undefined);
    }
  }

  private finish(): void {
    const text = this.early ?? this.understood();
    this.early = null;
    this.chunks = [];
    this.listener.ended();
    text.then(this.listener.heard, (error: unknown) => {
      this.listener.failed(error instanceof Error ? error.message : String(error));
    });
  }

  private understood(): Promise<string> {
    const samples = new Float32Array(this.chunks.reduce((sum, chunk) => sum + chunk.length, 0));
    let at = 0;
    for (const chunk of this.chunks) {
      samples.set(chunk, at);
      at += chunk.length;
    }
    return hear(wav(samples, this.context.sampleRate));
  }

  close(): void {
    clearInterval(this.timer);
    for (const track of this.stream.getTracks()) track.stop();
    void this.context.close();
  }
}

/** Somebody whose lips can follow. */
export interface Lips {
  say: (phonemes: readonly Phoneme[], clock: () => number) => void;
  silence: () => void;
}

/** Her voice: one utterance after the other, and cut off at once. */
export class Voice {
  private waiting: string[] = [];
  private audio: HTMLAudioElement | null = null;
  private turn = 0;

  constructor(
    private readonly lips: () => Lips | null,
    private readonly failed: (why: string) => void,
  ) {}

  say(text: string): void {
    this.waiting.push(text);
    if (this.waiting.length === 1) void this.next(this.turn);
  }

  private async next(turn: number): Promise<void> {
    while (this.waiting[0] !== undefined && turn === this.turn) {
      try {
        const said = await speak(this.waiting[0]);
        if (turn !== this.turn) return;
        await this.play(said.sound, said.phonemes);
      } catch (error) {
        this.failed(error instanceof Error ? error.message : String(error));
      }
      if (turn === this.turn) this.waiting.shift();
    }
  }

  private play(url: string, phonemes: readonly Phoneme[]): Promise<void> {
    const audio = new Audio(url);
    this.audio = audio;
    return new Promise((done) => {
      const end = (): void => {
        if (this.audio === audio) {
          this.audio = null;
          this.lips()?.silence();
        }
        done();
      };
      audio.onended = audio.onerror = audio.onpause = end;
      this.lips()?.say(phonemes, () => audio.currentTime);
      audio.play().catch(end);
    });
  }

  /** Silence, at once. */
  stop(): void {
    this.turn++;
    this.waiting = [];
    this.audio?.pause();
  }
}
