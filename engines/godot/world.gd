extends Spatial
# The world behind the messages: what is where, and what the body does. Plain numbers in ADAMO's
# frame (right-handed, z up, metres); only the stage speaks Godot's.

const Stage = preload("res://stage.gd")
const Solids = preload("res://solids.gd")
const FloorMap = preload("res://floor_map.gd")

const AS_ASKED = 0.05
const CLEARANCE = 0.010
const EDGE = 0.005
const STEP = 0.02
const EYE_FORWARD = 0.08
const SHOULDERS = [1.35, 0.7]
const OVERHEAD = 1.75
const MOST_SPOTS = 60
const APART = 0.06

var _data
var _stage
var _info
var _objects = {}
var _ids = []
var _position = [0.0, 0.0, 0.0]
var _heading = 0.0
var _gaze = [0.0, 0.0, 0.0]
var _held = -1
var _brightness = []
var _map = null
var _offsets = []

func load_scene(folder):
	var file = File.new()
	file.open(folder + "/scene.json", File.READ)
	_data = parse_json(file.get_as_text())
	file.close()
	_info = _data.body
	_stage = Stage.new()
	add_child(_stage)
	_stage.build(_data, folder)
	for item in _data.objects:
		_ids.append(int(item.id))
	_ids.sort()
	_make_offsets()
	reset()
	var names = {}
	for item in _data.objects:
		names[str(int(item.id))] = item["class_name"]
	var outlines = []
	for piece in _data.furniture:
		outlines.append({
			"name": piece.name, "points": piece.points, "bottom_m": piece.bottom_m,
			"top_m": piece.top_m, "surfaces": piece.surfaces,
		})
	var scene = _data.scene.duplicate()
	scene.erase("title")
	scene["variation"] = int(scene["variation"])
	return {"scene": scene, "object_names": names, "furniture": outlines}

func body_info():
	var info = _info.duplicate()
	info.erase("max_pitch_rad")
	return info

func reset():
	_objects = {}
	for item in _data.objects:
		var c = item.box.center
		var s = item.box.size
		var q = item.box.orientation
		_objects[int(item.id)] = {
			"class_name": item["class_name"], "center": [c.x, c.y, c.z], "size": [s.x, s.y, s.z],
			"q": [q.w, q.x, q.y, q.z], "support": item.support, "gone": false,
		}
	var start = _data.start
	_position = _list(start.position)
	_heading = start.heading_rad
	_gaze = _list(start.gaze)
	_held = -1
	_brightness = []
	for light in _data.lights:
		_brightness.append(light.diffuse)
	_update()

# Brings the stage to what the numbers say.
func _update():
	_map = null
	for id in _ids:
		var item = _objects[id]
		_stage.show_thing(id, not item.gone)
		_stage.put(id, item.center, item.q)
	for i in range(_brightness.size()):
		_stage.lights[i].light_energy = _brightness[i] * 1.1

static func _list(p):
	return [float(p.x), float(p.y), float(p.z)]

static func _point(p):
	return {"x": p[0], "y": p[1], "z": p[2]}

static func _far(a, b):
	return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2))

static func _distance(a, b):
	return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2))

# --- what is known -----------------------------------------------------------------------------

func _box(id):
	var item = _objects[id]
	var q = item.q
	return {
		"center": _point(item.center), "size": _point(item.size),
		"orientation": {"w": q[0], "x": q[1], "y": q[2], "z": q[3]},
	}

func _eyes():
	return [
		_position[0] + cos(_heading) * EYE_FORWARD, _position[1] + sin(_heading) * EYE_FORWARD,
		float(_info.eye_height_m),
	]

func body_state():
	return {
		"position": _point(_position), "heading_rad": _heading, "gaze": _point(_gaze),
		"eyes": _point(_eyes()), "held": null if _held < 0 else _held,
		"held_box": null if _held < 0 else _box(_held),
	}

func state():
	var found = []
	for id in _ids:
		var item = _objects[id]
		if not item.gone:
			found.append({
				"id": id, "class_name": item["class_name"], "box": _box(id), "held": id == _held,
				"support": null if id == _held else item.support,
			})
	return {"objects": found, "bodies": {"agent": body_state()}}

