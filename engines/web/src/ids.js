// From the flat colours of a second pass to the object at each pixel.

export const NO_OBJECT = 65535;

/** RGBA rows from below, as WebGL reads them, as rows from the top of 16-bit numbers. */
export function idsOf(rgba, width, height) {
  const ids = new Uint16Array(width * height);
  for (let row = 0; row < height; row++) {
    let from = (height - 1 - row) * width * 4;
    for (let to = row * width; to < (row + 1) * width; to++, from += 4)
      ids[to] = rgba[from] > 127 ? NO_OBJECT : rgba[from + 1] * 256 + rgba[from + 2];
  }
  return ids;
}

/** Every object that a layer shows, ascending. */
export function shownIn(layers) {
  const shown = new Set();
  for (const layer of layers) for (const id of layer) shown.add(id);
  shown.delete(NO_OBJECT);
  return [...shown].sort((a, b) => a - b);
}
