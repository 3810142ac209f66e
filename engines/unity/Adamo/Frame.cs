using System;

namespace Adamo
{
    /// <summary>Between ADAMO's frame (right-handed, X right, Y forward, Z up) and Unity's (left-handed, Y up).</summary>
    /// <remarks>
    /// Unity (x, y, z) = ADAMO (x, z, y): the two exchange up and forward, and with it the hand. A yaw in
    /// Unity turns clockwise seen from above and begins at +Z; ADAMO's turns counter-clockwise from +X.
    /// </remarks>
    public static class Frame
    {
        public const string Name = "right-handed, z up, metres";

        /// <summary>A point of either frame in the other.</summary>
        public static Vec3 Exchanged(Vec3 point) { return new Vec3 { X = point.X, Y = point.Z, Z = point.Y }; }

        /// <summary>A rotation of either frame in the other.</summary>
        public static Quaternion Exchanged(Quaternion turn)
        {
            // Exchanging two axes mirrors: the axis is exchanged, and the angle changes its sign.
            return new Quaternion { W = turn.W, X = -turn.X, Y = -turn.Z, Z = -turn.Y };
        }

        /// <summary>A heading of ADAMO, radians, as a yaw of Unity, degrees; and the way back.</summary>
        public static double UnityYawDeg(double headingRad) { return 90 - headingRad * 180 / Math.PI; }

        public static double HeadingRad(double unityYawDeg)
        {
            double heading = (90 - unityYawDeg) * Math.PI / 180;
            return Math.Atan2(Math.Sin(heading), Math.Cos(heading));
        }
    }
}
