// Builds the page into dist/: one script, Havok's program, and the page itself.

import { build } from "esbuild";
import { copyFile, mkdir } from "node:fs/promises";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const out = `${here}dist`;
await mkdir(`${out}/scenes`, { recursive: true });
await build({
  absWorkingDir: here, entryPoints: ["src/main.js"], outdir: out, bundle: true, minify: true, format: "esm", target: "es2022",
  logLevel: "warning", external: ["module", "fs", "path", "url"],
});
await copyFile(`${here}index.html`, `${out}/index.html`);
await copyFile(`${here}node_modules/@babylonjs/havok/lib/esm/HavokPhysics.wasm`, `${out}/HavokPhysics.wasm`);
