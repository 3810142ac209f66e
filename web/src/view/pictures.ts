// The pictures of a file are unpacked beside the rest of it: shapes need not wait for them.

import {
  ClampToEdgeWrapping,
  LinearFilter,
  LinearMipmapLinearFilter,
  LinearMipmapNearestFilter,
  type MagnificationTextureFilter,
  type MinificationTextureFilter,
  MirroredRepeatWrapping,
  NearestFilter,
  NearestMipmapLinearFilter,
  NearestMipmapNearestFilter,
  RepeatWrapping,
  Texture,
  type Wrapping,
} from "three";
import type { GLTFLoaderPlugin, GLTFParser } from "three/addons/loaders/GLTFLoader.js";

const FILTERS: Readonly<Record<number, number>> = {
  9728: NearestFilter,
  9729: LinearFilter,
  9984: NearestMipmapNearestFilter,
  9985: LinearMipmapNearestFilter,
  9986: NearestMipmapLinearFilter,
  9987: LinearMipmapLinearFilter,
};
const WRAPPINGS: Readonly<Record<number, Wrapping>> = {
  10497: RepeatWrapping,
  33071: ClampToEdgeWrapping,
  33648: MirroredRepeatWrapping,
};

const WHITE = new Uint8ClampedArray([255, 255, 255, 255]);

interface Sampler {
  magFilter?: number;
  minFilter?: number;
  wrapS?: number;
  wrapT?: number;
}

export class Pictures implements GLTFLoaderPlugin {
  readonly name = "pictures";
  private readonly coming: Promise<void>[] = [];

  constructor(private readonly parser: GLTFParser) {}

  /** When all are there. */
  get ready(): Promise<unknown> {
    return Promise.all(this.coming);
  }

  /** A texture whose picture is on its way; null leaves it to the loader. */
  loadTexture(index: number): Promise<Texture> | null {
    const { json, associations } = this.parser;
    const { source, sampler, extensions } = json.textures[index];
    const { bufferView, mimeType } = json.images[source] ?? {};
    if (extensions || bufferView === undefined) return null;
    const texture = new Texture();
    const { magFilter = 9729, minFilter = 9987, wrapS = 10497, wrapT = 10497 }: Sampler = json.samplers?.[sampler] ?? {};
    texture.flipY = false;
    texture.magFilter = (FILTERS[magFilter] ?? LinearFilter) as MagnificationTextureFilter;
    texture.minFilter = (FILTERS[minFilter] ?? LinearMipmapLinearFilter) as MinificationTextureFilter;
    texture.wrapS = WRAPPINGS[wrapS] ?? RepeatWrapping;
    texture.wrapT = WRAPPINGS[wrapT] ?? RepeatWrapping;
    texture.generateMipmaps = minFilter > 9729;
    associations.set(texture, { textures: index });
    this.coming.push(this.fill(texture, bufferView, mimeType));
    return Promise.resolve(texture);
  }

  private async fill(texture: Texture, view: number, type: string): Promise<void> {
    const packed = (await this.parser.getDependency("bufferView", view)) as ArrayBuffer;
    const whole = createImageBitmap(new Blob([packed], { type }), { premultiplyAlpha: "none", colorSpaceConversion: "none" });
    // A picture that cannot be unpacked costs its surface the pattern, and not the page its room.
    texture.image = await whole.catch(() => createImageBitmap(new ImageData(WHITE, 1, 1)));
    texture.needsUpdate = true;
  }
}
