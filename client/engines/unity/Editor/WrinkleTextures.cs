// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace Furrow.Editor
{
    /// <summary>Sets the textures of exported wrinkle shaders on the materials of a target's mesh, as its wrinkles.json says.
    /// The shaders' textures do not appear in a graph.</summary>
    internal static class WrinkleTextures
    {
        [Serializable]
        private sealed class File
        {
            public string format = "";
            public Map[] maps = new Map[0];
            public Mask[] masks = new Mask[0];
            public Surface[] materials = new Surface[0];
        }

        [Serializable]
        private sealed class Map
        {
            public string normal = "";
            public string colour = "";
            public string cavity = "";
        }

        [Serializable]
        private sealed class Mask
        {
            public string file = "";
        }

        [Serializable]
        private sealed class Surface
        {
            public string name = "";
            public string base_normal = "";
            public int[] maps = new int[0];
            public int[] masks = new int[0];
        }

        /// <summary>Returns what was set, or why nothing was.</summary>
        public static string Set(FurrowTarget target)
        {
            if (target.wrinkles == null || target.mesh == null)
            {
                return "Set Mesh and Wrinkles first";
            }
            string path = AssetDatabase.GetAssetPath(target.wrinkles);
            string folder = path.Substring(0, path.LastIndexOf('/') + 1);
            var file = JsonUtility.FromJson<File>(target.wrinkles.text);
            var missing = new List<string>();
            int count = 0;
            foreach (Surface surface in file.materials)
            {
                Material material = Array.Find(target.mesh.sharedMaterials, each => each != null && each.name == surface.name);
                if (material == null)
                {
                    continue;
                }
                foreach (KeyValuePair<string, string> entry in TexturesOf(file, surface))
                {
                    var texture = AssetDatabase.LoadAssetAtPath<Texture>(folder + entry.Value);
                    if (texture == null)
                    {
                        missing.Add(folder + entry.Value);
                        continue;
                    }
                    material.SetTexture(entry.Key, texture);
                    ++count;
                }
                EditorUtility.SetDirty(material);
            }
            if (missing.Count > 0)
            {
                return missing[0] + " is missing; copy the whole folder of the export into Assets";
            }
            return count > 0 ? count + " textures set"
                             : "no material of the mesh has a name of wrinkles.json: " +
                               string.Join(", ", Array.ConvertAll(file.materials, each => each.name));
        }

        /// <summary>Files by the names of shader properties.</summary>
        private static List<KeyValuePair<string, string>> TexturesOf(File file, Surface surface)
        {
            var list = new List<KeyValuePair<string, string>>();
            Add(list, "_FurrowBaseNormal", surface.base_normal);
            foreach (int i in surface.maps)
            {
                Add(list, "_FurrowNormal" + i, file.maps[i].normal);
                Add(list, "_FurrowColour" + i, file.maps[i].colour);
                Add(list, "_FurrowCavity" + i, file.maps[i].cavity);
            }
            foreach (int i in surface.masks)
            {
                Add(list, "_FurrowMask" + i, file.masks[i].file);
            }
            return list;
        }

        private static void Add(List<KeyValuePair<string, string>> list, string property, string file)
        {
            if (!string.IsNullOrEmpty(file))
            {
                list.Add(new KeyValuePair<string, string>(property, file));
            }
        }
    }
}
