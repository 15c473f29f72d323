// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/page_files.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/temporary_folder.h"

namespace furrow::server {
namespace {

TEST(PageFiles, OneMoreFileIsServedBesideThePage) {
  const TemporaryFolder folder;
  const std::string bytes(3000, 'x');
  std::filesystem::create_directory(folder.path() / "page");
  ASSERT_TRUE(WriteFileAtomically(folder.path() / "page/index.html", "<p>").ok());
  ASSERT_TRUE(WriteFileAtomically(folder.path() / "one.glb", bytes).ok());
  Result<PageFiles> page = PageFiles::Load(folder.path() / "page");
  ASSERT_TRUE(page.ok()) << page.status().ToString();
  EXPECT_EQ(page->Find("/character.glb"), nullptr);
  ASSERT_TRUE(page->Add("/character.glb", folder.path() / "one.glb", 3000).ok());
  const PageFile* file = page->Find("/character.glb");
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(file->type, "model/gltf-binary");
  EXPECT_EQ(file->bytes, bytes);
  EXPECT_LT(file->gzip.size(), 200u);
  EXPECT_FALSE(file->immutable);
  EXPECT_NE(page->Find("/"), nullptr);
}

TEST(PageFiles, LargeAndMissingFilesAreRejected) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "page");
  ASSERT_TRUE(WriteFileAtomically(folder.path() / "page/index.html", "<p>").ok());
  ASSERT_TRUE(WriteFileAtomically(folder.path() / "one.glb", std::string(3001, 'x')).ok());
  Result<PageFiles> page = PageFiles::Load(folder.path() / "page");
  ASSERT_TRUE(page.ok()) << page.status().ToString();
  EXPECT_EQ(page->Add("/character.glb", folder.path() / "one.glb", 3000).code(),
            StatusCode::kLimit);
  EXPECT_FALSE(page->Add("/character.glb", folder.path() / "absent.glb", 3000).ok());
  EXPECT_EQ(page->Find("/character.glb"), nullptr);
}

}  // namespace
}  // namespace furrow::server
