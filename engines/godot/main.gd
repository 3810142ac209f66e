extends Spatial
# Dials in to ADAMO and answers what it is asked: see docs/engines.md for the messages.
#
# Environment: ADAMO_URL (ws://127.0.0.1:8020/engine), ADAMO_SCENES (folder of exported scenes),
# ADAMO_VH_TOKEN (if the server asks for one).

const World = preload("res://world.gd")

var socket = WebSocketClient.new()
var world = null
# Godot hands new materials to the renderer between two steps: until then all is drawn white.
var materials_wait = false

func _ready():
	get_viewport().disable_3d = true
	VisualServer.render_loop_enabled = false
	var url = OS.get_environment("ADAMO_URL")
	if url == "":
		url = "ws://127.0.0.1:8020/engine"
	socket.connect("connection_established", self, "_opened")
	socket.connect("connection_error", self, "_ended")
	socket.connect("connection_closed", self, "_ended")
	socket.set_buffers(8192, 64, 32768, 64)
	var headers = PoolStringArray()
	var token = OS.get_environment("ADAMO_VH_TOKEN")
	if token != "":
		headers.append("Authorization: Bearer " + token)
	if socket.connect_to_url(url, PoolStringArray(), false, headers) != OK:
		printerr("cannot connect to ", url)
		get_tree().quit(1)

# Rays can be cast in here alone; so everything is answered in here, for some milliseconds on end.
func _physics_process(_delta):
	for _i in range(50):
		if materials_wait:
			return
		socket.poll()
		if socket.get_connection_status() == NetworkedMultiplayerPeer.CONNECTION_CONNECTED:
			_answer_all()
		OS.delay_usec(200)

func _process(_delta):
	materials_wait = false

func _opened(_protocol = ""):
	var version = Engine.get_version_info()
	var name = "Godot %d.%d.%d" % [version.major, version.minor, version.patch]
	var able = {"ids": true, "closeup": true, "snapshot": true, "events": true, "deterministic": true}
	var hello = {"wire": 1, "engine": name, "frame": "right-handed, z up, metres", "abilities": able}
	_send({"jsonrpc": "2.0", "method": "hello", "params": hello})

func _ended(_clean = false):
	get_tree().quit()

func _answer_all():
	while not materials_wait and socket.get_peer(1).get_available_packet_count() > 0:
		_answer(parse_json(socket.get_peer(1).get_packet().get_string_from_utf8()))

func _send(message):
	socket.get_peer(1).set_write_mode(WebSocketPeer.WRITE_MODE_TEXT)
	socket.get_peer(1).put_packet(to_json(message).to_utf8())

func _answer(request):
	var attached = []
	var reply = {"jsonrpc": "2.0", "id": int(request.id)}
	var result = _carried_out(request.method, request.params, attached)
	if result is String:
		reply["error"] = {"code": 1, "message": result}
		attached = []
	else:
		reply["result"] = result
	reply["attachments"] = attached.size()
	_send(reply)
	for picture in attached:
		socket.get_peer(1).set_write_mode(WebSocketPeer.WRITE_MODE_BINARY)
		socket.get_peer(1).put_packet(picture)

# The result as a dictionary, or why there is none as a text.
func _carried_out(method, params, attached):
	if method == "scene":
		return _load_scene(params.scene)
	if world == null:
		return "ask for a scene first."
	if params.has("body") and params.body != "agent":
		return "there is no body of that name."
	match method:
		"bodies":
			return {"bodies": {"agent": world.body_info()}}
		"reset":
			world.reset()
			return {}
		"state":
			return world.state()
		"capture":
			return world.capture(int(params.width_px), int(params.height_px), params.get("aim"), attached)
		"rays":
			return {"hits": world.rays(params.origin, params.directions)}
		"look":
			return world.look(params.point)
		"walk":
			return world.walk(params.point)
		"pick":
			return world.pick(int(params.object_id))
		"drop":
			return world.drop(params.point)
		"say":
			print("the agent says: ", params.text)
			return {}
		"snapshot":
			return {"snapshot": world.snapshot()}
		"restore":
			return world.restore(params.snapshot)
		"apply":
			return world.apply(params.event)
	return "there is no method of that name."

func _load_scene(name):
	var folder = OS.get_environment("ADAMO_SCENES") + "/" + name.to_lower()
	if not name.is_valid_identifier() or not File.new().file_exists(folder + "/scene.json"):
		return "there is no exported scene of that name; make one: adamo-vh scenes export"
	if world != null:
		remove_child(world)
		world.free()
	world = World.new()
	add_child(world)
	materials_wait = true
	return world.load_scene(folder)
