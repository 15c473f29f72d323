// SPDX-License-Identifier: Apache-2.0
#include "server/daemon_files.h"

#include <cstdlib>
#include <string>

#include "base/asset_path.h"
#include "base/data_dir.h"
#include "character/package/package.h"
#include "server/config/osc_profile_file.h"
#include "server/machine/cache_folder.h"

namespace furrow::server {
namespace {

namespace fs = std::filesystem;

fs::path FromEnvironment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? fs::path() : fs::path(value);
}

// The folder of a file, because editors replace files instead of writing to them, and the folder
// of what it links to.
void AppendFoldersOf(const fs::path& file, std::vector<fs::path>* folders) {
  std::error_code error;
  folders->push_back(fs::absolute(file, error).parent_path());
  const fs::path target = fs::canonical(file, error);
  if (!error && target.parent_path() != folders->back()) folders->push_back(target.parent_path());
}

}  // namespace

Confinement FilesOf(const Config& config) {
  Confinement files;
  // Drivers and the module of pictures are loaded late; /proc and /sys describe the devices.
  files.read = {"/usr",       "/lib",         "/lib64", "/opt",
                "/etc",       "/proc",        "/sys",   "/run/opengl-driver",
                "/nix/store", InstallPrefix()};
  files.read.push_back(FromEnvironment("FURROW_DATA_DIR"));
  AppendPaths(FromEnvironment("FURROW_ASSET_PATH").string(), &files.read);
  AppendPaths(FromEnvironment("LD_LIBRARY_PATH").string(), &files.read);
  AppendPaths(FromEnvironment("LIBGL_DRIVERS_PATH").string(), &files.read);
  AppendPaths(FromEnvironment("__EGL_VENDOR_LIBRARY_DIRS").string(), &files.read);
  const TlsFiles& tls = config.security.tls;
  const fs::path package =
      config.character.empty() ? fs::path() : character::FindCharacterFile(config.character);
  for (const fs::path& file :
       {config.source, package, config.rig, fs::path(config.skeleton_map),
        fs::path(config.shape_map), config.security.keys, config.play, config.render_settings,
        config.http.page, tls.certificate, tls.key, tls.client_authority,
        config.cluster.credentials, config.cluster.authority}) {
    if (!file.empty()) AppendFoldersOf(file, &files.read);
  }
  if (!package.empty()) AppendFoldersOf(character::RigBeside(package), &files.read);
  if (!config.http.page.empty()) files.read.push_back(config.http.page);
  for (const OscTargetConfig& target : config.osc.targets) {
    if (!IsShippedOscProfile(target.profile)) AppendFoldersOf(target.profile, &files.read);
  }
  // The GPU, shared memory, and the drivers' temporary files and caches of compiled shaders.
  std::error_code error;
  files.write = {"/dev",
                 fs::temp_directory_path(error),
                 FromEnvironment("XDG_RUNTIME_DIR"),
                 FromEnvironment("MESA_SHADER_CACHE_DIR"),
                 FromEnvironment("__GL_SHADER_DISK_CACHE_PATH"),
                 CacheFolder(),
                 config.record.folder};
  const fs::path home = FromEnvironment("HOME");
  const fs::path cache = FromEnvironment("XDG_CACHE_HOME");
  if (!cache.empty()) files.write.push_back(cache);
  if (!home.empty()) {
    if (cache.empty()) files.write.push_back(home / ".cache");
    files.write.push_back(home / ".nv");
  }
  files.run = {"/usr", "/lib", "/lib64", "/nix/store", InstallPrefix()};
  std::erase_if(files.read, [](const fs::path& path) { return path.empty(); });
  std::erase_if(files.write, [](const fs::path& path) { return path.empty(); });
  return files;
}

}  // namespace furrow::server
