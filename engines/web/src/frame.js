// Between ADAMO's frame (Z up) and that of the meshes and of Babylon.js, right-handed with Y up: x stays, y is up, z is -y.

export const toPage = (p) => [p.x, p.z, -p.y];
export const fromPage = (p) => ({ x: p.x, y: -p.z, z: p.y });
export const turnToPage = (q) => [q.x, q.z, -q.y, q.w];
export const turnFromPage = (q) => ({ w: q.w, x: q.x, y: -q.z, z: q.y });
