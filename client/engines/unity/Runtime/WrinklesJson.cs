// SPDX-License-Identifier: Apache-2.0
using System;
using UnityEngine;

namespace Furrow
{
    /// <summary>The names in a wrinkles.json of 'furrow export'.</summary>
    internal static class WrinklesJson
    {
        private const int Version = 1;

        [Serializable]
        private sealed class File
        {
            public string format = "";
            public int version = 0;
            public Weight[] weights = new Weight[0];
        }

        [Serializable]
        private sealed class Weight
        {
            public string name = "";
        }

        /// <summary>The names of the weights in their order; empty, with an error in the log, if the text is no such
        /// file.</summary>
        public static string[] NamesOf(string text)
        {
            File file = null;
            try
            {
                file = JsonUtility.FromJson<File>(text);
            }
            catch (ArgumentException)
            {
                // Not JSON; reported below.
            }
            if (file == null || file.format != "furrow-wrinkles" || file.version != Version)
            {
                Debug.LogError("Furrow: the file is not a wrinkles.json of version " + Version +
                               "; write one with 'furrow export --for unity'");
                return new string[0];
            }
            return Array.ConvertAll(file.weights, weight => weight.name);
        }
    }
}
