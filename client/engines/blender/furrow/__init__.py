# SPDX-License-Identifier: Apache-2.0
"""Furrow for Blender: live wrinkle weights of furrowd on objects, and recordings of them as keyframes.

Weights become custom properties of an object ("furrow_" and the name, for example furrow_brow_l_squash), and move shape
keys of the same name. The sidebar of the 3D view (N) has the tab Furrow. docs/engines/blender.md is the manual.
"""
bl_info = {
    "name": "Furrow",
    "description": "Live wrinkle weights on objects and shape keys",
    "author": "The Furrow authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Furrow",
    "category": "Animation",
}

if "bpy" in locals():  # "Reload Scripts"
    import importlib
    for module in (library, targets, recording, session, panel):  # pylint: disable=used-before-assignment
        importlib.reload(module)

import bpy  # pylint: disable=wrong-import-position
from . import library, targets, recording, session, panel  # pylint: disable=wrong-import-position


def register():
    panel.register()
    bpy.app.timers.register(session.tick, persistent=True)


def unregister():
    if bpy.app.timers.is_registered(session.tick):
        bpy.app.timers.unregister(session.tick)
    session.session.disconnect()
    panel.unregister()