func snapshot():
	var all = {
		"scene": _data.scene.name, "objects": _objects, "position": _position, "heading": _heading,
		"gaze": _gaze, "held": _held, "brightness": _brightness,
	}
	return Marshalls.variant_to_base64(all)

func restore(text):
	# A text that is no base64 makes Godot complain in its log; the answer is the same.
	var raw = Marshalls.base64_to_raw(text) if text.length() % 4 == 0 else PoolByteArray()
	var all = bytes2var(raw) if raw.size() > 8 else null
	if not all is Dictionary or not all.has_all(["scene", "objects", "position", "held", "brightness"]):
		return "the snapshot is damaged."
	if all.scene != _data.scene.name or all.objects.size() != _ids.size():
		return "the snapshot is of another scene."
	_objects = all.objects
	_position = all.position
	_heading = all.heading
	_gaze = all.gaze
	_held = all.held
	_brightness = all.brightness
	_update()
	return {}

# --- what is seen ------------------------------------------------------------------------------

func capture(width, height, aim, attached):
	var eyes = _eyes()
	var at = _gaze
	var fov = float(_info.fov_y_rad)
	if aim != null:
		at = _list(aim.point)
		fov = float(aim.fov_y_rad)
	var flat = _far(at, eyes)
	var yaw = atan2(at[1] - eyes[1], at[0] - eyes[0]) if flat > 1e-6 else _heading
	var pitch = atan2(at[2] - eyes[2], flat)
	for picture in _stage.capture(eyes, yaw, pitch, fov, Vector2(width, height)):
		attached.append(picture)
	var seen = []
	for id in _ids:
		if not _objects[id].gone:
			seen.append({"id": id, "box": _box(id)})
	return {
		"camera": {"position": _point(eyes), "yaw_rad": yaw, "pitch_rad": pitch, "fov_y_rad": fov},
		"body": body_state(), "objects": seen, "colour": "rgb8", "ids": "rgb555", "layers": 1,
	}

func rays(origin, directions):
	var skipped = [] if _held < 0 else [_stage.things[_held]]
	var found = []
	for way in directions:
		var hit = _stage.ray(_list(origin), _list(way), skipped)
		found.append(null if hit == null else Stage.there(hit))
	return found

# --- what is done ------------------------------------------------------------------------------

func _report(outcome, code, point = null, walked = 0.0, support = null):
	return {
		"outcome": outcome, "code": code, "point": null if point == null else _point(point),
		"walked_m": walked, "support": support,
	}

# Turns to a point; whether the neck turned all the way.
func _face(point):
	if _far(point, _position) > 0.05:
		_heading = atan2(point[1] - _position[1], point[0] - _position[0])
	var eyes = _eyes()
	var ahead = _far(point, eyes) if _far(point, _position) > EYE_FORWARD else 0.0
	var pitch = atan2(point[2] - eyes[2], ahead)
	var limit = float(_info.max_pitch_rad)
	_gaze = point
	var exact = abs(pitch) <= limit
	if not exact:
		var far = max(0.3, _distance(point, eyes))
		pitch = limit * sign(pitch)
		_gaze = [
			eyes[0] + cos(_heading) * cos(pitch) * far, eyes[1] + sin(_heading) * cos(pitch) * far,
			eyes[2] + sin(pitch) * far,
		]
	_carry()
	return exact

# Brings what is held to the hand.
func _carry():
	if _held >= 0:
		var c = cos(_heading)
		var s = sin(_heading)
		_objects[_held].center = [
			_position[0] + c * 0.38 + s * 0.22, _position[1] + s * 0.38 - c * 0.22, 1.05,
		]
		_stage.put(_held, _objects[_held].center, _objects[_held].q)

func look(target):
	if _face(_list(target)):
		return _report("done", "ok", _gaze)
	return _report("corrected", "gaze_limited", _gaze)

func walk(target):
	var point = _list(target)
	var way = _floor().way_to_nearest(_position[0], _position[1], point[0], point[1])
	var walked = _go(way)
	if _far(_position, point) <= AS_ASKED:
		return _report("done", "ok", _position, walked)
	return _report("corrected", "stopped_short", _position, walked)

