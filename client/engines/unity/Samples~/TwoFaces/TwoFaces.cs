// SPDX-License-Identifier: Apache-2.0
using Furrow;
using UnityEngine;

/// <summary>Two subjects on two meshes. Add this to an empty object, and assign the meshes.</summary>
public sealed class TwoFaces : MonoBehaviour
{
    public SkinnedMeshRenderer first;
    public SkinnedMeshRenderer second;
    public string firstSubject = "ada";
    public string secondSubject = "bob";

    private void Start()
    {
        FurrowReceiver receiver = gameObject.AddComponent<FurrowReceiver>();
        AddTarget(receiver, first, firstSubject);
        AddTarget(receiver, second, secondSubject);
    }

    private static void AddTarget(FurrowReceiver receiver, SkinnedMeshRenderer mesh, string subject)
    {
        FurrowTarget target = mesh.gameObject.AddComponent<FurrowTarget>();
        target.receiver = receiver;
        target.mesh = mesh;
        target.subject = subject;
    }
}
