extends Reference
# Upright prisms over turned rectangles: how placement and walking see things. A solid is a
# dictionary {x, y, half_x, half_y, yaw_rad, z_min, z_max}, in metres in ADAMO's frame.

# The prism that holds an oriented box, aligned with its heading.
static func around(center, size, q):
	var w = q[0]
	var x = q[1]
	var y = q[2]
	var z = q[3]
	var yaw = atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
	# Rows of the rotation, world from local.
	var rows = [
		[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
		[2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
		[2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
	]
	var reach = []
	for row in [_turned(rows, yaw, 0), _turned(rows, yaw, 1), rows[2]]:
		reach.append((abs(row[0]) * size[0] + abs(row[1]) * size[1] + abs(row[2]) * size[2]) / 2)
	return {
		"x": center[0], "y": center[1], "half_x": reach[0], "half_y": reach[1], "yaw_rad": yaw,
		"z_min": center[2] - reach[2], "z_max": center[2] + reach[2],
	}

static func _turned(rows, yaw, which):
	var a = cos(yaw) if which == 0 else -sin(yaw)
	var b = sin(yaw) if which == 0 else cos(yaw)
	return [
		a * rows[0][0] + b * rows[1][0], a * rows[0][1] + b * rows[1][1], a * rows[0][2] + b * rows[1][2],
	]

static func overlaps_height(solid, low, high):
	return solid.z_min < high - 0.002 and solid.z_max > low + 0.002

# Horizontal distance of a point from a solid; 0 inside.
static func distance(solid, x, y):
	var c = cos(solid.yaw_rad)
	var s = sin(solid.yaw_rad)
	var dx = x - solid.x
	var dy = y - solid.y
	var along = max(abs(dx * c + dy * s) - solid.half_x, 0.0)
	var across = max(abs(dy * c - dx * s) - solid.half_y, 0.0)
	return sqrt(along * along + across * across)

# Whether two solids keep at least a gap, seen from above: some axis parts them.
static func are_apart(a, b, gap):
	var dx = b.x - a.x
	var dy = b.y - a.y
	for yaw in [a.yaw_rad, a.yaw_rad + PI / 2, b.yaw_rad, b.yaw_rad + PI / 2]:
		var c = cos(yaw)
		var s = sin(yaw)
		if abs(dx * c + dy * s) - _extent(a, yaw) - _extent(b, yaw) >= gap:
			return true
	return false

static func _extent(solid, yaw):
	var turn = solid.yaw_rad - yaw
	return abs(cos(turn)) * solid.half_x + abs(sin(turn)) * solid.half_y

# Whether the whole footprint lies on a surface, with a margin to its edge.
static func lies_on(solid, surface, margin):
	var c = cos(surface.yaw_rad)
	var s = sin(surface.yaw_rad)
	var dx = solid.x - surface.center.x
	var dy = solid.y - surface.center.y
	var u = abs(dx * c + dy * s) + _extent(solid, surface.yaw_rad)
	var v = abs(dy * c - dx * s) + _extent(solid, surface.yaw_rad + PI / 2)
	return u <= surface.half_x - margin and v <= surface.half_y - margin
