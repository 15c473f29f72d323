// SPDX-License-Identifier: Apache-2.0
// The package in a program of its own, which sends Unity's messages to the components. Arguments: the address, and the
// number of frames to receive.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Threading;
using Furrow;
using UnityEngine;

public static class Program
{
    private static readonly string[] SubjectNames = { "ada", "bob" };
    private static FurrowReceiver receiver;
    private static readonly List<FurrowTarget> Targets = new List<FurrowTarget>();
    private static readonly Dictionary<string, Run> Runs = new Dictionary<string, Run>();

    private sealed class Run
    {
        public int Current;
        public int Longest;
        public uint Last;
    }

    private static void Tell(string name, string more = "")
    {
        Console.WriteLine("furrow-test: {\"event\": \"" + name + "\"" + more + "}");
    }

    private static void Check(bool condition, string what)
    {
        if (!condition)
        {
            throw new Exception("check failed: " + what);
        }
    }

    // One picture of the engine.
    private static void Picture()
    {
        receiver.Send("Update");
        foreach (FurrowTarget target in Targets)
        {
            target.Send("LateUpdate");
        }
        Thread.Sleep(2);
    }

    private static void RunTestsOfThePackage()
    {
        int count = 0;
        foreach (MethodInfo test in typeof(Furrow.Tests.CoreTests).GetMethods())
        {
            if (test.GetCustomAttributes(typeof(NUnit.Framework.TestAttribute), false).Length > 0)
            {
                test.Invoke(new Furrow.Tests.CoreTests(), null);
                ++count;
            }
        }
        Check(count == 4, "tests of the package");
    }

    private static void CheckFrameOfAnOlderLibrary()
    {
        int whole = Marshal.SizeOf(typeof(Native.Frame));
        IntPtr frame = Marshal.AllocHGlobal(whole);
        for (int i = 0; i < whole; ++i)
        {
            Marshal.WriteByte(frame, i, 0x31);
        }
        foreach (int size in new[] { 56, whole })
        {
            Marshal.WriteInt32(frame, size);
            Native.Frame read = Native.ReadFrame(frame);
            Check(read.CaptureTimeUs == 0x3131313131313131L, "what both libraries have");
            Check(read.TimecodeRateNumerator == (size == whole ? 0x31313131u : 0u), "the rate");
            Check((read.TimecodeBytes0To7 != 0) == (size == whole), "the timecode");
        }
        Marshal.FreeHGlobal(frame);
    }

    private static SkinnedMeshRenderer MeshWithShape(string name)
    {
        var mesh = new SkinnedMeshRenderer { name = name };
        mesh.sharedMesh = new Mesh { blendShapes = new[] { "furrow_brow_l_squash" } };
        mesh.gameObject.name = name;
        return mesh;
    }

    private static void Watch(Subject subject)
    {
        var run = new Run();
        Runs[subject.Requested] = run;
        subject.Received += one =>
        {
            bool follows = one.Frames == 1 || one.Sequence == run.Last + 1;
            run.Last = one.Sequence;
            run.Current = follows && !one.IsDecaying ? run.Current + 1 : 1;
            run.Longest = Math.Max(run.Longest, run.Current);
        };
    }

    public static int Main(string[] arguments)
    {
        RunTestsOfThePackage();
        CheckFrameOfAnOlderLibrary();
        CheckTextures();
        int needed = int.Parse(arguments[1]);
        var sample = new TwoFaces { first = MeshWithShape("Ada's face"), second = MeshWithShape("bob") };
        sample.Send("Start");
        receiver = (FurrowReceiver)sample.gameObject.components.Single();
        receiver.address = arguments[0];
        foreach (SkinnedMeshRenderer mesh in new[] { sample.first, sample.second })
        {
            Targets.Add((FurrowTarget)mesh.gameObject.components.Single());
        }
        Targets[0].wrinkles = new TextAsset
        {
            text = "{\"format\": \"furrow-wrinkles\", \"version\": 1, \"masks\": [1.5e0, null, [true]], \"weights\": [" +
                   "{\"name\": \"nose.squash\", \"index\": 0}, {\"name\": \"elsewhere\"}, {\"name\": \"brow_l.squash\"}]}",
        };
        receiver.Send("OnEnable");
        // Until the performance raises the brows.
        while (SubjectNames.Any(name => receiver.Follow(name).Frames == 0) || sample.first.shapes[0] == 0)
        {
            Picture();
        }
        foreach (string name in SubjectNames)
        {
            Watch(receiver.Follow(name));
        }
        Targets[0].StartRecording();
        float highest = 0;
        while (Runs.Values.Any(run => run.Longest < needed))
        {
            Picture();
            float shape = sample.first.shapes[0] / 100;
            float[] array = sample.first.block.arrays[Shader.PropertyToID("_FurrowWeights")];
            Check(array.Length == 3 && array[1] == 0 && Math.Abs(array[2] - shape) < 1e-6f, "the order of wrinkles.json");
            highest = Math.Max(highest, shape);
        }
        CheckTimecode();
        Tell("received", ", \"runs\": {" + string.Join(", ", Runs.Select(run => "\"" + run.Key + "\": " + run.Value.Longest)) +
             "}, \"highest\": " + highest.ToString(System.Globalization.CultureInfo.InvariantCulture) +
             ", \"status\": \"" + Targets[0].Status + "\"");
        CheckRecording();

        while (receiver.Status != "connection lost, trying again: " + receiver.address)
        {
            Picture();
        }
        Tell("lost");
        Dictionary<string, long> before = SubjectNames.ToDictionary(name => name, name => receiver.Follow(name).Frames);
        while (SubjectNames.Any(name => receiver.Follow(name).Frames == before[name] || receiver.Follow(name).IsDecaying))
        {
            Picture();
        }
        Tell("again");

        // Disconnect and connect at run time.
        receiver.Disconnect();
        Picture();
        Check(!receiver.IsOpen && receiver.Status == "not connected" && receiver.Follow("ada") == null, "disconnected");
        receiver.Connect();
        while (receiver.Follow("bob").Frames == 0)
        {
            Picture();
        }
        CheckOldestSubject();
        Targets[0].Send("OnDisable");
        receiver.Send("OnDisable");
        receiver.address = "nowhere://";
        receiver.Connect();
        Check(!receiver.IsOpen && receiver.Status.Contains("furrow://"), "an invalid address is explained");
        Tell("end");
        return 0;
    }

