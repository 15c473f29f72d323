// SPDX-License-Identifier: Apache-2.0
// Stand-ins for the parts of UnityEngine, UnityEditor and NUnit that the package uses, so that it compiles and runs without
// Unity. What has a meaning here (blend shapes, shader arrays, JSON) works; the rest only has the right shape.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Reflection;
using System.Text;

namespace UnityEngine
{
    public class Object
    {
        public string name = "";

        public static implicit operator bool(Object exists)
        {
            return exists != null;
        }
    }

    public class GameObject : Object
    {
        public readonly List<MonoBehaviour> components = new List<MonoBehaviour>();

        public T AddComponent<T>() where T : MonoBehaviour, new()
        {
            var component = new T { gameObject = this, name = name };
            components.Add(component);
            return component;
        }
    }

    public class Component : Object
    {
        public GameObject gameObject = new GameObject();
        public Transform transform = null;
    }

    public class Transform : Component
    {
    }

    public class MonoBehaviour : Component
    {
        /// <summary>Calls a message of Unity, as Unity does: by its name, also if it is private.</summary>
        public void Send(string message)
        {
            MethodInfo method = GetType().GetMethod(
                message, BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.Public);
            if (method != null)
            {
                method.Invoke(this, null);
            }
        }
    }

    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>() where T : ScriptableObject, new()
        {
            return new T();
        }
    }

    public class TextAsset : Object
    {
        public string text = "";
    }

    public class Mesh : Object
    {
        public string[] blendShapes = new string[0];

        public int GetBlendShapeIndex(string shape)
        {
            return Array.IndexOf(blendShapes, shape);
        }
    }

    public class MaterialPropertyBlock
    {
        public readonly Dictionary<int, float[]> arrays = new Dictionary<int, float[]>();

        public void SetFloatArray(int id, float[] values)
        {
            arrays[id] = (float[])values.Clone();
        }
    }

    public class Texture : Object
    {
    }

    public class Material : Object
    {
        public readonly Dictionary<string, Texture> textures = new Dictionary<string, Texture>();

        public void SetTexture(string property, Texture texture)
        {
            textures[property] = texture;
        }
    }

    public class SkinnedMeshRenderer : Component
    {
        public Mesh sharedMesh = null;
        public Material[] sharedMaterials = new Material[0];
        public readonly Dictionary<int, float> shapes = new Dictionary<int, float>();
        public MaterialPropertyBlock block = null;

        public void SetBlendShapeWeight(int index, float percent)
        {
            shapes[index] = percent;
        }

        public void GetPropertyBlock(MaterialPropertyBlock into)
        {
        }

        public void SetPropertyBlock(MaterialPropertyBlock from)
        {
            block = from;
        }
    }

    public static class Shader
    {
        private static readonly List<string> Known = new List<string>();

        public static int PropertyToID(string property)
        {
            if (!Known.Contains(property))
            {
                Known.Add(property);
            }
            return Known.IndexOf(property);
        }
    }

    public static class Debug
    {
        public static void LogError(string message, Object context = null)
        {
            Console.WriteLine("LogError: " + message);
        }
    }

    public static class Application
    {
        public static bool isPlaying = true;
    }

    public static class GUILayout
    {
        public static bool Button(string text)
        {
            return false;
        }
    }

    public struct Keyframe
    {
        public float time;
        public float value;

        public Keyframe(float time, float value)
        {
            this.time = time;
            this.value = value;
        }
    }

    public class AnimationCurve
    {
        public Keyframe[] keys;

        public AnimationCurve(params Keyframe[] keys)
        {
            this.keys = keys;
        }

        public static AnimationCurve Linear(float timeStart, float valueStart, float timeEnd, float valueEnd)
        {
            return new AnimationCurve(new Keyframe(timeStart, valueStart), new Keyframe(timeEnd, valueEnd));
        }
    }

    public class AnimationClip : Object
    {
        public readonly Dictionary<string, AnimationCurve> curves = new Dictionary<string, AnimationCurve>();

        public void SetCurve(string path, Type type, string property, AnimationCurve curve)
        {
            curves[type.Name + "." + property] = curve;
        }
    }

    public sealed class TooltipAttribute : Attribute
    {
        public TooltipAttribute(string text)
        {
        }
    }

    public sealed class AddComponentMenuAttribute : Attribute
    {
        public AddComponentMenuAttribute(string path)
        {
        }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class ExecuteAlwaysAttribute : Attribute
    {
    }

    /// <summary>Fills the fields of an object from JSON, and ignores members without a field, as Unity's does.</summary>
    public static class JsonUtility
    {
        public static T FromJson<T>(string json)
        {
            int at = 0;
            return (T)Fill(typeof(T), Parse(json, ref at));
        }

        private static object Fill(Type type, object value)
        {
            if (value == null || type.IsInstanceOfType(value))
            {
                return value;
            }
            if (value is List<object>)
            {
                var list = (List<object>)value;
                Array array = Array.CreateInstance(type.GetElementType(), list.Count);
                for (int i = 0; i < list.Count; ++i)
                {
                    array.SetValue(Fill(type.GetElementType(), list[i]), i);
                }
                return array;
            }
            if (!(value is Dictionary<string, object>))
            {
                return Convert.ChangeType(value, type, CultureInfo.InvariantCulture);
            }
            object filled = Activator.CreateInstance(type, true);
            foreach (FieldInfo field in type.GetFields())
            {
                object member;
                if (((Dictionary<string, object>)value).TryGetValue(field.Name, out member))
                {
                    field.SetValue(filled, Fill(field.FieldType, member));
                }
            }
            return filled;
        }

        private static char Next(string json, ref int at)
        {
            while (at < json.Length && char.IsWhiteSpace(json[at]))
            {
                ++at;
            }
            if (at >= json.Length)
            {
                throw new ArgumentException("JSON parse error");
            }
            return json[at];
        }

        private static object Parse(string json, ref int at)
        {
            char c = Next(json, ref at);
            if (c == '{' || c == '[')
            {
                ++at;
                var list = new List<object>();
                var members = new Dictionary<string, object>();
                while (Next(json, ref at) != '}' && json[at] != ']')
                {
                    if (json[at] == ',')
                    {
                        ++at;
                        continue;
                    }
                    object value = Parse(json, ref at);
                    if (c == '[')
                    {
                        list.Add(value);
                        continue;
                    }
                    Next(json, ref at);
                    ++at;  // the colon
                    members[(string)value] = Parse(json, ref at);
                }
                ++at;
                return c == '{' ? (object)members : list;
            }
            if (c == '"')
            {
                var text = new StringBuilder();
                for (++at; json[at] != '"'; ++at)
                {
                    text.Append(json[at]);
                }
                ++at;
                return text.ToString();
            }
            int begin = at;
            while (at < json.Length && (char.IsLetterOrDigit(json[at]) || "+-.".IndexOf(json[at]) >= 0))
            {
                ++at;
            }
            string word = json.Substring(begin, at - begin);
            if (word == "")
            {
                throw new ArgumentException("JSON parse error");
            }
            return word == "null" ? null : word == "true" ? true : word == "false" ? (object)false
                : double.Parse(word, CultureInfo.InvariantCulture);
        }
    }
}

