// SPDX-License-Identifier: Apache-2.0
using UnityEngine;

namespace Furrow
{
    /// <summary>A recording as an asset. See <see cref="Take"/>.</summary>
    public sealed class FurrowTakeAsset : ScriptableObject
    {
        public string[] names = new string[0];
        public float[] times = new float[0];  // seconds, ascending
        public float[] values = new float[0];  // names.Length per frame
    }
}
