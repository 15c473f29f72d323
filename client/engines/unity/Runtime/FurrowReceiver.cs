// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using UnityEngine;

namespace Furrow
{
    /// <summary>A connection to furrowd. FurrowTarget components take the weights from it.</summary>
    [AddComponentMenu("Furrow/Furrow Receiver")]
    public sealed class FurrowReceiver : MonoBehaviour
    {
        [Tooltip("furrow://HOST[:PORT], or with ?transport=tcp (default: UDP, port 7401)")]
        public string address = "furrow://127.0.0.1";

        [Tooltip("Connect when the component is enabled")]
        public bool connectOnEnable = true;

        private readonly Dictionary<string, Subject> subjects = new Dictionary<string, Subject>();
        private Connection connection;
        private string error = "";

        public bool IsOpen
        {
            get { return connection != null; }
        }

        /// <summary>One line for people.</summary>
        public string Status
        {
            get
            {
                if (connection == null)
                {
                    return error != "" ? error : "not connected";
                }
                switch (connection.State)
                {
                    case ConnectionState.Connected: return "connected to " + connection.Address;
                    case ConnectionState.Lost: return "connection lost, trying again: " + connection.Address;
                    default: return "connecting to " + connection.Address;
                }
            }
        }

        public void Connect()
        {
            Disconnect();
            try
            {
                connection = new Connection(address);
                error = "";
            }
            catch (FurrowException failure)
            {
                Fail(failure.Message);
            }
            catch (DllNotFoundException)
            {
                Fail("libfurrow.so was not found; copy it to Assets/Plugins/x86_64");
            }
        }

        /// <summary>Ends the connection. Targets keep their last weights.</summary>
        public void Disconnect()
        {
            if (connection != null)
            {
                connection.Dispose();  // throws inside Subject.Received, and then everything stays as it was
                connection = null;
            }
            subjects.Clear();
        }

        /// <summary>Follows a subject; an empty name means the oldest one. Null while there is no connection.</summary>
        public Subject Follow(string subjectName)
        {
            Subject subject;
            if (connection == null)
            {
                return null;
            }
            if (!subjects.TryGetValue(subjectName, out subject))
            {
                subject = connection.Subscribe(subjectName);
                subjects.Add(subjectName, subject);
            }
            return subject;
        }

        /// <summary>One line about a subject that is followed: age of the last frame and losses.</summary>
        public string StatusOf(Subject subject)
        {
            if (connection == null || subject == null)
            {
                return "not connected";
            }
            SubjectStatus status = connection.StatusOf(subject);
            if (!status.HasWeights)
            {
                return status.Message;
            }
            return status.IsGone
                ? "the subject has left"
                : string.Format("{0:F0} ms old, {1} missed", status.AgeMs, status.Missed);
        }

        private void OnEnable()
        {
            if (connectOnEnable)
            {
                Connect();
            }
        }

        private void OnDisable()
        {
            Disconnect();
        }

        private void Update()
        {
            if (connection == null)
            {
                return;
            }
            try
            {
                connection.Poll();
            }
            catch (FurrowException failure)
            {
                Disconnect();
                Fail(failure.Message);
            }
        }

        private void Fail(string message)
        {
            error = message;
            Debug.LogError("Furrow: " + message, this);
        }
    }
}
