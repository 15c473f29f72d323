// SPDX-License-Identifier: Apache-2.0
using System;

namespace Furrow
{
    /// <summary>One performer that a <see cref="Connection"/> follows, with the newest weights.</summary>
    public sealed class Subject
    {
        internal byte[] Key;  // Requested, for C
        internal byte[] DaemonKey;  // Name, for C
        internal ulong Layout;
        internal uint LastSequence;
        internal long LastTimeUs;
        internal ulong TimecodeBytes0To7;  // 16 bytes of text
        internal ulong TimecodeBytes8To15;

        internal Subject(string requested)
        {
            Requested = requested ?? "";
            Name = Requested;
            Key = Text.ToC(Requested);
            DaemonKey = Key;
            Names = new string[0];
            Values = new float[0];
        }

        /// <summary>The name that was asked for; empty: the oldest subject.</summary>
        public string Requested { get; private set; }

        /// <summary>The name that the daemon uses.</summary>
        public string Name { get; internal set; }

        /// <summary>Names of the weights. Another array when the daemon's rig changes.</summary>
        public string[] Names { get; internal set; }

        /// <summary>The newest weights in [0, 1], one per name. The array is used again for the next frame.</summary>
        public float[] Values { get; internal set; }

        /// <summary>Number of the pose, as its publisher counts; it wraps around.</summary>
        public uint Sequence { get; internal set; }

        /// <summary>When the pose was captured, microseconds, on the publisher's clock.</summary>
        public long CaptureTimeUs { get; internal set; }

        /// <summary>
        /// The SMPTE timecode that the source gives to the pose, "10:00:00:00"; ';' before the frames means drop-frame.
        /// Empty: the source sends none. Makes a new string.
        /// </summary>
        public string Timecode
        {
            get
            {
                var text = new byte[16];
                BitConverter.GetBytes(TimecodeBytes0To7).CopyTo(text, 0);
                BitConverter.GetBytes(TimecodeBytes8To15).CopyTo(text, 8);
                return Text.FromC(text);
            }
        }

        /// <summary>Frames per second of the timecode, as a fraction with TimecodeRateDenominator; 0: there is none.</summary>
        public uint TimecodeRateNumerator { get; internal set; }

        /// <summary>See TimecodeRateNumerator.</summary>
        public uint TimecodeRateDenominator { get; internal set; }

        /// <summary>No new pose arrives: the daemon holds the weights, then fades them to neutral.</summary>
        public bool IsDecaying { get; internal set; }

        /// <summary>Frames received so far.</summary>
        public long Frames { get; internal set; }

        /// <summary>Called inside Connection.Poll() for each new frame.</summary>
        public event Action<Subject> Received;

        internal void Raise()
        {
            Action<Subject> handlers = Received;
            if (handlers != null)
            {
                handlers(this);
            }
        }
    }

    /// <summary>What is known of a subject at this moment.</summary>
    public struct SubjectStatus
    {
        /// <summary>There are weights. If not, Message says why.</summary>
        public bool HasWeights;

        /// <summary>One sentence for people; empty if all is well.</summary>
        public string Message;

        /// <summary>Time without a new pose, milliseconds.</summary>
        public double AgeMs;

        /// <summary>Poses without a frame: lost on the way, or skipped by a rate.</summary>
        public long Missed;

        /// <summary>The subject has left; it may return.</summary>
        public bool IsGone;
    }
}
