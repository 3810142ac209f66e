// The pointer over the room: turns, moves and zooms the free camera; everything else is asked first.

const TURN = 0.006;
const CLICK_PX = 5;

/** The camera that is moved. */
export interface Steered {
  readonly kind: string;
  choose: (kind: "free") => void;
  turn: (dx: number, dy: number) => void;
  zoom: (factor: number) => void;
  pan: (dx: number, dy: number) => void;
}

export interface PointerUser {
  /** Returns true to have the movement for itself, e.g. to drag a thing. */
  down: (event: PointerEvent) => boolean;
  move: (event: PointerEvent) => void;
  up: () => void;
  click: (event: PointerEvent) => void;
  hover: (event: PointerEvent) => void;
  /** The free camera was moved by hand. */
  steered: () => void;
}

export function steer(canvas: HTMLCanvasElement, cameras: Steered, user: PointerUser): void {
  const held = new Map<number, { x: number; y: number }>();
  let begin = { x: 0, y: 0 };
  let taken = false;
  let moved = false;

  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    begin = { x: event.clientX, y: event.clientY };
    moved = false;
    taken = held.size === 1 && event.button === 0 && user.down(event);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) {
      user.hover(event);
      return;
    }
    const now = { x: event.clientX, y: event.clientY };
    if (Math.hypot(now.x - begin.x, now.y - begin.y) > CLICK_PX) moved = true;
    if (taken) user.move(event);
    else if (moved) drag(event, before, now);
    held.set(event.pointerId, now);
  });
  const drag = (event: PointerEvent, before: { x: number; y: number }, now: { x: number; y: number }): void => {
    if (cameras.kind !== "free") cameras.choose("free");
    user.steered();
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    if (held.size === 2) {
      const other = [...held.entries()].find(([id]) => id !== event.pointerId)?.[1];
      if (!other) return;
      const far = (p: { x: number; y: number }): number => Math.hypot(p.x - other.x, p.y - other.y);
      if (far(now) > 1) cameras.zoom(far(before) / far(now));
      cameras.pan(dx / 2 / canvas.clientHeight, dy / 2 / canvas.clientHeight);
    } else if (event.buttons & 2 || event.shiftKey) cameras.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
    else cameras.turn(dx * TURN, dy * TURN);
  };
  const end = (event: PointerEvent): void => {
    held.delete(event.pointerId);
    if (taken) user.up();
    if (!moved && event.type === "pointerup" && event.button === 0) user.click(event);
    taken = false;
  };
  canvas.addEventListener("pointerup", end);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      if (cameras.kind !== "free") cameras.choose("free");
      cameras.zoom(Math.exp(event.deltaY * 0.0012));
      user.steered();
    },
    { passive: false },
  );
}
