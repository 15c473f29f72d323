#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the sequence of each new frame that libfurrow.so receives.

    c_client.py LIBRARY ADDRESS SUBJECT
"""
import ctypes
import sys


class Frame(ctypes.Structure):
    """furrow_frame of furrow.h."""
    _fields_ = [("struct_size", ctypes.c_uint32), ("flags", ctypes.c_uint32), ("count", ctypes.c_uint32),
                ("sequence", ctypes.c_uint32), ("layout", ctypes.c_uint64), ("number", ctypes.c_uint64),
                ("missed", ctypes.c_uint64), ("capture_time_us", ctypes.c_int64), ("age_us", ctypes.c_int64)]


def main():
    library = ctypes.CDLL(sys.argv[1])
    address, subject = (word.encode() for word in sys.argv[2:4])
    connection = ctypes.c_void_p()
    if library.furrow_open(address, None, ctypes.byref(connection)) != 0:
        sys.exit("furrow_open failed")
    frame = Frame(struct_size=ctypes.sizeof(Frame))
    values = (ctypes.c_float * 4096)()
    newest = 0
    while True:
        library.furrow_poll(connection, ctypes.c_int32(10))
        status = library.furrow_weights(connection, subject, values, ctypes.c_uint32(4096), ctypes.byref(frame))
        # Flag 2: the daemon holds or decays; flag 1: the subject is gone.
        if status == 0 and frame.number != newest and frame.flags == 0:
            newest = frame.number
            print(frame.sequence, flush=True)


if __name__ == "__main__":
    main()
