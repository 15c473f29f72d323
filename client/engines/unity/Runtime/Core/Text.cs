// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Furrow
{
    /// <summary>Text between C#, and C with UTF-8 and zero bytes.</summary>
    internal static class Text
    {
        public static byte[] ToC(string text)
        {
            return Encoding.UTF8.GetBytes((text ?? "") + "\0");
        }

        public static string FromC(byte[] buffer)
        {
            int length = Array.IndexOf(buffer, (byte)0);
            return Encoding.UTF8.GetString(buffer, 0, length < 0 ? buffer.Length : length);
        }

        public static string FromC(IntPtr text)
        {
            int length = 0;
            while (Marshal.ReadByte(text, length) != 0)
            {
                ++length;
            }
            var bytes = new byte[length];
            Marshal.Copy(text, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        /// <summary>Whether C text has these bytes, which end with zero. Allocates nothing.</summary>
        public static bool Equals(IntPtr text, byte[] bytes)
        {
            for (int i = 0; i < bytes.Length; ++i)
            {
                if (Marshal.ReadByte(text, i) != bytes[i])
                {
                    return false;
                }
            }
            return true;
        }
    }
}