func pick(id):
	if not _objects.has(id):
		return "there is no object of that id."
	if _held >= 0:
		return _report("refused", "hand_full")
	if _objects[id].gone:
		return _report("refused", "gone")
	var target = _objects[id].center
	var way = _way_to(target, float(_info.radius_m) if target[2] < OVERHEAD else 0.0)
	if way == null:
		return _unreachable(target)
	var walked = _go(way)
	_face(target)
	_held = id
	_let_down(id)
	_carry()
	_map = null
	return _report("done", "repositioned" if walked > 0 else "ok", target, walked)

# What lay on an object sinks to what that lay on.
func _let_down(id):
	var taken = _objects[id]
	var shape = Solids.around(taken.center, taken.size, taken.q)
	for other in _ids:
		if _objects[other].support == "object %d" % id and other != id:
			_objects[other].support = taken.support
			_objects[other].center[2] -= shape.z_max - shape.z_min
			_stage.put(other, _objects[other].center, _objects[other].q)

func drop(target):
	if _held < 0:
		return _report("refused", "hand_empty")
	var point = _list(target)
	var shape = _solid(_held)
	var checked = []
	var spots = _spots(point, _held)
	if spots.empty():
		return _report("refused", "no_free_spot")
	var keep_off = float(_info.radius_m) + sqrt(pow(shape.half_x, 2) + pow(shape.half_y, 2)) + 0.01
	for spot in spots:
		if checked.size() >= MOST_SPOTS or not _is_apart(spot, checked):
			continue
		checked.append(spot)
		var way = _way_to(spot.center, keep_off)
		if way == null:
			continue
		var walked = _go(way)
		_face(spot.center)
		var id = _held
		_held = -1
		_lay(id, spot)
		var missed = _far(spot.center, point)
		if missed <= AS_ASKED and spot.missed <= AS_ASKED:
			var code = "repositioned" if walked > 0 else "ok"
			return _report("done", code, spot.center, walked, spot.support)
		return _report("corrected", "placed_elsewhere", spot.center, walked, spot.support)
	return _unreachable(point)

func _is_apart(spot, others):
	for other in others:
		if other.support == spot.support and _far(other.center, spot.center) < APART:
			return false
	return true

func _lay(id, spot):
	_objects[id].center = spot.center
	_objects[id].support = spot.support
	_stage.put(id, spot.center, _objects[id].q)
	_map = null

func _unreachable(target):
	var way = _floor().way_to_nearest(_position[0], _position[1], target[0], target[1])
	return _report("refused", "unreachable", [way[-1][0], way[-1][1], 0.0])

# Walks a way of [x, y] corners; how long it was.
func _go(way):
	var length = 0.0
	for i in range(1, way.size()):
		length += _far(way[i - 1], way[i])
	if length <= 0:
		return 0.0
	var before = way[-2]
	var end = way[-1]
	_heading = atan2(end[1] - before[1], end[0] - before[0])
	_position = [end[0], end[1], 0.0]
	var eyes = _eyes()
	_gaze = [eyes[0] + cos(_heading), eyes[1] + sin(_heading), eyes[2]]
	_carry()
	return length

func _solid(id):
	return Solids.around(_objects[id].center, _objects[id].size, _objects[id].q)

func _floor():
	if _map == null:
		var solids = []
		for piece in _data.furniture:
			solids += piece.solids
		for id in _ids:
			if id != _held and not _objects[id].gone:
				var solid = _solid(id)
				if solid.z_min < 0.3:
					solids.append(solid)
		_map = FloorMap.new(_data.scene, float(_info.radius_m), solids)
	return _map

func _can_reach(x, y, target):
	if target[2] > _info.reach_top_m:
		return false
	for height in SHOULDERS:
		if _stage.line_is_free([x, y, height], target):
			return true
	return false

# The way to a place from which a target can be handled; only the own place if it is one.
func _way_to(target, keep_off):
	var reach = float(_info.reach_m)
	var far = _far(_position, target)
	if far >= keep_off and far <= reach and _can_reach(_position[0], _position[1], target):
		return [[_position[0], _position[1]]]
	var map = _floor()
	var found = []
	for cell in map.reached_from(_position[0], _position[1]):
		var place = map.place_of(cell)
		var off = _far([place.x, place.y], target)
		if off <= reach - 0.02 and off >= keep_off:
			found.append([_far([place.x, place.y], _position) + 0.01 * off, cell])
	found.sort_custom(self, "_nearer")
	for pair in found:
		var place = map.place_of(pair[1])
		if _can_reach(place.x, place.y, target):
			return map.way(_position[0], _position[1], pair[1], [place.x, place.y])
	return null

