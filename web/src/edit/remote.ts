// What the editor asks the server.

import { fields, text } from "../reading.ts";
import { addressOf, getJson, postJson } from "../server.ts";
import { type Catalog, type Finding, readCatalog, readFindings, readScene, type SceneData } from "./scene.ts";

const part = encodeURIComponent;

export async function getScene(name: string): Promise<SceneData> {
  return readScene(fields(await getJson(`scenes/${part(name)}`)).data);
}

export const getCatalog = async (): Promise<Catalog> => readCatalog(await getJson("catalog"));

export async function checkScene(data: SceneData): Promise<Finding[]> {
  return readFindings(fields(await postJson("scenes/check", { data })).findings);
}

/** What is sent to save a scene; it gets the name of its file. */
export const saving = (data: SceneData, name: string, replace: boolean): unknown => ({
  name,
  replace,
  data: { ...data, name, variation: 0 },
});

/** Returns what the scene is called from then on. */
export async function saveScene(data: SceneData, name: string, replace: boolean): Promise<string> {
  return text(fields(await postJson("scenes", saving(data, name, replace))).scene);
}

export const meshOfScene = (name: string): string => addressOf(`scenes/${part(name)}.glb`).href;
export const meshOfAsset = (name: string): string => addressOf(`assets/${part(name)}.glb`).href;
