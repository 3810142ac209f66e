// What draws the pictures: a graphics card, or a processor in place of one.

let known: boolean | null = null;

/** Whether rooms are drawn plainly: where a processor draws, or as the address asks for. */
export function drawsPlainly(): boolean {
  const asked = new URLSearchParams(location.search).get("quality");
  return isSoftware() ? asked !== "full" : asked === "plain";
}

/** Whether a processor draws; then nothing on the page moves that need not. */
export function isSoftware(): boolean {
  if (known !== null) return known;
  const gl = document.createElement("canvas").getContext("webgl2");
  const about = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl && about ? String(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  known = /swiftshader|llvmpipe|software|basic render/i.test(name);
  document.documentElement.classList.toggle("calm", known);
  return known;
}
