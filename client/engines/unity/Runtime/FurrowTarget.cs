// SPDX-License-Identifier: Apache-2.0
using UnityEngine;

namespace Furrow
{
    /// <summary>
    /// Puts the weights of one subject on a mesh: on blend shapes named like the weight ("brow_l.squash") or its property
    /// ("furrow_brow_l_squash"), and into the shader array _FurrowWeights in the order of an exported wrinkles.json.
    /// </summary>
    [ExecuteAlways]
    [AddComponentMenu("Furrow/Furrow Target")]
    public sealed class FurrowTarget : MonoBehaviour
    {
        private static readonly int WeightsId = Shader.PropertyToID("_FurrowWeights");

        public FurrowReceiver receiver;

        [Tooltip("Name of the performer; empty: the oldest one")]
        public string subject = "";

        public SkinnedMeshRenderer mesh;

        [Tooltip("wrinkles.json of 'furrow export --for unity'; may be empty")]
        public TextAsset wrinkles;

        [Tooltip("A recording to play instead of the live weights; may be empty")]
        public FurrowTakeAsset take;

        [Tooltip("Time in the recording, in seconds; animate it")]
        public float takeTime;

        private readonly WeightOrder order = new WeightOrder();
        private MaterialPropertyBlock block;
        private Subject live;
        private long shown;
        private string[] mappedNames;
        private TextAsset mappedWrinkles;
        private int[] shapes = new int[0];
        private float[] sampled = new float[0];
        private Take recording;

        public bool IsRecording
        {
            get { return recording != null; }
        }

        /// <summary>One line for people: age, losses, names in use.</summary>
        public string Status
        {
            get
            {
                string line = receiver != null ? receiver.StatusOf(live) : "no receiver";
                return live == null ? line : line + ", " + Covered() + " of " + live.Names.Length + " names in use";
            }
        }

        public void StartRecording()
        {
            recording = new Take();
        }

        /// <summary>Ends the recording and returns it; null if nothing was recorded.</summary>
        public Take StopRecording()
        {
            Take ended = recording;
            recording = null;
            return ended != null && ended.Times.Count > 0 ? ended : null;
        }

        /// <summary>How many names a blend shape or the shader uses.</summary>
        public int Covered()
        {
            int count = 0;
            for (int i = 0; i < shapes.Length; ++i)
            {
                if (shapes[i] >= 0 || order.Uses(i))
                {
                    ++count;
                }
            }
            return count;
        }

        /// <summary>Shows weights. Values outside of [0, 1] are the caller's mistake.</summary>
        public void Apply(string[] names, float[] values)
        {
            MapNames(names);
            for (int i = 0; mesh != null && i < shapes.Length; ++i)
            {
                if (shapes[i] >= 0)
                {
                    mesh.SetBlendShapeWeight(shapes[i], 100 * values[i]);
                }
            }
            if (mesh == null || order.Count == 0)
            {
                return;
            }
            block = block ?? new MaterialPropertyBlock();
            mesh.GetPropertyBlock(block);
            block.SetFloatArray(WeightsId, order.Arrange(values));
            mesh.SetPropertyBlock(block);
        }

        private void LateUpdate()
        {
            Follow(receiver != null ? receiver.Follow(subject) : null);
            if (take != null)
            {
                if (sampled.Length != take.names.Length)
                {
                    sampled = new float[take.names.Length];
                }
                Take.Sample(take.times, take.values, takeTime, sampled);
                Apply(take.names, sampled);
            }
            else if (live != null && live.Frames != shown)
            {
                shown = live.Frames;
                Apply(live.Names, live.Values);
            }
        }

        private void OnDisable()
        {
            Follow(null);
        }

        private void Follow(Subject next)
        {
            if (ReferenceEquals(live, next))
            {
                return;
            }
            if (live != null)
            {
                live.Received -= OnReceived;
            }
            live = next;
            shown = 0;
            if (live != null)
            {
                live.Received += OnReceived;
            }
        }

        private void OnReceived(Subject from)
        {
            if (recording != null)
            {
                recording.Add(from);
            }
        }

        private void MapNames(string[] names)
        {
            if (ReferenceEquals(names, mappedNames) && ReferenceEquals(wrinkles, mappedWrinkles))
            {
                return;
            }
            mappedNames = names;
            mappedWrinkles = wrinkles;
            shapes = new int[names.Length];
            for (int i = 0; i < names.Length; ++i)
            {
                shapes[i] = -1;
                if (mesh != null && mesh.sharedMesh != null)
                {
                    int plain = mesh.sharedMesh.GetBlendShapeIndex(names[i]);
                    shapes[i] = plain >= 0 ? plain : mesh.sharedMesh.GetBlendShapeIndex(Names.Property(names[i]));
                }
            }
            order.Set(wrinkles != null ? WrinklesJson.NamesOf(wrinkles.text) : new string[0], names);
        }
    }
}
