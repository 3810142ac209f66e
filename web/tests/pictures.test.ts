import type { GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import { afterEach, expect, test, vi } from "vitest";
import { Pictures } from "../src/view/pictures.ts";

const BROKEN = new Uint8Array([1, 2, 3]).buffer;
const GOOD = new Uint8Array([137, 80, 78, 71]).buffer;

/** A file with two pictures, the second of which nothing can unpack. */
const parser = {
  json: { textures: [{ source: 0 }, { source: 1 }], images: [{ bufferView: 0 }, { bufferView: 1 }] },
  associations: new Map(),
  getDependency: (_: string, view: number) => Promise.resolve(view ? BROKEN : GOOD),
} as unknown as GLTFParser;

afterEach(() => vi.unstubAllGlobals());

test("a picture that cannot be unpacked is white, and keeps nothing else from being shown", async () => {
  class Pixels {
    constructor(readonly data: Uint8ClampedArray) {}
  }
  vi.stubGlobal("ImageData", Pixels);
  vi.stubGlobal("createImageBitmap", async (from: Blob | Pixels) => {
    if (from instanceof Pixels) return [...from.data];
    if (from.size === BROKEN.byteLength) throw new DOMException("The source image could not be decoded.");
    return "whole";
  });
  const pictures = new Pictures(parser);
  const textures = await Promise.all([pictures.loadTexture(0), pictures.loadTexture(1)]);
  await pictures.ready;
  expect(textures.map((texture) => texture?.image)).toEqual(["whole", [255, 255, 255, 255]]);
});
