extends Reference
# Reads the GLB files that ADAMO exports into ArrayMeshes: one node, triangles, PNG textures.
# Godot 4 has GLTFDocument for this; the runner of Godot 3 cannot import while it runs.

var _json = {}
var _bytes = StreamPeerBuffer.new()
var _data = PoolByteArray()

func load_mesh(path):
	var file = File.new()
	if file.open(path, File.READ) != OK:
		return null
	var all = file.get_buffer(file.get_len())
	file.close()
	var head = StreamPeerBuffer.new()
	head.data_array = all.subarray(0, 19)
	head.seek(12)
	var length = head.get_u32()
	_json = parse_json(all.subarray(20, 19 + length).get_string_from_utf8())
	_data = all.subarray(28 + length, all.size() - 1)
	_bytes.data_array = _data
	var mesh = ArrayMesh.new()
	for part in _json.meshes[0].primitives:
		_add_part(mesh, part)
	return mesh

func _add_part(mesh, part):
	var arrays = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = _vectors(part.attributes.POSITION)
	arrays[Mesh.ARRAY_NORMAL] = _vectors(part.attributes.NORMAL)
	arrays[Mesh.ARRAY_TEX_UV] = _places(part.attributes.TEXCOORD_0)
	arrays[Mesh.ARRAY_INDEX] = _indices(part.indices)
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	mesh.surface_set_material(mesh.get_surface_count() - 1, _material(_json.materials[part.material]))

func _start(accessor):
	_bytes.seek(int(_json.bufferViews[accessor.bufferView].byteOffset))
	return int(accessor.count)

func _vectors(number):
	var count = _start(_json.accessors[number])
	var found = PoolVector3Array()
	found.resize(count)
	for i in range(count):
		found[i] = Vector3(_bytes.get_float(), _bytes.get_float(), _bytes.get_float())
	return found

func _places(number):
	var count = _start(_json.accessors[number])
	var found = PoolVector2Array()
	found.resize(count)
	for i in range(count):
		found[i] = Vector2(_bytes.get_float(), _bytes.get_float())
	return found

func _indices(number):
	var accessor = _json.accessors[number]
	var count = _start(accessor)
	var wide = int(accessor.componentType) == 5125
	var found = PoolIntArray()
	found.resize(count)
	for i in range(count):
		# Godot goes round a triangle the other way.
		var at = i - i % 3 + [0, 2, 1][i % 3]
		found[at] = _bytes.get_u32() if wide else _bytes.get_u16()
	return found

func _material(told):
	var surface = told.pbrMetallicRoughness
	var material = SpatialMaterial.new()
	var factor = surface.baseColorFactor
	material.albedo_color = Color(_srgb(factor[0]), _srgb(factor[1]), _srgb(factor[2]), factor[3])
	material.roughness = surface.roughnessFactor
	material.metallic_specular = 0.3
	material.params_cull_mode = SpatialMaterial.CULL_DISABLED
	material.flags_transparent = factor[3] < 0.999
	if surface.has("baseColorTexture"):
		material.albedo_texture = _texture(int(_json.textures[surface.baseColorTexture.index].source))
	return material

func _texture(number):
	var view = _json.bufferViews[_json.images[number].bufferView]
	var start = int(view.byteOffset)
	var image = Image.new()
	image.load_png_from_buffer(_data.subarray(start, start + int(view.byteLength) - 1))
	var texture = ImageTexture.new()
	texture.create_from_image(image, Texture.FLAG_MIPMAPS | Texture.FLAG_FILTER)
	return texture

func _srgb(linear):
	if linear <= 0.0031308:
		return linear * 12.92
	return 1.055 * pow(linear, 1.0 / 2.4) - 0.055
