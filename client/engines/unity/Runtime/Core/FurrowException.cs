// SPDX-License-Identifier: Apache-2.0
using System;

namespace Furrow
{
    /// <summary>A function of the library failed. The message says what to do.</summary>
    public sealed class FurrowException : Exception
    {
        public FurrowException(string message) : base(message)
        {
        }
    }
}
