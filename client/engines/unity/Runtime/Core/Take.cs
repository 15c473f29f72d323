// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;

namespace Furrow
{
    /// <summary>Recorded frames of one subject.</summary>
    public sealed class Take
    {
        /// <summary>Ten minutes at 240 frames per second. A recording ends there and does not fill the memory.</summary>
        public const int MaxFrames = 144000;

        private readonly List<float> times = new List<float>();
        private readonly List<float> values = new List<float>();
        private long firstUs;
        private long lastUs;

        public Take()
        {
            Names = new string[0];
        }

        public string[] Names { get; private set; }

        /// <summary>Seconds since the first frame, ascending.</summary>
        public IList<float> Times
        {
            get { return times; }
        }

        /// <summary>Names.Length values per frame, frame by frame.</summary>
        public IList<float> Values
        {
            get { return values; }
        }

        public float Length
        {
            get { return times.Count == 0 ? 0 : times[times.Count - 1]; }
        }

        /// <summary>
        /// Adds the newest frame of a subject. Faded frames, frames of other names, and frames out of order are skipped.
        /// </summary>
        public void Add(Subject subject)
        {
            if (subject.IsDecaying || times.Count >= MaxFrames)
            {
                return;
            }
            if (times.Count == 0)
            {
                Names = subject.Names;
                firstUs = subject.CaptureTimeUs;
            }
            else if (!ReferenceEquals(Names, subject.Names) || subject.CaptureTimeUs <= lastUs)
            {
                return;
            }
            lastUs = subject.CaptureTimeUs;
            times.Add((float)((lastUs - firstUs) * 1e-6));
            values.AddRange(subject.Values);
        }

        /// <summary>The weights at a time, linear between frames, into `output`, which has Names.Length floats.</summary>
        public static void Sample(IList<float> times, IList<float> values, float time, float[] output)
        {
            int count = output.Length;
            if (times.Count == 0)
            {
                Array.Clear(output, 0, count);
                return;
            }
            int low = 0;
            int high = times.Count - 1;
            while (high - low > 1)
            {
                int middle = (low + high) / 2;
                if (times[middle] <= time)
                {
                    low = middle;
                }
                else
                {
                    high = middle;
                }
            }
            float span = times[high] - times[low];
            float share = span <= 0 ? 0 : Math.Max(0, Math.Min(1, (time - times[low]) / span));
            for (int i = 0; i < count; ++i)
            {
                float a = values[low * count + i];
                output[i] = a + share * (values[high * count + i] - a);
            }
        }
    }
}
