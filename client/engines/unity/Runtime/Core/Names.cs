// SPDX-License-Identifier: Apache-2.0
using System.Collections.Generic;
using System.Text;

namespace Furrow
{
    /// <summary>Names of weights in shaders and on meshes, and their order.</summary>
    public static class Names
    {
        /// <summary>"brow_l.squash" becomes "furrow_brow_l_squash", as in all engines.</summary>
        public static string Property(string weight)
        {
            var text = new StringBuilder("furrow_");
            foreach (char c in weight)
            {
                bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
                text.Append(plain ? c : '_');
            }
            return text.ToString();
        }

        /// <summary>
        /// For each name of `to`, its index in `from`; -1 if it is missing there.
        /// </summary>
        public static int[] Map(IList<string> from, IList<string> to)
        {
            var places = new Dictionary<string, int>();
            for (int i = 0; i < from.Count; ++i)
            {
                places[from[i]] = i;
            }
            var map = new int[to.Count];
            for (int i = 0; i < to.Count; ++i)
            {
                int place;
                map[i] = places.TryGetValue(to[i], out place) ? place : -1;
            }
            return map;
        }
    }
}
