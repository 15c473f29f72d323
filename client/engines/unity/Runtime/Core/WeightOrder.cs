// SPDX-License-Identifier: Apache-2.0
using System;

namespace Furrow
{
    /// <summary>Arranges the daemon's weights in the order of a shader's array.</summary>
    public sealed class WeightOrder
    {
        private int[] map = new int[0];
        private bool[] used = new bool[0];
        private float[] arranged = new float[0];

        /// <summary>Number of floats in the array.</summary>
        public int Count
        {
            get { return map.Length; }
        }

        /// <param name="wanted">Names in the order of the shader.</param>
        /// <param name="received">Names in the order of the daemon.</param>
        public void Set(string[] wanted, string[] received)
        {
            map = Names.Map(received, wanted);
            arranged = new float[wanted.Length];
            used = new bool[received.Length];
            foreach (int index in map)
            {
                if (index >= 0)
                {
                    used[index] = true;
                }
            }
        }

        /// <summary>Whether the shader uses the daemon's weight `index`.</summary>
        public bool Uses(int index)
        {
            return index < used.Length && used[index];
        }

        /// <summary>The values in the order of the shader; 0 for weights that the daemon does not send. The array is used
        /// again for the next call.</summary>
        public float[] Arrange(float[] values)
        {
            for (int i = 0; i < map.Length; ++i)
            {
                arranged[i] = map[i] >= 0 ? values[map[i]] : 0;
            }
            return arranged;
        }
    }
}
