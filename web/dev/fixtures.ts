// While the page is worked on alone: answers its requests from a folder of recorded files.
// Set STUDIO_FIXTURES to a folder with offer.json, SCENE.glb, FIGURE.glb, RUN.json and frames/.

import { existsSync, readFileSync } from "node:fs";
import type { IncomingMessage, ServerResponse } from "node:http";
import { join } from "node:path";
import type { Plugin } from "vite";

const TYPES: Record<string, string> = { json: "application/json", glb: "model/gltf-binary", jpg: "image/jpeg", png: "image/png" };

/** The file that answers an address; empty for none. */
export function fileFor(url: string): string {
  const path = decodeURIComponent(new URL(url, "http://localhost").pathname);
  const found =
    /^\/api\/(?:scenes|figures)\/([\w-]+\.glb)$/.exec(path) ??
    /^\/api\/runs\/[\w-]+\/(frames\/[\w.]+)$/.exec(path) ??
    /^\/api\/(offer)$/.exec(path) ??
    /^\/api\/runs\/([\w-]+)\/track$/.exec(path);
  if (!found?.[1]) return "";
  return /\.\w+$/.test(found[1]) ? found[1] : `${found[1]}.json`;
}

type Answering = (request: IncomingMessage, response: ServerResponse, next: () => void) => void;

/** Answer from a folder what it holds; the rest goes on to the next. */
export function answering(folder: string): Answering {
  return (request, response, next) => {
    const name = fileFor(request.url ?? "");
    const file = name && join(folder, name);
    if (!file || !existsSync(file)) return next();
    response.setHeader("content-type", TYPES[file.split(".").at(-1) ?? ""] ?? "text/plain");
    response.end(readFileSync(file));
  };
}

export function fixtures(): Plugin {
  const folder = process.env.STUDIO_FIXTURES;
  const answer = folder ? answering(folder) : null;
  return {
    name: "fixtures",
    configureServer: ({ middlewares }) => {
      if (answer) middlewares.use(answer);
    },
    configurePreviewServer: ({ middlewares }) => {
      if (answer) middlewares.use(answer);
    },
  };
}
