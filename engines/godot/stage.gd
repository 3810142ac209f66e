extends Spatial
# What is drawn and what rays hit. ADAMO's frame has z up: (x, y, z) there is (x, z, -y) here.

const Glb = preload("res://glb.gd")
const COLOURS = 1
const IDS = 2
const NO_OBJECT = 0x7FFF
const FURNITURE = 2
const THINGS = 4
const SHELL = 8
const FAR = 60.0

var things = {}
var lights = []
var _meshes = {}
var _colours
var _ids
var _eyes
var _id_eyes

static func here(p):
	return Vector3(p[0], p[2], -p[1])

static func there(v):
	return {"x": v.x, "y": -v.z, "z": v.y}

func build(data, folder):
	_add(folder, data.mesh, NO_OBJECT, SHELL)
	for piece in data.furniture:
		var node = _add(folder, piece.mesh, NO_OBJECT, FURNITURE)
		_put(node, piece.position, [cos(piece.yaw_rad / 2), 0.0, 0.0, sin(piece.yaw_rad / 2)])
	for item in data.objects:
		things[int(item.id)] = _add(folder, item.mesh, int(item.id), THINGS)
	for light in data.lights:
		var lamp = OmniLight.new()
		lamp.translation = here(light.position)
		lamp.omni_range = 9.0
		lamp.omni_attenuation = 0.6
		lamp.light_color = Color(1.0, 0.98, 0.94)
		lamp.light_energy = light.diffuse * 1.1
		lamp.light_specular = 0.15
		lamp.shadow_enabled = light.shadow
		lamp.shadow_bias = 0.05
		lamp.light_cull_mask = COLOURS
		add_child(lamp)
		lamp.force_update_transform()
		lights.append(lamp)
	_colours = _viewport(COLOURS, Color(0.62, 0.74, 0.88), data.ambient)
	_ids = _viewport(IDS, Color(1, 1, 1), 0.0)
	_colours.msaa = Viewport.MSAA_4X
	_eyes = _colours.get_child(0)
	_id_eyes = _ids.get_child(0)

func _viewport(layers, background, ambient):
	var viewport = Viewport.new()
	viewport.own_world = false
	viewport.render_target_v_flip = true
	viewport.render_target_update_mode = Viewport.UPDATE_DISABLED
	viewport.shadow_atlas_size = 2048
	viewport.hdr = true
	add_child(viewport)
	var camera = Camera.new()
	camera.cull_mask = layers
	camera.near = 0.02
	camera.far = FAR
	var surroundings = Environment.new()
	surroundings.background_mode = Environment.BG_COLOR
	surroundings.background_color = background
	surroundings.ambient_light_color = Color(1, 1, 1)
	surroundings.ambient_light_energy = ambient * 0.75
	surroundings.ambient_light_sky_contribution = 0.0
	camera.environment = surroundings
	viewport.add_child(camera)
	camera.current = true
	return viewport

func _add(folder, file, number, layer):
	if not _meshes.has(file):
		_meshes[file] = Glb.new().load_mesh(folder + "/" + file)
	var body = StaticBody.new()
	body.collision_layer = layer
	body.collision_mask = 0
	var shown = MeshInstance.new()
	shown.mesh = _meshes[file]
	shown.layers = COLOURS
	body.add_child(shown)
	var flat = MeshInstance.new()
	flat.mesh = _meshes[file]
	flat.layers = IDS
	flat.cast_shadow = GeometryInstance.SHADOW_CASTING_SETTING_OFF
	flat.material_override = _flat(number)
	body.add_child(flat)
	var shape = CollisionShape.new()
	shape.shape = _meshes[file].create_trimesh_shape()
	body.add_child(shape)
	add_child(body)
	return body

func _flat(number):
	var shader = Shader.new()
	shader.code = "shader_type spatial; render_mode unshaded, cull_disabled, shadows_disabled; uniform vec3 told; void fragment() { ALBEDO = told; }"
	var material = ShaderMaterial.new()
	material.shader = shader
	var parts = []
	for shift in [10, 5, 0]:
		parts.append(_linear(((number >> shift) & 31) * 8 + 4))
	material.set_shader_param("told", Vector3(parts[0], parts[1], parts[2]))
	return material

# The target is written as sRGB: what is to arrive as a byte goes in as linear light.
func _linear(byte):
	var value = byte / 255.0
	return value / 12.92 if value <= 0.04045 else pow((value + 0.055) / 1.055, 2.4)

func put(number, center, q):
	_put(things[number], center, q)

func _put(node, position, q):
	# w, x, y, z about ADAMO's axes.
	node.transform = Transform(Basis(Quat(q[1], q[3], -q[2], q[0])), here(position))
	# Godot tells the renderer at the end of a step; the next picture may be asked for before.
	node.force_update_transform()
	for child in node.get_children():
		child.force_update_transform()
	PhysicsServer.body_set_state(node.get_rid(), PhysicsServer.BODY_STATE_TRANSFORM, node.global_transform)

func show_thing(number, is_there):
	things[number].visible = is_there
	things[number].collision_layer = THINGS if is_there else 0

# Draws colours and ids; the first is raw bytes, the second a PNG.
func capture(eyes, yaw, pitch, fov, size):
	var way = Vector3(cos(yaw) * cos(pitch), sin(pitch), -sin(yaw) * cos(pitch))
	for camera in [_eyes, _id_eyes]:
		camera.look_at_from_position(here(eyes), here(eyes) + way, Vector3(0, 1, 0))
		camera.fov = rad2deg(fov)
		camera.force_update_transform()
	for viewport in [_colours, _ids]:
		viewport.size = size
		viewport.render_target_update_mode = Viewport.UPDATE_ONCE
	VisualServer.force_draw(false)
	var colours = _colours.get_texture().get_data()
	colours.convert(Image.FORMAT_RGB8)
	var ids = _ids.get_texture().get_data()
	ids.convert(Image.FORMAT_RGB8)
	return [colours.get_data(), ids.save_png_to_buffer()]

func ray(from, way, skipped):
	return _hit(here(from), here(way).normalized() * FAR, skipped, FURNITURE | THINGS | SHELL)

func line_is_free(from, to):
	var way = here(to) - here(from)
	return _hit(here(from), way * max(0.0, 1.0 - 0.03 / way.length()), [], FURNITURE) == null

func _hit(start, way, skipped, layers):
	var found = get_world().direct_space_state.intersect_ray(start, start + way, skipped, layers)
	return found.position if found else null
