// SPDX-License-Identifier: Apache-2.0
using UnityEditor;
using UnityEngine;

namespace Furrow.Editor
{
    /// <summary>Shows the status of a target, records it with one button, and removes the recording with another. A third sets
    /// the textures of exported wrinkle shaders.</summary>
    [CustomEditor(typeof(FurrowTarget))]
    public sealed class FurrowTargetEditor : UnityEditor.Editor
    {
        private string textures = "";

        public override void OnInspectorGUI()
        {
            DrawDefaultInspector();
            var one = (FurrowTarget)target;
            EditorGUILayout.LabelField("Status", one.Status);
            if (GUILayout.Button(one.IsRecording ? "Stop" : "Record"))
            {
                if (one.IsRecording)
                {
                    Take take = one.StopRecording();
                    if (take != null)
                    {
                        RecordingAssets.Save(one, take);
                    }
                }
                else
                {
                    one.StartRecording();
                }
            }
            if (GUILayout.Button("Clear Recording"))
            {
                RecordingAssets.Delete(one);
            }
            if (GUILayout.Button("Set Wrinkle Textures"))
            {
                textures = WrinkleTextures.Set(one);
            }
            if (textures != "")
            {
                EditorGUILayout.LabelField("Textures", textures);
            }
        }

        public override bool RequiresConstantRepaint()
        {
            return Application.isPlaying;
        }
    }
}