    private static void CheckTimecode()
    {
        Subject phone = receiver.Follow("cam");
        while (phone.Frames == 0)
        {
            Picture();
        }
        // The recording of the phone lasts a second, and repeats.
        Check(phone.Timecode.Length == 11 && phone.Timecode.StartsWith("10:00:00:"), "timecode " + phone.Timecode);
        Check(phone.TimecodeRateNumerator == 60 && phone.TimecodeRateDenominator == 1, "rate of the timecode");
        Check(receiver.Follow("ada").Timecode == "" && receiver.Follow("ada").TimecodeRateNumerator == 0, "BVH has none");
    }

    private static void CheckRecording()
    {
        Furrow.Take take = Targets[0].StopRecording();
        int index = Array.IndexOf(take.Names, "brow_l.squash");
        int width = take.Names.Length;
        int peak = Enumerable.Range(0, take.Times.Count)
            .OrderByDescending(frame => take.Values[frame * width + index]).First();
        Furrow.Editor.RecordingAssetsTest.Save(Targets[0], take);
        var clip = (AnimationClip)UnityEditor.AssetDatabase.Assets["Assets/Furrow/Ada_s_face.anim"];
        Check(clip.curves["SkinnedMeshRenderer.blendShape.furrow_brow_l_squash"].keys.Length == take.Times.Count, "keys");
        // The asset plays without the connection, and moves the mesh as the performer did.
        Targets[0].takeTime = take.Times[peak];
        Targets[0].Send("LateUpdate");
        Check(Math.Abs(Targets[0].mesh.shapes[0] / 100 - take.Values[peak * width + index]) < 1e-6f, "the take plays");
        Tell("recorded", ", \"keys\": " + take.Times.Count + ", \"length\": " +
             take.Length.ToString(System.Globalization.CultureInfo.InvariantCulture));
        Furrow.Editor.RecordingAssetsTest.Delete(Targets[0]);
        Check(UnityEditor.AssetDatabase.Assets.Count == 0 && Targets[0].take == null, "cleared");
    }

    /// <summary>Only the materials of the mesh get textures, and a missing file is named.</summary>
    private static void CheckTextures()
    {
        var assets = UnityEditor.AssetDatabase.Assets;
        var skin = new Material { name = "skin" };
        var target = new FurrowTarget { mesh = new SkinnedMeshRenderer() };
        Check(Furrow.Editor.RecordingAssetsTest.SetTextures(target).Contains("Wrinkles"), "no file yet");
        target.wrinkles = new TextAsset
        {
            text = "{\"format\": \"furrow-wrinkles\", \"version\": 1, \"maps\": [{\"normal\": \"textures/a.png\", \"colour\": null}, " +
                   "{\"normal\": \"textures/b.png\", \"cavity\": \"textures/c.png\"}], \"masks\": [{\"file\": \"textures/m.png\"}], " +
                   "\"materials\": [{\"name\": \"skin\", \"base_normal\": \"textures/s.png\", \"maps\": [1], \"masks\": [0]}, " +
                   "{\"name\": \"cloth\", \"maps\": [0], \"masks\": [0]}]}",
        };
        assets["Assets/Face/wrinkles.json"] = target.wrinkles;
        Check(Furrow.Editor.RecordingAssetsTest.SetTextures(target).Contains("skin, cloth"), "no material of the mesh");
        target.mesh.sharedMaterials = new[] { null, skin };
        foreach (string name in new[] { "b", "c", "m" })
        {
            assets["Assets/Face/textures/" + name + ".png"] = new Texture { name = name };
        }
        Check(Furrow.Editor.RecordingAssetsTest.SetTextures(target).StartsWith("Assets/Face/textures/s.png is missing"), "a file is missing");
        assets["Assets/Face/textures/s.png"] = new Texture { name = "s" };
        Check(Furrow.Editor.RecordingAssetsTest.SetTextures(target) == "4 textures set", "all are set");
        string set = string.Join(" ", skin.textures.OrderBy(each => each.Key).Select(each => each.Key + "=" + each.Value.name));
        Check(set == "_FurrowBaseNormal=s _FurrowCavity1=c _FurrowMask0=m _FurrowNormal1=b", set);
        assets.Clear();
    }

    private static void CheckOldestSubject()
    {
        Subject oldest = receiver.Follow("");
        while (oldest.Frames == 0)
        {
            Picture();
        }
        Check(SubjectNames.Contains(oldest.Name) || oldest.Name == "cam", "the oldest subject has a name");
        Check(oldest.Names.Length == oldest.Values.Length, "names and values");
    }
}

namespace Furrow.Editor
{
    /// <summary>Reaches the internal classes.</summary>
    public static class RecordingAssetsTest
    {
        public static void Save(FurrowTarget target, Take take)
        {
            RecordingAssets.Save(target, take);
        }

        public static void Delete(FurrowTarget target)
        {
            RecordingAssets.Delete(target);
        }

        public static string SetTextures(FurrowTarget target)
        {
            return WrinkleTextures.Set(target);
        }
    }
}
