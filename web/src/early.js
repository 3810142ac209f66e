// Asks for the run that the address names, its track and its meshes, while the page's script is still on its way.
// The page finds them there when it asks for them; where it does not, nothing is lost.
{
  const run = new URLSearchParams(location.hash.slice(1)).get("run");
  const at = run && `api/runs/${run.split("/").map(encodeURIComponent).join("/")}`;
  for (const part of at ? ["track", "scene.glb", "figure.glb"] : []) {
    const link = document.createElement("link");
    document.head.append(Object.assign(link, { rel: "preload", as: "fetch", crossOrigin: "anonymous", href: `${at}/${part}` }));
  }
}