namespace UnityEditor
{
    public class Editor : UnityEngine.Object
    {
        public UnityEngine.Object target = null;

        public virtual void OnInspectorGUI()
        {
        }

        public virtual bool RequiresConstantRepaint()
        {
            return false;
        }

        public void DrawDefaultInspector()
        {
        }
    }

    public sealed class CustomEditorAttribute : Attribute
    {
        public CustomEditorAttribute(Type type)
        {
        }
    }

    public static class EditorGUILayout
    {
        public static void LabelField(string label, string text)
        {
        }
    }

    public static class EditorUtility
    {
        public static void SetDirty(UnityEngine.Object changed)
        {
        }
    }

    public static class AnimationUtility
    {
        public static string CalculateTransformPath(UnityEngine.Transform of, UnityEngine.Transform root)
        {
            return "";
        }
    }

    public static class AssetDatabase
    {
        public static readonly Dictionary<string, UnityEngine.Object> Assets = new Dictionary<string, UnityEngine.Object>();

        public static bool IsValidFolder(string path)
        {
            return false;
        }

        public static string CreateFolder(string parent, string folder)
        {
            return "";
        }

        public static void CreateAsset(UnityEngine.Object asset, string path)
        {
            Assets[path] = asset;
        }

        public static bool DeleteAsset(string path)
        {
            return Assets.Remove(path);
        }

        public static void SaveAssets()
        {
        }

        public static string GetAssetPath(UnityEngine.Object asset)
        {
            return Assets.FirstOrDefault(entry => ReferenceEquals(entry.Value, asset)).Key ?? "";
        }

        public static T LoadAssetAtPath<T>(string path) where T : UnityEngine.Object
        {
            UnityEngine.Object asset;
            return Assets.TryGetValue(path, out asset) ? asset as T : null;
        }
    }
}

namespace NUnit.Framework
{
    [AttributeUsage(AttributeTargets.Method)]
    public sealed class TestAttribute : Attribute
    {
    }

    public static class Assert
    {
        public static void AreEqual(object expected, object actual)
        {
            if (!Equals(expected, actual))
            {
                Fail("expected " + expected + ", got " + actual);
            }
        }

        public static void Fail(string message)
        {
            throw new Exception(message);
        }
    }
}
