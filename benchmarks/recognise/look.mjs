// Looks for people: node look.mjs PACKAGES FOLDER. Prints one line of JSON for each picture in the folder,
// NAME_WIDTHxHEIGHT.rgb, three bytes a pixel. Nothing is fetched: models are files of the package.

import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [packages, folder] = process.argv.slice(2).map((path) => resolve(path));
// Node's own fetch reads no files, and here nothing else is to be read.
globalThis.fetch = async (url) => {
  const type = String(url).endsWith(".json") ? "application/json" : "application/octet-stream";
  return new Response(readFileSync(new URL(url)), { headers: { "content-type": type } });
};
const within = (...path) => join(packages, "node_modules", ...path);
const { Human } = createRequire(import.meta.url)(within("@vladmandic", "human", "dist", "human.node-wasm.js"));
const off = { enabled: false };
const human = new Human({
  backend: "wasm",
  wasmPath: within("@tensorflow", "tfjs-backend-wasm", "dist", "/"),
  modelBasePath: pathToFileURL(within("@vladmandic", "human", "models", "/")).href,
  cacheSensitivity: 0,
  filter: off,
  gesture: off,
  hand: off,
  face: { mesh: off, iris: off, emotion: off, description: off },
  body: off,
  object: { enabled: true },
});
await human.load();
for (const file of readdirSync(folder).sort()) {
  const [, name, width, height] = /^(.*)_(\d+)x(\d+)\.rgb$/.exec(file);
  const picture = human.tf.tensor3d(new Uint8Array(readFileSync(join(folder, file))), [+height, +width, 3], "int32");
  const seen = await human.detect(picture);
  picture.dispose();
  if (seen.error) throw new Error(seen.error);
  const people = seen.object.filter(({ label }) => label === "person");
  const surest = (found) => Math.max(0, ...found.map(({ score }) => score));
  console.log(JSON.stringify({ name, person: surest(people), face: surest(seen.face) }));
}
