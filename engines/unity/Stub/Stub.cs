using System;
using System.Collections.Generic;
using System.Threading;

namespace Adamo
{
    /// <summary>The smallest engine: a bare floor, one cube, and eyes that draw nothing. It shows how the parts fit.</summary>
    public sealed class Stub : IAdamoEngine
    {
        const int Cube = 1;
        const double Radius = 0.25, EyeHeight = 1.6, Fov = 1.29;
        string scene = "";
        Vec3 position, gaze;
        double heading;

        static Vec3 At(double x, double y, double z) { return new Vec3 { X = x, Y = y, Z = z }; }

        static void Main(string[] arguments)
        {
            var url = new Uri(arguments.Length > 0 ? arguments[0] : "ws://127.0.0.1:8020/engine");
            string token = Environment.GetEnvironmentVariable("ADAMO_VH_TOKEN");
            var can = new Abilities { Ids = true, Closeup = false, Snapshot = false, Events = false, Deterministic = true };
            var client = new EngineClient(new Stub(), "C# stub 1.0", can);
            client.RunAsync(url, token, CancellationToken.None).GetAwaiter().GetResult();
        }

        public SceneAnswer Scene(SceneWish wish)
        {
            scene = wish.Scene;
            Reset(new ResetWish());
            var room = new SceneInfo { Name = scene, XMin = -3, XMax = 3, YMin = -3, YMax = 3, HeightM = 2.6, Areas = new List<Area>() };
            return new SceneAnswer { Scene = room, ObjectNames = new Dictionary<string, string> { { Cube.ToString(), "cube" } } };
        }

        public BodiesAnswer Bodies()
        {
            var body = new BodyInfo { Figure = "nobody", RadiusM = Radius, EyeHeightM = EyeHeight, FovYRad = Fov, ReachM = 0.9, ReachTopM = 2, CorrectionM = 0.5 };
            return new BodiesAnswer { Bodies = new Dictionary<string, BodyInfo> { { "agent", body } } };
        }

        public void Reset(ResetWish wish)
        {
            position = At(0, 0, 0);
            heading = 0;
            gaze = At(2, 0, 0.5);
        }

        BodyState Body() { return new BodyState { Position = position, HeadingRad = heading, Gaze = gaze, Eyes = At(position.X, position.Y, EyeHeight) }; }

        public StateAnswer State()
        {
            var box = new Box { Center = At(2, 0, 0.1), Size = At(0.2, 0.2, 0.2) };
            var cube = new ObjectState { Id = Cube, ClassName = "cube", Box = box, Support = "floor", Held = false };
            return new StateAnswer { Objects = new List<ObjectState> { cube }, Bodies = new Dictionary<string, BodyState> { { "agent", Body() } } };
        }

        public CaptureAnswer Capture(CaptureWish wish, List<byte[]> pictures)
        {
            // A project draws here: colours with its camera, ids with flat colours in a second pass.
            var grey = new byte[3 * wish.WidthPx * wish.HeightPx];
            var nothing = new byte[2 * wish.WidthPx * wish.HeightPx];
            for (int i = 0; i < grey.Length; i++) grey[i] = 128;
            for (int i = 0; i < nothing.Length; i++) nothing[i] = 255;
            pictures.Add(grey);
            pictures.Add(nothing);
            var line = At(gaze.X - position.X, gaze.Y - position.Y, gaze.Z - EyeHeight);
            var view = new View { Position = At(position.X, position.Y, EyeHeight), YawRad = heading, PitchRad = Math.Atan2(line.Z, Math.Sqrt(line.X * line.X + line.Y * line.Y)), FovYRad = Fov };
            return new CaptureAnswer { Camera = view, Body = Body(), Objects = new List<SeenBox>(), Colour = "rgb8", Ids = "int16", Layers = 1 };
        }

        public RaysAnswer Rays(RaysWish wish)
        {
            // The floor alone.
            return new RaysAnswer { Hits = wish.Directions.ConvertAll(way => way.Z >= 0 ? null : At(wish.Origin.X - way.X * wish.Origin.Z / way.Z, wish.Origin.Y - way.Y * wish.Origin.Z / way.Z, 0)) };
        }

        public ReportAnswer Look(PointWish wish)
        {
            heading = Math.Atan2(wish.Point.Y - position.Y, wish.Point.X - position.X);
            gaze = wish.Point;
            return new ReportAnswer { Outcome = Outcome.Done, Code = Code.Ok, Point = gaze };
        }

        public ReportAnswer Walk(PointWish wish)
        {
            double x = Math.Max(Radius - 3, Math.Min(3 - Radius, wish.Point.X)), y = Math.Max(Radius - 3, Math.Min(3 - Radius, wish.Point.Y));
            double walked = Math.Sqrt((x - position.X) * (x - position.X) + (y - position.Y) * (y - position.Y));
            if (walked > 1e-6) heading = Math.Atan2(y - position.Y, x - position.X);
            position = At(x, y, 0);
            gaze = At(x + Math.Cos(heading), y + Math.Sin(heading), EyeHeight);
            bool there = Math.Abs(x - wish.Point.X) < 0.05 && Math.Abs(y - wish.Point.Y) < 0.05;
            return new ReportAnswer { Outcome = there ? Outcome.Done : Outcome.Corrected, Code = there ? Code.Ok : Code.StoppedShort, Point = position, WalkedM = walked };
        }

        public ReportAnswer Pick(PickWish wish)
        {
            if (wish.ObjectId != Cube) throw new AdamoException("there is no object " + wish.ObjectId + ".");
            return new ReportAnswer { Outcome = Outcome.Refused, Code = Code.Unreachable, Point = position };
        }

        public ReportAnswer Drop(PointWish wish) { return new ReportAnswer { Outcome = Outcome.Refused, Code = Code.HandEmpty }; }
        public void Say(SayWish wish) { Console.WriteLine(wish.Text); }
        public SnapshotAnswer Snapshot() { throw new AdamoException("it keeps no states."); }
        public void Restore(SnapshotAnswer wish) { throw new AdamoException("it keeps no states."); }
        public void Apply(EventWish wish) { throw new AdamoException("nothing happens here but by the body."); }
    }
}
