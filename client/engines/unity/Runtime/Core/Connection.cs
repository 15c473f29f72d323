// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace Furrow
{
    /// <summary>State of a connection.</summary>
    public enum ConnectionState
    {
        Connecting = 0,
        Connected = 1,
        Lost = 2,
    }

    /// <summary>
    /// A connection to furrowd over libfurrow. It connects, and connects again after losses, by itself. Use it on one
    /// thread. Needs no UnityEngine.
    /// </summary>
    public sealed class Connection : IDisposable
    {
        // Kept alive as long as C may call it. IL2CPP can only call static methods with the attribute.
        private static readonly Native.OnWeights WeightsFunction = OnWeights;

        private readonly List<Subject> subjects = new List<Subject>();
        private readonly float[] scratch = new float[Native.MaxWeights];
        private IntPtr handle;
        private GCHandle self;
        private Exception thrown;
        private bool polling;

        /// <summary>Opens a connection and returns at once; Poll() connects.</summary>
        /// <param name="address">"furrow://host[:port][?transport=tcp]" or "host[:port]".</param>
        /// <exception cref="FurrowException">The address is invalid, or the library is too new.</exception>
        /// <exception cref="DllNotFoundException">libfurrow.so was not found.</exception>
        public Connection(string address)
        {
            uint version = Native.furrow_abi_version();
            if (version > 1)
            {
                throw new FurrowException("libfurrow has interface version " + version + "; this package needs 0 or 1");
            }
            var error = new byte[1024];
            byte[] program = Text.ToC("furrow-unity");
            GCHandle errorPin = GCHandle.Alloc(error, GCHandleType.Pinned);
            GCHandle programPin = GCHandle.Alloc(program, GCHandleType.Pinned);
            try
            {
                var options = new Native.Options
                {
                    StructSize = (uint)Marshal.SizeOf(typeof(Native.Options)),
                    Flags = Native.OpenWithoutSubscription,
                    Program = programPin.AddrOfPinnedObject(),
                    Error = errorPin.AddrOfPinnedObject(),
                    ErrorSize = (uint)error.Length,
                };
                int status = Native.furrow_open(Text.ToC(address), ref options, out handle);
                if (status < Native.Ok)
                {
                    string message = Text.FromC(error);
                    throw new FurrowException(message != "" ? message : StatusText(status));
                }
            }
            finally
            {
                errorPin.Free();
                programPin.Free();
            }
            Address = address;
            self = GCHandle.Alloc(this);
            var callbacks = new Native.Callbacks
            {
                StructSize = (uint)Marshal.SizeOf(typeof(Native.Callbacks)),
                User = GCHandle.ToIntPtr(self),
                Weights = Marshal.GetFunctionPointerForDelegate(WeightsFunction),
            };
            Check(Native.furrow_set_callbacks(handle, ref callbacks));
        }

        public string Address { get; private set; }

        public IList<Subject> Subjects
        {
            get { return subjects.AsReadOnly(); }
        }

        public ConnectionState State
        {
            get
            {
                var info = new Native.Info { StructSize = (uint)Marshal.SizeOf(typeof(Native.Info)) };
                Check(Native.furrow_get_info(Handle, ref info));
                return (ConnectionState)info.State;
            }
        }

        private IntPtr Handle
        {
            get
            {
                if (handle == IntPtr.Zero)
                {
                    throw new ObjectDisposedException("Furrow.Connection");
                }
                return handle;
            }
        }

        /// <summary>Ends the connection. May be called again, but not inside Subject.Received.</summary>
        public void Dispose()
        {
            if (handle == IntPtr.Zero)
            {
                return;
            }
            if (polling)
            {
                throw new InvalidOperationException("Connection.Dispose() must not be called inside Subject.Received");
            }
            Native.furrow_close(handle);
            handle = IntPtr.Zero;
            self.Free();
        }

        /// <summary>Follows a subject, which need not be there yet.</summary>
        /// <param name="name">Its name; empty: the oldest subject.</param>
        /// <param name="pattern">Names of the weights as comma-separated globs; empty: all.</param>
        /// <param name="maxRateHz">Most frames per second; 0: every pose.</param>
        public Subject Subscribe(string name, string pattern = "", float maxRateHz = 0)
        {
            var subject = new Subject(name);
            byte[] globs = Text.ToC(pattern);
            GCHandle namePin = GCHandle.Alloc(subject.Key, GCHandleType.Pinned);
            GCHandle globsPin = GCHandle.Alloc(globs, GCHandleType.Pinned);
            try
            {
                var request = new Native.Subscription
                {
                    StructSize = (uint)Marshal.SizeOf(typeof(Native.Subscription)),
                    Subject = namePin.AddrOfPinnedObject(),
                    Pattern = globsPin.AddrOfPinnedObject(),
                    MaxRateHz = maxRateHz,
                };
                Check(Native.furrow_subscribe(Handle, ref request));
            }
            finally
            {
                namePin.Free();
                globsPin.Free();
            }
            subjects.Add(subject);
            return subject;
        }

        public void Unsubscribe(Subject subject)
        {
            Check(Native.furrow_unsubscribe(Handle, subject.Key));
            subjects.Remove(subject);
        }

        /// <summary>
        /// Does all the work of the connection without waiting: receives, and raises Subject.Received. Call it once per
        /// picture, and at least once per second.
        /// </summary>
        public void Poll()
        {
            UpdateNames();
            polling = true;
            int status = Native.furrow_poll(Handle, 0);
            polling = false;
            Exception failure = thrown;
            thrown = null;
            if (failure != null)
            {
                throw failure;
            }
            Check(status);
            UpdateNames();
        }

        /// <summary>What is known of a subject right now.</summary>
        public SubjectStatus StatusOf(Subject subject)
        {
            var frame = new Native.Frame { StructSize = (uint)Marshal.SizeOf(typeof(Native.Frame)) };
            int status = Native.furrow_weights(Handle, subject.Key, scratch, (uint)scratch.Length, ref frame);
            string message = "";
            if (status == Native.NoData)
            {
                message = "waiting for the subject";
            }
            else if (status < Native.Ok)
            {
                message = LastError();
                message = message != "" ? message : StatusText(status);
            }
            return new SubjectStatus
            {
                HasWeights = status == Native.Ok,
                Message = message,
                AgeMs = frame.AgeUs / 1000.0,
                Missed = (long)frame.Missed,
                IsGone = (frame.Flags & Native.FrameSubjectGone) != 0,
            };
        }

        /// <summary>What the daemon or the network reported last; empty if nothing did.</summary>
        public string LastError()
        {
            var buffer = new byte[1024];
            Native.furrow_last_error(Handle, buffer, (uint)buffer.Length);
            return Text.FromC(buffer);
        }

        [MonoPInvokeCallback(typeof(Native.OnWeights))]
        private static void OnWeights(IntPtr user, IntPtr subject, IntPtr frame, IntPtr values)
        {
            // No exception may pass through C, so Poll() throws it later.
            var connection = (Connection)GCHandle.FromIntPtr(user).Target;
            try
            {
                connection.Take(subject, Native.ReadFrame(frame), values);
            }
            catch (Exception error)
            {
                connection.thrown = connection.thrown ?? error;
            }
        }

        private void Take(IntPtr name, Native.Frame frame, IntPtr values)
        {
            for (int i = 0; i < subjects.Count; ++i)
            {
                Subject subject = subjects[i];
                if (!Text.Equals(name, subject.DaemonKey) && !(subject.Requested == "" && FindName(i, subject, name)))
                {
                    continue;
                }
                bool decaying = (frame.Flags & Native.FrameDecaying) != 0;
                // A subject that was asked for by name and as the oldest arrives twice.
                if (!decaying && subject.Frames > 0 && frame.Sequence == subject.LastSequence &&
                    frame.CaptureTimeUs == subject.LastTimeUs)
                {
                    continue;
                }
                if (subject.Layout != frame.Layout)
                {
                    UpdateNames(subject);
                }
                if (subject.Names.Length != frame.Count)
                {
                    continue;
                }
                Marshal.Copy(values, subject.Values, 0, (int)frame.Count);
                subject.LastSequence = subject.Sequence = frame.Sequence;
                subject.LastTimeUs = subject.CaptureTimeUs = frame.CaptureTimeUs;
                subject.TimecodeBytes0To7 = frame.TimecodeBytes0To7;
                subject.TimecodeBytes8To15 = frame.TimecodeBytes8To15;
                subject.TimecodeRateNumerator = frame.TimecodeRateNumerator;
                subject.TimecodeRateDenominator = frame.TimecodeRateDenominator;
                subject.IsDecaying = decaying;
                subject.Frames += 1;
                subject.Raise();
            }
        }

        // For a subscription to the oldest subject: reads the name that the daemon chose.
        private bool FindName(int index, Subject subject, IntPtr name)
        {
            var buffer = new byte[Native.NameSize];
            if (Native.furrow_subject_name(handle, (uint)index, buffer, (uint)buffer.Length) != Native.Ok)
            {
                return false;
            }
            subject.Name = Text.FromC(buffer);
            subject.DaemonKey = Text.ToC(subject.Name);
            return Text.Equals(name, subject.DaemonKey);
        }

        private void UpdateNames()
        {
            foreach (Subject subject in subjects)
            {
                UpdateNames(subject);
            }
        }

        private void UpdateNames(Subject subject)
        {
            uint count;
            ulong layout;
            if (Native.furrow_layout(handle, subject.Key, out count, out layout) != Native.Ok ||
                layout == subject.Layout)
            {
                return;
            }
            var names = new string[count];
            var buffer = new byte[Native.NameSize];
            for (uint i = 0; i < count; ++i)
            {
                Check(Native.furrow_weight_name(handle, subject.Key, i, buffer, (uint)buffer.Length));
                names[i] = Text.FromC(buffer);
            }
            subject.Layout = layout;
            subject.Names = names;
            subject.Values = new float[count];
        }

        private static string StatusText(int status)
        {
            return Text.FromC(Native.furrow_status_text(status));
        }

        private void Check(int status)
        {
            if (status < Native.Ok)
            {
                string message = LastError();
                throw new FurrowException(message != "" ? message : StatusText(status));
            }
        }
    }

    /// <summary>Tells IL2CPP that C calls a method. IL2CPP finds the attribute by its name.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type)
        {
        }
    }
}
