
# Consider dependencies only in project.
set(CMAKE_DEPENDS_IN_PROJECT_ONLY OFF)

# The set of languages for which implicit dependencies are needed:
set(CMAKE_DEPENDS_LANGUAGES
  )

# The set of dependency files which are needed:
set(CMAKE_DEPENDS_DEPENDENCY_FILES
  "/tmp/hp/protocol/codec.cpp" "protocol/CMakeFiles/furrow_protocol.dir/codec.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/codec.cpp.o.d"
  "/tmp/hp/protocol/codec_frames.cpp" "protocol/CMakeFiles/furrow_protocol.dir/codec_frames.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/codec_frames.cpp.o.d"
  "/tmp/hp/protocol/codec_meeting.cpp" "protocol/CMakeFiles/furrow_protocol.dir/codec_meeting.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/codec_meeting.cpp.o.d"
  "/tmp/hp/protocol/codec_pose.cpp" "protocol/CMakeFiles/furrow_protocol.dir/codec_pose.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/codec_pose.cpp.o.d"
  "/tmp/hp/protocol/codec_skeleton.cpp" "protocol/CMakeFiles/furrow_protocol.dir/codec_skeleton.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/codec_skeleton.cpp.o.d"
  "/tmp/hp/protocol/codec_subscribe.cpp" "protocol/CMakeFiles/furrow_protocol.dir/codec_subscribe.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/codec_subscribe.cpp.o.d"
  "/tmp/hp/protocol/envelope.cpp" "protocol/CMakeFiles/furrow_protocol.dir/envelope.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/envelope.cpp.o.d"
  "/tmp/hp/protocol/fragment.cpp" "protocol/CMakeFiles/furrow_protocol.dir/fragment.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/fragment.cpp.o.d"
  "/tmp/hp/protocol/hash.cpp" "protocol/CMakeFiles/furrow_protocol.dir/hash.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/hash.cpp.o.d"
  "/tmp/hp/protocol/mocap/humanoid.cpp" "protocol/CMakeFiles/furrow_protocol.dir/mocap/humanoid.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/mocap/humanoid.cpp.o.d"
  "/tmp/hp/protocol/mocap/livelink_face.cpp" "protocol/CMakeFiles/furrow_protocol.dir/mocap/livelink_face.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/mocap/livelink_face.cpp.o.d"
  "/tmp/hp/protocol/mocap/neutral_frame.cpp" "protocol/CMakeFiles/furrow_protocol.dir/mocap/neutral_frame.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/mocap/neutral_frame.cpp.o.d"
  "/tmp/hp/protocol/mocap/osc.cpp" "protocol/CMakeFiles/furrow_protocol.dir/mocap/osc.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/mocap/osc.cpp.o.d"
  "/tmp/hp/protocol/mocap/osc_out.cpp" "protocol/CMakeFiles/furrow_protocol.dir/mocap/osc_out.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/mocap/osc_out.cpp.o.d"
  "/tmp/hp/protocol/mocap/vmc.cpp" "protocol/CMakeFiles/furrow_protocol.dir/mocap/vmc.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/mocap/vmc.cpp.o.d"
  "/tmp/hp/protocol/mocap/vmc_state.cpp" "protocol/CMakeFiles/furrow_protocol.dir/mocap/vmc_state.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/mocap/vmc_state.cpp.o.d"
  "/tmp/hp/protocol/pattern.cpp" "protocol/CMakeFiles/furrow_protocol.dir/pattern.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/pattern.cpp.o.d"
  "/tmp/hp/protocol/quantise.cpp" "protocol/CMakeFiles/furrow_protocol.dir/quantise.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/quantise.cpp.o.d"
  "/tmp/hp/protocol/sequence.cpp" "protocol/CMakeFiles/furrow_protocol.dir/sequence.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/sequence.cpp.o.d"
  "/tmp/hp/protocol/tcp_framing.cpp" "protocol/CMakeFiles/furrow_protocol.dir/tcp_framing.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/tcp_framing.cpp.o.d"
  "/tmp/hp/protocol/text.cpp" "protocol/CMakeFiles/furrow_protocol.dir/text.cpp.o" "gcc" "protocol/CMakeFiles/furrow_protocol.dir/text.cpp.o.d"
  )

# Targets to which this target links.
set(CMAKE_TARGET_LINKED_INFO_FILES
  )

# Fortran module output directory.
set(CMAKE_Fortran_TARGET_MODULE_DIR "")
