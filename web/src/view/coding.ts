// Light as it is kept for a corner of a triangle: a byte for each colour.

/** How bright the picture is drawn as a whole. */
export const EXPOSURE = 1.05;
/** The brightest that a byte holds, as the root of a light. */
export const MOST = 2;

/** A light in a byte: its root, because eyes tell dark shades apart better. */
export const coded = (light: number): number => (255 / MOST) * Math.sqrt(EXPOSURE * light);
