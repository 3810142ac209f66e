// Written by tools/csharp.py from docs/wire/engine.json; change that, and write it anew.
using System.Collections.Generic;

namespace Adamo
{
    public static class Wire
    {
        public const int Version = 1;
    }

    /// <summary>The finer reason behind an outcome. Tools from outside may add their own strings.</summary>
    public static class Code
    {
        public const string Ok = "ok";
        public const string Repositioned = "repositioned";
        public const string StoppedShort = "stopped_short";
        public const string GazeLimited = "gaze_limited";
        public const string PlacedElsewhere = "placed_elsewhere";
        public const string MovedInside = "moved_inside";
        public const string Cancelled = "cancelled";
        public const string UnknownTool = "unknown_tool";
        public const string BadArgument = "bad_argument";
        public const string UnknownTag = "unknown_tag";
        public const string NotSeen = "not_seen";
        public const string NotInView = "not_in_view";
        public const string OutsideRoom = "outside_room";
        public const string HandFull = "hand_full";
        public const string HandEmpty = "hand_empty";
        public const string NotHeld = "not_held";
        public const string Gone = "gone";
        public const string Unreachable = "unreachable";
        public const string NoFreeSpot = "no_free_spot";
    }

    /// <summary>How an action ended.</summary>
    public static class Outcome
    {
        public const string Done = "done";
        public const string Corrected = "corrected";
        public const string Refused = "refused";
    }

    /// <summary>What an engine can do beyond what every engine must; one that does not say can do all.</summary>
    public sealed class Abilities
    {
        public bool Ids = true;
        public bool Closeup = true;
        public bool Snapshot = true;
        public bool Events = true;
        public bool Deterministic = true;

        public static Abilities Read(object json)
        {
            var map = Json.Map(json);
            var read = new Abilities();
            if (map.ContainsKey("ids")) read.Ids = Json.Truth(map["ids"]);
            if (map.ContainsKey("closeup")) read.Closeup = Json.Truth(map["closeup"]);
            if (map.ContainsKey("snapshot")) read.Snapshot = Json.Truth(map["snapshot"]);
            if (map.ContainsKey("events")) read.Events = Json.Truth(map["events"]);
            if (map.ContainsKey("deterministic")) read.Deterministic = Json.Truth(map["deterministic"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "ids", Ids },
                { "closeup", Closeup },
                { "snapshot", Snapshot },
                { "events", Events },
                { "deterministic", Deterministic },
            };
        }
    }

    /// <summary>A named rectangle on the floor.</summary>
    public sealed class Area
    {
        public string Name;
        public string Kind;
        public double XMin;
        public double YMin;
        public double XMax;
        public double YMax;

        public static Area Read(object json)
        {
            var map = Json.Map(json);
            var read = new Area();
            read.Name = Json.Words(map["name"]);
            read.Kind = Json.Words(map["kind"]);
            read.XMin = Json.Number(map["x_min"]);
            read.YMin = Json.Number(map["y_min"]);
            read.XMax = Json.Number(map["x_max"]);
            read.YMax = Json.Number(map["y_max"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "name", Name },
                { "kind", Kind },
                { "x_min", XMin },
                { "y_min", YMin },
                { "x_max", XMax },
                { "y_max", YMax },
            };
        }
    }

    /// <summary>The bodies by name, the one that acts first.</summary>
    public sealed class BodiesAnswer
    {
        public Dictionary<string, BodyInfo> Bodies;

