// Written by tools/csharp.py from docs/wire/engine.json; change that, and write it anew.
using System.Collections.Generic;

namespace Adamo
{
    /// <summary>What a project offers to carry an agent.</summary>
    /// <remarks>
    /// All points are in ADAMO's frame, see Frame.
    /// Throw AdamoException for what cannot be done; its message is told.
    /// </remarks>
    public interface IAdamoEngine
    {
        SceneAnswer Scene(SceneWish wish);
        BodiesAnswer Bodies();
        void Reset(ResetWish wish);
        StateAnswer State();
        CaptureAnswer Capture(CaptureWish wish, List<byte[]> pictures);
        RaysAnswer Rays(RaysWish wish);
        ReportAnswer Look(PointWish wish);
        ReportAnswer Walk(PointWish wish);
        ReportAnswer Pick(PickWish wish);
        ReportAnswer Drop(PointWish wish);
        void Say(SayWish wish);
        SnapshotAnswer Snapshot();
        void Restore(SnapshotAnswer wish);
        void Apply(EventWish wish);
    }

    /// <summary>Carries a request out.</summary>
    public static class Requests
    {
        public static object Answer(
            IAdamoEngine engine, string method, object wish, List<byte[]> pictures)
        {
            switch (method)
            {
                case "scene": return engine.Scene(SceneWish.Read(wish)).Write();
                case "bodies": return engine.Bodies().Write();
                case "reset": engine.Reset(ResetWish.Read(wish)); return new Dictionary<string, object>();
                case "state": return engine.State().Write();
                case "capture": return engine.Capture(CaptureWish.Read(wish), pictures).Write();
                case "rays": return engine.Rays(RaysWish.Read(wish)).Write();
                case "look": return engine.Look(PointWish.Read(wish)).Write();
                case "walk": return engine.Walk(PointWish.Read(wish)).Write();
                case "pick": return engine.Pick(PickWish.Read(wish)).Write();
                case "drop": return engine.Drop(PointWish.Read(wish)).Write();
                case "say": engine.Say(SayWish.Read(wish)); return new Dictionary<string, object>();
                case "snapshot": return engine.Snapshot().Write();
                case "restore": engine.Restore(SnapshotAnswer.Read(wish)); return new Dictionary<string, object>();
                case "apply": engine.Apply(EventWish.Read(wish)); return new Dictionary<string, object>();
                default: throw new AdamoException("there is no method " + method + ".");
            }
        }
    }
}
