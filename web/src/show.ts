// One track that is shown: its clock, its story, and the live room behind it if there is one.

import { Conversation } from "./mind/conversation.ts";
import type { Asked, Doing, Hello, Message, Notice, Said, Status } from "./protocol.ts";
import { Player } from "./track/player.ts";
import { Track } from "./track/track.ts";
import type { Live } from "./server.ts";

type Listener = () => void;

/** Something that one can wait for changes of. */
export class Changes {
  private readonly listeners: Listener[] = [];

  listen(listener: Listener): void {
    this.listeners.push(listener);
  }

  tell(): void {
    for (const listener of this.listeners) listener();
  }
}

export class Show {
  readonly track: Track;
  readonly player: Player;
  readonly story: Conversation;
  /** The story, the status or a question changed. */
  readonly changes = new Changes();
  /** Another object is pointed at. */
  readonly pointed = new Changes();
  live: Live | null = null;
  connected = false;
  notice: Notice | null = null;
  private tag = "";

  constructor(track: Track | Hello) {
    this.track = track instanceof Track ? track : new Track(track);
    this.player = new Player(this.track);
    this.story = new Conversation(this.track.hello.scene);
    for (const event of this.track.events) this.story.add(event);
  }

  get hello(): Hello {
    return this.track.hello;
  }

  /** Whether something may be done, e.g. "say" or "undo". */
  may(control: string): boolean {
    return this.hello.live && this.hello.controls.includes(control);
  }

  take(message: Message): void {
    if (!this.track.add(message) && message.type !== "notice") return;
    if (message.type === "event") this.story.add(message);
    if (message.type === "notice") this.notice = message;
    if (message.type !== "pose") this.changes.tell();
  }

  connect(on: boolean): void {
    this.connected = on;
    this.changes.tell();
  }

  say(said: Said): boolean {
    const sent = this.live?.say(said) ?? false;
    if (!sent) this.tellUser("The room is not connected at this moment. Try again.", "error");
    return sent;
  }

  tellUser(text: string, level: Notice["level"] = "info"): void {
    this.notice = { type: "notice", n: 0, t: this.track.end, text, level };
    this.changes.tell();
  }

  get status(): Status | null {
    const { track, player } = this;
    return player.following ? (track.statuses.at(-1) ?? null) : track.statusAt(player.time);
  }

  get doing(): Doing {
    return this.status?.doing ?? "idle";
  }

  /** What she asks to be approved of, if that is still open. */
  get open(): Asked | null {
    const asked = this.track.asked.at(-1);
    const status = this.track.statuses.at(-1);
    if (!asked || !this.hello.live || status?.doing !== "asking") return null;
    return asked;
  }

  get bright(): string {
    return this.tag;
  }

  /** Show an object in frame and room alike; empty for none. */
  point(tag: string): void {
    if (this.tag === tag) return;
    this.tag = tag;
    this.pointed.tell();
  }

  /** The id of an object by its tag or the short form of it; null if there is none. */
  objectOf(tag: string): number | null {
    const { objects } = this.hello.scene;
    const found = objects.find((object) => object.tag === tag);
    return found?.id ?? null;
  }
}
