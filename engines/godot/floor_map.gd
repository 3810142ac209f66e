extends Reference
# Where the body can stand at one moment, and the way there: a grid of 5 cm and Godot's AStar2D.

const Solids = preload("res://solids.gd")
const CELL = 0.05

var _room
var _radius
var _nx
var _ny
var _free = PoolByteArray()
var _solids = []
var _ways = AStar2D.new()
var _reached = {}

func _init(room, radius, solids):
	_room = room
	_radius = radius
	_nx = int(floor((room.x_max - room.x_min) / CELL))
	_ny = int(floor((room.y_max - room.y_min) / CELL))
	_free.resize(_nx * _ny)
	for i in range(_nx):
		for j in range(_ny):
			_free[i * _ny + j] = 1 if _wall_gap(_x(i), _y(j)) >= radius else 0
	for solid in solids:
		if Solids.overlaps_height(solid, 0.0, 1.75):
			_solids.append(solid)
			_take_out(solid)
	_connect()

func _x(i):
	return _room.x_min + (i + 0.5) * CELL

func _y(j):
	return _room.y_min + (j + 0.5) * CELL

func _wall_gap(x, y):
	return min(min(x - _room.x_min, _room.x_max - x), min(y - _room.y_min, _room.y_max - y))

func _take_out(solid):
	var far = sqrt(solid.half_x * solid.half_x + solid.half_y * solid.half_y) + _radius
	var i0 = max(0, int((solid.x - far - _room.x_min) / CELL))
	var i1 = min(_nx - 1, int((solid.x + far - _room.x_min) / CELL) + 1)
	var j0 = max(0, int((solid.y - far - _room.y_min) / CELL))
	var j1 = min(_ny - 1, int((solid.y + far - _room.y_min) / CELL) + 1)
	for i in range(i0, i1 + 1):
		for j in range(j0, j1 + 1):
			if _free[i * _ny + j] and Solids.distance(solid, _x(i), _y(j)) < _radius:
				_free[i * _ny + j] = 0

func _connect():
	_ways.reserve_space(_nx * _ny)
	for i in range(_nx):
		for j in range(_ny):
			var cell = i * _ny + j
			if _free[cell]:
				_ways.add_point(cell, Vector2(_x(i), _y(j)))
	for i in range(_nx):
		for j in range(_ny):
			for step in [[0, 1], [1, 0], [1, 1], [1, -1]]:
				var a = i + step[0]
				var b = j + step[1]
				if a < _nx and b >= 0 and b < _ny and _free[i * _ny + j] and _free[a * _ny + b]:
					_ways.connect_points(i * _ny + j, a * _ny + b)

# How far the nearest wall or solid is.
func clearance(x, y):
	var gap = _wall_gap(x, y)
	for solid in _solids:
		gap = min(gap, Solids.distance(solid, x, y))
	return gap

func can_stand(x, y):
	return clearance(x, y) >= _radius - 1e-6

# Every cell that can be walked to from a place: cell -> true.
func reached_from(x, y):
	var first = _ways.get_closest_point(Vector2(x, y))
	if not _reached.has(first):
		var found = {first: true}
		var open = [first]
		while open.size() > 0:
			var cell = open.pop_back()
			for next in _ways.get_point_connections(cell):
				if not found.has(next):
					found[next] = true
					open.append(next)
		_reached[first] = found
	return _reached[first]

func place_of(cell):
	return _ways.get_point_position(cell)

# The way from a place to the reachable place nearest to a target, as [x, y] corners.
func way_to_nearest(x, y, target_x, target_y):
	var best = -1
	var least = INF
	for cell in reached_from(x, y):
		var far = place_of(cell).distance_squared_to(Vector2(target_x, target_y))
		if far < least:
			least = far
			best = cell
	if sqrt(least) < CELL and can_stand(target_x, target_y):
		return way(x, y, best, [target_x, target_y])
	var end = place_of(best)
	return way(x, y, best, [end.x, end.y])

func way(x, y, cell, end):
	var found = _ways.get_point_path(_ways.get_closest_point(Vector2(x, y)), cell)
	var points = [[x, y]]
	for i in range(1, found.size() - 1):
		points.append([found[i].x, found[i].y])
	if Vector2(x, y).distance_to(Vector2(end[0], end[1])) > 1e-6:
		points.append(end)
	return _pulled(points)

# Leaves out every corner that can be cut.
func _pulled(points):
	var kept = [points[0]]
	var i = 0
	while i < points.size() - 1:
		var ahead = points.size() - 1
		while ahead > i + 1 and not _is_straight(points[i], points[ahead]):
			ahead = int(max(i + 1, ahead - max(1, (ahead - i) / 8)))
		kept.append(points[ahead])
		i = ahead
	return kept

func _is_straight(a, b):
	var count = int(max(2, Vector2(a[0], a[1]).distance_to(Vector2(b[0], b[1])) / (CELL / 2)))
	for k in range(count + 1):
		var t = float(k) / count
		var i = int((a[0] + (b[0] - a[0]) * t - _room.x_min) / CELL)
		var j = int((a[1] + (b[1] - a[1]) * t - _room.y_min) / CELL)
		if i < 0 or j < 0 or i >= _nx or j >= _ny or not _free[i * _ny + j]:
			return false
	return true
