// Take part: put a thing elsewhere by dragging it. Where it would come to rest, a ghost shows it.

import { Group, Mesh, MeshBasicMaterial, type Object3D, Quaternion } from "three";
import { spoken, whereIs } from "../mind/words.ts";
import type { Show } from "../show.ts";
import { halfExtents } from "../view/contact.ts";
import { meshesIn } from "../view/loading.ts";
import type { Hit } from "../view/pointing.ts";
import type { Seeing } from "../view/seeing.ts";

const LEVEL = 0.8;
/** A surface whose outward direction points up at least this much carries things. */
const MOVED_M = 0.03;
const GOOD = 0xf0976a;
const BAD = 0xc0392b;

export class Drag {
  private ghost: Group | null = null;
  private readonly look = new MeshBasicMaterial({ color: GOOD, transparent: true, opacity: 0.6, depthWrite: false });
  private id = -1;
  private point: [number, number, number] | null = null;

  constructor(
    private readonly show: Show,
    private readonly seeing: Seeing,
  ) {}

  /** Begin, if this can be dragged. */
  grab(hit: Hit): boolean {
    const { stage } = this.seeing;
    const thing = hit.objectId === null ? undefined : stage?.room.things.get(hit.objectId);
    if (!stage || !thing || hit.objectId === null || !this.show.may("move")) return false;
    if (stage.moment?.held === hit.objectId) {
      this.seeing.tell("She holds it. Ask her to put it down.");
      return false;
    }
    this.id = hit.objectId;
    this.point = null;
    this.ghost = ghostOf(thing, this.look);
    this.ghost.visible = false;
    stage.scene.add(this.ghost);
    return true;
  }

  drag(event: PointerEvent): void {
    const { stage, pointing } = this.seeing;
    const { ghost } = this;
    const thing = stage?.room.things.get(this.id);
    const object = this.show.hello.scene.objects.find(({ id }) => id === this.id);
    if (!ghost || !thing || !object || !stage) return;
    const hit = pointing?.at(event, this.id) ?? null;
    ghost.visible = hit !== null;
    stage.touch();
    if (!hit) return;
    const up = halfExtents(object.size, new Quaternion().copy(thing.quaternion)).z;
    const isGood = hit.normal.z > LEVEL;
    const middle = hit.point.z + up;
    ghost.position.set(hit.point.x, hit.point.y, middle);
    this.look.color.setHex(isGood ? GOOD : BAD);
    const isFar = ghost.position.distanceTo(thing.position) > MOVED_M;
    this.point = isGood && isFar ? [hit.point.x, hit.point.y, hit.point.z] : null;
    const where = whereIs([hit.point.x, hit.point.y, middle], this.show.hello.scene);
    this.seeing.tell(isGood ? `Put ${spoken(object.tag)} on ${where || "this"}` : "Things stay only on what is level");
  }

  release(): void {
    const { stage } = this.seeing;
    if (this.ghost) stage?.scene.remove(this.ghost);
    this.ghost = null;
    stage?.touch();
    this.seeing.tell("");
    if (!this.point) return;
    const rounded = this.point.map((value) => Number(value.toFixed(3))) as [number, number, number];
    this.show.say({ type: "move", object_id: this.id, point: rounded });
    this.point = null;
  }
}

function ghostOf(thing: Object3D, look: MeshBasicMaterial): Group {
  const ghost = new Group();
  ghost.quaternion.copy(thing.quaternion);
  const back = thing.matrixWorld.clone().invert();
  for (const mesh of meshesIn(thing)) {
    const copy = new Mesh(mesh.geometry, look);
    copy.applyMatrix4(back.clone().multiply(mesh.matrixWorld));
    ghost.add(copy);
  }
  return ghost;
}
