// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "motion/clip/clip.h"
#include "recording/take_reader.h"
#include "rig/shapes/rig_shapes.h"
#include "rig/skeleton_match.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"
#include "wrinkle/solver/solver.h"

namespace furrow::cli {

// Help of an argument that LoadCharacterArgument() reads.
inline constexpr char kCharacterHelp[] =
    "Character package (.glb), or the name of a shipped character such as elder";

// Loads a recording: the file `path`, or the shipped one of that name (motion::FindRecording()).
// "take.mcap#NAME" selects a subject of a take with several subjects, "walk.fbx#NAME" an animation
// of a file with several. Prints the reader's warnings to standard error. Sets `report`, unless it
// is null. Errors: those of motion::FindRecording() and motion::LoadClip().
[[nodiscard]] Result<motion::Clip> LoadClipArgument(const std::string& path,
                                                    const motion::LoadOptions& options = {},
                                                    motion::ClipReport* report = nullptr);

// Returns a callback that shows a progress bar while a take is read. The end of the read erases it.
[[nodiscard]] recording::ReadProgress ReadingBar();

// Opens a take, "take.mcap" or "take.mcap#NAME", with a progress bar. Sets `subject` to NAME, or to
// an empty string without one.
[[nodiscard]] Result<std::unique_ptr<recording::TakeReader>> OpenTakeArgument(
    const std::string& path, std::string* subject);

// Prints "furrow: warning: <text>" to standard error for each warning.
void PrintWarnings(const std::vector<std::string>& warnings);

// Resolves a --rig argument: an existing path, else the path of the shipped rig of this name. An
// argument that is neither is returned unchanged, so that the loader reports the error.
[[nodiscard]] std::filesystem::path ResolveRigPath(const std::string& argument);

// Reads the recordings of a rig's reference poses, in Furrow's axes. Prints the reader's warnings.
// `read`: how they are read; its rest frame is ignored, because poses state one of their own.
// `skeleton_map`: the map that the user chose, or empty; it, the shipped maps and the roles that
// `package` states (a character's file, or empty) tell the axes. They are read with the first
// recording, but a map that the user chose must exist. Errors: those of
// rig::SkeletonMatcher::Create().
[[nodiscard]] Result<wrinkle::PoseSource> RigPoses(const motion::LoadOptions& read,
                                                   const std::string& skeleton_map = {},
                                                   const std::filesystem::path& package = {});

// Loads a rig by path, or a shipped rig by name ("cmu" or "cmu.json"). `read` and `skeleton_map`:
// see RigPoses().
[[nodiscard]] Result<wrinkle::Rig> LoadRigArgument(const std::string& argument,
                                                   const motion::LoadOptions& read = {},
                                                   const std::string& skeleton_map = {});

// A rig, with the character that it came with.
struct RigInput {
  wrinkle::Rig rig;
  std::unique_ptr<const character::Character> character;  // null: a rig alone
  [[nodiscard]] const wrinkle::Skeleton* skeleton() const {
    return character == nullptr ? nullptr : &character->skeleton;
  }
};

// The character package that a rig argument names: a .glb file, or a shipped character ("elder").
// Empty if the argument names a rig, such as "default", which is a shipped character, too.
[[nodiscard]] std::filesystem::path FindPackageArgument(const std::string& argument);

// The failure to find the rig of a character package. Code: kNotFound.
[[nodiscard]] Status CharacterWithoutRig(const std::string& argument);

// As LoadRigArgument(), and accepts a character package (FindPackageArgument()), whose rig is used
// and whose shapes then follow a recording's joints as in the daemon. Errors: those of
// CharacterWithoutRig().
[[nodiscard]] Result<RigInput> LoadRigInput(const std::string& argument,
                                            const motion::LoadOptions& read = {},
                                            const std::string& skeleton_map = {});

// Loads the skeleton map of --skeleton-map, by name or file. An empty `map` selects the best
// shipped map per skeleton. `character` may be null: its package may state the roles of its joints.
// Without shipped maps, joints match by equal names and a warning is printed.
[[nodiscard]] Result<rig::SkeletonMatcher> LoadSkeletonMatcher(
    const std::string& map, const character::Character* character = nullptr);

// Prints to standard error which skeleton map the joints of a recording follow and how well it
// fits, in one line, and the match's warnings. Prints nothing for a recording without joints.
void PrintMatch(const rig::SkeletonMatch& match);

// The same for skeletons alone, with the shipped maps: what other commands and the daemon find.
void PrintMatchesOf(std::span<const wrinkle::Skeleton> skeletons);

// Finds the joints that `rig` reads in the recording, and calls PrintMatch(). `character` may be
// null; see SkeletonMatcher::Match().
[[nodiscard]] rig::SkeletonMatch MatchJoints(const rig::SkeletonMatcher& matcher,
                                             const motion::Clip& clip, const wrinkle::Rig& rig,
                                             const wrinkle::Skeleton* character = nullptr);

// Loads the shape map of --shape-map in the same way. Without shipped maps, blend shapes match by
// equal names.
[[nodiscard]] Result<rig::ShapeMatcher> LoadShapeMatcher(const std::string& map);

// Finds the blend shapes that `rig` reads in the recording. Prints which map is used, if one is.
// `moved`: the shapes of a character that the recording's joints move.
[[nodiscard]] rig::RigShapes MatchBlendShapes(const rig::ShapeMatcher& matcher,
                                              const motion::Clip& clip, const wrinkle::Rig& rig,
                                              const rig::JointMovedShapes& moved = {});

// Finds the shapes of `character` that the recording's joints move, unless its blend shapes move
// any. `match`: MatchJoints() for this character. Prints one line if there are any. The result
// refers to `character`; null gives nothing.
[[nodiscard]] rig::JointMovedShapes MatchFaceJoints(const rig::ShapeMatcher& matcher,
                                                    const motion::Clip& clip,
                                                    const rig::SkeletonMatch& match,
                                                    const character::Character* character);

// Prints one warning for the joints and one for the blend shapes that the rig reads and the
// recording lacks, with their number and the first few names. A recording without any blend shapes
// gives no warning about blend shapes.
void WarnAboutMissing(const wrinkle::RigBinding& binding, const motion::Clip& clip);

// Loads a character package. `glb`: see character::FindCharacterFile(); empty: the default
// character. `rig`: a rig that replaces the rig of the package, by path or name of a shipped rig;
// empty: keep the rig of the package. `read` and `skeleton_map`: see RigPoses().
[[nodiscard]] Result<character::Character> LoadCharacterArgument(
    const std::string& glb, const std::string& rig, const motion::LoadOptions& read = {},
    const std::string& skeleton_map = {});

}  // namespace furrow::cli