        public static BodiesAnswer Read(object json)
        {
            var map = Json.Map(json);
            var read = new BodiesAnswer();
            read.Bodies = Json.Table(map["bodies"], x => BodyInfo.Read(x));
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "bodies", Json.Entries(Bodies, x => x.Write()) },
            };
        }
    }

    /// <summary>What is always true of a body: who it is, how large, and how far it reaches.</summary>
    public sealed class BodyInfo
    {
        public string Figure;
        public double RadiusM;
        public double EyeHeightM;
        public double FovYRad;
        public double ReachM;
        public double ReachTopM;
        public double CorrectionM;

        public static BodyInfo Read(object json)
        {
            var map = Json.Map(json);
            var read = new BodyInfo();
            read.Figure = Json.Words(map["figure"]);
            read.RadiusM = Json.Number(map["radius_m"]);
            read.EyeHeightM = Json.Number(map["eye_height_m"]);
            read.FovYRad = Json.Number(map["fov_y_rad"]);
            read.ReachM = Json.Number(map["reach_m"]);
            read.ReachTopM = Json.Number(map["reach_top_m"]);
            read.CorrectionM = Json.Number(map["correction_m"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "figure", Figure },
                { "radius_m", RadiusM },
                { "eye_height_m", EyeHeightM },
                { "fov_y_rad", FovYRad },
                { "reach_m", ReachM },
                { "reach_top_m", ReachTopM },
                { "correction_m", CorrectionM },
            };
        }
    }

    /// <summary>The body as the engine knows it.</summary>
    public sealed class BodyState
    {
        public Vec3 Position;
        public double HeadingRad;
        public Vec3 Gaze;
        public Vec3 Eyes;
        public int? Held;
        public Box HeldBox;

        public static BodyState Read(object json)
        {
            var map = Json.Map(json);
            var read = new BodyState();
            read.Position = Vec3.Read(map["position"]);
            read.HeadingRad = Json.Number(map["heading_rad"]);
            read.Gaze = Vec3.Read(map["gaze"]);
            read.Eyes = Vec3.Read(map["eyes"]);
            if (map.ContainsKey("held")) read.Held = map["held"] == null ? (int?)null : Json.Whole(map["held"]);
            if (map.ContainsKey("held_box")) read.HeldBox = map["held_box"] == null ? null : Box.Read(map["held_box"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "position", Position.Write() },
                { "heading_rad", HeadingRad },
                { "gaze", Gaze.Write() },
                { "eyes", Eyes.Write() },
                { "held", Held },
                { "held_box", HeldBox == null ? null : HeldBox.Write() },
            };
        }
    }

    /// <summary>An oriented box: the local bounding box of a thing, placed in the world.</summary>
    public sealed class Box
    {
        public Vec3 Center;
        public Vec3 Size;
        public Quaternion Orientation = new Quaternion();

        public static Box Read(object json)
        {
            var map = Json.Map(json);
            var read = new Box();
            read.Center = Vec3.Read(map["center"]);
            read.Size = Vec3.Read(map["size"]);
            if (map.ContainsKey("orientation")) read.Orientation = Quaternion.Read(map["orientation"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "center", Center.Write() },
                { "size", Size.Write() },
                { "orientation", Orientation.Write() },
            };
        }
    }

    /// <summary>A picture; its attachments are the colours and then each layer of ids.</summary>
    public sealed class CaptureAnswer
    {
        public View Camera;
        public BodyState Body;
        public List<SeenBox> Objects;
        public string Colour;
        public string Ids;
        public int Layers = 0;

        public static CaptureAnswer Read(object json)
        {
            var map = Json.Map(json);
            var read = new CaptureAnswer();
            read.Camera = View.Read(map["camera"]);
            read.Body = BodyState.Read(map["body"]);
            read.Objects = Json.List(map["objects"], x => SeenBox.Read(x));
            read.Colour = Json.Words(map["colour"]);
            if (map.ContainsKey("ids")) read.Ids = map["ids"] == null ? null : Json.Words(map["ids"]);
            if (map.ContainsKey("layers")) read.Layers = Json.Whole(map["layers"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "camera", Camera.Write() },
                { "body", Body.Write() },
                { "objects", Json.Each(Objects, x => x.Write()) },
                { "colour", Colour },
                { "ids", Ids },
                { "layers", Layers },
            };
        }
    }

    /// <summary>Draw what a body sees.</summary>
    public sealed class CaptureWish
    {
        public string Body;
        public int WidthPx;
        public int HeightPx;
        public CloseAim Aim;

        public static CaptureWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new CaptureWish();
            read.Body = Json.Words(map["body"]);
            read.WidthPx = Json.Whole(map["width_px"]);
            read.HeightPx = Json.Whole(map["height_px"]);
            if (map.ContainsKey("aim")) read.Aim = map["aim"] == null ? null : CloseAim.Read(map["aim"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "body", Body },
                { "width_px", WidthPx },
                { "height_px", HeightPx },
                { "aim", Aim == null ? null : Aim.Write() },
            };
        }
    }

    /// <summary>Where a close-up looks, from the same eyes.</summary>
    public sealed class CloseAim
    {
        public Vec3 Point;
        public double FovYRad;

        public static CloseAim Read(object json)
        {
            var map = Json.Map(json);
            var read = new CloseAim();
            read.Point = Vec3.Read(map["point"]);
            read.FovYRad = Json.Number(map["fov_y_rad"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "point", Point.Write() },
                { "fov_y_rad", FovYRad },
            };
        }
    }

    /// <summary>Let something happen that no body does.</summary>
    public sealed class EventWish
    {
        public object Event;

        public static EventWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new EventWish();
            read.Event = map["event"];
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "event", Event },
            };
        }
    }

    /// <summary>A piece of furniture, which never moves, seen from above.</summary>
    public sealed class FurnitureOutline
    {
        public string Name;
        public List<List<double>> Points;
        public double BottomM;
        public double TopM;
        public List<WorldSurface> Surfaces = new List<WorldSurface>();

        public static FurnitureOutline Read(object json)
        {
            var map = Json.Map(json);
            var read = new FurnitureOutline();
            read.Name = Json.Words(map["name"]);
            read.Points = Json.List(map["points"], y => Json.List(y, x => Json.Number(x)));
            read.BottomM = Json.Number(map["bottom_m"]);
            read.TopM = Json.Number(map["top_m"]);
            if (map.ContainsKey("surfaces")) read.Surfaces = Json.List(map["surfaces"], x => WorldSurface.Read(x));
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "name", Name },
                { "points", Json.Each(Points, y => Json.Each(y, x => x)) },
                { "bottom_m", BottomM },
                { "top_m", TopM },
                { "surfaces", Json.Each(Surfaces, x => x.Write()) },
            };
        }
    }

    /// <summary>The first message: who dials in and what it can do.</summary>
    public sealed class Hello
    {
        public int Wire;
        public string Engine;
        public string Frame;
        public Abilities Abilities;

        public static Hello Read(object json)
        {
            var map = Json.Map(json);
            var read = new Hello();
            read.Wire = Json.Whole(map["wire"]);
            read.Engine = Json.Words(map["engine"]);
            read.Frame = Json.Words(map["frame"]);
            read.Abilities = Abilities.Read(map["abilities"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "wire", Wire },
                { "engine", Engine },
                { "frame", Frame },
                { "abilities", Abilities.Write() },
            };
        }
    }

    /// <summary>A light of the scene becomes brighter or darker.</summary>
    public sealed class LightChanged
    {
        public int Light;
        public double Diffuse;
        public string Type = "light_changed";

        public static LightChanged Read(object json)
        {
            var map = Json.Map(json);
            var read = new LightChanged();
            read.Light = Json.Whole(map["light"]);
            read.Diffuse = Json.Number(map["diffuse"]);
            if (map.ContainsKey("type")) read.Type = Json.Words(map["type"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "light", Light },
                { "diffuse", Diffuse },
                { "type", Type },
            };
        }
    }

    /// <summary>Somebody else brings an object in, and puts it at the free place nearest to a point.</summary>
    public sealed class ObjectAdded
    {
        public int ObjectId;
        public Vec3 Point;
        public string Type = "object_added";

        public static ObjectAdded Read(object json)
        {
            var map = Json.Map(json);
            var read = new ObjectAdded();
            read.ObjectId = Json.Whole(map["object_id"]);
            read.Point = Vec3.Read(map["point"]);
            if (map.ContainsKey("type")) read.Type = Json.Words(map["type"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "object_id", ObjectId },
                { "point", Point.Write() },
                { "type", Type },
            };
        }
    }

    /// <summary>Somebody else puts an object down elsewhere: at the free place nearest to a point.</summary>
    public sealed class ObjectMoved
    {
        public int ObjectId;
        public Vec3 Point;
        public string Type = "object_moved";

        public static ObjectMoved Read(object json)
        {
            var map = Json.Map(json);
            var read = new ObjectMoved();
            read.ObjectId = Json.Whole(map["object_id"]);
            read.Point = Vec3.Read(map["point"]);
            if (map.ContainsKey("type")) read.Type = Json.Words(map["type"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "object_id", ObjectId },
                { "point", Point.Write() },
                { "type", Type },
            };
        }
    }

    /// <summary>One interactable object, as the simulator knows it.</summary>
    public sealed class ObjectState
    {
        public int Id;
        public string ClassName;
        public Box Box;
        public string Support;
        public bool Held;

        public static ObjectState Read(object json)
        {
            var map = Json.Map(json);
            var read = new ObjectState();
            read.Id = Json.Whole(map["id"]);
            read.ClassName = Json.Words(map["class_name"]);
            read.Box = Box.Read(map["box"]);
            read.Support = map["support"] == null ? null : Json.Words(map["support"]);
            read.Held = Json.Truth(map["held"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "id", Id },
                { "class_name", ClassName },
                { "box", Box.Write() },
                { "support", Support },
                { "held", Held },
            };
        }
    }

    /// <summary>Somebody else takes an object out of the room.</summary>
    public sealed class ObjectTaken
    {
        public int ObjectId;
        public string Type = "object_taken";

        public static ObjectTaken Read(object json)
        {
            var map = Json.Map(json);
            var read = new ObjectTaken();
            read.ObjectId = Json.Whole(map["object_id"]);
            if (map.ContainsKey("type")) read.Type = Json.Words(map["type"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "object_id", ObjectId },
                { "type", Type },
            };
        }
    }

    /// <summary>Take an object into the hand.</summary>
    public sealed class PickWish
    {
        public string Body;
        public int ObjectId;

        public static PickWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new PickWish();
            read.Body = Json.Words(map["body"]);
            read.ObjectId = Json.Whole(map["object_id"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "body", Body },
                { "object_id", ObjectId },
            };
        }
    }

    /// <summary>Look at, walk to, or drop at a point.</summary>
    public sealed class PointWish
    {
        public string Body;
        public Vec3 Point;

        public static PointWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new PointWish();
            read.Body = Json.Words(map["body"]);
            read.Point = Vec3.Read(map["point"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "body", Body },
                { "point", Point.Write() },
            };
        }
    }

    /// <summary>A unit rotation quaternion, scalar first.</summary>
    public sealed class Quaternion
    {
        public double W = 1.0;
        public double X = 0.0;
        public double Y = 0.0;
        public double Z = 0.0;

        public static Quaternion Read(object json)
        {
            var map = Json.Map(json);
            var read = new Quaternion();
            if (map.ContainsKey("w")) read.W = Json.Number(map["w"]);
            if (map.ContainsKey("x")) read.X = Json.Number(map["x"]);
            if (map.ContainsKey("y")) read.Y = Json.Number(map["y"]);
            if (map.ContainsKey("z")) read.Z = Json.Number(map["z"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "w", W },
                { "x", X },
                { "y", Y },
                { "z", Z },
            };
        }
    }

    /// <summary>One hit, or null, for each direction.</summary>
    public sealed class RaysAnswer
    {
        public List<Vec3> Hits;

        public static RaysAnswer Read(object json)
        {
            var map = Json.Map(json);
            var read = new RaysAnswer();
            read.Hits = Json.List(map["hits"], x => x == null ? null : Vec3.Read(x));
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "hits", Json.Each(Hits, x => x == null ? null : x.Write()) },
            };
        }
    }

    /// <summary>First hits of rays; the body and what it holds are passed through.</summary>
    public sealed class RaysWish
    {
        public string Body;
        public Vec3 Origin;
        public List<Vec3> Directions;

        public static RaysWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new RaysWish();
            read.Body = Json.Words(map["body"]);
            read.Origin = Vec3.Read(map["origin"]);
            read.Directions = Json.List(map["directions"], x => Vec3.Read(x));
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "body", Body },
                { "origin", Origin.Write() },
                { "directions", Json.Each(Directions, x => x.Write()) },
            };
        }
    }

    /// <summary>How an action went; see `adamo_vh.engine.BodyReport`.</summary>
    public sealed class ReportAnswer
    {
        public string Outcome;
        public string Code;
        public Vec3 Point;
        public string Support;
        public double WalkedM = 0.0;
        public double? StoppedS;

        public static ReportAnswer Read(object json)
        {
            var map = Json.Map(json);
            var read = new ReportAnswer();
            read.Outcome = Json.Words(map["outcome"]);
            read.Code = Json.Words(map["code"]);
            if (map.ContainsKey("point")) read.Point = map["point"] == null ? null : Vec3.Read(map["point"]);
            if (map.ContainsKey("support")) read.Support = map["support"] == null ? null : Json.Words(map["support"]);
            if (map.ContainsKey("walked_m")) read.WalkedM = Json.Number(map["walked_m"]);
            if (map.ContainsKey("stopped_s")) read.StoppedS = map["stopped_s"] == null ? (double?)null : Json.Number(map["stopped_s"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "outcome", Outcome },
                { "code", Code },
                { "point", Point == null ? null : Point.Write() },
                { "support", Support },
                { "walked_m", WalkedM },
                { "stopped_s", StoppedS },
            };
        }
    }

    /// <summary>Put the world back to its start. Same seed, same world.</summary>
    public sealed class ResetWish
    {
        public int Seed;

        public static ResetWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new ResetWish();
            read.Seed = Json.Whole(map["seed"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "seed", Seed },
            };
        }
    }

    /// <summary>Deliver the agent's final answer.</summary>
    public sealed class SayWish
    {
        public string Body;
        public string Text;

        public static SayWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new SayWish();
            read.Body = Json.Words(map["body"]);
            read.Text = Json.Words(map["text"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "body", Body },
                { "text", Text },
            };
        }
    }

    /// <summary>What is always true of the loaded scene.</summary>
    public sealed class SceneAnswer
    {
        public SceneInfo Scene;
        public Dictionary<string, string> ObjectNames;
        public List<FurnitureOutline> Furniture = new List<FurnitureOutline>();

        public static SceneAnswer Read(object json)
        {
            var map = Json.Map(json);
            var read = new SceneAnswer();
            read.Scene = SceneInfo.Read(map["scene"]);
            read.ObjectNames = Json.Table(map["object_names"], x => Json.Words(x));
            if (map.ContainsKey("furniture")) read.Furniture = Json.List(map["furniture"], x => FurnitureOutline.Read(x));
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "scene", Scene.Write() },
                { "object_names", Json.Entries(ObjectNames, x => x) },
                { "furniture", Json.Each(Furniture, x => x.Write()) },
            };
        }
    }

    /// <summary>What is public about a scene: its name, origin, extent and named floor areas.</summary>
    public sealed class SceneInfo
    {
        public string Name;
        public double XMin;
        public double YMin;
        public double XMax;
        public double YMax;
        public double HeightM;
        public List<Area> Areas;
        public string Source = "";
        public string Digest = "";
        public int Variation = 0;

        public static SceneInfo Read(object json)
        {
            var map = Json.Map(json);
            var read = new SceneInfo();
            read.Name = Json.Words(map["name"]);
            read.XMin = Json.Number(map["x_min"]);
            read.YMin = Json.Number(map["y_min"]);
            read.XMax = Json.Number(map["x_max"]);
            read.YMax = Json.Number(map["y_max"]);
            read.HeightM = Json.Number(map["height_m"]);
            read.Areas = Json.List(map["areas"], x => Area.Read(x));
            if (map.ContainsKey("source")) read.Source = Json.Words(map["source"]);
            if (map.ContainsKey("digest")) read.Digest = Json.Words(map["digest"]);
            if (map.ContainsKey("variation")) read.Variation = Json.Whole(map["variation"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "name", Name },
                { "x_min", XMin },
                { "y_min", YMin },
                { "x_max", XMax },
                { "y_max", YMax },
                { "height_m", HeightM },
                { "areas", Json.Each(Areas, x => x.Write()) },
                { "source", Source },
                { "digest", Digest },
                { "variation", Variation },
            };
        }
    }

    /// <summary>Load a scene; the engine may answer that it does not have it.</summary>
    public sealed class SceneWish
    {
        public string Scene;
        public string Figure;

        public static SceneWish Read(object json)
        {
            var map = Json.Map(json);
            var read = new SceneWish();
            read.Scene = Json.Words(map["scene"]);
            read.Figure = Json.Words(map["figure"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "scene", Scene },
                { "figure", Figure },
            };
        }
    }

    /// <summary>An object with pixels in a picture.</summary>
    public sealed class SeenBox
    {
        public int Id;
        public Box Box;
        public List<int> BoxPx;
        public int? Pixels;

        public static SeenBox Read(object json)
        {
            var map = Json.Map(json);
            var read = new SeenBox();
            read.Id = Json.Whole(map["id"]);
            read.Box = Box.Read(map["box"]);
            if (map.ContainsKey("box_px")) read.BoxPx = map["box_px"] == null ? null : Json.List(map["box_px"], x => Json.Whole(x));
            if (map.ContainsKey("pixels")) read.Pixels = map["pixels"] == null ? (int?)null : Json.Whole(map["pixels"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "id", Id },
                { "box", Box.Write() },
                { "box_px", BoxPx == null ? null : Json.Each(BoxPx, x => x) },
                { "pixels", Pixels },
            };
        }
    }

    /// <summary>Everything that decides what happens next, as a text that only the engine reads.</summary>
    public sealed class SnapshotAnswer
    {
        public string Snapshot;

        public static SnapshotAnswer Read(object json)
        {
            var map = Json.Map(json);
            var read = new SnapshotAnswer();
            read.Snapshot = Json.Words(map["snapshot"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "snapshot", Snapshot },
            };
        }
    }

    /// <summary>Where everything is.</summary>
    public sealed class StateAnswer
    {
        public List<ObjectState> Objects;
        public Dictionary<string, BodyState> Bodies;

        public static StateAnswer Read(object json)
        {
            var map = Json.Map(json);
            var read = new StateAnswer();
            read.Objects = Json.List(map["objects"], x => ObjectState.Read(x));
            read.Bodies = Json.Table(map["bodies"], x => BodyState.Read(x));
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "objects", Json.Each(Objects, x => x.Write()) },
                { "bodies", Json.Entries(Bodies, x => x.Write()) },
            };
        }
    }

    /// <summary>A point or vector in metres.</summary>
    public sealed class Vec3
    {
        public double X;
        public double Y;
        public double Z;

        public static Vec3 Read(object json)
        {
            var map = Json.Map(json);
            var read = new Vec3();
            read.X = Json.Number(map["x"]);
            read.Y = Json.Number(map["y"]);
            read.Z = Json.Number(map["z"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "x", X },
                { "y", Y },
                { "z", Z },
            };
        }
    }

    /// <summary>The camera that drew a picture.</summary>
    public sealed class View
    {
        public Vec3 Position;
        public double YawRad;
        public double PitchRad;
        public double FovYRad;

        public static View Read(object json)
        {
            var map = Json.Map(json);
            var read = new View();
            read.Position = Vec3.Read(map["position"]);
            read.YawRad = Json.Number(map["yaw_rad"]);
            read.PitchRad = Json.Number(map["pitch_rad"]);
            read.FovYRad = Json.Number(map["fov_y_rad"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "position", Position.Write() },
                { "yaw_rad", YawRad },
                { "pitch_rad", PitchRad },
                { "fov_y_rad", FovYRad },
            };
        }
    }

    /// <summary>A horizontal rectangle in the world that carries things.</summary>
    public sealed class WorldSurface
    {
        public string Support;
        public Vec3 Center;
        public double HalfX;
        public double HalfY;
        public double YawRad;

        public static WorldSurface Read(object json)
        {
            var map = Json.Map(json);
            var read = new WorldSurface();
            read.Support = Json.Words(map["support"]);
            read.Center = Vec3.Read(map["center"]);
            read.HalfX = Json.Number(map["half_x"]);
            read.HalfY = Json.Number(map["half_y"]);
            read.YawRad = Json.Number(map["yaw_rad"]);
            return read;
        }

        public object Write()
        {
            return new Dictionary<string, object>
            {
                { "support", Support },
                { "center", Center.Write() },
                { "half_x", HalfX },
                { "half_y", HalfY },
                { "yaw_rad", YawRad },
            };
        }
    }
}
