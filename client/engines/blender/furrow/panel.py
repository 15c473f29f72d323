# SPDX-License-Identifier: Apache-2.0
"""The tab in the sidebar, its buttons, and what a scene and the preferences store."""
import json
import textwrap

import bpy
from bpy.app.handlers import persistent

from . import library, recording, targets
from .session import session

LINE = 30  # characters per line of the sidebar at its usual width


class FurrowPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    library_path: bpy.props.StringProperty(
        name="libfurrow.so.1", subtype="FILE_PATH",
        description="The library, or its folder. Empty: beside the add-on, then the system's search path")

    def draw(self, _context):
        self.layout.prop(self, "library_path")


class FurrowRow(bpy.types.PropertyGroup):
    """A subject and the object that it drives."""
    subject: bpy.props.StringProperty(
        name="Subject", description="Name of the performer, as 'furrow watch' shows it. Empty: the oldest one")
    target: bpy.props.PointerProperty(
        name="Object", type=bpy.types.Object, description="Object that receives the weights")


class FurrowScene(bpy.types.PropertyGroup):
    address: bpy.props.StringProperty(
        name="Address", default="furrow://127.0.0.1",
        description="furrow://HOST[:PORT], or with ?transport=tcp (default: UDP, port 7401)")
    rows: bpy.props.CollectionProperty(type=FurrowRow)
    active: bpy.props.IntProperty()


class FURROW_UL_rows(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property):
        split = layout.split(factor=0.4)
        split.prop(item, "subject", text="")
        split.prop(item, "target", text="")


class FURROW_OT_add(bpy.types.Operator):
    """Add a subject for the active object"""
    bl_idname = "furrow.add"
    bl_label = "Add"
    bl_options = {"UNDO"}

    def execute(self, context):
        row = context.scene.furrow.rows.add()
        row.target = context.object
        context.scene.furrow.active = len(context.scene.furrow.rows) - 1
        return {"FINISHED"}


class FURROW_OT_remove(bpy.types.Operator):
    """Remove the selected subject and its custom properties from the object"""
    bl_idname = "furrow.remove"
    bl_label = "Remove"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        return 0 <= context.scene.furrow.active < len(context.scene.furrow.rows)

    def execute(self, context):
        settings = context.scene.furrow
        target = settings.rows[settings.active].target
        settings.rows.remove(settings.active)
        if target and all(row.target != target for row in settings.rows):
            targets.remove(target)
        settings.active = max(0, settings.active - 1)
        return {"FINISHED"}


class FURROW_OT_connect(bpy.types.Operator):
    """Connect to the daemon at the address"""
    bl_idname = "furrow.connect"
    bl_label = "Connect"

    def execute(self, context):
        entry = context.preferences.addons.get(__package__)
        path = entry.preferences.library_path if entry else ""
        try:
            session.connect(context.scene.furrow.address, bpy.path.abspath(path))
        except library.FurrowError as error:
            session.error = str(error)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class FURROW_OT_disconnect(bpy.types.Operator):
    """Disconnect; objects keep their last weights"""
    bl_idname = "furrow.disconnect"
    bl_label = "Disconnect"

    def execute(self, _context):
        session.disconnect()
        return {"FINISHED"}


class FURROW_OT_record(bpy.types.Operator):
    """Record the weights to keyframes from the current frame on; click again to stop"""
    bl_idname = "furrow.record"
    bl_label = "Record"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, _context):
        return session.connection is not None

    def execute(self, context):
        if session.recording:
            count = session.stop_recording(context.scene)
            self.report({"INFO"}, f"recorded {count} frames")
        else:
            session.start_recording(context.scene)
        return {"FINISHED"}


class FURROW_OT_clear(bpy.types.Operator):
    """Remove the keyframes of weights from all objects in the list"""
    bl_idname = "furrow.clear"
    bl_label = "Clear Keyframes"
    bl_options = {"UNDO"}

    def execute(self, context):
        objects = {row.target for row in context.scene.furrow.rows if row.target}
        count = sum(recording.clear(target) for target in objects)
        self.report({"INFO"}, f"removed {count} channels")
        return {"FINISHED"}


class FURROW_OT_build_material(bpy.types.Operator):
    """Add the wrinkles of an export to the materials of the active object"""
    bl_idname = "furrow.build_material"
    bl_label = "Build Wrinkle Material"
    bl_options = {"UNDO"}

    filepath: bpy.props.StringProperty(
        name="wrinkles.json", subtype="FILE_PATH", description="File of 'furrow export --for blender'")
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return context.object is not None

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        try:
            from . import nodes  # pylint: disable=import-outside-toplevel
        except ImportError:
            return self._fail("the add-on has no nodes.py; install an add-on that contains this file")
        try:
            built = nodes.build_material(bpy.path.abspath(self.filepath), context.object)
        except (json.JSONDecodeError, UnicodeDecodeError, AttributeError, IndexError, KeyError, TypeError) as error:
            return self._fail(f"{self.filepath}: damaged ({error!r}); export it again")
        except (OSError, ValueError, RuntimeError) as error:
            return self._fail(str(error))
        self.report({"INFO"}, f"built: {', '.join(built)}")
        return {"FINISHED"}

    def _fail(self, text):
        self.report({"ERROR"}, text)
        return {"CANCELLED"}


def draw_text(layout, text, icon="NONE"):
    """Labels do not wrap, and the sidebar is narrow."""
    column = layout.column(align=True)
    for number, line in enumerate(textwrap.wrap(text, LINE)):
        column.label(text=line, icon=icon if number == 0 else "BLANK1" if icon != "NONE" else "NONE")


class FURROW_PT_sidebar(bpy.types.Panel):
    bl_label = "Furrow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Furrow"

    def draw(self, context):
        layout, settings = self.layout, context.scene.furrow
        layout.prop(settings, "address", text="")
        if session.connection is None:
            layout.operator("furrow.connect", icon="LINKED")
        else:
            layout.operator("furrow.disconnect", icon="UNLINKED")
        draw_text(layout, session.status(), "ERROR" if session.error else "INFO")
        line = layout.row()
        line.template_list("FURROW_UL_rows", "", settings, "rows", settings, "active", rows=3)
        buttons = line.column(align=True)
        buttons.operator("furrow.add", text="", icon="ADD")
        buttons.operator("furrow.remove", text="", icon="REMOVE")
        for row in settings.rows:
            draw_text(layout, f"{row.subject or 'oldest'}: {session.row_status(row)}")
        layout.operator("furrow.record", text="Stop" if session.recording else "Record",
                        icon="SNAP_FACE" if session.recording else "REC")
        layout.operator("furrow.clear", icon="X")
        layout.operator("furrow.build_material", icon="MATERIAL")


@persistent
def disconnect_before_load(_):
    """The objects of another file are not those of the list."""
    session.disconnect()


CLASSES = (FurrowPreferences, FurrowRow, FurrowScene, FURROW_UL_rows, FURROW_OT_add, FURROW_OT_remove, FURROW_OT_connect,
           FURROW_OT_disconnect, FURROW_OT_record, FURROW_OT_clear, FURROW_OT_build_material, FURROW_PT_sidebar)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.furrow = bpy.props.PointerProperty(type=FurrowScene)
    bpy.app.handlers.load_pre.append(disconnect_before_load)


def unregister():
    bpy.app.handlers.load_pre.remove(disconnect_before_load)
    del bpy.types.Scene.furrow
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
