// A small room with a table, a cup and a box, as scene.json has it.

const UPRIGHT = { w: 1, x: 0, y: 0, z: 0 };
const box = (x, y, z, size) => ({ center: { x, y, z }, size: { x: size, y: size, z: size }, orientation: UPRIGHT });

export const ROOM = {
  format: 1,
  mesh: "room_shell.glb",
  scene: { name: "room", x_min: -2, y_min: -2, x_max: 2, y_max: 2, height_m: 2.5, areas: [], variation: 0 },
  body: {
    figure: "mara", radius_m: 0.25, eye_height_m: 1.6, fov_y_rad: 1.29, reach_m: 0.9, reach_top_m: 2.07, correction_m: 0.5,
    max_pitch_rad: 1.4,
  },
  start: { position: { x: -1.5, y: 0, z: 0 }, heading_rad: 0, gaze: { x: 0.5, y: 0, z: 0.8 } },
  furniture: [{
    name: "table", mesh: "table.glb", points: [[0, -0.5], [1, -0.5], [1, 0.5], [0, 0.5]], bottom_m: 0, top_m: 0.7,
    surfaces: [{ support: "table", center: { x: 0.5, y: 0, z: 0.7 }, half_x: 0.5, half_y: 0.5, yaw_rad: 0 }],
    solids: [{ x: 0.5, y: 0, half_x: 0.5, half_y: 0.5, yaw_rad: 0, z_min: 0, z_max: 0.7 }],
  }],
  objects: [
    { id: 1, class_name: "Cup", mesh: "cup.glb", box: box(0.3, 0, 0.75, 0.1), support: "table", held: false },
    { id: 2, class_name: "Box", mesh: "box.glb", box: box(0.7, 0.2, 0.75, 0.1), support: "table", held: false },
  ],
};

/** Rest where it was put, on what a spot was found on: physics for a room where everything is flat. */
export const flat = (id, box) => ({ box, support: box.center.z - box.size.z / 2 < 0.1 ? "floor" : "table" });
