// SPDX-License-Identifier: Apache-2.0
using UnityEditor;
using UnityEngine;

namespace Furrow.Editor
{
    /// <summary>Shows the connection, and connects and disconnects at run time.</summary>
    [CustomEditor(typeof(FurrowReceiver))]
    public sealed class FurrowReceiverEditor : UnityEditor.Editor
    {
        public override void OnInspectorGUI()
        {
            DrawDefaultInspector();
            var receiver = (FurrowReceiver)target;
            EditorGUILayout.LabelField("Status", receiver.Status);
            if (GUILayout.Button(receiver.IsOpen ? "Disconnect" : "Connect"))
            {
                if (receiver.IsOpen)
                {
                    receiver.Disconnect();
                }
                else
                {
                    receiver.Connect();
                }
            }
        }

        public override bool RequiresConstantRepaint()
        {
            return Application.isPlaying;
        }
    }
}