func _nearer(a, b):
	return a[0] < b[0] or (a[0] == b[0] and a[1] < b[1])

# Offsets from a wished point, nearest first.
func _make_offsets():
	var most = float(_info.correction_m)
	var count = int(round(most / STEP))
	for i in range(-count, count + 1):
		for j in range(-count, count + 1):
			var far = sqrt(i * i + j * j) * STEP
			if far <= most:
				_offsets.append([far, i * STEP, j * STEP])
	_offsets.sort_custom(self, "_before")

func _before(a, b):
	if a[0] != b[0]:
		return a[0] < b[0]
	return a[1] < b[1] or (a[1] == b[1] and a[2] < b[2])

# Free spots for an object, nearest to the wish first: {support, center, missed, far}.
func _spots(wish, id):
	var shape = _solid(id)
	var height = shape.z_max - shape.z_min
	var most = float(_info.correction_m)
	var near = []
	for piece in _data.furniture:
		near += piece.solids
	for other in _ids:
		if other != id and not _objects[other].gone:
			near.append(_solid(other))
	var room = _data.scene
	var surfaces = [{
		"support": "floor", "yaw_rad": 0.0,
		"center": {"x": (room.x_min + room.x_max) / 2, "y": (room.y_min + room.y_max) / 2, "z": 0.0},
		"half_x": (room.x_max - room.x_min) / 2, "half_y": (room.y_max - room.y_min) / 2,
	}]
	for piece in _data.furniture:
		surfaces += piece.surfaces
	var found = []
	for surface in surfaces:
		var top = float(surface.center.z)
		var lift = wish[2] - top
		# A wish between a surface and the top of the thing put there means this surface.
		var missed = max(max(-lift, lift - height), 0.0)
		if missed <= most:
			_add_spots(found, wish, shape, surface, missed, _beside(near, wish, shape, top, height))
	found.sort_custom(self, "_closer")
	return found

func _beside(near, wish, shape, top, height):
	var far = float(_info.correction_m) + sqrt(pow(shape.half_x, 2) + pow(shape.half_y, 2)) + CLEARANCE
	var found = []
	for solid in near:
		var reach = far + sqrt(pow(solid.half_x, 2) + pow(solid.half_y, 2))
		if Solids.overlaps_height(solid, top, top + height) and _far([solid.x, solid.y], wish) < reach:
			found.append(solid)
	return found

func _add_spots(found, wish, shape, surface, missed, beside):
	var put = shape.duplicate()
	var height = shape.z_max - shape.z_min
	var count = 0
	for offset in _offsets:
		var far = sqrt(offset[0] * offset[0] + missed * missed)
		if far > float(_info.correction_m) or count >= 400:
			break
		put.x = wish[0] + offset[1]
		put.y = wish[1] + offset[2]
		if Solids.lies_on(put, surface, EDGE) and _is_clear(put, beside):
			count += 1
			var center = [put.x, put.y, float(surface.center.z) + height / 2]
			found.append({"support": surface.support, "center": center, "missed": missed, "far": far})

func _is_clear(put, beside):
	for solid in beside:
		if not Solids.are_apart(put, solid, CLEARANCE):
			return false
	return true

func _closer(a, b):
	if a.far != b.far:
		return a.far < b.far
	return _nearer([a.center[0], a.center[1]], [b.center[0], b.center[1]])

# --- what happens without the body -------------------------------------------------------------

func apply(event):
	if event.type == "light_changed":
		var light = int(event.light)
		if light < 0 or light >= _brightness.size() or event.diffuse < 0 or event.diffuse > 1:
			return "there is no such light, or it cannot be that bright."
		_brightness[light] = float(event.diffuse)
		_update()
		return {}
	var id = int(event.object_id)
	if not _objects.has(id):
		return "there is no such object."
	var is_back = event.type == "object_added"
	if id == _held or _objects[id].gone != is_back:
		return "that object is in the hand, or not where it would have to be."
	if event.type == "object_taken":
		_objects[id].gone = true
		_let_down(id)
	else:
		var spots = _spots(_list(event.point), id)
		if spots.empty():
			return "there is no free spot."
		_objects[id].gone = false
		_let_down(id)
		_lay(id, spots[0])
	_update()
	return {}
