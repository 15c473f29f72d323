// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.InteropServices;

namespace Furrow
{
    /// <summary>The functions of furrow/furrow.h that receive weights. The header is the manual.</summary>
    internal static class Native
    {
        // libfurrow.so; Unity finds it in a folder Plugins, other programs by the system's search path.
        private const string Library = "furrow";

        public const int Ok = 0;
        public const int NoData = 2;
        public const uint OpenWithoutSubscription = 1;
        public const uint FrameSubjectGone = 1;
        public const uint FrameDecaying = 2;
        public const int NameSize = 256;
        public const int MaxWeights = 2048;

        [StructLayout(LayoutKind.Sequential)]
        public struct Options
        {
            public uint StructSize;
            public uint Flags;
            public IntPtr Program;
            public IntPtr Error;
            public uint ErrorSize;
            public uint Tls;
            public IntPtr Token;
            public IntPtr ServerKey;
            public IntPtr TlsAuthority;
        }

        [StructLayout(LayoutKind.Sequential)]
        public struct Info
        {
            public uint StructSize;
            public int State;
            public ulong Connects;
            public ulong Malformed;
            public uint Subjects;
            public uint Streams;
        }

        [StructLayout(LayoutKind.Sequential)]
        public struct Subscription
        {
            public uint StructSize;
            public uint Flags;
            public IntPtr Subject;
            public IntPtr Pattern;
            public float MaxRateHz;
            public uint Reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        public struct Frame
        {
            public uint StructSize;
            public uint Flags;
            public uint Count;
            public uint Sequence;
            public ulong Layout;
            public ulong Number;
            public ulong Missed;
            public long CaptureTimeUs;
            public long AgeUs;
            public ulong TimecodeBytes0To7;  // 16 bytes of text
            public ulong TimecodeBytes8To15;
            public uint TimecodeRateNumerator;
            public uint TimecodeRateDenominator;
        }

        /// <summary>Copies a frame of a callback. An older library passes a shorter one; what it lacks is 0.</summary>
        public static Frame ReadFrame(IntPtr frame)
        {
            int size = Marshal.SizeOf(typeof(Frame));
            int given = Marshal.ReadInt32(frame);
            if (given >= size)
            {
                return (Frame)Marshal.PtrToStructure(frame, typeof(Frame));
            }
            IntPtr whole = Marshal.AllocHGlobal(size);
            try
            {
                for (int i = 0; i < size; ++i)
                {
                    Marshal.WriteByte(whole, i, i < given ? Marshal.ReadByte(frame, i) : (byte)0);
                }
                return (Frame)Marshal.PtrToStructure(whole, typeof(Frame));
            }
            finally
            {
                Marshal.FreeHGlobal(whole);
            }
        }

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        public delegate void OnWeights(IntPtr user, IntPtr subject, IntPtr frame, IntPtr values);

        [StructLayout(LayoutKind.Sequential)]
        public struct Callbacks
        {
            public uint StructSize;
            public uint Reserved;
            public IntPtr User;
            public IntPtr Weights;
            public IntPtr Layout;
            public IntPtr SubjectGone;
            public IntPtr State;
        }

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern uint furrow_abi_version();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr furrow_status_text(int status);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_open(byte[] address, ref Options options, out IntPtr connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void furrow_close(IntPtr connection);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_poll(IntPtr connection, int timeoutMs);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_get_info(IntPtr connection, ref Info info);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_last_error(IntPtr connection, byte[] buffer, uint size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_subscribe(IntPtr connection, ref Subscription subscription);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_unsubscribe(IntPtr connection, byte[] subject);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_subject_name(IntPtr connection, uint index, byte[] buffer, uint size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_weights(IntPtr connection, byte[] subject, float[] values, uint capacity,
                                                ref Frame frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_layout(IntPtr connection, byte[] subject, out uint count, out ulong layout);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_weight_name(IntPtr connection, byte[] subject, uint index, byte[] buffer,
                                                    uint size);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int furrow_set_callbacks(IntPtr connection, ref Callbacks callbacks);
    }
}
