// Asks the server, and keeps a live room's WebSocket open.

import type { Message, Offer, RoomWish, Said } from "./protocol.ts";
import { fields, list, number, readMessage, text } from "./reading.ts";
import { Track } from "./track/track.ts";
import type { Phoneme } from "./view/face.ts";

const AGAIN_MS = [500, 1000, 2000, 4000, 8000];
/** Close code for a room that there is not. */
const GONE = 4404;
const PING_MS = 20_000;

export const addressOf = (path: string): URL => new URL(`api/${path}`, document.baseURI);
const part = encodeURIComponent;

/** The element of a page that has its track in itself, and needs no server. */
const HELD = "adamo-track";
const HELD_FILES = /^data:(image\/(jpeg|png)|model\/gltf-binary);base64,/;

/** The track that the page itself holds; null on a page of a server. */
export function heldTrack(): Track | null {
  const held = document.getElementById(HELD);
  return held ? trackOf(JSON.parse(held.textContent ?? "")) : null;
}

/** The address of a picture or a mesh, if the page holds it or it is one of this server; empty otherwise. */
export function ownAddress(frame: string): string {
  if (!frame) return "";
  if (HELD_FILES.test(frame)) return frame;
  try {
    const url = new URL(frame, document.baseURI);
    return url.origin === location.origin ? url.href : "";
  } catch {
    return "";
  }
}

/** What is wrong, in the server's words where it gave some. */
async function problem(answer: Response): Promise<Error> {
  try {
    const body = fields(await answer.json());
    const said = text(fields(body.error).message) || text(body.detail) || text(body.message);
    if (said) return new Error(said);
  } catch {
    // The status has to do.
  }
  return new Error(`The server answered ${answer.status}.`);
}

export async function getJson(path: string, init?: RequestInit): Promise<unknown> {
  const answer = await fetch(addressOf(path), init);
  if (!answer.ok) throw await problem(answer);
  return answer.json();
}

export const postJson = (path: string, body: unknown): Promise<unknown> =>
  getJson(path, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });

export async function getOffer(): Promise<Offer> {
  const from = fields(await getJson("offer"));
  return {
    scenes: list(from.scenes).map(fields).map((s) => ({ name: text(s.name), title: text(s.title) || text(s.name) })),
    tasks: list(from.tasks)
      .map(fields)
      .map((t) => ({ id: text(t.id), instruction: text(t.instruction), scenes: list(t.scenes).map(text) })),
    models: list(from.models)
      .map(fields)
      .map((m) => ({
        name: text(m.name),
        note: text(m.note),
        needs_key: m.needs_key === true,
        has_key: m.has_key === true,
      })),
    profiles: list(from.profiles).map(text),
    labelings: list(from.labelings).map(text),
    figures: list(from.figures).map(text),
    runs: list(from.runs)
      .map(fields)
      .map((r) => ({
        name: text(r.name),
        instruction: text(r.instruction),
        model: text(r.model),
        completion: typeof r.completion === "number" ? r.completion : null,
        when: text(r.when),
      })),
  };
}

/** Whether the server hears what is said, and speaks. */
export async function getSpeech(): Promise<{ hears: boolean; speaks: boolean }> {
  const from = fields(fields(await getJson("offer")).speech);
  return { hears: from.hears === true, speaks: from.speaks === true };
}

/** What is said in a WAV file; empty if nobody spoke. */
export async function hear(sound: Blob): Promise<string> {
  const init = { method: "POST", headers: { "content-type": "audio/wav" }, body: sound };
  return text(fields(await getJson("hear", init)).text);
}

/** The address of the sound of a text, and the moments of its speech sounds. */
export async function speak(said: string): Promise<{ sound: string; phonemes: Phoneme[] }> {
  const from = fields(await postJson("speak", { text: said }));
  const phonemes = list(from.phonemes).map(list).map(([symbol, start, end]): Phoneme => [text(symbol), number(start), number(end)]);
  return { sound: ownAddress(text(from.sound)), phonemes };
}

export async function openRoom(wish: RoomWish): Promise<string> {
  return text(fields(await postJson("rooms", wish)).room);
}

/** A run as a track. The server makes it on the first request, which takes a while. */
export async function getTrack(run: string, waiting: () => void): Promise<Track> {
  for (;;) {
    const answer = await fetch(addressOf(`runs/${run.split("/").map(part).join("/")}/track`));
    if (answer.status === 202) {
      waiting();
      const wait = number(Number(answer.headers.get("retry-after")), 1) || 1;
      await new Promise((done) => setTimeout(done, wait * 1000));
      continue;
    }
    if (!answer.ok) throw await problem(answer);
    return trackOf(await answer.json());
  }
}

/** A track that is told as a whole. */
export function trackOf(told: unknown): Track {
  const from = fields(told);
  const hello = readMessage({ ...fields(from.hello), type: "hello" });
  if (hello?.type !== "hello") throw new Error("This is no track.");
  const track = new Track(hello);
  for (const item of list(from.messages)) {
    const message = readMessage(item);
    if (message) track.add(message);
  }
  return track;
}

export interface LiveListener {
  message: (message: Message) => void;
  connected: (on: boolean) => void;
}

/** The connection to a live room. It comes back by itself, and goes on where it was. */
export class Live {
  private socket: WebSocket | null = null;
  private tries = 0;
  private isClosed = false;
  private next = 0;
  private ping = 0;

  constructor(
    private readonly room: string,
    private readonly listener: LiveListener,
  ) {
    this.open();
  }

  private open(): void {
    const url = addressOf(`rooms/${part(this.room)}/live?from=${this.next}`);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(url);
    this.socket = socket;
    socket.onopen = () => {
      this.tries = 0;
      this.listener.connected(true);
    };
    socket.onmessage = ({ data }) => this.take(data);
    socket.onclose = ({ code }) => {
      this.listener.connected(false);
      const isOver = code === 1000 || code === 1008 || code === GONE;
      if (this.isClosed || isOver) return;
      const wait = AGAIN_MS[Math.min(this.tries++, AGAIN_MS.length - 1)];
      setTimeout(() => this.open(), wait);
    };
    clearInterval(this.ping);
    this.ping = window.setInterval(() => this.say({ type: "ping" }), PING_MS);
  }

  private take(data: unknown): void {
    let told: unknown;
    try {
      told = JSON.parse(String(data));
    } catch {
      return;
    }
    for (const item of Array.isArray(told) ? told : [told]) {
      const message = readMessage(item);
      if (!message) continue;
      this.next = Math.max(this.next, message.n + 1);
      this.listener.message(message);
    }
  }

  /** Returns whether it was sent. */
  say(said: Said): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(said));
    return true;
  }

  close(): void {
    this.isClosed = true;
    clearInterval(this.ping);
    this.socket?.close(1000);
  }
}
