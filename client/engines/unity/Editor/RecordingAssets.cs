// SPDX-License-Identifier: Apache-2.0
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace Furrow.Editor
{
    /// <summary>
    /// A recording as two assets: all frames (FurrowTakeAsset), and an animation clip that moves the time in them and the
    /// blend shapes. The clip works in an Animator and on a Timeline.
    /// </summary>
    internal static class RecordingAssets
    {
        private const string Folder = "Assets/Furrow";

        public static void Save(FurrowTarget target, Take take)
        {
            if (!AssetDatabase.IsValidFolder(Folder))
            {
                AssetDatabase.CreateFolder("Assets", "Furrow");
            }
            Delete(target);
            var asset = ScriptableObject.CreateInstance<FurrowTakeAsset>();
            asset.names = take.Names;
            asset.times = take.Times.ToArray();
            asset.values = take.Values.ToArray();
            AssetDatabase.CreateAsset(asset, PathOf(target, "asset"));
            AssetDatabase.CreateAsset(MakeClip(target, take), PathOf(target, "anim"));
            AssetDatabase.SaveAssets();
            target.take = asset;
            EditorUtility.SetDirty(target);
        }

        public static void Delete(FurrowTarget target)
        {
            target.take = null;
            EditorUtility.SetDirty(target);
            AssetDatabase.DeleteAsset(PathOf(target, "asset"));
            AssetDatabase.DeleteAsset(PathOf(target, "anim"));
        }

        private static string PathOf(FurrowTarget target, string ending)
        {
            return Folder + "/" + Names.Property(target.name).Substring("furrow_".Length) + "." + ending;
        }

        private static AnimationClip MakeClip(FurrowTarget target, Take take)
        {
            var clip = new AnimationClip();
            clip.SetCurve("", typeof(FurrowTarget), "takeTime", AnimationCurve.Linear(0, 0, take.Length, take.Length));
            Mesh mesh = target.mesh != null ? target.mesh.sharedMesh : null;
            string path = mesh != null
                ? AnimationUtility.CalculateTransformPath(target.mesh.transform, target.transform) : "";
            for (int i = 0; mesh != null && i < take.Names.Length; ++i)
            {
                foreach (string shape in new[] { take.Names[i], Names.Property(take.Names[i]) })
                {
                    if (mesh.GetBlendShapeIndex(shape) >= 0)
                    {
                        clip.SetCurve(path, typeof(SkinnedMeshRenderer), "blendShape." + shape, CurveOf(take, i));
                    }
                }
            }
            return clip;
        }

        private static AnimationCurve CurveOf(Take take, int weight)
        {
            var keys = new List<Keyframe>();
            for (int frame = 0; frame < take.Times.Count; ++frame)
            {
                keys.Add(new Keyframe(take.Times[frame], 100 * take.Values[frame * take.Names.Length + weight]));
            }
            return new AnimationCurve(keys.ToArray());
        }
    }
}
